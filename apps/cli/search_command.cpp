// kinebase search: every place where a motion class happens.

#include <memory>
#include <optional>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/feature_options.h"
#include "cli/search_curve.h"
#include "cli/search_output.h"
#include "cli/take_source_options.h"
#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/features/vocabulary.h"
#include "kinebase/library/library_templates.h"
#include "kinebase/library/source_search.h"
#include "kinebase/templates/calibration.h"
#include "kinebase/templates/keyframes.h"
#include "kinebase/templates/quantized_template.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

struct SearchCommandOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> templates;
  TakeSourceOptions source;
  std::optional<double> tau;
  std::optional<double> confidence;
  std::size_t most_hits = 500;
  bool mirror = false;
  std::filesystem::path curve;
  std::filesystem::path labels;
  std::string keyframes = "none";
  std::string profile;
  std::string feature_set;
  std::string method;  // Empty: as the template knows.
  std::string format;  // Empty: as --json says.
  bool fuzzy = false;
  std::string features;  // Of a fuzzy search, as FindFeatures takes them.
  int faults = 0;

  [[nodiscard]] std::string Format() const {
    if (!format.empty()) return format;
    return common.json ? "json" : "text";
  }
};

void CheckCurve(const SearchCommandOptions& options) {
  const bool is_picture = IsPicture(options.curve);
  if (!options.labels.empty() && !is_picture) {
    throw UsageError("--labels are drawn below curves; add --curve with a file in .svg or .png");
  }
  if (options.curve.empty()) return;
  if (options.templates.size() != 1 && !is_picture) {
    throw UsageError("--curve takes one template, unless its file ends in .svg or .png");
  }
  CheckWritable(options.curve, options.common.overwrite());
}

void CheckUsage(const SearchCommandOptions& options) {
  if (options.common.json && options.Format() != "json") {
    throw UsageError(fmt::format("--json and --format {} both ask for standard output; leave one",
                                 options.format));
  }
  if (!options.source.is_given()) {
    throw UsageError("--in is required, or --library; see 'kinebase search --help'");
  }
  if (options.fuzzy && options.features.empty()) {
    throw UsageError("--fuzzy needs the features that count: --features rknee bent,lknee bent");
  }
  if (options.confidence && options.method == "mt") {
    throw UsageError(
        "--confidence is about the costs of mt+; leave out --method mt, or give --tau");
  }
  CheckCurve(options);
}

constexpr std::uint64_t kMostFaults = 1000;

using Query = SearchQuery;

// Those of another template file, made for the same template.
std::vector<Keyframe> KeyframesOfFile(const std::filesystem::path& path,
                                      const std::filesystem::path& library,
                                      const MotionTemplate& motion_template) {
  const MotionTemplate source = ReadOrLoadTemplate(path, library);
  if (source.keyframes.empty()) {
    throw Error(ErrorCode::kNotFound, "holds no keyframes; kinebase template keyframes makes some",
                {path});
  }
  if (source.feature_set_hash != motion_template.feature_set_hash ||
      source.matrix.column_count() != motion_template.matrix.column_count()) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("has keyframes of another template than '{}': columns or feature set "
                            "differ",
                            motion_template.name),
                {path});
  }
  return source.keyframes;
}

// Puts the keyframes to search with into the template, whatever its file holds.
void SetKeyframes(Query& query, const SearchCommandOptions& options) {
  std::vector<Keyframe>& keyframes = query.motion_template.keyframes;
  if (options.keyframes == "none") {
    keyframes.clear();
  } else if (options.keyframes != "auto") {
    keyframes = KeyframesOfFile(options.keyframes, options.source.library, query.motion_template);
  } else if (keyframes.empty()) {
    keyframes = ChooseKeyframes(query.motion_template, query.features);
    if (!keyframes.empty()) return;
    PrintNote(
        options.common,
        fmt::format("no moment of {} is telling enough for a keyframe: everything is searched",
                    OnOneLine(query.motion_template.name)));
  }
}

// What the template asks for of the selected features, whatever else it knows. With --mirror the
// selection changes sides too: it names what counts in the template's file.
FuzzyQuery FuzzyQueryOf(const Query& query, const SearchCommandOptions& options) {
  const MotionTemplate& motion_template = query.motion_template;
  const std::vector<int> mirrored = query.features.MirrorRows();
  std::uint64_t selected = 0;
  for (const int row : FindFeatures(query.features, options.features)) {
    selected |=
        std::uint64_t{1} << (options.mirror ? mirrored[static_cast<std::size_t>(row)] : row);
  }
  return MakeFuzzyQuery(
      Quantize(motion_template.matrix, motion_template.quantisation, motion_template.matching),
      selected);
}

