// The standard joints straight from markers: good enough for features, without a body model.
//
// Read motion/marker_set.h first. Method and errors: docs/design/marker-joints.md.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinebase/core/diagnostic.h"
#include "kinebase/motion/joint_source.h"
#include "kinebase/motion/marker_cloud.h"
#include "kinebase/motion/marker_set.h"
#include "kinebase/motion/motion.h"

namespace kinebase {

struct MarkerJoints {
  std::string marker_set;            // The name of the set that was taken.
  JointTrajectories joints;          // The 24 standard joints.
  std::vector<JointSource> sources;  // One for each, in order.
};

// Takes the first of `sets` that places all joints. Markers that are missing in a frame are
// interpolated over time first, at the ends of the recording held.
//
// Errors       Mismatch if no set fits, naming what the nearest one lacks; if there are no frames.
// diagnostics  Markers interpolated over more than half a second; labels of several subjects.
// Cost         O(frames · (markers of the set + joints)).
[[nodiscard]] MarkerJoints ApproximateJoints(const MarkerCloud& markers,
                                             std::span<const MarkerSet> sets,
                                             Diagnostics& diagnostics);

}  // namespace kinebase
