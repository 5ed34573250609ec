// kinebase learn: a few examples become a motion template.

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/failure_output.h"
#include "cli/feature_options.h"
#include "cli/take_filter.h"
#include "cli/take_source_options.h"
#include "cli/update_template.h"
#include "fmt/format.h"
#include "kinebase/library/class_learning.h"
#include "kinebase/library/library_examples.h"
#include "kinebase/library/take_source.h"
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
  std::string label;  // Of a library's stretches, instead of a class.
  TakeFilter filter;  // Of a list its actors alone.
  std::vector<std::filesystem::path> folders;
  std::filesystem::path library;  // Instead of clips and lists.
  std::uint64_t memory_bytes = kDefaultMemoryBytes;
  int max_rounds = 10;
  std::string method;  // As asked for.
  bool all_classes = false;
  bool styles = false;
  std::vector<std::filesystem::path> background;
  std::filesystem::path update;
  std::vector<std::filesystem::path> marks;

  [[nodiscard]] Profile Learning() const {
    return ParseProfile(learning).value_or(features.ParsedProfile());
  }
  [[nodiscard]] Profile Matching() const {
    return ParseProfile(matching).value_or(features.ParsedProfile());
  }
  [[nodiscard]] std::string Method() const {
    if (!method.empty()) return method;
    return all_classes || styles || !background.empty() ? "mt+" : "mt";
  }
};

std::string TemplateName(const LearnCommandOptions& options) {
  if (!options.name.empty()) return options.name;
  if (!options.class_name.empty()) return options.class_name;
  if (!options.label.empty()) return options.label;
  const std::string file = options.output.filename().string();
  return file.substr(0, file.find('.'));
}

// Learning needs to know from what, and where to put the result.
void CheckUsage(const LearnCommandOptions& options) {
  if (!options.update.empty()) {
    if (options.marks.empty()) {
      throw UsageError("--update needs hits that are marked right or wrong: --marks hits.csv");
    }
    return;
  }
  const bool is_labelled = !options.list.empty() || !options.library.empty();
  if (!is_labelled &&
      (!options.class_name.empty() || options.all_classes || !options.filter.actors.empty())) {
    throw UsageError("--class, --all-classes and --actors choose from a --list or a --library");
  }
  if (!options.folders.empty() && options.list.empty()) {
    throw UsageError("--in says where the files of a --list or an --update are");
  }
  if (options.clips.empty() && !is_labelled) {
    throw UsageError(
        "learn needs clips, or a list of clips, or a library: --list clips.csv --class NAME");
  }
  if (is_labelled && options.label.empty() && options.class_name.empty() != options.all_classes) {
    throw UsageError(fmt::format("{} needs either --class NAME or --all-classes{}",
                                 options.library.empty() ? "--list" : "--library",
                                 options.library.empty() ? "" : ", or --label WORD"));
  }
  if (options.background.empty()) CheckReadsFiles(options.library, options.common.load);
  if (options.styles && options.Method() == "mt") {
    throw UsageError("--styles is for --method mt+");
  }
  if (options.all_classes) {
    if (options.output.empty()) throw UsageError("--all-classes needs a folder: -o FOLDER");
    if (options.Method() == "mt") throw UsageError("--all-classes is for --method mt+");
    return;
  }
  if (options.Method() == "mt" && !options.background.empty()) {
    throw UsageError("--background is for --method mt+");
  }
  const bool has_other_classes = is_labelled && options.label.empty();
  if (options.Method() == "mt+" && !has_other_classes && options.background.empty()) {
    throw UsageError(
        "--method mt+ needs other motion to set the class off from: --background PATH, or the "
        "other classes of a --list or a --library");
  }
  if (!options.clips.empty() && is_labelled) {
    throw UsageError("learn takes clips, or --list, or --library; one of them");
  }
  if (options.output.empty() && TemplateName(options).empty()) {
    throw UsageError("learn needs --name NAME or -o FILE");
  }
}

std::vector<TakeStretch> ChosenClips(const LearnCommandOptions& options) {
  if (!options.list.empty()) {
    return ClipsOfClass(options.list, options.class_name, options.filter.actors, options.folders);
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

// A name that a file may have.
std::filesystem::path DefaultOutput(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return c == '/' || static_cast<unsigned char>(c) < ' '; }, '_');
  return name + ".template.json";
}

