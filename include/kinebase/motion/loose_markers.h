// Markers that are not where they were put: slipped, swapped or reconstructed wrongly.
//
// Markers on one bone keep their distances. docs/design/marker-joints.md has the method.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinebase/motion/marker_cloud.h"
#include "kinebase/motion/marker_set.h"

namespace kinebase {

struct LooseMarker {
  std::string label;
  std::vector<std::string> others;  // From which it does not keep its distance.
  int first = 0;                    // The first and last frame where it is loose, 0-based;
  int last = 0;                     // in between it need not be all the time.
  int frames = 0;                   // How many.
  double farthest_cm = 0;           // How much a distance is off, at most.
};

// Looks at the markers that a set calls rigid. A distance is compared with the one that more than
// half of the frames nearly have; where several are off, the marker is loose that most have in
// common. Where that is more than one, as after a swap, all of them are named: distances cannot
// tell which. Markers of different subjects are not compared. What is loose for less than a quarter
// of a second in all is left out, as noise.
//
// Cost  O(frames · log frames) for each pair of markers of a bone.
[[nodiscard]] std::vector<LooseMarker> FindLooseMarkers(const MarkerCloud& markers,
                                                        std::span<const MarkerSet> sets);

}  // namespace kinebase