Query LoadQuery(const std::filesystem::path& path, const SearchCommandOptions& options) {
  Query query{.motion_template = ReadOrLoadTemplate(path, options.source.library)};
  query.features = FeatureSetOfTemplate(path, query.motion_template, options.feature_set);
  SetKeyframes(query, options);
  if (options.mirror) query.motion_template = MirrorTemplate(query.motion_template, query.features);
  if (const auto profile = ParseProfile(options.profile)) query.motion_template.matching = *profile;
  if (options.fuzzy) query.fuzzy = FuzzyQueryOf(query, options);
  if ((options.method == "mt" || options.fuzzy) && query.motion_template.contrast) {
    // Threshold and confidence are about other costs.
    query.motion_template.contrast.reset();
    query.motion_template.calibration.reset();
    query.motion_template.tau.reset();
  }
  if (query.motion_template.contrast && options.keyframes != "none") {
    throw Error(ErrorCode::kInvalidArgument,
                "was learned with --method mt+, which looks at everything; --keyframes needs "
                "--method mt",
                {path});
  }
  if (options.method == "mt+" && !query.motion_template.contrast) {
    throw Error(ErrorCode::kInvalidArgument,
                "is a plain template; learn it with --method mt+ for that", {path});
  }
  if (options.confidence) {
    CheckKnowsConfidence(query.motion_template, path);
    query.motion_template.tau = CostAt(*query.motion_template.calibration, *options.confidence);
  }
  return query;
}

double ThresholdOf(const MotionTemplate& motion_template, const SearchCommandOptions& options) {
  return options.tau.value_or(motion_template.tau.value_or(kDefaultTau));
}

void Show(const SourceHits& found, const std::vector<NamedHit>& hits, double elapsed_s,
          const SearchCommandOptions& options) {
  const double share = found.all_columns == 0 ? 1
                                              : static_cast<double>(found.searched_columns) /
                                                    static_cast<double>(found.all_columns);
  if (options.Format() == "json") {
    Json json = HitsToJson(hits, found.failures, found.frames, elapsed_s);
    if (options.keyframes != "none") json["searched_share"] = share;
    PrintJson(json);
    return;
  }
  if (options.Format() == "csv") {
    Print(HitsToCsv(hits));
  } else if (!hits.empty()) {
    Print(HitsToText(hits, options.templates.size() > 1));
  }
  PrintNote(options.common, fmt::format("{} in {} frames of {}, {:.2f} s",
                                        FormatCount(std::ssize(hits), "hit", "hits"), found.frames,
                                        FormatCount(static_cast<std::int64_t>(found.takes),
                                                    "recording", "recordings"),
                                        elapsed_s));
  if (found.searched_columns < found.all_columns) {
    PrintNote(options.common,
              fmt::format("keyframes left {:.1f} % of the columns to search; motion that does not "
                          "show them is missed (--keyframes none searches everything)",
                          100 * share));
  }
}

std::vector<NamedHit> WithNames(const SourceHits& found, std::span<const Query> queries) {
  std::vector<NamedHit> hits;
  hits.reserve(found.hits.size());
  for (const SourceHit& each : found.hits) {
    hits.push_back({each.query, queries[each.query].motion_template.name, each.file, each.hit});
  }
  return hits;
}

SourceSearchOptions SearchOptionsOf(const SearchCommandOptions& options) {
  return {.tau = options.tau,
          .most_hits = options.most_hits,
          .faults = options.faults,
          .threads = options.common.threads,
          .progress = MakeProgress(options.common),
          .on_takes = {}};
}

