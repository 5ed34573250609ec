// kinebase learn: a few examples become a motion template.

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/feature_options.h"
#include "fmt/format.h"
#include "kinebase/library/takes.h"
#include "kinebase/templates/learning.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

struct LearnCommandOptions {
  CommonOptions common;
  FeatureOptions features;
  std::string learning;  // Empty: as the profile.
  std::string matching;
  std::vector<std::string> clips;
  std::string name;
  std::filesystem::path output;
  std::filesystem::path list;
  std::string class_name;
  std::vector<std::string> actors;
  std::vector<std::filesystem::path> folders;
  int max_rounds = 10;
};

// Learning needs to know from what, and where to put the result.
void CheckUsage(const LearnCommandOptions& options) {
  if (options.clips.empty() && options.list.empty()) {
    throw UsageError("learn needs clips, or a list of clips: --list clips.csv --class NAME");
  }
  if (!options.clips.empty() && !options.list.empty()) {
    throw UsageError("learn takes clips or --list, not both");
  }
  if (options.output.empty() && options.name.empty() && options.class_name.empty()) {
    throw UsageError("learn needs --name NAME or -o FILE");
  }
}

std::vector<TakeStretch> ChosenClips(const LearnCommandOptions& options) {
  if (!options.list.empty()) {
    return ClipsOfClass(options.list, options.class_name, options.actors, options.folders);
  }
  std::vector<TakeStretch> stretches;
  for (const auto& clip : options.clips) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(clip, ignored)) {
      stretches.push_back(ParseMotionArgument(clip));
      continue;
    }
    for (auto& file : FindMotionFiles(std::vector<std::filesystem::path>{clip})) {
      stretches.push_back({.file = std::move(file)});
    }
  }
  return stretches;
}

std::string TemplateName(const LearnCommandOptions& options) {
  if (!options.name.empty()) return options.name;
  if (!options.class_name.empty()) return options.class_name;
  const std::string file = options.output.filename().string();
  return file.substr(0, file.find('.'));
}

// A name that a file may have.
std::filesystem::path DefaultOutput(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return c == '/' || static_cast<unsigned char>(c) < ' '; }, '_');
  return name + ".template.json";
}

Json FailuresToJson(const std::vector<TakeFailure>& failures) {
  Json list = Json::array();
  for (const auto& [path, error] : failures) {
    list.push_back({{"file", path.string()}, {"message", error.what()}});
  }
  return list;
}

MotionTemplate MakeTemplate(const LearnCommandOptions& options, const FeatureSet& features,
                            const TakeBatch& batch, const LearnedMatrix& learned) {
  MotionTemplate result{.name = TemplateName(options),
                        .feature_set = features.name,
                        .feature_set_hash = features.hash,
                        .matrix = learned.matrix,
                        .rounds = static_cast<int>(learned.largest_costs.size())};
  const Profile profile = options.features.ParsedProfile();
  result.learning = ParseProfile(options.learning).value_or(profile);
  result.matching = ParseProfile(options.matching).value_or(profile);
  for (const TakeFeatures& take : batch.takes) {
    result.clips.push_back({.file = take.path.filename().string(),
                            .first_frame = take.stretch.first_frame,
                            .last_frame = take.stretch.last_frame});
  }
  return result;
}