MotionTemplate MakeTemplate(const LearnCommandOptions& options, const FeatureSet& features,
                            const TakeBatch& batch, const LearnedMatrix& learned) {
  MotionTemplate result{.name = TemplateName(options),
                        .feature_set = features.name,
                        .feature_set_hash = features.hash,
                        .matrix = learned.matrix,
                        .rounds = static_cast<int>(learned.largest_costs.size())};
  result.learning = options.Learning();
  result.matching = options.Matching();
  for (const TakeFeatures& take : batch.takes) {
    result.clips.push_back({.file = take.path.filename().string(),
                            .first_frame = take.stretch.first_frame,
                            .last_frame = take.stretch.last_frame});
  }
  return result;
}

// The takes of the class that is asked for, in the library.
TakeFilter ChosenTakes(const LearnCommandOptions& options) {
  TakeFilter filter = options.filter;
  filter.classes = {options.class_name};
  return filter;
}

// Those, and of the classes that it is set off from.
TakeFilter TakesOfAllClasses(const LearnCommandOptions& options) {
  TakeFilter filter = options.filter;
  if (!filter.classes.empty() && !options.class_name.empty()) {
    filter.classes.push_back(options.class_name);
  }
  return filter;
}

ExampleRequest RequestOf(const LearnCommandOptions& options, const FeatureSet& features) {
  return {.features = &features,
          .rate_hz = options.features.rate_hz,
          .memory_bytes = static_cast<std::int64_t>(options.memory_bytes) / 2,
          .threads = options.common.threads};
}

// The clips of all classes of the list, each the background of the others.
std::vector<ListedClip> ListedClips(const LearnCommandOptions& options) {
  // Says what is wrong with the class that is asked for.
  if (!options.class_name.empty()) (void)ChosenClips(options);
  std::vector<ListedClip> clips = ReadClipList(options.list, options.folders);
  std::erase_if(clips, [&](const ListedClip& clip) {
    return !options.filter.actors.empty() &&
           std::ranges::find(options.filter.actors, clip.actor) == options.filter.actors.end();
  });
  return clips;
}

// What is learned from, and other motion.
struct Examples {
  LabelledBatch labelled;
  TakeBatch background;
};

std::filesystem::path PlaceOf(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(file, ignored);
}

void Append(TakeBatch more, TakeBatch& batch) {
  std::ranges::move(more.takes, std::back_inserter(batch.takes));
  std::ranges::move(more.failures, std::back_inserter(batch.failures));
}

// As much of a library as fits beside what has been read already.
void AppendLibrary(const std::filesystem::path& library,
                   const std::set<std::filesystem::path>& learned_from, ExampleRequest request,
                   const LearnCommandOptions& options, TakeBatch& batch) {
  request.memory_bytes =
      std::max<std::int64_t>(request.memory_bytes - ExampleBytes(batch.takes), 0);
  BackgroundTakes takes = LoadBackgroundTakes(TakeLibrary(library), learned_from, request);
  if (takes.chosen < takes.available) {
    PrintNote(options.common,
              fmt::format("of the background's {} takes {} fit into memory, evenly chosen; "
                          "--memory takes more",
                          takes.available, takes.chosen));
  }
  Append(std::move(takes.batch), batch);
}

// Recordings of other motion, without those that clips are from: a class is no other motion.
TakeBatch LoadBackground(const LearnCommandOptions& options, const FeatureSet& features,
                         const LabelledBatch& labelled, const ProgressCallback& progress) {
  std::set<std::filesystem::path> learned_from;
  ExampleRequest request = RequestOf(options, features);
  for (const LabelledClip& clip : labelled.clips) {
    learned_from.insert(PlaceOf(clip.take.path));
    request.memory_bytes -= ExampleBytes(std::span(&clip.take, 1));
  }
  std::vector<std::filesystem::path> libraries;
  std::vector<std::filesystem::path> others;
  for (const auto& path : options.background) {
    (IsLibrary(path) ? libraries : others).push_back(path);
  }
  std::vector<TakeStretch> files;
  for (auto& file : others.empty() ? others : FindMotionFiles(others)) {
    if (!learned_from.contains(PlaceOf(file))) files.push_back({.file = std::move(file)});
  }
  TakeBatch batch =
      LoadManyTakeFeatures(files, features, options.features.rate_hz, options.common.load,
                           options.common.threads, progress, {.poses = true});
  for (const auto& library : libraries) {
    AppendLibrary(library, learned_from, request, options, batch);
  }
  if (batch.takes.empty() && batch.failures.empty()) {
    throw Error(ErrorCode::kInvalidArgument,
                "--background holds nothing but what clips are from; name recordings of other "
                "motion");
  }
  return batch;
}

