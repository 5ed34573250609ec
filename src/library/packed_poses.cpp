#include "kinebase/library/packed_poses.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinebase/core/error.h"
#include "kinebase/motion/standard_skeleton.h"

namespace kinebase {
namespace {

constexpr double kLargestValue = std::numeric_limits<std::uint16_t>::max();

}  // namespace

PackedPoses PackPoses(const JointTrajectories& standard_joints) {
  const auto& places = standard_joints.positions_cm;
  if (standard_joints.joint_count != kStandardJointCount || places.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "poses are stored of the 24 standard joints");
  }
  Eigen::Vector3d low = places.front();
  Eigen::Vector3d high = places.front();
  for (const Eigen::Vector3d& place : places) {
    if (!place.allFinite()) {
      throw Error(ErrorCode::kInvalidArgument,
                  "a joint has a place that is no number; leave poses out or mend the recording");
    }
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  PackedPoses poses{.offset_cm = {low.x(), low.y(), low.z()},
                    .step_cm = (high - low).maxCoeff() / kLargestValue};
  const double per_step = poses.step_cm > 0 ? 1 / poses.step_cm : 0;
  poses.values.reserve(places.size() * 3);
  for (const Eigen::Vector3d& place : places) {
    for (const double steps : Eigen::Vector3d((place - low) * per_step)) {
      const double value = std::clamp(std::round(steps), 0.0, kLargestValue);
      poses.values.push_back(static_cast<std::uint16_t>(value));
    }
  }
  return poses;
}

JointTrajectories UnpackPoses(const PackedPoses& poses, double rate_hz) {
  JointTrajectories joints{.rate_hz = rate_hz, .joint_count = kStandardJointCount};
  const Eigen::Vector3d offset(poses.offset_cm[0], poses.offset_cm[1], poses.offset_cm[2]);
  joints.positions_cm.reserve(poses.values.size() / 3);
  for (std::size_t i = 0; i + 2 < poses.values.size(); i += 3) {
    const Eigen::Vector3d steps(poses.values[i], poses.values[i + 1], poses.values[i + 2]);
    joints.positions_cm.emplace_back(offset + poses.step_cm * steps);
  }
  return joints;
}

}  // namespace kinebase
