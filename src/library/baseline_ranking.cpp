// The methods that templates are compared with, as docs/design/baselines.md describes them.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "kinebase/core/parallel.h"
#include "kinebase/search/example_search.h"
#include "kinebase/search/fuzzy_search.h"
#include "kinebase/search/keyframe_index.h"
#include "kinebase/templates/keyframes.h"
#include "library/class_ranking.h"

namespace kinebase {
namespace internal {

double UsualDelta(std::span<const DeltaCurve> curves) {
  std::vector<double> deltas;
  for (const DeltaCurve& curve : curves) {
    std::ranges::copy_if(curve.delta, std::back_inserter(deltas),
                         [](double delta) { return std::isfinite(delta); });
  }
  return Median(std::move(deltas)).value_or(0);
}

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::max();
constexpr std::size_t kAllHits = std::numeric_limits<std::size_t>::max();

std::vector<RankedHit> AsRanked(std::vector<Hit> hits) {
  std::vector<RankedHit> ranked;
  ranked.reserve(hits.size());
  for (const Hit& hit : BestHits(std::move(hits), kAllHits)) {
    ranked.push_back({.hit = hit, .matching = hit.cost, .score = hit.cost});
  }
  return ranked;
}

// curve_of  Δ in a recording of the stream, by its index.
template <typename CurveOf>
ClassRanking RankByCurves(std::string class_name, std::string example, const BaselineInput& input,
                          const CurveOf& curve_of) {
  std::vector<DeltaCurve> curves(input.stream.size());
  ParallelFor(curves.size(), input.threads, "searching", {},
              [&](std::size_t i) { curves[i] = curve_of(*input.stream[i]); });
  std::vector<Hit> hits;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::vector<Hit> some = ExtractHits(curves[i], kNoLimit, static_cast<int>(i));
    hits.insert(hits.end(), some.begin(), some.end());
  }
  return {.class_name = std::move(class_name),
          .example = std::move(example),
          .hits = AsRanked(std::move(hits)),
          .usual_delta = UsualDelta(curves)};
}

// Of each class and actor the clip of median length; of equally long ones the order of the list
// decides.
std::vector<const LabelledClip*> ChooseExamples(std::span<const LabelledClip* const> clips) {
  std::map<std::pair<std::string, std::string>, std::vector<const LabelledClip*>> performed;
  for (const LabelledClip* clip : clips) {
    performed[{clip->class_name, clip->actor}].push_back(clip);
  }
  std::vector<const LabelledClip*> examples;
  examples.reserve(performed.size());
  for (auto& [of, takes] : performed) {
    std::ranges::stable_sort(
        takes, {}, [](const LabelledClip* clip) { return clip->take.features.column_count(); });
    examples.push_back(takes[takes.size() / 2]);
  }
  return examples;
}

// part  What of a take is compared.
template <typename Part>
std::vector<ClassRanking> RankByExamples(const BaselineInput& input, Part TakeFeatures::*part) {
  std::vector<ClassRanking> rankings;
  for (const LabelledClip* example : ChooseExamples(input.train)) {
    rankings.push_back(RankByCurves(
        example->class_name, example->take.path.string(), input, [&](const TakeFeatures& take) {
          return ComputeExampleDelta(example->take.*part, take.*part, input.matching);
        }));
  }
  return rankings;
}

std::vector<ClassRanking> RankUnquantized(const BaselineInput& input) {
  std::vector<ClassRanking> rankings;
  for (const MotionTemplate& each : input.learned) {
    rankings.push_back(RankByCurves(each.name, "", input, [&](const TakeFeatures& take) {
      return ComputeUnquantizedDelta(each.matrix, take.features, input.matching);
    }));
  }
  return rankings;
}

std::vector<FeatureMatrix> FeaturesOf(std::span<const TakeFeatures* const> takes) {
  std::vector<FeatureMatrix> features;
  features.reserve(takes.size());
  for (const TakeFeatures* take : takes) features.push_back(take->features);
  return features;
}

std::vector<ClassRanking> RankByKeyframes(const BaselineInput& input) {
  const std::vector<FeatureMatrix> stream = FeaturesOf(input.stream);
  const KeyframeIndex index(stream, input.features.Groups());
  const SearchOptions everything{
      .tau = kNoLimit, .most_hits = kAllHits, .threads = input.threads, .progress = {}};
  std::vector<ClassRanking> rankings;
  for (MotionTemplate each : input.learned) {
    each.contrast.reset();
    const std::vector<Keyframe> keyframes = ChooseKeyframes(each, input.features);
    const QuantizedTemplate quantized = Quantize(each);
    std::vector<Hit> hits;
    if (keyframes.empty()) {
      hits = SearchTemplate(quantized, stream, everything);
    } else {
      hits = SearchTemplate(quantized, stream, index.Preselect(keyframes, quantized.column_count()),
                            everything);
    }
    rankings.push_back({.class_name = each.name, .example = {}, .hits = AsRanked(std::move(hits))});
  }
  return rankings;
}

// How a class is looked for by features of a group.
struct FuzzyChoice {
  FuzzyQuery query;
  int faults = 0;
  double f1 = -1;  // In the training clips.
};

double FuzzyF1(std::span<const Hit> hits, std::span<const LabelledClip* const> clips,
               const std::string& class_name) {
  std::vector<KnownHit> known =
      JudgeAgainstClips(AsRanked({hits.begin(), hits.end()}), class_name, clips);
  const auto right = static_cast<double>(std::ranges::count(known, true, &KnownHit::right));
  const auto relevant =
      static_cast<double>(std::ranges::count(clips, class_name, &LabelledClip::class_name));
  return 2 * right / (static_cast<double>(known.size()) + relevant);
}

// The group of features and the number of faults, at most half the query's elements, that find the
// training clips best. Of equal ones the first group, and the fewest faults.
std::optional<FuzzyChoice> ChooseFuzzy(const MotionTemplate& motion_template,
                                       std::span<const FeatureMatrix> recordings,
                                       const BaselineInput& input) {
  const QuantizedTemplate quantized = Quantize(motion_template);
  std::optional<FuzzyChoice> best;
  for (const FeatureGroup& group : input.features.Groups()) {
    const bool is_free = std::ranges::none_of(quantized.columns, [&](const QuantizedColumn& each) {
      return (each.consistent & group.features) != 0;
    });
    if (is_free) continue;
    const FuzzyQuery query = MakeFuzzyQuery(quantized, group.features);
    const int most = static_cast<int>(query.elements.size()) / 2;
    for (int faults = 0; faults <= most && faults < std::ssize(query.elements); ++faults) {
      const std::vector<Hit> hits =
          SearchFuzzy(query, recordings, {.faults = faults, .most_hits = kAllHits});
      const double f1 = FuzzyF1(hits, input.train, motion_template.name);
      if (!best || f1 > best->f1) best = {query, faults, f1};
    }
  }
  return best;
}

std::vector<ClassRanking> RankFuzzily(const BaselineInput& input) {
  const std::vector<FeatureMatrix> stream = FeaturesOf(input.stream);
  std::vector<const TakeFeatures*> train;
  train.reserve(input.train.size());
  for (const LabelledClip* clip : input.train) train.push_back(&clip->take);
  const std::vector<FeatureMatrix> train_features = FeaturesOf(train);
  std::vector<ClassRanking> rankings;
  for (MotionTemplate each : input.learned) {
    each.contrast.reset();
    ClassRanking& ranking =
        rankings.emplace_back(ClassRanking{.class_name = each.name, .example = {}, .hits = {}});
    const std::optional<FuzzyChoice> choice = ChooseFuzzy(each, train_features, input);
    if (!choice) continue;  // Nothing is consistent: nothing is found.
    ranking.hits = AsRanked(
        SearchFuzzy(choice->query, stream, {.faults = choice->faults, .most_hits = kAllHits}));
    ranking.tau =
        static_cast<double>(choice->faults) / static_cast<double>(choice->query.elements.size());
  }
  return rankings;
}

}  // namespace

