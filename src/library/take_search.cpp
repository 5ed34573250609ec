#include "kinebase/library/take_search.h"

#include <limits>

#include "kinebase/templates/calibration.h"
#include "library/take_frames.h"

namespace kinebase {

std::vector<TakeHit> SearchTakes(const QuantizedTemplate& motion_template,
                                 std::span<const TakeFeatures> takes,
                                 const SearchOptions& options) {
  std::vector<FeatureMatrix> recordings;  // A word a column: little beside the scan itself.
  recordings.reserve(takes.size());
  for (const TakeFeatures& take : takes) recordings.push_back(take.features);
  std::vector<TakeHit> hits;
  for (const Hit& hit : SearchTemplate(motion_template, recordings, options)) {
    const auto index = static_cast<std::size_t>(hit.recording);
    hits.push_back(internal::ToTakeHit(hit, takes[index], index));
  }
  return hits;
}

std::vector<std::vector<TakeHit>> RankTakes(std::span<const MotionTemplate> templates,
                                            std::span<const TakeFeatures> takes,
                                            const RankTakesOptions& options) {
  std::vector<RecordingStreams> recordings;
  recordings.reserve(takes.size());
  for (const TakeFeatures& take : takes) recordings.push_back({&take.features, &take.poses});
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
