// kinebase synth: a small library of made-up motion as files, or a large one as import makes it.

#include <memory>
#include <optional>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/synth_hours.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/features/feature_set.h"
#include "kinebase/library/take_import.h"
#include "kinebase/synth/synthetic_motion.h"

namespace kinebase::cli {
namespace {

struct SynthCommandOptions {
  CommonOptions common;
  std::filesystem::path folder;
  SynthOptions synth;
  std::optional<double> hours;
  bool with_poses = false;
};

constexpr double kMostHours = 100'000;

int RunHours(const SynthCommandOptions& options) {
  const Stopwatch watch;
  const double hours = *options.hours;
  const ImportReport report =
      ImportTakes(options.folder, SyntheticSources(options.folder, hours, options.synth.seed),
                  {.features = LoadFeatureSet("bonn"),
                   .with_poses = options.with_poses,
                   .threads = options.common.threads,
                   .progress = MakeProgress(options.common)});
  for (const TakeFailure& failure : report.failures) PrintError(failure.error.what());
  const std::int64_t made = report.added + report.updated;
  if (options.common.json) {
    PrintJson({{"synthetic", true},
               {"library", options.folder.string()},
               {"hours", hours},
               {"added", report.added},
               {"updated", report.updated},
               {"unchanged", report.unchanged},
               {"frames", report.frames},
               {"seed", options.synth.seed},
               {"elapsed_s", watch.seconds()}});
  } else {
    Print(
        fmt::format("{}: {} h of synthetic motion, {} made, {} there before; {} frames, {:.2f} s\n",
                    options.folder.string(), hours, FormatCount(made, "take", "takes"),
                    report.unchanged, report.frames, watch.seconds()));
  }
  return report.failures.empty() ? kDone : kPartFailed;
}

int RunFiles(SynthCommandOptions& options) {
  const Stopwatch watch;
  options.synth.overwrite = options.common.overwrite();
  options.synth.threads = options.common.threads;
  options.synth.progress = MakeProgress(options.common);
  const SynthReport report = WriteSyntheticLibrary(options.folder, options.synth);
  if (options.common.json) {
    PrintJson({{"synthetic", true},
               {"folder", options.folder.string()},
               {"actors", report.actors},
               {"clips", report.clips},
               {"takes", report.takes},
               {"frames", report.frames},
               {"seed", options.synth.seed},
               {"elapsed_s", watch.seconds()}});
  } else {
    Print(fmt::format("{}: {} and {} of synthetic motion by {}, {} frames\n",
                      options.folder.string(), FormatCount(report.clips, "clip", "clips"),
                      FormatCount(report.takes, "long take", "long takes"),
                      FormatCount(report.actors, "actor", "actors"), report.frames));
  }
  return kDone;
}

int Run(SynthCommandOptions& options) {
  return options.hours ? RunHours(options) : RunFiles(options);
}

// What is made in one go knows nothing of clips and files.
void AddHoursOptions(CLI::App& command, SynthCommandOptions& options) {
  auto* hours =
      command
          .add_option("--hours", options.hours,
                      "Instead of files, a library to search, as import makes it: so many hours in "
                      "takes of five minutes, all classes, another actor every hour")
          ->check(NumberBetween(0.0001, kMostHours))
          ->type_name("HOURS");
  command.add_flag("--poses", options.with_poses, "With --hours: also keep where the joints are")
      ->needs(hours);
  for (const char* other :
       {"--actors", "--repetitions", "--takes", "--clips-per-take", "--classes", "--force"}) {
    hours->excludes(command.get_option(other));
  }
}

}  // namespace

void AddSynthCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<SynthCommandOptions>();
  SynthOptions& synth = options->synth;
  CLI::App* command = program.add_subcommand(
      "synth", "Make a small library of made-up motion, for trying and testing");
  command->add_option("FOLDER", options->folder, "Where to put it")->required();
  const auto add_count = [&](const char* name, int& value, const char* description, unsigned low) {
    command->add_option(name, value, description)
        ->check(WholeNumber(low, 1000))
        ->capture_default_str()
        ->type_name("N");
  };
  add_count("--actors", synth.actors, "People", 1);
  add_count("--repetitions", synth.repetitions, "Clips a class and actor", 0);
  add_count("--takes", synth.takes, "Long takes an actor", 0);
  add_count("--clips-per-take", synth.clips_per_take, "Motions in a long take", 1);
  command->add_option("--classes", synth.classes, "Only these motion classes: a,b")
      ->delimiter(',')
      ->check(OneOf(SyntheticClasses()))
      ->type_name("NAMES");
  command->add_option("--seed", synth.seed, "Another seed makes other motion")
      ->check(WholeNumber(0))
      ->capture_default_str()
      ->type_name("N");
  AddOutputOptions(*command, options->common);
  AddThreadsOption(*command, options->common);
  AddForceOption(*command, options->common);
  AddHoursOptions(*command, *options);
  command->footer(
      fmt::format("Motion classes:\n  {}\n\nExamples:\n  kinebase synth library "
                  "--actors 4 --classes squat1Reps,throwOverarmR\n"
                  "  kinebase synth large.kinebase --hours 100",
                  fmt::join(SyntheticClasses(), "\n  ")));
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
