// kinebase evaluate: how well methods find classes in actors they have not seen.

#include <memory>
#include <set>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/evaluate_options.h"
#include "cli/evaluate_preset.h"
#include "cli/evaluate_report.h"
#include "cli/score_table.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/library/evaluation.h"
#include "kinebase/library/paper_tables.h"

namespace kinebase::cli {
namespace {

Json ToJson(const TauScores& scores) {
  return {{"tau", scores.tau},
          {"precision", scores.precision},
          {"recall", scores.recall},
          {"f1", scores.f1}};
}

Json ToJson(const Scores& scores, bool has_tau) {
  Json at = Json::array();
  for (const TauScores& each : scores.at) at.push_back(ToJson(each));
  return {{"ap_strict", scores.ap_strict},
          {"ap_lenient", scores.ap_lenient},
          {"r_precision", scores.r_precision},
          {"recall_in_5", scores.recall_in_5},
          {"recall_in_10", scores.recall_in_10},
          {"recall_in_20", scores.recall_in_20},
          {"classified", scores.classified},
          {"separation", scores.separation > 0 ? Json(scores.separation) : Json()},
          {"at_own", has_tau ? ToJson(scores.at_own) : Json()},
          {"at", at}};
}

Json ToJson(const std::vector<ReliabilityBin>& bins) {
  Json reliability = Json::array();
  for (const ReliabilityBin& bin : bins) {
    reliability.push_back(
        {{"hits", bin.hits}, {"confidence", bin.confidence}, {"right", bin.right}});
  }
  return reliability;
}

Json ToJson(const Evaluation& evaluation) {
  Json methods = Json::array();
  for (const MethodResult& result : evaluation.methods) {
    Json classes = Json::array();
    for (const ClassResult& each : result.classes) {
      Json actors = Json::object();
      for (const auto& [actor, scores] : each.by_actor)
        actors[actor] = ToJson(scores, result.has_tau);
      classes.push_back(
          {{"class", each.class_name},
           {"mean", each.by_actor.empty() ? Json() : ToJson(each.mean, result.has_tau)},
           {"actors", actors}});
    }
    const std::vector<ReliabilityBin> bins = MeasureReliability(result);
    methods.push_back(
        {{"method", result.name},
         {"macro", ToJson(result.macro, result.has_tau)},
         {"calibration_error", result.has_confidence ? Json(CalibrationError(bins)) : Json()},
         {"reliability", result.has_confidence ? ToJson(bins) : Json()},
         {"confusion", ConfusionToJson(result)},
         {"mistaken", MistakenToJson(result)},
         {"classes", classes}});
  }
  return methods;
}

constexpr char kNone[] = "–";

std::string ShortNumber(double value) { return fmt::format("{:.3f}", value); }

// A class's cell of a method in each column.
std::vector<std::string> ScoreCells(const MethodResult& result, const Scores& scores) {
  return {ShortNumber(scores.ap_lenient), ShortNumber(scores.ap_strict),
          ShortNumber(scores.r_precision), result.has_tau ? ShortNumber(scores.at_own.f1) : kNone};
}

// AP lenient and strict, R-precision, F1 at the class's own threshold; of many methods AP alone.
Rows ScoresByClass(const Evaluation& evaluation) {
  constexpr std::size_t kFewMethods = 3;
  const std::vector<std::string> measures = {"AP", "strict", "R-prec", "F1"};
  const bool few = evaluation.methods.size() <= kFewMethods;
  const std::size_t shown = few ? measures.size() : 1;
  Rows rows = {{few ? "class" : "class, AP"}};
  for (const MethodResult& result : evaluation.methods) {
    for (std::size_t i = 0; i < shown; ++i) {
      rows.front().push_back(few ? fmt::format("{} {}", result.name, measures[i])
                                 : std::string(result.name));
    }
  }
  // scores_of  Null where a class could not be evaluated.
  const auto add = [&](const std::string& name, const auto& scores_of) {
    std::vector<std::string> row = {name};
    for (const MethodResult& result : evaluation.methods) {
      const Scores* scores = scores_of(result);
      std::vector<std::string> cells(measures.size(), kNone);
      if (scores != nullptr) cells = ScoreCells(result, *scores);
      row.insert(row.end(), cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(shown));
    }
    rows.push_back(row);
  };
  for (std::size_t i = 0; i < evaluation.methods.front().classes.size(); ++i) {
    add(evaluation.methods.front().classes[i].class_name, [i](const MethodResult& result) {
      const ClassResult& each = result.classes[i];
      return each.by_actor.empty() ? nullptr : &each.mean;
    });
  }
  add("macro", [](const MethodResult& result) { return &result.macro; });
  return rows;
}

// What concerns a method as a whole.
Rows ScoresByMethod(const Evaluation& evaluation) {
  Rows rows = {{"method", "AP", "strict", "R-prec", "precision", "recall", "F1", "classified",
                "calibration error", "separation"}};
  for (const MethodResult& result : evaluation.methods) {
    const Scores& macro = result.macro;
    const auto if_tau = [&](double value) { return result.has_tau ? ShortNumber(value) : kNone; };
    rows.push_back(
        {std::string(result.name), ShortNumber(macro.ap_lenient), ShortNumber(macro.ap_strict),
         ShortNumber(macro.r_precision), if_tau(macro.at_own.precision),
         if_tau(macro.at_own.recall), if_tau(macro.at_own.f1), ShortNumber(macro.classified),
         result.has_confidence ? ShortNumber(CalibrationError(MeasureReliability(result))) : kNone,
         macro.separation > 0 ? fmt::format("{:.1f}", macro.separation) : kNone});
  }
  return rows;
}

Json ToJson(const AccuracyCounts& counts) {
  return {{"precision", counts.precision()}, {"recall", counts.recall()}, {"f1", counts.f1()}};
}

Json ToJson(const AnnotationAccuracy& accuracy) {
  return {{"frames", ToJson(AnnotationAccuracy::Micro(accuracy.frames))},
          {"segments", ToJson(AnnotationAccuracy::Micro(accuracy.segments))}};
}

Json ToJson(const std::vector<AnnotateEvaluation>& results) {
  Json methods = Json::array();
  for (const AnnotateEvaluation& result : results) {
    Json actors = Json::object();
    for (const auto& [actor, accuracy] : result.by_actor) actors[actor] = ToJson(accuracy);
    Json method = ToJson(result.accuracy);
    method["method"] = result.method;
    method["actors"] = std::move(actors);
    methods.push_back(std::move(method));
  }
  return methods;
}

// Micro precision, recall and F1 over frames, and over segments.
Rows AccuracyRows(const std::vector<AnnotateEvaluation>& results) {
  Rows rows = {{"method", "frames P", "R", "F1", "segments P", "R", "F1"}};
  for (const AnnotateEvaluation& result : results) {
    std::vector<std::string>& row = rows.emplace_back();
    row.emplace_back(result.method);
    for (const auto* counts : {&result.accuracy.frames, &result.accuracy.segments}) {
      const AccuracyCounts micro = AnnotationAccuracy::Micro(*counts);
      for (const double value : {micro.precision(), micro.recall(), micro.f1()}) {
        row.push_back(ShortNumber(value));
      }
    }
  }
  return rows;
}

// What --methods names, each once.
struct Chosen {
  std::vector<Method> methods;
  std::vector<Baseline> baselines;
};

Chosen ChosenMethods(const std::vector<std::string>& names) {
  Chosen chosen;
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!seen.insert(name).second) continue;
    if (const Method* method = FindMethod(name)) {
      chosen.methods.push_back(*method);
    } else {
      chosen.baselines.push_back(*FindBaseline(name));
    }
  }
  return chosen;
}