int Run(const SearchCommandOptions& options) {
  const Stopwatch watch;
  CheckUsage(options);
  std::vector<Query> queries;
  queries.reserve(options.templates.size());
  for (const auto& path : options.templates) queries.push_back(LoadQuery(path, options));
  std::vector<SegmentLabel> labels;
  if (!options.labels.empty()) labels = ReadSegmentLabels(options.labels);
  const TakeSource source = SourceOf(options.source, options.common.load);

  std::optional<CurveFile> curves;
  SourceSearchOptions search = SearchOptionsOf(options);
  if (!options.curve.empty()) {
    curves.emplace(options.curve, queries.size(), options.common.overwrite());
    search.on_takes = [&](std::size_t i, std::span<const TakeView> takes) {
      const MotionTemplate& motion_template = queries[i].motion_template;
      curves->Add(motion_template, ThresholdOf(motion_template, options), i, takes);
    };
  }
  const SourceHits found = SearchSource(source, queries, search);
  for (const auto& failure : found.failures) PrintError(failure.error.what());
  if (found.takes == 0) return kCouldNot;
  for (const auto& [file, diagnostics] : found.diagnostics) {
    PrintDiagnostics(options.common, file, diagnostics);
  }
  if (curves && !options.labels.empty()) CheckLabels(labels, curves->files(), options.labels);
  const std::vector<NamedHit> hits = WithNames(found, queries);
  if (curves) curves->Write(hits, labels);
  Show(found, hits, watch.seconds(), options);
  return found.failures.empty() ? kDone : kPartFailed;
}

// What a fuzzy search does not know cannot be asked of it.
void AddFuzzyOptions(CLI::App& command, SearchCommandOptions& options) {
  auto* fuzzy = command.add_flag("--fuzzy", options.fuzzy,
                                 "What the template shows of --features in this order, however "
                                 "long each of it lasts");
  command
      .add_option("--features", options.features,
                  "Features that count in a fuzzy search: F20,lknee bent; or a group: lower")
      ->needs(fuzzy)
      ->type_name("NAMES");
  command
      .add_option("--faults", options.faults,
                  "How much may be amiss in a fuzzy search: parts left out, or others between")
      ->needs(fuzzy)
      ->check(WholeNumber(0, kMostFaults))
      ->capture_default_str()
      ->type_name("N");
  for (const char* other :
       {"--tau", "--confidence", "--keyframes", "--curve", "--method", "--profile"}) {
    fuzzy->excludes(command.get_option(other));
  }
}

}  // namespace

void AddSearchCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<SearchCommandOptions>();
  CLI::App* command =
      program.add_subcommand("search", "Find every place where a motion class happens");
  command
      ->add_option("TEMPLATE", options->templates,
                   "Template files, from learn, or names of those in the library")
      ->required();
  auto* library = AddSourceOptions(*command, options->source, "search");
  command->get_option("--memory")->needs(library);
  command
      ->add_option("--tau", options->tau,
                   "Largest cost of a hit (default: the template's own, else 0.06); 1 lists all")
      ->check(NonNegativeNumber())
      ->type_name("COST");
  AddConfidenceOption(*command, options->confidence)->excludes("--tau");
  command->add_option("--top", options->most_hits, "Hits at most")
      ->check(WholeNumber(0))
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--mirror", options->mirror,
                    "Look for the motion with left and right exchanged");
  command
      ->add_option("--keyframes", options->keyframes,
                   "Search only where keyframes are shown, which may miss hits: auto (the "
                   "template's own, else chosen), or those of another template file")
      ->capture_default_str()
      ->type_name("none|auto|FILE");
  command
      ->add_option("--curve", options->curve,
                   "Also write the cost of the best match that ends at each column: a table of "
                   "one template (CSV), or a picture of all in .svg or .png")
      ->type_name("FILE");
  command
      ->add_option("--labels", options->labels,
                   "What is true, drawn below the curves (CSV: file,class,first_frame,last_frame)")
      ->type_name("FILE");
  AddMethodOption(*command, options->method);
  AddProfileOption(*command, options->profile, "Matching by another profile than the template's");
  AddFuzzyOptions(*command, *options);
  AddFeatureSetOption(*command, options->feature_set);
  AddOutputOptions(*command, options->common);
  command
      ->add_option("--format", options->format,
                   "A table for people; json; or csv, with a column to mark hits right or wrong in "
                   "for learn --update")
      ->check(OneOf({"text", "csv", "json"}))
      ->type_name("text|csv|json");
  AddThreadsOption(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  for (const char* reading : {"--skeleton", "--source-rate", "--strict", "--asf-length",
                              "--source-up", "--source-units", "--names", "--marker-set"}) {
    library->excludes(command->get_option(reading));  // Its files have been read.
  }
  command->footer(
      "Examples:\n"
      "  kinebase search squat.template.json --in recordings/ --tau 0.04\n"
      "  kinebase search squat.template.json --library motion.kinebase --actors bd\n"
      "  kinebase search squat.template.json --in recordings/ --fuzzy --features \"rknee "
      "bent,lknee "
      "bent\"");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
