// kinebase annotate: which motion class happens when, over long takes.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "cli/annotate_output.h"
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/feature_options.h"
#include "cli/take_source_options.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/library_templates.h"
#include "kinebase/library/take_annotation.h"
#include "kinebase/templates/calibration.h"

namespace kinebase::cli {
namespace {

namespace fs = std::filesystem;

struct AnnotateOptions {
  CommonOptions common;
  std::vector<fs::path> templates;
  std::vector<std::string> classes;  // "NAME=FILE".
  TakeSourceOptions source;
  std::vector<fs::path> background;
  std::optional<double> tau;
  std::optional<double> confidence;
  std::string overlap = "none";
  std::vector<std::string> sets;  // "CLASS,CLASS".
  std::optional<double> merge_s;
  bool no_unknown = false;
  std::string format;  // Empty: by the output's extension, else a table for people.
  fs::path output;
  fs::path picture;
  fs::path truth;
  std::vector<std::string> labels;  // "LABEL=CLASS".
  std::string feature_set;
};

using Query = AnnotationQuery;

// "NAME=VALUE"; the name has no '='.
std::pair<std::string, std::string> SplitAssignment(const std::string& text,
                                                    const std::string& option,
                                                    const std::string& form) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0 || sign + 1 == text.size()) {
    throw UsageError(fmt::format("{} takes {}, not {}", option, form, Quoted(text)));
  }
  return {text.substr(0, sign), text.substr(sign + 1)};
}

std::string ChosenFormat(const AnnotateOptions& options) {
  if (!options.format.empty()) return options.format;
  if (IsStandardOutput(options.output)) return options.common.json ? "json" : "";
  const std::string extension = ToLower(options.output.extension().string());
  if (extension == ".json" || extension == ".csv" || extension == ".eaf") {
    return extension.substr(1);
  }
  throw UsageError(
      fmt::format("'{}' does not tell the format: end it in .json, .csv or .eaf, or "
                  "add --format",
                  options.output.string()));
}

void CheckUsage(const AnnotateOptions& options, const std::string& format) {
  if (options.templates.empty() && options.classes.empty()) {
    throw UsageError("annotate needs templates: TEMPLATE, or --class NAME=FILE");
  }
  if (!options.source.is_given()) {
    throw UsageError("--in is required, or --library; see 'kinebase annotate --help'");
  }
  if (options.background.empty()) {
    CheckReadsFiles(options.source.library, options.common.load);
  }
  if (options.tau && !options.background.empty()) {
    throw UsageError("annotate takes --tau or --background, not both");
  }
  if (options.tau && options.confidence) {
    throw UsageError("annotate takes --tau or --confidence, not both");
  }
  if (!options.sets.empty() && options.overlap != "none") {
    throw UsageError("annotate takes --set or --overlap, not both");
  }
  if (!options.labels.empty() && options.truth.empty()) {
    throw UsageError("--label says what the labels of --truth mean; --truth is missing");
  }
  const bool prints_document = IsStandardOutput(options.output) && !format.empty();
  if (prints_document && options.common.json && format != "json") {
    throw UsageError(
        fmt::format("--json and --format {} both ask for standard output; add -o FILE", format));
  }
  if (prints_document && format != "json" && !options.truth.empty()) {
    throw UsageError(
        fmt::format("--truth and --format {} both ask for standard output; add "
                    "-o FILE",
                    format));
  }
}

void SetThreshold(Query& query, double tau) {
  query.search.tau = tau;
  query.motion_template.tau = tau;
}

Query LoadQuery(const fs::path& file, std::string class_name, const AnnotateOptions& options) {
  Query query{.motion_template = ReadOrLoadTemplate(file, options.source.library)};
  query.features = FeatureSetOfTemplate(file, query.motion_template, options.feature_set);
  query.class_name = class_name.empty() ? query.motion_template.name : std::move(class_name);
  if (query.class_name == kUnknownClass) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("the class '{}' stands for what no template fits; name it otherwise "
                            "with --class NAME=FILE",
                            kUnknownClass),
                {file});
  }
  const MotionTemplate& learned = query.motion_template;
  if (options.confidence) CheckKnowsConfidence(learned, file);
  query.search.quantized = Quantize(learned);
  SetThreshold(query, options.tau.value_or(learned.tau.value_or(kDefaultTau)));
  return query;
}

