// kinebase library label, compact: what is changed of the takes of a library.

#include "cli/failure_output.h"
#include "cli/library_actions.h"
#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/library_compaction.h"
#include "kinebase/library/library_labels.h"

namespace kinebase::cli {
namespace {

// "120-480".
void ReadFrames(const std::string& text, LabelChange& change) {
  if (text.empty()) return;
  const std::size_t dash = text.find('-');
  const auto first = ParseInteger(std::string_view(text).substr(0, dash));
  const auto last = dash == std::string::npos
                        ? std::optional<std::int64_t>()
                        : ParseInteger(std::string_view(text).substr(dash + 1));
  if (!first || !last || *first < 1 || *last < *first) {
    throw UsageError("--frames '" + text + "': expected first-last, counted from 1, as 120-480");
  }
  change.first_frame = *first;
  change.last_frame = *last;
}

LabelReport LabelByHand(const LibraryOptions& options) {
  LabelChange change{.add = options.add, .remove = options.remove};
  ReadFrames(options.frames, change);
  if (options.choice.names.empty() && options.choice.filter == TakeFilter()) {
    throw UsageError(
        "library label needs TAKEs or --actors, --classes, --labelled, --formats or "
        "--text, to say which takes are meant");
  }
  return ChangeLabels(options.library, options.choice, change);
}

int WriteLabels(const LibraryOptions& options) {
  const bool is_printed = IsStandardOutput(options.output);
  if (options.common.json && is_printed) throw UsageError("--json needs -o FILE");
  if (!is_printed) CheckWritable(options.output, options.common.overwrite());
  const TakeLibrary library(options.library);
  WriteTextOrPrint(options.output, FormatLabelTable(ChooseTakes(library, options.choice)),
                   options.common);
  if (is_printed) return kDone;
  if (options.common.json) {
    PrintJson({{"file", options.output.string()}});
  } else {
    PrintWritten(options.common, options.output);
  }
  return kDone;
}

int Label(const LibraryOptions& options) {
  if (!options.output.empty()) return WriteLabels(options);
  const bool is_by_hand = !options.add.empty() || !options.remove.empty();
  if (is_by_hand != options.table.empty()) {
    throw UsageError("library label needs --add or --remove, a table with --from, or -o for one");
  }
  const LabelReport report =
      is_by_hand ? LabelByHand(options)
                 : AddSegmentLabels(options.library, options.choice,
                                    ReadSegmentLabels(options.table), options.table);
  if (options.common.json) {
    PrintJson({{"takes", report.takes},
               {"added", report.added},
               {"removed", report.removed},
               {"passed_over", report.passed_over}});
    return kDone;
  }
  Print(fmt::format("{} added, {} removed, in {}\n", FormatCount(report.added, "label", "labels"),
                    report.removed, FormatCount(report.takes, "take", "takes")));
  if (report.passed_over > 0) {
    PrintNote(options.common, fmt::format("{} of recordings that are not among these takes",
                                          FormatCount(report.passed_over, "row", "rows")));
  }
  return kDone;
}

int Compact(const LibraryOptions& options) {
  const CompactReport report =
      CompactLibrary(options.library, {.progress = MakeProgress(options.common)});
  for (const TakeFailure& failure : report.failures) PrintError(failure.error.what());
  if (options.common.json) {
    Json json = {{"segments_before", report.segments_before},
                 {"segments_after", report.segments_after},
                 {"bytes_before", report.bytes_before},
                 {"bytes_after", report.bytes_after},
                 {"bytes_freed", report.bytes_before - report.bytes_after}};
    if (!report.failures.empty()) json["failed"] = FailuresToJson(report.failures);
    PrintJson(json);
  } else {
    Print(fmt::format("{} freed; {} in {}, before {} in {}\n",
                      FormatSize(report.bytes_before - report.bytes_after),
                      FormatSize(report.bytes_after),
                      FormatCount(report.segments_after, "segment", "segments"),
                      FormatSize(report.bytes_before), report.segments_before));
  }
  return report.failures.empty() ? kDone : kPartFailed;
}

}  // namespace

void AddLabelActions(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                     int& exit_code) {
  CLI::App* label = AddLibraryAction(command, options, exit_code, "label", &Label);
  label->description("Give takes, or stretches of them, key words to find them by");
  AddTakeChoiceOptions(*label, options->choice);
  const auto words = [&](const char* name, std::vector<std::string>& values, const char* help) {
    return label->add_option(name, values, help)->delimiter(',')->type_name("WORDS");
  };
  CLI::Option* add = words("--add", options->add, "Labels to add: a,b");
  CLI::Option* remove = words("--remove", options->remove, "Labels to remove: a,b");
  CLI::Option* frames = label->add_option("--frames", options->frames,
                                          "The stretch that is meant, as 120-480; else the take");
  frames->type_name("FIRST-LAST");
  label
      ->add_option("--from", options->table,
                   "Labels of stretches from a table (CSV: file,class,first_frame,last_frame), as "
                   "annotate writes and evaluate reads it")
      ->type_name("FILE")
      ->excludes(add)
      ->excludes(remove)
      ->excludes(frames);
  label
      ->add_option("-o,--output", options->output,
                   "Write the labels as such a table (-: standard output)")
      ->type_name("FILE")
      ->excludes(add)
      ->excludes(remove)
      ->excludes(frames)
      ->excludes("--from");
  AddForceOption(*label, options->common);
  label->footer(
      "Examples:\n"
      "  kinebase library label motion.kinebase --classes squat1Reps --add gym,legs\n"
      "  kinebase library label motion.kinebase gym.amc --add warm-up --frames 1-480\n"
      "  kinebase library label motion.kinebase --from labels.csv");

  CLI::App* compact = AddLibraryAction(command, options, exit_code, "compact", &Compact);
  compact->description("Give back the room of removed takes, and join small segment files");
  compact->footer("Example:\n  kinebase library compact motion.kinebase");
}

}  // namespace kinebase::cli