std::vector<ClassRanking> RankByBaseline(const Baseline& baseline, const BaselineInput& input) {
  switch (baseline.kind) {
    case BaselineKind::kUnquantized:
      return RankUnquantized(input);
    case BaselineKind::kFeatures:
      return RankByExamples(input, &TakeFeatures::features);
    case BaselineKind::kPositions:
      return RankByExamples(input, &TakeFeatures::positions);
    case BaselineKind::kRotations:
      return RankByExamples(input, &TakeFeatures::rotations);
    case BaselineKind::kFuzzy:
      return RankFuzzily(input);
    case BaselineKind::kKeyframes:
      return RankByKeyframes(input);
  }
  return {};
}

}  // namespace internal

namespace {

constexpr std::array kBaselines = {
    Baseline{.name = "mt-unquantized", .kind = BaselineKind::kUnquantized},
    Baseline{.name = "keyframes", .kind = BaselineKind::kKeyframes},
    Baseline{.name = "fuzzy", .kind = BaselineKind::kFuzzy},
    Baseline{.name = "rf", .kind = BaselineKind::kFeatures},
    Baseline{.name = "3d", .kind = BaselineKind::kPositions},
    Baseline{.name = "q", .kind = BaselineKind::kRotations},
};

}  // namespace

std::span<const Baseline> Baselines() { return kBaselines; }

const Baseline* FindBaseline(std::string_view name) {
  const auto* const found = std::ranges::find(kBaselines, name, &Baseline::name);
  return found == kBaselines.end() ? nullptr : found;
}

TakeParts PartsFor(std::span<const Baseline> baselines) {
  const auto asks_for = [&](BaselineKind kind) {
    return std::ranges::find(baselines, kind, &Baseline::kind) != baselines.end();
  };
  return {.poses = true,
          .rotations = asks_for(BaselineKind::kRotations),
          .positions = asks_for(BaselineKind::kPositions)};
}

}  // namespace kinebase
