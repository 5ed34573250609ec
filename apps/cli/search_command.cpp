// kinebase search: every place where a motion class happens.

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>

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
#include "kinebase/library/take_search.h"
#include "kinebase/library/take_source.h"
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
  std::uint64_t memory_bytes = kDefaultMemoryBytes;
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

double ThresholdOf(const MotionTemplate& motion_template, const SearchCommandOptions& options) {
  return options.tau.value_or(motion_template.tau.value_or(kDefaultTau));
}

// The queries that share the features of one set at one rate, by index; those with keyframes of
// their own, and those that know what sets their class off: rivals are searched together.
struct QueryGroup {
  FeatureKey key;
  std::vector<std::size_t> queries;
  std::vector<std::size_t> preselected;
  std::vector<std::size_t> rivals;
};

std::vector<QueryGroup> GroupQueries(std::span<const Query> queries) {
  std::map<FeatureKey, QueryGroup> groups;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    QueryGroup& group = groups[KeyOf(queries[i])];
    group.key = KeyOf(queries[i]);
    group.queries.push_back(i);
    if (queries[i].motion_template.contrast) {
      group.rivals.push_back(i);
    } else if (!queries[i].motion_template.keyframes.empty() && !queries[i].fuzzy) {
      group.preselected.push_back(i);
    }
  }
  std::vector<QueryGroup> all;
  all.reserve(groups.size());
  for (auto& [key, group] : groups) all.push_back(std::move(group));
  return all;
}

// What is known of the takes once they have been searched.
struct SearchedTakes {
  std::size_t takes = 0;
  std::int64_t frames = 0;
  std::vector<std::filesystem::path> files;  // Where labels are to be compared with.
  std::vector<std::pair<std::filesystem::path, Diagnostics>> diagnostics;
  std::vector<TakeFailure> failures;
};

// All queries over all takes, some of these at a time.
class Search {
 public:
  Search(std::span<const Query> queries, const SearchCommandOptions& options)
      : queries_(queries),
        options_(options),
        groups_(GroupQueries(queries)),
        progress_(MakeProgress(options.common)),
        curves_(options.curve, queries.size()),
        best_(queries.size()) {}

  void Run(const TakeSource& source) {
    for (const QueryGroup& group : groups_) {
      TakeRequest request{.features = &queries_[group.queries.front()].features,
                          .rate_hz = group.key.second,
                          .with_poses = !group.rivals.empty(),
                          .threads = options_.common.threads,
                          .progress = progress_};
      for (const std::size_t i : group.preselected) {
        const MotionTemplate& each = queries_[i].motion_template;
        request.keyframes.push_back({each.keyframes, each.matrix.column_count()});
      }
      request.only_preselected =
          group.preselected.size() == group.queries.size() && options_.curve.empty();
      const bool is_first = &group == &groups_.front();  // All read the same files.
      auto failures = source.Visit(request, [&](const TakesAtHand& at_hand) {
        if (is_first) Remember(at_hand);
        SearchGroup(group, at_hand);
      });
      if (is_first) takes_.failures = std::move(failures);
    }
  }

