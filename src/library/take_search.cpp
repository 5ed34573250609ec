#include "kinebase/library/take_search.h"

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
    const TakeFeatures& take = takes[index];
    const FrameRange frames =
        FramesOfColumns(hit.first, hit.last, take.features.rate_hz, take.rate_hz, take.frame_count);
    hits.push_back({.take = index,
                    .first_frame = frames.first + 1,
                    .last_frame = frames.last + 1,
                    .start_s = static_cast<double>(frames.first) / take.rate_hz,
                    .end_s = static_cast<double>(frames.last + 1) / take.rate_hz,
                    .cost = hit.cost});
  }
  return hits;
}

}  // namespace kinebase
