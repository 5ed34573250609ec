// kinebase library: what is in a library on disk, whether it is sound, taking takes out of it.

#include <algorithm>
#include <map>
#include <memory>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/take_filter.h"
#include "fmt/format.h"
#include "kinebase/library/library_upkeep.h"

namespace kinebase::cli {
namespace {

struct LibraryOptions {
  CommonOptions common;
  std::filesystem::path library;
  TakeFilter filter;                         // list, remove, export
  std::vector<std::filesystem::path> names;  // remove
  bool damaged = false;
  std::filesystem::path output;  // export
};

std::vector<StoredTake> ChosenTakes(const TakeLibrary& library, const TakeFilter& filter) {
  library.CheckFilter(filter);
  std::vector<StoredTake> takes;
  std::ranges::copy_if(library.takes(), std::back_inserter(takes),
                       [&](const StoredTake& take) { return filter.Accepts(take); });
  return takes;
}

bool HasPoses(const StoredTake& take) {
  return std::ranges::any_of(take.features, &StoredFeatures::has_poses);
}

double SecondsOf(const StoredTake& take) {
  return take.rate_hz > 0 ? static_cast<double>(take.frame_count) / take.rate_hz : 0;
}

std::string FormatSize(std::int64_t bytes) {
  constexpr double kBytesPerMegabyte = 1e6;
  return fmt::format("{:.2f} MB", static_cast<double>(bytes) / kBytesPerMegabyte);
}

Json ToJson(const StoredTake& take) {
  const auto text_or_null = [](const std::string& text) {
    return text.empty() ? Json() : Json(text);
  };
  return {{"file", take.path.string()},
          {"format", take.format},
          {"actor", text_or_null(take.name.actor)},
          {"class", text_or_null(take.name.class_name)},
          {"take", text_or_null(take.name.take)},
          {"frames", take.frame_count},
          {"rate_hz", take.rate_hz},
          {"duration_s", SecondsOf(take)},
          {"poses", HasPoses(take)}};
}

Json ListAsJson(const TakeLibrary& library, const std::vector<StoredTake>& takes) {
  Json json = {{"takes", Json::array()}, {"feature_sets", Json::array()}};
  for (const StoredTake& take : takes) json["takes"].push_back(ToJson(take));
  for (const StoredFeatureSet& set : library.feature_sets()) {
    json["feature_sets"].push_back(
        {{"name", set.name}, {"rate_hz", set.rate_hz}, {"takes", set.takes}});
  }
  json["bytes"] = library.segment_bytes();
  return json;
}

int List(const LibraryOptions& options) {
  const TakeLibrary library(options.library);
  const std::vector<StoredTake> takes = ChosenTakes(library, options.filter);
  if (options.common.json) {
    PrintJson(ListAsJson(library, takes));
    return kDone;
  }
  TextTable table({"file", "format", "actor", "class", ">frames", ">Hz", ">s", "poses"});
  double seconds = 0;
  for (const StoredTake& take : takes) {
    table.Add({take.path.string(), take.format, take.name.actor, take.name.class_name,
               std::to_string(take.frame_count), fmt::format("{:g}", take.rate_hz),
               fmt::format("{:.2f}", SecondsOf(take)), HasPoses(take) ? "yes" : ""});
    seconds += SecondsOf(take);
  }
  if (!takes.empty()) Print(table.ToString());
  std::string note =
      fmt::format("{}, {} min:s; {} on disk", FormatCount(std::ssize(takes), "take", "takes"),
                  FormatTime(seconds), FormatSize(library.segment_bytes()));
  for (const StoredFeatureSet& set : library.feature_sets()) {
    note += fmt::format("; features '{}' at {:g} Hz of {}", set.name, set.rate_hz,
                        FormatCount(set.takes, "take", "takes"));
  }
  PrintNote(options.common, note);
  return kDone;
}

// A line for what is wrong, with the take, or how many there are, that it costs.
void PrintDamage(const std::vector<TakeFailure>& damaged) {
  std::map<std::string, std::vector<const TakeFailure*>> takes;  // By what is wrong.
  for (const TakeFailure& failure : damaged) takes[failure.error.what()].push_back(&failure);
  for (const auto& [what, failures] : takes) {
    PrintError(failures.size() == 1 ? fmt::format("{}: {}", failures.front()->path.string(), what)
                                    : fmt::format("{} takes, such as {}: {}", failures.size(),
                                                  failures.front()->path.string(), what));
  }
}

int Verify(const LibraryOptions& options) {
  const VerifyReport report =
      VerifyLibrary(options.library, options.common.threads, MakeProgress(options.common));
  PrintDamage(report.damaged);
  if (!report.damaged.empty() && std::ssize(report.damaged) == report.takes) return kCouldNot;
  if (options.common.json) {
    Json json = {{"takes", report.takes},
                 {"bytes", report.segment_bytes},
                 {"leftovers", report.leftovers.size()}};
    for (const TakeFailure& damaged : report.damaged) {
      json["failed"].push_back(
          {{"file", damaged.path.string()}, {"message", damaged.error.what()}});
    }
    PrintJson(json);
  } else {
    Print(fmt::format(
        "{}, {}: {}\n", FormatCount(report.takes, "take", "takes"),
        FormatSize(report.segment_bytes),
        report.damaged.empty() ? "all intact" : fmt::format("{} damaged", report.damaged.size())));
  }
  if (!report.leftovers.empty()) {
    PrintNote(options.common,
              fmt::format("{} of an import that was cut short, or still goes on; the next import "
                          "removes what is left",
                          FormatCount(std::ssize(report.leftovers), "file", "files")));
  }
  return report.damaged.empty() ? kDone : kPartFailed;
}

int Remove(const LibraryOptions& options) {
  const bool is_filtered = !options.filter.actors.empty() || !options.filter.classes.empty();
  if (options.names.empty() && !is_filtered && !options.damaged) {
    throw UsageError(
        "library remove needs TAKEs, --actors, --classes or --damaged, to say what is removed");
  }
  const auto removed =
      RemoveTakes(options.library,
                  {.names = options.names, .filter = options.filter, .damaged = options.damaged});
  if (options.common.json) {
    Json json = {{"removed", Json::array()}};
    for (const auto& path : removed) json["removed"].push_back(path.string());
    PrintJson(json);
  } else {
    for (const auto& path : removed) Print(OnOneLine(path.string()) + '\n');
    PrintNote(options.common,
              fmt::format("{} removed; the recordings themselves stay where they are",
                          FormatCount(std::ssize(removed), "take", "takes")));
  }
  return kDone;
}

int Export(const LibraryOptions& options) {
  const bool is_printed = IsStandardOutput(options.output);
  if (options.common.json && is_printed) throw UsageError("--json needs -o FILE");
  if (!is_printed) CheckWritable(options.output, options.common.overwrite());
  const TakeLibrary library(options.library);
  const std::vector<StoredTake> takes = ChosenTakes(library, options.filter);
  WriteTextOrPrint(options.output, FormatTakeList(takes), options.common);
  if (is_printed) return kDone;
  if (options.common.json) {
    PrintJson({{"file", options.output.string()}, {"takes", takes.size()}});
  } else {
    PrintWritten(options.common, options.output);
  }
  return kDone;
}

CLI::App* AddAction(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                    int& exit_code, const std::string& name, const std::string& description,
                    int (*run)(const LibraryOptions&)) {
  CLI::App* action = command.add_subcommand(name, description);
  action->add_option("LIBRARY", options->library, "Folder of the library, from import")->required();
  AddOutputOptions(*action, options->common);
  action->callback([options, &exit_code, run] { exit_code = run(*options); });
  return action;
}

}  // namespace

void AddLibraryCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<LibraryOptions>();
  CLI::App* command = program.add_subcommand(
      "library", "What a library on disk holds; checking it, and taking takes out of it");
  command->require_subcommand(1);
  command->footer("Example:\n  kinebase library list motion.kinebase");