Examples LoadExamples(const LearnCommandOptions& options, const FeatureSet& features) {
  const ProgressCallback progress = MakeProgress(options.common);
  const auto load = [&](const std::vector<TakeStretch>& stretches) {
    return LoadManyTakeFeatures(stretches, features, options.features.rate_hz, options.common.load,
                                options.common.threads, progress, {.poses = true});
  };
  Examples examples;
  if (!options.library.empty()) {
    const TakeLibrary library(options.library);
    if (!options.class_name.empty()) {  // Says what is wrong with it.
      (void)library.TakesWith(features, options.features.rate_hz, ChosenTakes(options), true);
    }
    const ExampleRequest request = RequestOf(options, features);
    examples.labelled =
        options.label.empty()
            ? LoadLabelledTakes(library, TakesOfAllClasses(options), request)
            : LoadLabelledStretches(library, options.label, options.filter, request);
  } else if (options.list.empty()) {
    TakeBatch clips = load(ChosenClips(options));
    for (TakeFeatures& take : clips.takes) {
      std::string actor = take.name.actor;
      examples.labelled.clips.push_back({std::move(take), TemplateName(options), std::move(actor)});
    }
    examples.labelled.failures = std::move(clips.failures);
  } else {
    examples.labelled = LoadLabelledClips(ListedClips(options), features, options.features.rate_hz,
                                          options.common.load, options.common.threads, progress);
  }
  if (options.background.empty()) return examples;
  examples.background = LoadBackground(options, features, examples.labelled, progress);
  return examples;
}

std::vector<MotionTemplate> LearnTogether(const LearnCommandOptions& options,
                                          const FeatureSet& features, const Examples& examples) {
  std::vector<const LabelledClip*> clips;
  clips.reserve(examples.labelled.clips.size());
  for (const LabelledClip& clip : examples.labelled.clips) clips.push_back(&clip);
  std::vector<RecordingStreams> unlabelled;
  unlabelled.reserve(examples.background.takes.size());
  for (const TakeFeatures& take : examples.background.takes) {
    unlabelled.push_back({take.features, &take.poses});
  }
  const ClassLearningOptions learning{.learning = options.Learning(),
                                      .matching = options.Matching(),
                                      .max_rounds = options.max_rounds,
                                      .with_styles = options.styles,
                                      .unlabelled = unlabelled,
                                      .threads = options.common.threads,
                                      .progress = MakeProgress(options.common)};
  std::vector<MotionTemplate> templates = LearnClasses(clips, features, learning);
  const std::array methods = {*FindMethod("mt+")};
  Calibrate(GatherEvidence(clips, templates, features, methods, learning).front(), templates);
  return templates;
}

Json SummaryOf(const MotionTemplate& learned, const std::filesystem::path& file, double elapsed_s) {
  return {{"name", learned.name},
          {"clips", learned.clips.size()},
          {"columns", learned.matrix.column_count()},
          {"rounds", learned.rounds},
          {"elapsed_s", elapsed_s},
          {"file", file.string()}};
}

std::string DescribeLearned(const MotionTemplate& learned, const std::filesystem::path& file) {
  return fmt::format(
      "{}: learned from {} in {}, {} long ({:.2f} s), written to {}\n", OnOneLine(learned.name),
      FormatCount(std::ssize(learned.clips), "clip", "clips"),
      FormatCount(learned.rounds, "round", "rounds"),
      FormatCount(learned.matrix.column_count(), "column", "columns"),
      learned.matrix.total_weight() / learned.matrix.rate_hz, OnOneLine(file.string()));
}

// Of the second style of a class "squat-2.template.json", beside "squat.template.json".
std::filesystem::path FileOfStyle(const std::filesystem::path& file, int style) {
  if (style == 1) return file;
  const std::string name = file.filename().string();
  const std::size_t dot = std::min(name.find(".template."), name.find_last_of('.'));
  const std::size_t stem = std::min(dot, name.size());
  return file.parent_path() /
         fmt::format("{}-{}{}", name.substr(0, stem), style, name.substr(stem));
}