std::vector<Query> LoadQueries(const AnnotateOptions& options, std::vector<std::string>& classes) {
  std::vector<Query> queries;
  queries.reserve(options.templates.size() + options.classes.size());
  for (const fs::path& file : options.templates) queries.push_back(LoadQuery(file, {}, options));
  for (const std::string& text : options.classes) {
    const auto [name, file] = SplitAssignment(text, "--class", "NAME=FILE");
    queries.push_back(LoadQuery(file, name, options));
  }
  for (Query& query : queries) {
    const auto known = std::ranges::find(classes, query.class_name);
    query.search.motion_class = static_cast<int>(known - classes.begin());
    if (known == classes.end()) classes.push_back(query.class_name);
  }
  return queries;
}

// Failures of the background are among those of the takes.
void ChooseThresholds(std::vector<Query>& queries, const AnnotateOptions& options,
                      const ProgressCallback& progress, std::vector<TakeFailure>& failures) {
  const std::vector<TakeSource> background =
      SourcesIn(options.background, options.common.load, options.source.memory_limit());
  BackgroundThresholds found =
      FindThresholds(background, queries, options.common.threads, progress);
  failures = std::move(found.failures);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const std::optional<double>& tau = found.tau[i];
    std::optional<Calibration>& calibration = queries[i].motion_template.calibration;
    if (!tau) {
      throw Error(ErrorCode::kNotFound,
                  fmt::format("no background is long enough for the template '{}' and of another "
                              "class; add recordings to --background, or give --tau",
                              queries[i].motion_template.name));
    }
    SetThreshold(queries[i], *tau);
    if (calibration) calibration = HalfAt(*tau, calibration->slope);
  }
}

// What costs more is less sure than was asked for.
void AskForConfidence(std::vector<Query>& queries, double confidence) {
  for (Query& query : queries) {
    SetThreshold(query, CostAt(*query.motion_template.calibration, confidence));
  }
}

std::vector<int> TracksOfSets(const std::vector<std::string>& sets,
                              const std::vector<std::string>& classes) {
  std::vector<int> tracks(classes.size(), 0);  // Of those in no set.
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (std::size_t begin = 0; begin <= sets[i].size();) {
      const std::size_t end = std::min(sets[i].find(',', begin), sets[i].size());
      const std::string name = sets[i].substr(begin, end - begin);
      const auto known = std::ranges::find(classes, name);
      if (known == classes.end()) {
        throw UsageError(fmt::format("--set names a class {}; there are {}", Quoted(name),
                                     fmt::join(classes, ", ")));
      }
      int& track = tracks[static_cast<std::size_t>(known - classes.begin())];
      if (track != 0) throw UsageError(fmt::format("class '{}' is in two of --set", name));
      track = static_cast<int>(i) + 1;
      begin = end + 1;
    }
  }
  return tracks;
}

std::vector<int> Tracks(const AnnotateOptions& options, const std::vector<Query>& queries,
                        const std::vector<std::string>& classes) {
  if (!options.sets.empty()) return TracksOfSets(options.sets, classes);
  std::vector<int> tracks(classes.size(), 0);
  if (options.overlap == "all") {
    for (std::size_t i = 0; i < tracks.size(); ++i) tracks[i] = static_cast<int>(i);
  } else if (options.overlap == "parts") {
    std::vector<AnnotationTemplate> templates;
    for (const Query& query : queries) {
      if (query.features.hash != queries.front().features.hash) {
        throw Error(ErrorCode::kMismatch,
                    "--overlap parts needs templates of one feature set; name sets with --set");
      }
      templates.push_back(query.search);
    }
    tracks =
        TracksByBodyPart(templates, static_cast<int>(classes.size()), queries.front().features);
  }
  return tracks;
}