  CLI::App* list = AddAction(*command, options, exit_code, "list", "List takes", &List);
  AddTakeFilterOptions(*list, options->filter);
  list->footer("Example:\n  kinebase library list motion.kinebase --actors bd,bk");

  CLI::App* verify = AddAction(*command, options, exit_code, "verify",
                               "Read everything and compare all checksums", &Verify);
  AddThreadsOption(*verify, options->common);
  verify->footer("Example:\n  kinebase library verify motion.kinebase");

  CLI::App* remove = AddAction(*command, options, exit_code, "remove",
                               "Take takes out; their recordings stay where they are", &Remove);
  remove->add_option("TAKE", options->names,
                     "Files as 'list' shows them, their names, or folders above them");
  AddTakeFilterOptions(*remove, options->filter);
  remove->add_flag("--damaged", options->damaged, "Only takes that cannot be read any more");
  remove->footer(
      "Examples:\n"
      "  kinebase library remove motion.kinebase take.amc\n"
      "  kinebase library remove motion.kinebase --damaged");

  CLI::App* exported = AddAction(*command, options, exit_code, "export",
                                 "Write the takes as a list of clips (CSV)", &Export);
  exported->add_option("-o,--output", options->output, "File (default, or -: standard output)")
      ->type_name("FILE");
  AddTakeFilterOptions(*exported, options->filter);
  AddForceOption(*exported, options->common);
  exported->footer("Example:\n  kinebase library export motion.kinebase -o clips.csv");
}

}  // namespace kinebase::cli