int Run(LearnCommandOptions& options) {
  const Stopwatch watch;
  CheckUsage(options);
  if (options.output.empty()) options.output = DefaultOutput(TemplateName(options));
  CheckWritable(options.output, options.common.overwrite());
  const FeatureSet features = options.features.Load();
  const std::vector<TakeStretch> stretches = ChosenClips(options);
  const ProgressCallback progress = MakeProgress(options.common);
  const TakeBatch batch =
      LoadManyTakeFeatures(stretches, features, options.features.rate_hz, options.common.load,
                           options.common.threads, progress);
  for (const auto& failure : batch.failures) PrintError(failure.error.what());
  for (const auto& take : batch.takes) {
    PrintDiagnostics(options.common, take.path, take.diagnostics);
  }
  if (batch.takes.empty()) return kCouldNot;
  std::vector<TemplateMatrix> performances;
  performances.reserve(batch.takes.size());
  for (const TakeFeatures& take : batch.takes) {
    performances.push_back(ToTemplateMatrix(take.features));
  }
  LearnOptions learn{
      .max_rounds = options.max_rounds, .threads = options.common.threads, .progress = progress};
  learn.profile = ParseProfile(options.learning).value_or(options.features.ParsedProfile());
  const LearnedMatrix learned = LearnTemplate(performances, learn);
  const MotionTemplate result = MakeTemplate(options, features, batch, learned);
  WriteTemplate(result, options.output, options.common.overwrite());
  if (options.common.json) {
    Json json = {{"name", result.name},
                 {"clips", result.clips.size()},
                 {"columns", result.matrix.column_count()},
                 {"rounds", result.rounds},
                 {"elapsed_s", watch.seconds()},
                 {"file", options.output.string()}};
    if (!batch.failures.empty()) json["failed"] = FailuresToJson(batch.failures);
    PrintJson(json);
  } else {
    Print(fmt::format(
        "{}: learned from {} in {}, {} long ({:.2f} s), written to {}\n", OnOneLine(result.name),
        FormatCount(std::ssize(result.clips), "clip", "clips"),
        FormatCount(result.rounds, "round", "rounds"),
        FormatCount(result.matrix.column_count(), "column", "columns"),
        result.matrix.total_weight() / result.matrix.rate_hz, OnOneLine(options.output.string())));
  }
  return batch.failures.empty() ? kDone : kPartFailed;
}

}  // namespace

void AddLearnCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<LearnCommandOptions>();
  CLI::App* command =
      program.add_subcommand("learn", "Learn a motion class from examples: a motion template");
  command->add_option("CLIP", options->clips,
                      "Clips, folders of clips, or stretches of takes: take.amc:120-480");
  command->add_option("--name", options->name, "Name of the class (default: --class, or from -o)")
      ->type_name("NAME");
  command->add_option("-o,--output", options->output, "Template file (default: NAME.template.json)")
      ->type_name("FILE");
  auto* list = command
                   ->add_option("--list", options->list,
                                "Table of clips instead: CSV with columns file, class, actor")
                   ->type_name("FILE");
  auto* class_name = command->add_option("--class", options->class_name, "Class in the list")
                         ->type_name("NAME")
                         ->needs(list);
  list->needs(class_name);
  command->add_option("--actors", options->actors, "Only clips of these actors: a,b")
      ->delimiter(',')
      ->needs(list)
      ->type_name("NAMES");
  command->add_option("--in", options->folders, "Folders with the list's files, beside its own")
      ->needs(list)
      ->type_name("FOLDER");
  AddProfileOption(*command, options->features.profile,
                   "Features, learning and matching as the authors' toolbox (bonn) or the paper")
      ->capture_default_str();
  AddFeatureSetOption(*command, options->features.feature_set);
  for (const auto& [name, target, what] :
       {std::tuple{"--learning", &options->learning, "Learning by another profile"},
        std::tuple{"--matching", &options->matching, "Matching by another profile"}}) {
    command->add_option(name, *target, what)
        ->check(OneOf({"bonn", "paper"}))
        ->type_name("bonn|paper");
  }
  AddRateOption(*command, options->features.rate_hz);
  command->add_option("--max-rounds", options->max_rounds, "Rounds of learning at most")
      ->check(WholeNumber(1, 10000))
      ->capture_default_str()
      ->type_name("N");
  AddOutputOptions(*command, options->common);
  AddThreadsOption(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer(
      "Examples:\n"
      "  kinebase learn squat_1.amc squat_2.amc gym.amc:120-480 --name squat\n"
      "  kinebase learn --list clips.csv --class squat1Reps --actors bd,bk -o squat.template.json");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
