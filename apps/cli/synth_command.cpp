// kinebase synth: a small library of made-up motion.

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/synth/synthetic_motion.h"

namespace kinebase::cli {
namespace {

struct SynthCommandOptions {
  CommonOptions common;
  std::filesystem::path folder;
  SynthOptions synth;
};

int Run(SynthCommandOptions& options) {
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
  command->footer(
      fmt::format("Motion classes:\n  {}\n\nExample:\n  kinebase synth library "
                  "--actors 4 --classes squat1Reps,throwOverarmR",
                  fmt::join(SyntheticClasses(), "\n  ")));
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
