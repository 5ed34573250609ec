#include "kinebase/library/take_search.h"

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

}  // namespace kinebase
