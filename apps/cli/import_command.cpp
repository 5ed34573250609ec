// kinebase import: recordings into a library on disk.

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/failure_output.h"
#include "cli/feature_options.h"
#include "fmt/format.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/library/descriptions.h"
#include "kinebase/library/take_import.h"

namespace kinebase::cli {
namespace {

struct ImportCommandOptions {
  CommonOptions common;
  FeatureOptions features;
  std::vector<std::filesystem::path> paths;
  std::filesystem::path list;
  std::filesystem::path descriptions;
  std::filesystem::path library;
  bool with_poses = false;
  int takes_per_batch = ImportOptions().takes_per_batch;
  std::uint64_t memory_bytes = kDefaultMemoryBytes;
};

constexpr std::uint64_t kMostTakesPerBatch = 10000;

std::string_view ToString(ImportState state) {
  switch (state) {
    case ImportState::kAdded:
      return "added";
    case ImportState::kUpdated:
      return "updated";
    case ImportState::kUnchanged:
      return "unchanged";
  }
  return "";
}

// What the list names, below its folder and the paths; else everything that the paths hold.
std::vector<ImportSource> FindSources(const ImportCommandOptions& options,
                                      std::vector<TakeFailure>& failures) {
  if (!options.list.empty()) return ListedSources(options.list, options.paths, failures);
  std::vector<ImportSource> sources;
  for (auto& file : FindMotionFiles(options.paths)) sources.push_back({.file = std::move(file)});
  return sources;
}

// One line each, as a script that reads along needs it.
void PrintJsonLine(const Json& json) {
  Print(json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n');
}

void ShowTake(const ImportedTake& take, const CommonOptions& options) {
  if (options.json) {
    PrintJsonLine({{"file", take.path.string()},
                   {"state", ToString(take.state)},
                   {"frames", take.frame_count}});
  }
  PrintDiagnostics(options, take.path, take.diagnostics);
}

Json ToJson(const ImportReport& report, double elapsed_s) {
  return {{"added", report.added},         {"updated", report.updated},
          {"unchanged", report.unchanged}, {"failed", FailuresToJson(report.failures)},
          {"frames", report.frames},       {"elapsed_s", elapsed_s}};
}

std::string Summary(const ImportReport& report, double elapsed_s) {
  std::string text = fmt::format("{} added", report.added);
  if (report.updated > 0) text += fmt::format(", {} updated", report.updated);
  if (report.unchanged > 0) text += fmt::format(", {} unchanged", report.unchanged);
  if (!report.failures.empty()) text += fmt::format(", {} failed", report.failures.size());
  return text + fmt::format("; {} frames, {:.2f} s\n", report.frames, elapsed_s);
}

int Run(const ImportCommandOptions& options) {
  const Stopwatch watch;
  if (options.paths.empty() && options.list.empty()) {
    throw UsageError("import needs files or folders, or a table of clips with --list");
  }
  ImportOptions import{.features = options.features.Load(),
                       .rate_hz = options.features.rate_hz,
                       .with_poses = options.with_poses,
                       .load = options.common.load,
                       .threads = options.common.threads,
                       .takes_per_batch = options.takes_per_batch,
                       .memory_bytes = static_cast<std::int64_t>(options.memory_bytes),
                       .progress = MakeProgress(options.common)};
  import.on_durable = [&](const ImportedTake& take) { ShowTake(take, options.common); };
  std::vector<TakeFailure> missing;
  std::vector<ImportSource> sources = FindSources(options, missing);
  if (!options.descriptions.empty()) {
    const MappedFile table(options.descriptions);
    Describe(sources, ParseDescriptions(table.text(), options.descriptions));
  }
  ImportReport report = ImportTakes(options.library, sources, import);
  report.failures.insert(report.failures.begin(), missing.begin(), missing.end());

  for (const TakeFailure& failure : report.failures) PrintError(failure.error.what());
  const bool is_any_in = report.added + report.updated + report.unchanged > 0;
  const bool is_nothing_done = !report.failures.empty() && !is_any_in;
  if (options.common.json) {  // The last line in any case, for whoever reads along.
    PrintJsonLine(ToJson(report, watch.seconds()));
  } else if (!is_nothing_done) {
    Print(Summary(report, watch.seconds()));
  }
  if (is_nothing_done) return kCouldNot;
  return report.failures.empty() ? kDone : kPartFailed;
}

}  // namespace

void AddImportCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<ImportCommandOptions>();
  CLI::App* command = program.add_subcommand(
      "import", "Put recordings into a library on disk, which is searched without them");
  command->add_option("PATH", options->paths,
                      "Motion files and folders; with --list, where its files are");
  command->add_option("--library", options->library, "Folder of the library; made if it is missing")
      ->required()
      ->type_name("FOLDER");
  command
      ->add_option("--list", options->list,
                   "Only the files of this table, with their classes and actors (CSV: "
                   "file,class,actor)")
      ->type_name("FILE");
  command
      ->add_option("--descriptions", options->descriptions,
                   "What the files show, in words (CSV: file,description, or class,description)")
      ->type_name("FILE");
  command->add_flag("--poses", options->with_poses,
                    "Also keep where the joints are, for mt+ templates and to play takes back");
  command
      ->add_option("--batch", options->takes_per_batch,
                   "Takes that are made durable, or lost in a crash, together")
      ->check(WholeNumber(1, kMostTakesPerBatch))
      ->capture_default_str()
      ->type_name("N");
  AddMemoryOption(*command, options->memory_bytes);
  AddProfileOption(*command, options->features.profile, "Feature set of this profile")
      ->capture_default_str();
  AddFeatureSetOption(*command, options->features.feature_set);
  AddRateOption(*command, options->features.rate_hz);
  AddOutputOptions(*command, options->common);
  AddThreadsOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer(
      "Examples:\n"
      "  kinebase import recordings/ --library motion.kinebase\n"
      "  kinebase import --list clips.csv --library motion.kinebase --poses");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