// Labels with the names of the classes that they mean.
std::vector<SegmentLabel> LoadTruth(const AnnotateOptions& options,
                                    const std::vector<std::string>& classes) {
  std::map<std::string, std::string> meanings;
  for (const std::string& text : options.labels) {
    const auto [label, name] = SplitAssignment(text, "--label", "LABEL=CLASS");
    if (std::ranges::find(classes, name) == classes.end()) {
      throw UsageError(fmt::format("--label names a class {}; there are {}", Quoted(name),
                                   fmt::join(classes, ", ")));
    }
    meanings[label] = name;
  }
  std::vector<SegmentLabel> labels = ReadSegmentLabels(options.truth);
  std::set<std::string> unknown;
  for (SegmentLabel& label : labels) {
    const auto meaning = meanings.find(label.label);
    if (meaning != meanings.end()) label.label = meaning->second;
    if (std::ranges::find(classes, label.label) == classes.end()) unknown.insert(label.label);
  }
  const bool has_class = std::ranges::any_of(
      labels, [&](const SegmentLabel& label) { return !unknown.contains(label.label); });
  if (!has_class) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("none of its labels ({}) is one of the classes ({}); say which is "
                            "which with --label LABEL=CLASS",
                            fmt::join(unknown, ", "), fmt::join(classes, ", ")),
                {options.truth});
  }
  return labels;
}

void AddTruth(const std::vector<SegmentLabel>& labels, const fs::path& file,
              Annotation& annotation) {
  std::map<std::string, fs::path> recordings;
  bool is_any = false;
  for (AnnotatedTake& take : annotation.takes) {
    const std::string name = RecordingName(take.path);
    const auto [other, is_new] = recordings.try_emplace(name, take.path);
    if (!is_new) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("the labels for '{}' may mean {} or {}; annotate them one by one",
                              name, other->second.string(), take.path.string()),
                  {file});
    }
    for (const SegmentLabel& label : labels) {
      if (label.recording == name) take.truth.push_back(label);
    }
    is_any = is_any || !take.truth.empty();
  }
  if (is_any) return;
  throw Error(ErrorCode::kMismatch,
              "has no labels for any of the recordings; its column of files holds their names, "
              "with or without folder and extension",
              {file});
}

// Recordings that the truth does not know say nothing.
AnnotationAccuracy Measure(const Annotation& annotation) {
  std::vector<JudgedRecording> recordings;
  for (const AnnotatedTake& take : annotation.takes) {
    if (take.truth.empty()) continue;
    JudgedRecording recording{.length = take.frame_count};
    for (const AnnotationCandidate& segment : take.segments) {
      recording.found.push_back({segment.motion_class, segment.first - 1, segment.last - 1});
    }
    for (const SegmentLabel& label : take.truth) {
      const auto known = std::ranges::find(annotation.classes, label.label);
      if (known == annotation.classes.end()) continue;
      recording.truth.push_back({static_cast<int>(known - annotation.classes.begin()),
                                 label.first_frame - 1, label.last_frame - 1});
    }
    recordings.push_back(std::move(recording));
  }
  return MeasureAnnotation(recordings, static_cast<int>(annotation.classes.size()));
}

void CheckElan(const Annotation& annotation, const AnnotateOptions& options) {
  std::error_code ignored;
  const bool may_be_folder = fs::is_directory(options.output, ignored) ||
                             ToLower(options.output.extension().string()) != ".eaf";
  if (annotation.takes.size() == 1) return;
  if (!IsStandardOutput(options.output) && may_be_folder) return;
  throw UsageError(
      fmt::format("an EAF document describes one recording, and there are {}; name a "
                  "folder for them with -o, and --format eaf",
                  annotation.takes.size()));
}

