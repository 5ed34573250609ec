// Poses of the standard joints in two bytes a coordinate: enough to play a take back.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kinebase/motion/motion.h"
#include "kinebase/motion/standard_skeleton.h"

namespace kinebase {

// Of one frame.
inline constexpr int kPackedPoseBytes = 3 * kStandardJointCount * int{sizeof(std::uint16_t)};

// A coordinate is offset + step · value. The step is the take's largest extent along an axis
// divided by 65535, so that a coordinate is at most half a step off: 0.08 mm in a take that covers
// ten metres.
struct PackedPoses {
  std::array<double, 3> offset_cm = {};  // x, y, z: the lowest place of any joint.
  double step_cm = 0;
  std::vector<std::uint16_t> values;  // [frame × joint × 3]

  friend bool operator==(const PackedPoses&, const PackedPoses&) = default;
};

// standard_joints  24 joints, at least one frame.
// Errors           InvalidArgument: other joints, a place that is no number.
[[nodiscard]] PackedPoses PackPoses(const JointTrajectories& standard_joints);

[[nodiscard]] JointTrajectories UnpackPoses(const PackedPoses& poses, double rate_hz);

}  // namespace kinebase