  // The best of all, those of rivals behind the others where they score the same.
  [[nodiscard]] std::vector<NamedHit> Best() {
    std::vector<std::size_t> order(queries_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) {
      const Query& query = queries_[i];
      return query.motion_template.contrast ? std::optional(KeyOf(query)) : std::nullopt;
    });
    std::vector<NamedHit> hits;
    for (const std::size_t i : order) std::ranges::move(best_[i], std::back_inserter(hits));
    KeepBest(hits);
    return hits;
  }

  [[nodiscard]] const SearchedTakes& takes() const { return takes_; }
  [[nodiscard]] const Coverage& coverage() const { return coverage_; }
  [[nodiscard]] CurveFile& curves() { return curves_; }

 private:
  void Remember(const TakesAtHand& at_hand) {
    takes_.takes += at_hand.takes.size();
    for (const TakeView& take : at_hand.takes) {
      takes_.frames += take.frame_count;
      if (!options_.labels.empty()) takes_.files.push_back(*take.path);
      if (take.diagnostics != nullptr && !take.diagnostics->empty()) {
        takes_.diagnostics.emplace_back(*take.path, *take.diagnostics);
      }
    }
  }

  void SearchGroup(const QueryGroup& group, const TakesAtHand& at_hand) {
    for (const std::size_t i : group.queries) {
      if (!options_.curve.empty()) {
        curves_.Add(queries_[i].motion_template, ThresholdOf(queries_[i].motion_template, options_),
                    i, at_hand.takes);
      }
      if (queries_[i].motion_template.contrast) continue;
      const auto place = std::ranges::find(group.preselected, i);
      const bool is_preselected = place != group.preselected.end();
      Keep(i, at_hand,
           is_preselected
               ? SearchStretches(i, at_hand, at_hand.stretches[place - group.preselected.begin()])
               : SearchAll(i, at_hand));
    }
    if (group.rivals.empty()) return;
    std::vector<MotionTemplate> templates;
    templates.reserve(group.rivals.size());
    for (const std::size_t i : group.rivals) templates.push_back(queries_[i].motion_template);
    const auto found = RankTakes(templates, at_hand.takes,
                                 {.tau = options_.tau,
                                  .most_hits = options_.most_hits,
                                  .threads = options_.common.threads,
                                  .progress = ProgressOfSearch()});
    for (std::size_t t = 0; t < found.size(); ++t) Keep(group.rivals[t], at_hand, found[t]);
  }

  std::vector<TakeHit> SearchAll(std::size_t i, const TakesAtHand& at_hand) {
    coverage_.all += at_hand.columns;
    coverage_.searched += at_hand.columns;
    if (queries_[i].fuzzy) {
      return SearchTakes(*queries_[i].fuzzy, at_hand.takes,
                         {.faults = options_.faults, .most_hits = options_.most_hits});
    }
    return SearchTakes(Quantize(queries_[i].motion_template), at_hand.takes, OptionsOf(i));
  }

  std::vector<TakeHit> SearchStretches(std::size_t i, const TakesAtHand& at_hand,
                                       std::span<const Stretch> stretches) {
    coverage_.all += at_hand.columns;
    coverage_.searched += CountColumns(stretches);
    return SearchTakes(Quantize(queries_[i].motion_template), at_hand.takes, stretches,
                       OptionsOf(i));
  }

  [[nodiscard]] SearchOptions OptionsOf(std::size_t i) const {
    return {.tau = ThresholdOf(queries_[i].motion_template, options_),
            .most_hits = options_.most_hits,
            .threads = options_.common.threads,
            .progress = ProgressOfSearch()};
  }

  // A library's takes are counted as they come.
  [[nodiscard]] ProgressCallback ProgressOfSearch() const {
    return options_.library.empty() ? progress_ : ProgressCallback();
  }

  void Keep(std::size_t i, const TakesAtHand& at_hand, const std::vector<TakeHit>& found) {
    for (const TakeHit& hit : found) {
      best_[i].push_back({i, queries_[i].motion_template.name, *at_hand.takes[hit.take].path, hit});
    }
    KeepBest(best_[i]);
  }

  // By score; of equals those that came first.
  void KeepBest(std::vector<NamedHit>& hits) const {
    std::ranges::stable_sort(hits, {}, [](const NamedHit& named) { return named.hit.score; });
    if (hits.size() > options_.most_hits) hits.resize(options_.most_hits);
  }

  std::span<const Query> queries_;
  const SearchCommandOptions& options_;
  std::vector<QueryGroup> groups_;
  ProgressCallback progress_;
  CurveFile curves_;
  std::vector<std::vector<NamedHit>> best_;  // [query]
  SearchedTakes takes_;
  Coverage coverage_;
};

void Show(const std::vector<NamedHit>& hits, const SearchedTakes& takes, const Coverage& coverage,
          double elapsed_s, const SearchCommandOptions& options) {
  if (options.Format() == "json") {
    Json json = HitsToJson(hits, takes.failures, takes.frames, elapsed_s);
    if (options.keyframes != "none") json["searched_share"] = coverage.share();
    PrintJson(json);
    return;
  }
  if (options.Format() == "csv") {
    Print(HitsToCsv(hits));
  } else if (!hits.empty()) {
    Print(HitsToText(hits, options.templates.size() > 1));
  }
  PrintNote(options.common, fmt::format("{} in {} frames of {}, {:.2f} s",
                                        FormatCount(std::ssize(hits), "hit", "hits"), takes.frames,
                                        FormatCount(static_cast<std::int64_t>(takes.takes),
                                                    "recording", "recordings"),
                                        elapsed_s));
  if (coverage.searched < coverage.all) {
    PrintNote(options.common,
              fmt::format("keyframes left {:.1f} % of the columns to search; motion that does not "
                          "show them is missed (--keyframes none searches everything)",
                          100 * coverage.share()));
  }
}

TakeSource SourceOf(const SearchCommandOptions& options) {
  if (!options.library.empty()) {
    return {options.library, options.filter, static_cast<std::int64_t>(options.memory_bytes)};
  }
  std::vector<TakeStretch> stretches;
  for (auto& file : FindMotionFiles(options.paths)) stretches.push_back({.file = std::move(file)});
  return {std::move(stretches), options.common.load};
}

int Run(const SearchCommandOptions& options) {
  const Stopwatch watch;
  CheckUsage(options);
  std::vector<Query> queries;
  queries.reserve(options.templates.size());
  for (const auto& path : options.templates) queries.push_back(LoadQuery(path, options));
  std::vector<SegmentLabel> labels;
  if (!options.labels.empty()) labels = ReadSegmentLabels(options.labels);
  const TakeSource source = SourceOf(options);

  Search search(queries, options);
  search.Run(source);
  const std::vector<NamedHit> hits = search.Best();
  const SearchedTakes& takes = search.takes();
  for (const auto& failure : takes.failures) PrintError(failure.error.what());
  if (takes.takes == 0) return kCouldNot;
  for (const auto& [file, diagnostics] : takes.diagnostics) {
    PrintDiagnostics(options.common, file, diagnostics);
  }
  if (!options.labels.empty()) CheckLabels(labels, takes.files, options.labels);
  if (!options.curve.empty()) search.curves().Write(hits, labels, options.common.overwrite());
  Show(hits, takes, search.coverage(), watch.seconds(), options);
  return takes.failures.empty() ? kDone : kPartFailed;
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
  AddMemoryOption(*command, options->memory_bytes)->needs(library);
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