// ELAN's documents describe one recording each: several go into a folder, under their names.
void WriteElan(const Annotation& annotation, const AnnotateOptions& options) {
  std::error_code ignored;
  const bool is_folder = annotation.takes.size() > 1 || fs::is_directory(options.output, ignored);
  std::vector<std::string> texts;
  std::vector<fs::path> paths;
  for (const AnnotatedTake& take : annotation.takes) {
    texts.push_back(ToElan(annotation, take));
    fs::path path = options.output;
    if (is_folder) path /= RecordingName(take.path) + ".eaf";
    if (std::ranges::find(paths, path) != paths.end()) {
      throw Error(ErrorCode::kMismatch,
                  "would hold two recordings of this name; annotate them one by one", {path});
    }
    paths.push_back(std::move(path));
  }
  std::vector<FileContents> files;
  for (std::size_t i = 0; i < paths.size(); ++i) files.push_back({paths[i], texts[i]});
  WriteFiles(files, options.common.overwrite());
  PrintWritten(options.common, options.output);
}

void WriteDocument(const Annotation& annotation, const std::string& format,
                   const AnnotateOptions& options) {
  if (format == "eaf") {
    WriteElan(annotation, options);
    return;
  }
  std::string text = ToCsv(annotation);
  if (format == "json") {
    text = ToJson(annotation).dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
  }
  WriteFile(options.output, text, options.common.overwrite());
  PrintWritten(options.common, options.output);
}

void PrintDocument(const Annotation& annotation, const std::string& format) {
  if (format == "json") {
    PrintJson(ToJson(annotation));
  } else if (format == "csv") {
    Print(ToCsv(annotation));
  } else {
    Print(ToElan(annotation, annotation.takes.front()));  // CheckElan: the only one.
  }
}

void PrintTables(const Annotation& annotation, const AnnotateOptions& options) {
  std::string text;
  if (IsStandardOutput(options.output)) text = SegmentTable(annotation);
  if (annotation.accuracy) text += (text.empty() ? "" : "\n") + AccuracyTables(annotation);
  if (!text.empty()) Print(text);
}

void Show(const Annotation& annotation, const std::string& format, const AnnotateOptions& options) {
  if (!options.picture.empty()) {
    DrawAnnotation(annotation, options.picture, options.common.overwrite());
    PrintWritten(options.common, options.picture);
  }
  if (IsStandardOutput(options.output) && !format.empty()) {
    PrintDocument(annotation, format);
    return;
  }
  if (!IsStandardOutput(options.output)) WriteDocument(annotation, format, options);
  if (options.common.json) {
    PrintJson(ToJson(annotation));
  } else {
    PrintTables(annotation, options);
  }
}

void CheckOutputs(const AnnotateOptions& options, const std::string& format) {
  std::error_code ignored;
  const bool is_folder = format == "eaf" && fs::is_directory(options.output, ignored);
  if (!IsStandardOutput(options.output) && !is_folder) {
    CheckWritable(options.output, options.common.overwrite());
  }
  if (!options.picture.empty()) CheckWritable(options.picture, options.common.overwrite());
}

int Run(const AnnotateOptions& options) {
  const std::string format = ChosenFormat(options);
  CheckUsage(options, format);
  CheckOutputs(options, format);
  Annotation annotation{.shows_unknown = !options.no_unknown};
  std::vector<Query> queries = LoadQueries(options, annotation.classes);
  const std::vector<int> tracks = Tracks(options, queries, annotation.classes);
  annotation.one_track = std::ranges::all_of(tracks, [&](int t) { return t == tracks.front(); });
  std::vector<SegmentLabel> truth;
  if (!options.truth.empty()) truth = LoadTruth(options, annotation.classes);

  const ProgressCallback progress = MakeProgress(options.common);
  if (!options.background.empty()) {
    ChooseThresholds(queries, options, progress, annotation.failures);
  }
  if (options.confidence) AskForConfidence(queries, *options.confidence);
  for (const Query& query : queries) {
    annotation.thresholds.push_back(
        {query.motion_template.name, query.class_name, query.search.tau});
  }
  AnnotatedTakes annotated = AnnotateTakes(SourceOf(options.source, options.common.load), queries,
                                           {.tracks = tracks,
                                            .merge_s = options.merge_s,
                                            .threads = options.common.threads,
                                            .progress = progress});
  annotation.failures.insert(annotation.failures.end(), annotated.failures.begin(),
                             annotated.failures.end());
  for (const auto& failure : annotation.failures) PrintError(failure.error.what());
  if (annotated.takes.empty()) return kCouldNot;
  for (TakeSegments& take : annotated.takes) {
    PrintDiagnostics(options.common, take.path, take.diagnostics);
    annotation.takes.push_back({.path = std::move(take.path),
                                .rate_hz = take.rate_hz,
                                .frame_count = take.frame_count,
                                .segments = std::move(take.segments)});
  }
  if (format == "eaf") CheckElan(annotation, options);
  if (!options.truth.empty()) AddTruth(truth, options.truth, annotation);
  if (!options.truth.empty()) annotation.accuracy = Measure(annotation);
  Show(annotation, format, options);
  return annotation.failures.empty() ? kDone : kPartFailed;
}

