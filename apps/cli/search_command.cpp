// kinebase search: every place where a motion class happens.

#include <map>
#include <memory>
#include <set>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/feature_options.h"
#include "cli/search_curve.h"
#include "cli/search_output.h"
#include "cli/take_filter.h"
#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/features/vocabulary.h"
#include "kinebase/library/library_templates.h"
#include "kinebase/library/take_library.h"
#include "kinebase/library/take_search.h"
#include "kinebase/library/takes.h"
#include "kinebase/templates/calibration.h"
#include "kinebase/templates/keyframes.h"
#include "kinebase/templates/quantized_template.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

struct SearchCommandOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> templates;
  std::vector<std::filesystem::path> paths;
  std::filesystem::path library;  // Instead of paths.
  TakeFilter filter;
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
  if (options.paths.empty() && options.library.empty()) {
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

// A template that is ready to be searched for.
struct Query {
  MotionTemplate motion_template;
  FeatureSet features;
  std::optional<FuzzyQuery> fuzzy;
};

// Recordings with the features of one set at one rate, and where they show what: made when the
// first template with keyframes asks for it.
struct SearchedTakes {
  TakeBatch batch;
  std::optional<KeyframeIndex> index;
};

// How much of the recordings was looked at, in columns of all templates.
struct Coverage {
  std::int64_t searched = 0;
  std::int64_t all = 0;

  [[nodiscard]] double share() const {
    return all == 0 ? 1 : static_cast<double>(searched) / static_cast<double>(all);
  }
};

// The recordings with the features of one set at one rate; templates that agree in both share them.
using FeatureKey = std::pair<std::uint64_t, double>;

FeatureKey KeyOf(const Query& query) {
  return {query.features.hash, query.motion_template.matrix.rate_hz};
}

// Those of another template file, made for the same template.
std::vector<Keyframe> KeyframesOfFile(const std::filesystem::path& path,
                                      const MotionTemplate& motion_template) {
  const MotionTemplate source = ReadTemplate(path);
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
    keyframes = KeyframesOfFile(options.keyframes, query.motion_template);
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
  Query query{.motion_template = ReadOrLoadTemplate(path, options.library)};
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

std::vector<TakeHit> SearchIn(const Query& query, SearchedTakes& takes, const SearchOptions& search,
                              Coverage& coverage) {
  const MotionTemplate& motion_template = query.motion_template;
  const std::vector<TakeFeatures>& all = takes.batch.takes;
  std::int64_t columns = 0;
  for (const TakeFeatures& take : all) columns += take.features.column_count();
  coverage.all += columns;
  if (motion_template.keyframes.empty()) {
    coverage.searched += columns;
    return SearchTakes(Quantize(motion_template), all, search);
  }
  if (!takes.index) takes.index = IndexTakes(all, query.features);
  const std::vector<Stretch> stretches =
      takes.index->Preselect(motion_template.keyframes, motion_template.matrix.column_count());
  coverage.searched += CountColumns(stretches);
  return SearchTakes(Quantize(motion_template), all, stretches, search);
}

std::vector<TakeHit> SearchFuzzilyIn(const Query& query, const SearchedTakes& takes,
                                     const SearchCommandOptions& options, Coverage& coverage) {
  for (const TakeFeatures& take : takes.batch.takes) coverage.all += take.features.column_count();
  coverage.searched = coverage.all;
  return SearchTakes(*query.fuzzy, takes.batch.takes,
                     {.faults = options.faults, .most_hits = options.most_hits});
}

double ThresholdOf(const MotionTemplate& motion_template, const SearchCommandOptions& options) {
  return options.tau.value_or(motion_template.tau.value_or(kDefaultTau));
}

std::vector<NamedHit> SearchOne(std::span<const Query> queries, std::size_t index,
                                SearchedTakes& takes, const SearchCommandOptions& options,
                                const ProgressCallback& progress, Coverage& coverage) {
  const Query& query = queries[index];
  const SearchOptions search{.tau = ThresholdOf(query.motion_template, options),
                             .most_hits = options.most_hits,
                             .threads = options.common.threads,
                             .progress = progress};
  std::vector<NamedHit> hits;
  for (const TakeHit& hit : query.fuzzy ? SearchFuzzilyIn(query, takes, options, coverage)
                                        : SearchIn(query, takes, search, coverage)) {
    hits.push_back({index, query.motion_template.name, takes.batch.takes[hit.take].path, hit});
  }
  return hits;
}

// Templates that know what sets their class off are searched together, as they are rivals.
std::vector<NamedHit> SearchTogether(std::span<const Query> queries,
                                     std::span<const std::size_t> indices, const TakeBatch& batch,
                                     const SearchCommandOptions& options,
                                     const ProgressCallback& progress) {
  std::vector<MotionTemplate> templates;
  for (const std::size_t index : indices) templates.push_back(queries[index].motion_template);
  const auto found = RankTakes(templates, batch.takes,
                               {.tau = options.tau,
                                .most_hits = options.most_hits,
                                .threads = options.common.threads,
                                .progress = progress});
  std::vector<NamedHit> hits;
  for (std::size_t t = 0; t < templates.size(); ++t) {
    for (const TakeHit& hit : found[t]) {
      hits.push_back({indices[t], templates[t].name, batch.takes[hit.take].path, hit});
    }
  }
  return hits;
}

void Show(const std::vector<NamedHit>& hits, const TakeBatch& batch, const Coverage& coverage,
          double elapsed_s, const SearchCommandOptions& options) {
  std::int64_t frames = 0;
  for (const TakeFeatures& take : batch.takes) frames += take.frame_count;
  if (options.Format() == "json") {
    Json json = HitsToJson(hits, batch.failures, frames, elapsed_s);
    if (options.keyframes != "none") json["searched_share"] = coverage.share();
    PrintJson(json);
    return;
  }
  if (options.Format() == "csv") {
    Print(HitsToCsv(hits));
  } else if (!hits.empty()) {
    Print(HitsToText(hits, options.templates.size() > 1));
  }
  PrintNote(
      options.common,
      fmt::format("{} in {} frames of {}, {:.2f} s", FormatCount(std::ssize(hits), "hit", "hits"),
                  frames, FormatCount(std::ssize(batch.takes), "recording", "recordings"),
                  elapsed_s));
  if (coverage.searched < coverage.all) {
    PrintNote(options.common,
              fmt::format("keyframes left {:.1f} % of the columns to search; motion that does not "
                          "show them is missed (--keyframes none searches everything)",
                          100 * coverage.share()));
  }
}

void WriteCurve(std::span<const Query> queries, const std::map<FeatureKey, SearchedTakes>& batches,
                const std::vector<NamedHit>& hits, std::span<const SegmentLabel> labels,
                const SearchCommandOptions& options) {
  std::vector<SearchedTemplate> searched;
  for (const Query& query : queries) {
    const MotionTemplate& motion_template = query.motion_template;
    searched.push_back({&motion_template,
                        &batches.at(KeyOf(query)).batch,
                        ThresholdOf(motion_template, options),
                        {}});
  }
  for (const NamedHit& named : hits) searched[named.query].hits.push_back(named.hit);
  if (IsPicture(options.curve)) {
    DrawCurves(searched, labels, options.curve, options.common.overwrite());
  } else {
    WriteFile(options.curve, CurveTable(*searched.front().motion_template, *searched.front().batch),
              options.common.overwrite());
  }
}

// Where takes come from: files that are read anew, or a library that has their features.
class TakeSource {
 public:
  explicit TakeSource(const SearchCommandOptions& options) : options_(options) {
    if (!options.library.empty()) {
      library_.emplace(options.library);
      return;
    }
    for (auto& file : FindMotionFiles(options.paths)) {
      stretches_.push_back({.file = std::move(file)});
    }
  }

  [[nodiscard]] TakeBatch Load(const FeatureSet& features, double rate_hz, bool with_poses,
                               const ProgressCallback& progress) const {
    if (library_) return library_->Load(features, rate_hz, options_.filter, with_poses);
    return LoadManyTakeFeatures(stretches_, features, rate_hz, options_.common.load,
                                options_.common.threads, progress, {.poses = with_poses});
  }

 private:
  const SearchCommandOptions& options_;
  std::optional<TakeLibrary> library_;
  std::vector<TakeStretch> stretches_;
};

int Run(const SearchCommandOptions& options) {
  const Stopwatch watch;
  CheckUsage(options);
  std::vector<Query> queries;
  queries.reserve(options.templates.size());
  for (const auto& path : options.templates) queries.push_back(LoadQuery(path, options));
  std::vector<SegmentLabel> labels;
  if (!options.labels.empty()) labels = ReadSegmentLabels(options.labels);
  const TakeSource source(options);

  const ProgressCallback progress = MakeProgress(options.common);
  std::map<FeatureKey, SearchedTakes> batches;
  std::map<FeatureKey, std::vector<std::size_t>> together;  // Indices of queries.
  Coverage coverage;
  std::vector<NamedHit> hits;
  const auto append = [&hits](std::vector<NamedHit> found) {
    hits.insert(hits.end(), std::make_move_iterator(found.begin()),
                std::make_move_iterator(found.end()));
  };
  const bool with_poses = std::ranges::any_of(
      queries, [](const Query& query) { return query.motion_template.contrast.has_value(); });
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const Query& query = queries[i];
    const FeatureKey key = KeyOf(query);
    const auto [entry, is_new] = batches.try_emplace(key);
    SearchedTakes& takes = entry->second;
    if (is_new) {
      takes.batch = source.Load(query.features, key.second, with_poses, progress);
    }
    if (query.motion_template.contrast) {
      together[key].push_back(i);
    } else {
      append(SearchOne(queries, i, takes, options, progress, coverage));
    }
  }
  for (const auto& [key, indices] : together) {
    append(SearchTogether(queries, indices, batches.at(key).batch, options, progress));
  }
  std::ranges::stable_sort(hits, {}, [](const NamedHit& named) { return named.hit.score; });
  if (hits.size() > options.most_hits) hits.resize(options.most_hits);

  const TakeBatch& batch = batches.begin()->second.batch;  // All read the same files.
  for (const auto& failure : batch.failures) PrintError(failure.error.what());
  if (batch.takes.empty()) return kCouldNot;
  for (const TakeFeatures& take : batch.takes) {
    PrintDiagnostics(options.common, take.path, take.diagnostics);
  }
  if (!options.labels.empty()) CheckLabels(labels, batch, options.labels);
  if (!options.curve.empty()) WriteCurve(queries, batches, hits, labels, options);
  Show(hits, batch, coverage, watch.seconds(), options);
  return batch.failures.empty() ? kDone : kPartFailed;
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
  command->add_option("TEMPLATE", options->templates, "Template files, from learn")->required();
  auto* paths = command->add_option("--in", options->paths, "Motion files and folders to search")
                    ->type_name("PATH");
  auto* library = command
                      ->add_option("--library", options->library,
                                   "Library to search instead, from kinebase import")
                      ->excludes(paths)
                      ->type_name("FOLDER");
  for (CLI::Option* filter : AddTakeFilterOptions(*command, options->filter)) {
    filter->needs(library);
  }
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