// Where each template goes that is asked for.
std::vector<std::pair<MotionTemplate, std::filesystem::path>> Outputs(
    const LearnCommandOptions& options, std::vector<MotionTemplate> templates) {
  std::vector<std::pair<MotionTemplate, std::filesystem::path>> outputs;
  std::map<std::string, int> styles;  // By class, so far.
  for (MotionTemplate& each : templates) {
    const int style = ++styles[each.name];
    if (options.all_classes) {
      auto file = FileOfStyle(options.output / DefaultOutput(each.name), style);
      outputs.emplace_back(std::move(each), std::move(file));
    } else if (options.class_name.empty() || each.name == options.class_name) {
      each.name = TemplateName(options);
      outputs.emplace_back(std::move(each), FileOfStyle(options.output, style));
    }
  }
  std::map<std::filesystem::path, std::string> names;
  for (const auto& [learned, file] : outputs) {
    const auto [entry, is_new] = names.emplace(file, learned.name);
    if (is_new) continue;
    throw Error(
        ErrorCode::kInvalidArgument,
        fmt::format("would be the template of '{}' and of '{}'; rename one of these classes",
                    entry->second, learned.name),
        {file});
  }
  return outputs;
}

int RunWithContrast(LearnCommandOptions& options) {
  const Stopwatch watch;
  if (options.output.empty()) options.output = DefaultOutput(TemplateName(options));
  if (!options.all_classes) CheckWritable(options.output, options.common.overwrite());
  const FeatureSet features = options.features.Load();
  const Examples examples = LoadExamples(options, features);
  std::vector<TakeFailure> failures = examples.labelled.failures;
  failures.insert(failures.end(), examples.background.failures.begin(),
                  examples.background.failures.end());
  for (const auto& failure : failures) PrintError(failure.error.what());
  for (const LabelledClip& clip : examples.labelled.clips) {
    PrintDiagnostics(options.common, clip.take.path, clip.take.diagnostics);
  }
  if (examples.labelled.clips.empty()) return kCouldNot;
  const auto outputs = Outputs(options, LearnTogether(options, features, examples));
  if (outputs.empty()) return kCouldNot;  // No take of the class could be read.
  for (const auto& [learned, file] : outputs) CheckWritable(file, options.common.overwrite());
  Json list = Json::array();
  for (const auto& [learned, file] : outputs) {
    WriteTemplate(learned, file, options.common.overwrite());
    list.push_back(SummaryOf(learned, file, watch.seconds()));
    if (!options.common.json) Print(DescribeLearned(learned, file));
  }
  if (options.common.json) {
    Json json = options.all_classes || options.styles ? Json{{"templates", list}} : list.front();
    if (!failures.empty()) json["failed"] = FailuresToJson(failures);
    PrintJson(json);
  }
  return failures.empty() ? kDone : kPartFailed;
}

// What a template is learned from by features alone.
TakeBatch LoadClips(const LearnCommandOptions& options, const FeatureSet& features,
                    const ProgressCallback& progress) {
  if (options.library.empty()) {
    return LoadManyTakeFeatures(ChosenClips(options), features, options.features.rate_hz,
                                options.common.load, options.common.threads, progress);
  }
  ExampleRequest request = RequestOf(options, features);
  request.with_poses = false;
  const TakeLibrary library(options.library);
  LabelledBatch labelled =
      options.label.empty()
          ? LoadLabelledTakes(library, ChosenTakes(options), request)
          : LoadLabelledStretches(library, options.label, options.filter, request);
  TakeBatch batch{.takes = {}, .failures = std::move(labelled.failures)};
  batch.takes.reserve(labelled.clips.size());
  for (LabelledClip& clip : labelled.clips) batch.takes.push_back(std::move(clip.take));
  return batch;
}