// What the report begins with, as long as the watch has run.
ReportText BeginReport(const CLI::App& command, const EvaluateCommandOptions& options,
                       const EvaluationData& data, const Stopwatch& watch) {
  ReportText text{.command = CommandLine(command), .facts = DataFacts(data)};
  text.facts.emplace_back("protocol", options.protocol);
  if (options.protocol == "annotate") text.facts.emplace_back("thresholds", options.thresholds);
  text.facts.emplace_back("seconds, reading included", fmt::format("{:.1f}", watch.seconds()));
  return text;
}

int Run(const EvaluateCommandOptions& options, const CLI::App& command) {
  const Stopwatch watch;
  const bool annotates = options.protocol == "annotate";
  if (options.possibly_relevant.empty() != options.labels.empty()) {
    throw UsageError("--possibly-relevant and --labels go together");
  }
  if (!options.preset.empty()) return RunPreset(options, command);
  const auto [methods, baselines] = ChosenMethods(options.methods);
  if (annotates && !baselines.empty()) {
    throw UsageError(fmt::format("--protocol annotate is for templates; '{}' gives no segments",
                                 baselines.front().name));
  }
  const bool from_background = options.thresholds == "background";
  if (from_background && !annotates) {
    throw UsageError("--thresholds background is for --protocol annotate");
  }
  const bool reports = !options.report.folder.empty();
  const Overwrite overwrite = options.common.overwrite();
  if (reports) {
    CheckReport(options.report, annotates, options.methods, overwrite);
  }
  const FeatureSet features = options.features.Load();
  const ProgressCallback progress = MakeProgress(options.common);
  EvaluationData data = LoadEvaluationData({options.list, options.folders, options.distractors},
                                           features, options.features.rate_hz, options.common.load,
                                           options.common.threads, progress, PartsFor(baselines));
  if (!options.possibly_relevant.empty()) {
    data.possibly_relevant = PossiblyRelevant::Read(options.possibly_relevant, options.labels);
  }
  for (const TakeFailure& failure : data.failures) PrintError(failure.error.what());
  if (data.clips.empty()) return kCouldNot;
  const auto as = [&options](const Rows& rows) {
    return options.format == "markdown" ? AsMarkdown(rows) : AsText(rows);
  };
  if (annotates) {
    const auto results = EvaluateAnnotation(data, features,
                                            {.methods = methods,
                                             .profile = options.features.ParsedProfile(),
                                             .background_thresholds = from_background,
                                             .threads = options.common.threads,
                                             .progress = progress});
    if (reports) {
      ReportText text = BeginReport(command, options, data, watch);
      text.methods_table = AsMarkdown(AccuracyRows(results));
      text.json = {{"methods", ToJson(results)}};
      const std::set<std::string> classes = data.ClassNames();
      WriteReport(options.report, text, results, {classes.begin(), classes.end()}, overwrite);
      PrintWritten(options.common, options.report.folder);
    }
    if (options.common.json) {
      PrintJson({{"methods", ToJson(results)}});
    } else {
      Print(as(AccuracyRows(results)));
    }
    return data.failures.empty() ? kDone : kPartFailed;
  }
  const Evaluation evaluation = Evaluate(
      data, features,
      {.protocol = options.protocol == "half" ? Protocol::kHalf : Protocol::kLeaveOneActorOut,
       .methods = methods,
       .baselines = baselines,
       .profile = options.features.ParsedProfile(),
       .threads = options.common.threads,
       .progress = progress});
  if (reports) {
    ReportText text = BeginReport(command, options, data, watch);
    text.methods_table = AsMarkdown(ScoresByMethod(evaluation));
    text.classes_table = AsMarkdown(ScoresByClass(evaluation));
    text.json = {{"methods", ToJson(evaluation)}};
    WriteReport(options.report, text, evaluation, overwrite);
    PrintWritten(options.common, options.report.folder);
  }
  if (options.common.json) {
    PrintJson({{"methods", ToJson(evaluation)}});
  } else {
    Print(as(ScoresByMethod(evaluation)) + '\n' + as(ScoresByClass(evaluation)));
  }
  return data.failures.empty() ? kDone : kPartFailed;
}

