#include "kinebase/motion/marker_cloud.h"

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "motion/sampling.h"

namespace kinebase {

std::optional<int> MarkerCloud::FindMarker(std::string_view name) const {
  for (int i = 0; i < marker_count(); ++i) {
    const std::string& label = labels[static_cast<std::size_t>(i)];
    if (EqualsIgnoringCase(label, name) || EqualsIgnoringCase(BareLabel(label), name)) return i;
  }
  return std::nullopt;
}

std::string_view BareLabel(std::string_view label) {
  return label.substr(label.rfind(':') + 1);  // All of it where there is no colon.
}

MarkerCloud CutMarkers(const MarkerCloud& markers, int first, int last) {
  if (first < 0 || last < first || last >= markers.frame_count) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("cannot cut frames {} to {}: the recording has frames 1 to {}",
                            first + 1, last + 1, markers.frame_count));
  }
  const auto begin = static_cast<std::ptrdiff_t>(markers.Index(first, 0));
  const auto end = static_cast<std::ptrdiff_t>(markers.Index(last + 1, 0));
  MarkerCloud cut{.labels = markers.labels,
                  .rate_hz = markers.rate_hz,
                  .frame_count = last - first + 1,
                  .first_frame = markers.first_frame + first};
  cut.positions_cm.assign(markers.positions_cm.begin() + begin, markers.positions_cm.begin() + end);
  cut.states.assign(markers.states.begin() + begin, markers.states.begin() + end);
  return cut;
}

MarkerCloud ResampleMarkers(const MarkerCloud& markers, double rate_hz) {
  const internal::SampleGrid grid(markers.first_frame, markers.frame_count, markers.rate_hz,
                                  rate_hz);
  MarkerCloud result{.labels = markers.labels,
                     .rate_hz = rate_hz,
                     .frame_count = grid.count(),
                     .first_frame = grid.first_number()};
  result.positions_cm.reserve(result.Index(grid.count(), 0));
  result.states.reserve(result.Index(grid.count(), 0));
  for (int sample = 0; sample < grid.count(); ++sample) {
    const auto place = grid.Place(sample);
    const int after = place.share == 0 ? place.before : place.after;
    for (int marker = 0; marker < markers.marker_count(); ++marker) {
      const Eigen::Vector3d& a = markers.at(place.before, marker);
      const Eigen::Vector3d& b = markers.at(after, marker);
      // The lesser of two states: a sample between a measured and a missing one is missing.
      result.states.push_back(std::min(markers.states[markers.Index(place.before, marker)],
                                       markers.states[markers.Index(after, marker)]));
      result.positions_cm.emplace_back(result.states.back() == MarkerState::kMissing
                                           ? MissingPosition()
                                           : Eigen::Vector3d(a + (b - a) * place.share));
    }
  }
  return result;
}

BoundingBox ComputeBoundingBox(const MarkerCloud& markers) {
  BoundingBox box;
  bool is_first = true;
  for (std::size_t i = 0; i < markers.positions_cm.size(); ++i) {
    const Eigen::Vector3d& position = markers.positions_cm[i];
    if (markers.states[i] == MarkerState::kMissing || !position.allFinite()) continue;
    box.low_cm = is_first ? position : box.low_cm.cwiseMin(position);
    box.high_cm = is_first ? position : box.high_cm.cwiseMax(position);
    is_first = false;
  }
  return box;
}

}  // namespace kinebase
