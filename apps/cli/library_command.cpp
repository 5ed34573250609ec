// kinebase library: what is in a library on disk, whether it is sound, taking takes out of it.

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/failure_output.h"
#include "cli/library_actions.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/library/library_upkeep.h"

namespace kinebase::cli {
namespace {

bool HasPoses(const StoredTake& take) {
  return std::ranges::any_of(take.features, &StoredFeatures::has_poses);
}

double SecondsOf(const StoredTake& take) {
  return take.rate_hz > 0 ? static_cast<double>(take.frame_count) / take.rate_hz : 0;
}

// "gym", or of a stretch "gym 120-480".
std::string ToText(const StoredLabel& label) {
  if (label.first_frame == 0) return label.text;
  return fmt::format("{} {}-{}", label.text, label.first_frame, label.last_frame);
}

std::string LabelsText(const StoredTake& take) {
  std::vector<std::string> labels;
  labels.reserve(take.labels.size());
  for (const StoredLabel& label : take.labels) labels.push_back(ToText(label));
  return fmt::format("{}", fmt::join(labels, ", "));
}

Json LabelsAsJson(const StoredTake& take) {
  Json labels = Json::array();
  for (const StoredLabel& label : take.labels) {
    const bool is_whole = label.first_frame == 0;
    labels.push_back({{"label", label.text},
                      {"first_frame", is_whole ? Json() : Json(label.first_frame)},
                      {"last_frame", is_whole ? Json() : Json(label.last_frame)}});
  }
  return labels;
}

Json ToJson(const StoredTake& take) {
  return {{"file", take.path.string()},
          {"format", take.format},
          {"actor", TextOrNull(take.name.actor)},
          {"class", TextOrNull(take.name.class_name)},
          {"take", TextOrNull(take.name.take)},
          {"frames", take.frame_count},
          {"rate_hz", take.rate_hz},
          {"duration_s", SecondsOf(take)},
          {"poses", HasPoses(take)},
          {"description", TextOrNull(take.description)},
          {"labels", LabelsAsJson(take)},
          {"skeleton", TextOrNull(take.skeleton.path.string())},
          {"skeleton_key", TextOrNull(KeyText(take.skeleton.key))},
          {"origin",
           {{"imported", TextOrNull(FormatDate(take.origin.imported_s))},
            {"file_changed", TextOrNull(FormatDate(take.origin.file_time_s))},
            {"file_bytes", take.origin.file_bytes},
            {"program", TextOrNull(take.origin.program)},
            {"options", take.origin.options}}}};
}

Json ListAsJson(const TakeLibrary& library, const ChosenTakes& chosen) {
  Json json = {{"takes", Json::array()}, {"feature_sets", Json::array()}};
  for (const StoredTake* take : chosen.takes) json["takes"].push_back(ToJson(*take));
  for (const StoredFeatureSet& set : library.feature_sets()) {
    json["feature_sets"].push_back(
        {{"name", set.name}, {"rate_hz", set.rate_hz}, {"takes", set.takes}});
  }
  json["bytes"] = library.segment_bytes();
  AddFailures(chosen.failures, json);
  return json;
}

// Columns that `list --show` adds.
struct ExtraColumn {
  const char* name;
  std::string (*text)(const StoredTake& take);
};

constexpr ExtraColumn kExtraColumns[] = {
    {"labels", &LabelsText},
    {"description", [](const StoredTake& take) { return take.description; }},
    {"skeleton", [](const StoredTake& take) { return take.skeleton.path.string(); }},
    {"imported", [](const StoredTake& take) { return FormatDate(take.origin.imported_s); }},
};

std::vector<std::string> ExtraColumnNames() {
  std::vector<std::string> names;
  names.reserve(std::size(kExtraColumns));
  for (const ExtraColumn& column : kExtraColumns) names.emplace_back(column.name);
  return names;
}

TextTable TakeTable(std::span<const StoredTake* const> takes,
                    const std::vector<std::string>& show) {
  std::vector<std::string> titles = {"file",    "format", "actor", "class",
                                     ">frames", ">Hz",    ">s",    "poses"};
  titles.insert(titles.end(), show.begin(), show.end());
  TextTable table(std::move(titles));
  for (const StoredTake* take : takes) {
    std::vector<std::string> cells = {take->path.string(),
                                      take->format,
                                      take->name.actor,
                                      take->name.class_name,
                                      std::to_string(take->frame_count),
                                      fmt::format("{:g}", take->rate_hz),
                                      fmt::format("{:.2f}", SecondsOf(*take)),
                                      HasPoses(*take) ? "yes" : ""};
    for (const std::string& name : show) {
      cells.push_back(std::ranges::find(kExtraColumns, name, &ExtraColumn::name)->text(*take));
    }
    table.Add(std::move(cells));
  }
  return table;
}

int List(const LibraryOptions& options) {
  const TakeLibrary library(options.library);
  const ChosenTakes chosen = ChooseIntactTakes(library, options.choice);
  const std::vector<const StoredTake*>& takes = chosen.takes;
  PrintFailures(chosen.failures);
  if (options.common.json) {
    PrintJson(ListAsJson(library, chosen));
    return ExitCodeOf(chosen.failures);
  }
  double seconds = 0;
  for (const StoredTake* take : takes) seconds += SecondsOf(*take);
  if (!takes.empty()) Print(TakeTable(takes, options.show).ToString());
  const std::string duration =
      seconds < 3600 ? FormatTime(seconds) + " min:s" : fmt::format("{:.1f} hours", seconds / 3600);
  std::string note = fmt::format("{}, {}. In the library: {} in segments",
                                 FormatCount(std::ssize(takes), "take", "takes"), duration,
                                 FormatSize(library.segment_bytes()));
  for (const StoredFeatureSet& set : library.feature_sets()) {
    note += fmt::format("; features '{}' at {:g} Hz of {}", set.name, set.rate_hz,
                        FormatCount(set.takes, "take", "takes"));
  }
  PrintNote(options.common, note);
  return ExitCodeOf(chosen.failures);
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

// What is wrong beside the takes, with what to do.
std::vector<std::string> OtherDamage(const VerifyReport& report) {
  std::vector<std::string> lines;
  lines.reserve(report.damaged_records.size() + 2);
  for (const std::string& record : report.damaged_records) {
    lines.push_back(
        "catalogue: " + record +
        " is damaged; run 'kinebase library remove LIBRARY --damaged' and add it again");
  }
  if (report.orphaned_rows > 0) {
    lines.push_back(
        fmt::format("catalogue: {} to no take; 'kinebase library remove LIBRARY --damaged' removes "
                    "what is left of it",
                    FormatCount(report.orphaned_rows, "row belongs", "rows belong")));
  }
  if (report.words_are_damaged) {
    lines.emplace_back(
        "catalogue: the words by which takes are found are damaged; 'kinebase library compact' "
        "makes them anew");
  }
  return lines;
}

Json ToJson(const VerifyReport& report, std::span<const std::string> other_damage) {
  Json json = {{"takes", report.takes},
               {"bytes", report.segment_bytes},
               {"leftovers", report.leftovers.size()}};
  for (const TakeFailure& damaged : report.damaged) {
    json["failed"].push_back({{"file", damaged.path.string()}, {"message", damaged.error.what()}});
  }
  for (const std::string& line : other_damage) {
    json["failed"].push_back({{"file", Json()}, {"message", line}});
  }
  return json;
}

int Verify(const LibraryOptions& options) {
  const VerifyReport report =
      VerifyLibrary(options.library, options.common.threads, MakeProgress(options.common));
  const std::vector<std::string> other_damage = OtherDamage(report);
  PrintDamage(report.damaged);
  for (const std::string& line : other_damage) PrintError(line);
  if (!report.damaged.empty() && std::ssize(report.damaged) == report.takes) return kCouldNot;
  const bool is_intact = report.damaged.empty() && other_damage.empty();
  if (options.common.json) {
    PrintJson(ToJson(report, other_damage));
  } else {
    Print(fmt::format("{}, {} in segments: {}\n", FormatCount(report.takes, "take", "takes"),
                      FormatSize(report.segment_bytes),
                      is_intact ? "all intact" : fmt::format("{} damaged", report.damaged.size())));
  }
  if (!report.leftovers.empty()) {
    PrintNote(options.common,
              fmt::format("{} of an import that was cut short, or still goes on; the next import "
                          "removes what is left",
                          FormatCount(std::ssize(report.leftovers), "file", "files")));
  }
  return is_intact ? kDone : kPartFailed;
}

int Remove(const LibraryOptions& options) {
  const TakeChoice& choice = options.choice;
  if (choice.names.empty() && choice.filter == TakeFilter() && !options.damaged) {
    throw UsageError(
        "library remove needs TAKEs, --actors, --classes, --labelled, --formats, --text or "
        "--damaged, to say what is removed");
  }
  const auto removed =
      RemoveTakes(options.library,
                  {.names = choice.names, .filter = choice.filter, .damaged = options.damaged});
  std::vector<std::string> records;
  if (options.damaged && choice.names.empty() && choice.filter == TakeFilter()) {
    records = RemoveDamagedRecords(options.library);
  }
  if (options.common.json) {
    Json json = {{"removed", Json::array()}};
    for (const auto& path : removed) json["removed"].push_back(path.string());
    if (!records.empty()) json["records"] = records;
    PrintJson(json);
  } else {
    for (const auto& path : removed) Print(OnOneLine(path.string()) + '\n');
    for (const std::string& record : records) Print(OnOneLine(record) + '\n');
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
  const auto [chosen, failures] = ChooseIntactTakes(library, options.choice);
  std::vector<StoredTake> takes;
  takes.reserve(chosen.size());
  for (const StoredTake* take : chosen) takes.push_back(*take);
  PrintFailures(failures);
  WriteTextOrPrint(options.output, FormatTakeList(takes), options.common);
  if (is_printed) return ExitCodeOf(failures);
  if (options.common.json) {
    Json json = {{"file", options.output.string()}, {"takes", takes.size()}};
    AddFailures(failures, json);
    PrintJson(json);
  } else {
    PrintWritten(options.common, options.output);
  }
  return ExitCodeOf(failures);
}

void AddReadingActions(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                       int& exit_code) {
  CLI::App* list = AddLibraryAction(command, options, exit_code, "list", &List);
  list->description("List takes");
  AddTakeChoiceOptions(*list, options->choice);
  list->add_option("--show", options->show,
                   fmt::format("Also these columns: {}", fmt::join(ExtraColumnNames(), ",")))
      ->delimiter(',')
      ->check(OneOf(ExtraColumnNames()))
      ->type_name("NAMES");
  list->footer(
      "Examples:\n"
      "  kinebase library list motion.kinebase --actors bd,bk\n"
      "  kinebase library list motion.kinebase --text \"grab shelf\" --show labels,description");

  CLI::App* verify = AddLibraryAction(command, options, exit_code, "verify", &Verify);
  verify->description("Read everything and compare all checksums");
  AddThreadsOption(*verify, options->common);
  verify->footer("Example:\n  kinebase library verify motion.kinebase");

  CLI::App* exported = AddLibraryAction(command, options, exit_code, "export", &Export);
  exported->description("Write the takes as a list of clips (CSV)");
  exported->add_option("-o,--output", options->output, "File (default, or -: standard output)")
      ->type_name("FILE");
  AddTakeFilterOptions(*exported, options->choice.filter);
  AddForceOption(*exported, options->common);
  exported->footer("Example:\n  kinebase library export motion.kinebase -o clips.csv");
}

}  // namespace

std::string FormatSize(std::int64_t bytes) {
  constexpr double kBytesPerMegabyte = 1e6;
  return fmt::format("{:.2f} MB", static_cast<double>(bytes) / kBytesPerMegabyte);
}

std::string FormatDate(std::int64_t time_s) {
  if (time_s == 0) return {};
  const std::chrono::sys_seconds time{std::chrono::seconds(time_s)};
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss clock(time - day);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

void PrintFailures(std::span<const TakeFailure> failures) {
  for (const TakeFailure& failure : failures) PrintError(failure.error.what());
}

void AddFailures(std::span<const TakeFailure> failures, Json& json) {
  if (!failures.empty()) json["failed"] = FailuresToJson(failures);
}

int ExitCodeOf(std::span<const TakeFailure> failures) {
  return failures.empty() ? kDone : kPartFailed;
}

Json TextOrNull(const std::string& text) { return text.empty() ? Json() : Json(text); }

CLI::App* AddLibraryAction(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                           int& exit_code, const std::string& name, LibraryAction run) {
  CLI::App* action = command.add_subcommand(name);
  action->add_option("LIBRARY", options->library, "Folder of the library, from import")->required();
  AddOutputOptions(*action, options->common);
  action->callback([options, &exit_code, run] { exit_code = run(*options); });
  return action;
}

void AddLibraryCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<LibraryOptions>();
  CLI::App* command = program.add_subcommand(
      "library", "What a library on disk holds; checking it, and taking takes out of it");
  command->require_subcommand(1);
  command->footer("Example:\n  kinebase library list motion.kinebase");

  AddReadingActions(*command, options, exit_code);
  CLI::App* remove = AddLibraryAction(*command, options, exit_code, "remove", &Remove);
  remove->description("Take takes out; their recordings stay where they are");
  AddTakeChoiceOptions(*remove, options->choice);
  remove->add_flag(
      "--damaged", options->damaged,
      "Only takes that cannot be read any more; also what else the catalogue has that is "
      "damaged");
  remove->footer(
      "Examples:\n"
      "  kinebase library remove motion.kinebase take.amc\n"
      "  kinebase library remove motion.kinebase --damaged");
  AddLabelActions(*command, options, exit_code);
  AddRecordActions(*command, options, exit_code);
}

}  // namespace kinebase::cli