// decided  Options that a preset decides itself.
void AddPresetOptions(CLI::App& command, EvaluateCommandOptions& options,
                      const std::vector<CLI::Option*>& decided) {
  const auto presets = PaperPresetNames();
  CLI::Option* preset = command.add_option(
      "--preset", options.preset,
      "Instead: table1 to table5, figure7 or figure8 of the motion template paper, its figures "
      "beside ours");
  preset->check(OneOf(std::vector<std::string>(presets.begin(), presets.end())))->type_name("NAME");
  for (CLI::Option* option : decided) preset->excludes(option);
  command
      .add_option("--paper-classes", options.paper_classes,
                  "What the paper's classes are called in the list: CSV with columns class, hdm05")
      ->needs(preset)
      ->type_name("FILE");
  command
      .add_option("--picture", options.picture, "Draw figure7 or figure8 into this .svg or .png")
      ->needs(preset)
      ->check(PictureFile())
      ->type_name("FILE");
}

}  // namespace

void AddEvaluateCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<EvaluateCommandOptions>();
  CLI::App* command = program.add_subcommand(
      "evaluate", "How well methods find motion classes in actors that they have not seen");
  command
      ->add_option("--clips", options->list, "Table of clips: CSV with columns file, class, actor")
      ->required()
      ->type_name("FILE");
  command->add_option("--in", options->folders, "Folders with the list's files, beside its own")
      ->type_name("FOLDER");
  command
      ->add_option("--distractors", options->distractors,
                   "Takes of other motion: every hit in them is a false alarm")
      ->type_name("PATH");
  command
      ->add_option("--possibly-relevant", options->possibly_relevant,
                   "Table of what distractors may show after all: CSV with columns class, trial, "
                   "label")
      ->type_name("FILE");
  command->add_option("--labels", options->labels, "Table of the stretches that it names")
      ->type_name("FILE");
  CLI::Option* protocol =
      command->add_option("--protocol", options->protocol, "What is learned from, what searched");
  protocol->check(OneOf({"leave-one-actor-out", "half", "annotate"}))
      ->capture_default_str()
      ->type_name("NAME");
  CLI::Option* thresholds =
      command->add_option("--thresholds", options->thresholds,
                          "Where annotate's come from: training clips, or what other motion costs");
  thresholds->check(OneOf({"training", "background"}))
      ->capture_default_str()
      ->type_name("training|background");
  std::vector<std::string> names;
  for (const Method& method : RetrievalMethods()) names.emplace_back(method.name);
  for (const Baseline& baseline : Baselines()) names.emplace_back(baseline.name);
  CLI::Option* methods =
      command->add_option("--methods", options->methods, "Methods, side by side");
  methods->delimiter(',')->check(OneOf(names))->type_name("NAMES");
  AddPresetOptions(*command, *options, {protocol, methods, thresholds});
  command->add_option("--format", options->format, "Tables for people, or for a document")
      ->check(OneOf({"text", "markdown"}))
      ->capture_default_str()
      ->type_name("text|markdown");
  command
      ->add_option("--report", options->report.folder,
                   "Also write a document with tables, pictures and JSON into this folder")
      ->type_name("FOLDER");
  command->add_option("--picture-format", options->report.picture_format, "Of its pictures")
      ->needs("--report")
      ->check(OneOf({"svg", "png"}))
      ->capture_default_str()
      ->type_name("svg|png");
  AddProfileOption(*command, options->features.profile,
                   "Features, learning and matching as the authors' toolbox (bonn) or the paper");
  AddFeatureSetOption(*command, options->features.feature_set);
  AddRateOption(*command, options->features.rate_hz);
  AddOutputOptions(*command, options->common);
  AddThreadsOption(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer(
      "Examples:\n  kinebase evaluate --clips clips.csv --distractors takes/ --methods mt,mt+\n"
      "  kinebase evaluate --clips clips.csv --preset table2");
  command->callback([options, command, &exit_code] { exit_code = Run(*options, *command); });
}

}  // namespace kinebase::cli
