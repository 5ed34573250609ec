#include "cli/update_template.h"

#include <set>

#include "cli/feature_options.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/feedback.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

namespace fs = std::filesystem;

// The marks of one template's hits, out of tables that may hold those of others too.
std::vector<ListedMark> MarksOf(const std::string& template_name,
                                const std::vector<fs::path>& tables) {
  std::vector<ListedMark> marks;
  std::set<std::string> others;
  for (const fs::path& table : tables) {
    for (ListedMark& mark : ReadMarks(table)) {
      if (mark.template_name.empty() || mark.template_name == template_name) {
        marks.push_back(std::move(mark));
      } else {
        others.insert(mark.template_name);
      }
    }
  }
  if (!marks.empty()) return marks;
  if (!others.empty()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("has marks of hits of {}, and none of '{}'", fmt::join(others, ", "),
                            template_name),
                {tables.front()});
  }
  throw Error(ErrorCode::kInvalidArgument,
              "no hit is marked; write right or wrong as the verdict of some", {tables.front()});
}

// Where takes are looked for: what is named, then beside the marks and the template.
std::vector<fs::path> PlacesOf(const UpdateCommandOptions& options) {
  std::vector<fs::path> places = options.folders;
  for (const fs::path& table : options.marks) {
    places.push_back(fs::absolute(table).parent_path());
  }
  places.push_back(fs::absolute(options.template_file).parent_path());
  return places;
}

std::string TauText(const std::optional<double>& tau) {
  return tau ? fmt::format("{:.4f}", *tau) : "none";
}

void PrintNotes(const UpdateCommandOptions& options, const Feedback& feedback,
                const TemplateUpdate& update) {
  if (update.matrix == MatrixUpdate::kAveraged) {
    PrintNote(options.common,
              fmt::format("{} of its clips cannot be had ({}), so that right hits were averaged in "
                          "instead of learning again; name their folder with --in",
                          feedback.lost.size(), OnOneLine(feedback.lost.front())));
  }
  if (update.matrix == MatrixUpdate::kAveragedOwn) {
    PrintNote(options.common,
              "the template is not what its clips make, as it was edited or made in another way; "
              "right hits were averaged in instead of learning again");
  }
  if (!feedback.unusable.empty()) {
    PrintNote(options.common,
              fmt::format("{} of earlier updates did not count, as {} cannot be had",
                          FormatCount(std::ssize(feedback.unusable), "mark", "marks"),
                          OnOneLine(feedback.unusable.front().file)));
  }
  const auto unmatched = std::ssize(feedback.judged) - update.right - update.wrong;
  if (unmatched > 0) {
    PrintNote(options.common,
              fmt::format("{} did not count for the threshold, as the template does not match "
                          "there at any cost: too short or too long",
                          FormatCount(unmatched, "mark", "marks")));
  }
  if (update.contradictory) {
    PrintNote(options.common,
              "the marks contradict each other: no threshold tells right from wrong hits");
  }
  if (update.keyframes_dropped) {
    PrintNote(options.common,
              "its keyframes were of other columns and are gone; kinebase template "
              "keyframes chooses new ones");
  }
}

Json ToJson(const TemplateUpdate& update, const std::optional<double>& tau_before,
            const fs::path& file, double elapsed_s) {
  const auto number = [](const std::optional<double>& tau) { return tau ? Json(*tau) : Json(); };
  return {{"name", update.updated.name},
          {"clips", update.updated.clips.size()},
          {"columns", update.updated.matrix.column_count()},
          {"rounds", update.updated.rounds},
          {"elapsed_s", elapsed_s},
          {"file", file.string()},
          {"learned_again", update.matrix == MatrixUpdate::kRelearned},
          {"clips_added", update.clips_added},
          {"clips_dropped", update.clips_dropped},
          {"right", update.right},
          {"wrong", update.wrong},
          {"contradictory", update.contradictory},
          {"tau", number(update.updated.tau)},
          {"tau_before", number(tau_before)}};
}

std::string ToText(const TemplateUpdate& update, const std::optional<double>& tau_before,
                   const fs::path& file) {
  std::string clips = FormatCount(std::ssize(update.updated.clips), "clip", "clips");
  if (update.clips_added > 0) clips += fmt::format(", {} of them new", update.clips_added);
  if (update.clips_dropped > 0) clips += fmt::format(", {} left out", update.clips_dropped);
  return fmt::format("{}: {} right, {} wrong; from {}; tau {}, was {}; written to {}\n",
                     OnOneLine(update.updated.name), FormatCount(update.right, "mark", "marks"),
                     update.wrong, clips, TauText(update.updated.tau), TauText(tau_before),
                     OnOneLine(file.string()));
}

}  // namespace

int RunUpdate(UpdateCommandOptions options) {
  const Stopwatch watch;
  if (options.output.empty()) options.output = options.template_file;
  const MotionTemplate before = ReadTemplate(options.template_file);
  CheckWritable(options.output, options.common.overwrite());
  const FeatureSet features =
      FeatureSetOfTemplate(options.template_file, before, options.feature_set);
  const ProgressCallback progress = MakeProgress(options.common);
  const Feedback feedback = LoadFeedback(before, MarksOf(before.name, options.marks), features,
                                         {.folders = PlacesOf(options),
                                          .load = options.common.load,
                                          .threads = options.common.threads,
                                          .progress = progress});
  for (const TakeFeatures& take : feedback.takes) {
    PrintDiagnostics(options.common, take.path, take.diagnostics);
  }
  const TemplateUpdate update = UpdateTemplate(
      before, feedback,
      {.max_rounds = options.max_rounds, .threads = options.common.threads, .progress = progress});
  WriteTemplate(update.updated, options.output, options.common.overwrite());
  PrintNotes(options, feedback, update);
  if (options.common.json) {
    PrintJson(ToJson(update, before.tau, options.output, watch.seconds()));
  } else {
    Print(ToText(update, before.tau, options.output));
  }
  return kDone;
}

}  // namespace kinebase::cli