void AddWhatToFind(CLI::App& command, AnnotateOptions& options) {
  command.add_option("TEMPLATE", options.templates,
                     "Template files, from learn, or names of those in the library; those of one "
                     "name are one class");
  command.add_option("--class", options.classes, "A template of a class of this name")
      ->type_name("NAME=FILE");
  AddSourceOptions(command, options.source, "annotate");
  command
      .add_option("--tau", options.tau,
                  "Largest cost of all classes (default: each template's own, else 0.06)")
      ->check(NonNegativeNumber())
      ->type_name("COST");
  command
      .add_option("--background", options.background,
                  "Recordings, or libraries, that show other motion: thresholds are chosen from "
                  "them")
      ->type_name("PATH");
  AddConfidenceOption(command, options.confidence);
  command
      .add_option("--overlap", options.overlap,
                  "What may happen at the same time: nothing, classes of other body parts, or all")
      ->check(OneOf({"none", "parts", "all"}))
      ->capture_default_str()
      ->type_name("none|parts|all");
  command
      .add_option("--set", options.sets,
                  "Classes that exclude each other, and may overlap with those of other sets")
      ->type_name("CLASS,...");
  command
      .add_option("--merge", options.merge_s,
                  "Repetitions with at most this pause become one segment (default: stay apart)")
      ->check(NonNegativeNumber())
      ->type_name("SECONDS");
}

void AddWhatToShow(CLI::App& command, AnnotateOptions& options) {
  command.add_flag("--no-unknown", options.no_unknown, "Leave out stretches that no class fits");
  command
      .add_option("--format", options.format,
                  "Form of the result (default: by -o, else a table for people)")
      ->check(OneOf({"json", "csv", "eaf"}))
      ->type_name("json|csv|eaf");
  command
      .add_option("-o,--output", options.output,
                  "Write there; a folder for the EAF documents of several recordings")
      ->type_name("FILE");
  command.add_option("--picture", options.picture, "Draw timelines, .png or .svg")
      ->check(PictureFile())
      ->type_name("FILE");
  command
      .add_option("--truth", options.truth,
                  "Labels to compare with (CSV: file,class,first_frame,last_frame)")
      ->type_name("FILE");
  command.add_option("--label", options.labels, "Which class a label of the truth means")
      ->type_name("LABEL=CLASS");
}

}  // namespace

void AddAnnotateCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<AnnotateOptions>();
  CLI::App* command =
      program.add_subcommand("annotate", "Say which motion class happens when, over long takes");
  AddWhatToFind(*command, *options);
  AddWhatToShow(*command, *options);
  AddFeatureSetOption(*command, options->feature_set);
  AddOutputOptions(*command, options->common);
  AddThreadsOption(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer(
      "Examples:\n"
      "  kinebase annotate squat.template.json kick.template.json --in gym.amc --background "
      "other/\n"
      "  kinebase annotate squat.template.json --library motion.kinebase --actors bd -o bd.csv");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