int Run(LearnCommandOptions& options) {
  const Stopwatch watch;
  CheckUsage(options);
  if (!options.update.empty()) {
    return RunUpdate({.common = options.common,
                      .template_file = options.update,
                      .marks = options.marks,
                      .folders = options.folders,
                      .feature_set = options.features.feature_set,
                      .output = options.output,
                      .max_rounds = options.max_rounds});
  }
  if (options.Method() == "mt+") return RunWithContrast(options);
  if (options.output.empty()) options.output = DefaultOutput(TemplateName(options));
  CheckWritable(options.output, options.common.overwrite());
  const FeatureSet features = options.features.Load();
  const ProgressCallback progress = MakeProgress(options.common);
  const TakeBatch batch = LoadClips(options, features, progress);
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
  learn.profile = options.Learning();
  const LearnedMatrix learned = LearnTemplate(performances, learn);
  const MotionTemplate result = MakeTemplate(options, features, batch, learned);
  WriteTemplate(result, options.output, options.common.overwrite());
  if (options.common.json) {
    Json json = SummaryOf(result, options.output, watch.seconds());
    if (!batch.failures.empty()) json["failed"] = FailuresToJson(batch.failures);
    PrintJson(json);
  } else {
    Print(DescribeLearned(result, options.output));
  }
  return batch.failures.empty() ? kDone : kPartFailed;
}

void AddMethodOptions(CLI::App& command, LearnCommandOptions& options) {
  command
      .add_option("--method", options.method,
                  "mt, as in the paper; mt+, also what sets the class off from other motion: the "
                  "default where --background or --all-classes gives some")
      ->check(OneOf({"mt", "mt+"}))
      ->type_name("mt|mt+");
  command
      .add_option("--background", options.background,
                  "Other motion for mt+, without labels, also a library: best what will be "
                  "searched")
      ->type_name("PATH");
  command.add_flag("--styles", options.styles,
                   "Several templates for a class whose clips fall into groups (method mt+)");
  command.add_option("--max-rounds", options.max_rounds, "Rounds of learning at most")
      ->check(WholeNumber(1, 10000))
      ->capture_default_str()
      ->type_name("N");
}

// After the others: what a template was learned with cannot be changed by hits.
void AddUpdateOptions(CLI::App& command, LearnCommandOptions& options) {
  auto* update = command
                     .add_option("--update", options.update,
                                 "Improve a template by hits that somebody marked, instead of "
                                 "learning a new one")
                     ->type_name("TEMPLATE");
  command
      .add_option("--marks", options.marks,
                  "Hits of search --format csv or --json, with right or wrong as their verdict")
      ->needs(update)
      ->type_name("FILE");
  for (const char* other : {"CLIP", "--name", "--list", "--profile", "--learning", "--matching",
                            "--rate", "--method", "--background", "--styles", "--library"}) {
    update->excludes(command.get_option(other));
  }
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
  auto* class_name =
      command->add_option("--class", options->class_name, "Class in the list or library")
          ->type_name("NAME");
  class_name->excludes(command->add_flag(
      "--all-classes", options->all_classes,
      "A template for each class of the list or library, into the folder -o (method mt+)"));
  auto* library =
      command
          ->add_option("--library", options->library,
                       "Takes of a library instead, from kinebase import, by their classes")
          ->excludes(list)
          ->type_name("FOLDER");
  for (CLI::Option* filter : AddTakeFilterOptions(*command, options->filter)) {
    if (filter != command->get_option("--actors")) filter->needs(library);  // Lists have these.
  }
  command
      ->add_option("--label", options->label,
                   "Stretches of the library's takes that have this label, instead of a class")
      ->needs(library)
      ->excludes(class_name)
      ->excludes(command->get_option("--all-classes"))
      ->type_name("WORD");
  AddMemoryOption(*command, options->memory_bytes);
  command
      ->add_option("--in", options->folders,
                   "Folders with the files of the list, or of the template and its hits")
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
  AddMethodOptions(*command, *options);
  AddUpdateOptions(*command, *options);
  AddOutputOptions(*command, options->common);
  AddThreadsOption(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer(
      "Examples:\n"
      "  kinebase learn squat_1.amc squat_2.amc gym.amc:120-480 --name squat\n"
      "  kinebase learn --list clips.csv --class squat1Reps --actors bd,bk -o squat.template.json\n"
      "  kinebase learn --list clips.csv --all-classes --method mt+ --background takes/ -o "
      "classes\n"
      "  kinebase learn --library motion.kinebase --class squat1Reps --background "
      "motion.kinebase\n"
      "  kinebase learn --library motion.kinebase --label squat -o squat.template.json\n"
      "  kinebase learn --update squat.template.json --marks hits.csv -o better.template.json");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
