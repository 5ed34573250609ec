#include "kinebase/library/take_search.h"

#include <limits>

#include "kinebase/templates/calibration.h"
#include "library/take_frames.h"

namespace kinebase {
namespace {

std::vector<FeatureView> FeaturesOf(std::span<const TakeView> takes) {
  std::vector<FeatureView> recordings;
  recordings.reserve(takes.size());
  for (const TakeView& take : takes) recordings.push_back(take.features);
  return recordings;
}

std::vector<TakeHit> ToTakeHits(std::span<const Hit> hits, std::span<const TakeView> takes) {
  std::vector<TakeHit> take_hits;
  take_hits.reserve(hits.size());
  for (const Hit& hit : hits) {
    const auto index = static_cast<std::size_t>(hit.recording);
    take_hits.push_back(internal::ToTakeHit(hit, takes[index], index));
  }
  return take_hits;
}

}  // namespace

std::vector<TakeHit> SearchTakes(const QuantizedTemplate& motion_template,
                                 std::span<const TakeView> takes, const SearchOptions& options) {
  return ToTakeHits(SearchTemplate(motion_template, FeaturesOf(takes), options), takes);
}

std::vector<TakeHit> SearchTakes(const QuantizedTemplate& motion_template,
                                 std::span<const TakeView> takes,
                                 std::span<const Stretch> stretches, const SearchOptions& options) {
  return ToTakeHits(SearchTemplate(motion_template, FeaturesOf(takes), stretches, options), takes);
}

std::vector<TakeHit> SearchTakes(const FuzzyQuery& query, std::span<const TakeView> takes,
                                 const FuzzyOptions& options) {
  return ToTakeHits(SearchFuzzy(query, FeaturesOf(takes), options), takes);
}

std::vector<double> CostCurve(const MotionTemplate& motion_template, const TakeView& take) {
  const RecordingStreams recording{.features = take.features, .poses = take.poses};
  const auto ranked = RankHits(std::span(&motion_template, 1), std::span(&recording, 1),
                               {.rivals = false,
                                .every_end = true,
                                .most_hits = std::numeric_limits<std::size_t>::max(),
                                .threads = 1});
  std::vector<double> cost(take.features.columns.size(), std::numeric_limits<double>::infinity());
  for (const RankedHit& each : ranked.front()) {
    cost[static_cast<std::size_t>(each.hit.last)] = each.hit.cost;
  }
  return cost;
}

KeyframeIndex IndexTakes(std::span<const TakeView> takes, const FeatureSet& features) {
  return KeyframeIndex(FeaturesOf(takes), features.Groups());
}

std::vector<std::vector<TakeHit>> RankTakes(std::span<const MotionTemplate> templates,
                                            std::span<const TakeView> takes,
                                            const RankTakesOptions& options) {
  std::vector<RecordingStreams> recordings;
  recordings.reserve(takes.size());
  for (const TakeView& take : takes) recordings.push_back({take.features, take.poses});
  const auto ranked = RankHits(templates, recordings,
                               {.most_hits = std::numeric_limits<std::size_t>::max(),
                                .threads = options.threads,
                                .progress = options.progress});
  std::vector<std::vector<TakeHit>> hits(templates.size());
  for (std::size_t t = 0; t < templates.size(); ++t) {
    const double tau = options.tau.value_or(templates[t].tau.value_or(kDefaultTau));
    for (const RankedHit& each : ranked[t]) {
      if (hits[t].size() == options.most_hits) break;
      if (each.hit.cost > tau) continue;
      const auto index = static_cast<std::size_t>(each.hit.recording);
      TakeHit& hit = hits[t].emplace_back(internal::ToTakeHit(each.hit, takes[index], index));
      hit.score = each.score;
      const std::optional<Calibration>& calibration = templates[t].calibration;
      if (calibration) hit.confidence = Confidence(*calibration, hit.cost);
    }
  }
  return hits;
}

}  // namespace kinebase
