// A take: one skeleton moving through time.
//
// Read motion/skeleton.h first. Then motion/kinematics.h for where the joints are,
// motion/motion_file.h for where motions come from, motion/motion_editing.h for what can be done.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "kinebase/motion/skeleton.h"

namespace kinebase {

// Rates that a recording can have, Hz. Beyond them a number is a mistake, and resampling to the
// rate of the features would multiply frames without bound.
inline constexpr double kSmallestRateHz = 1;
inline constexpr double kLargestRateHz = 10000;

// Rotations are local: they turn a bone and all below it relative to its parent, and are the
// identity in the neutral pose. World space is right-handed with Y up.
struct Motion {
  std::shared_ptr<const Skeleton> skeleton;
  double rate_hz = 0;
  int frame_count = 0;
  std::int64_t first_frame = 1;  // The number that the file gives its first frame.

  std::vector<Eigen::Vector3d> root_position_cm;  // [frame]; world space.
  std::vector<Eigen::Quaterniond> rotations;      // [frame × joint]; unit length.

  // [frame × joint], or empty where no bone but the root translates or stretches: what is added
  // to the joint's offset, in the space that the offset is in.
  std::vector<Eigen::Vector3d> extra_offsets_cm;

  [[nodiscard]] int joint_count() const { return skeleton ? skeleton->joint_count() : 0; }
  [[nodiscard]] double duration_s() const { return rate_hz > 0 ? frame_count / rate_hz : 0; }
  [[nodiscard]] const Eigen::Quaterniond& rotation(int frame, int joint) const {
    return rotations[static_cast<std::size_t>(frame) * joint_count() + joint];
  }
};

// Where joints are over time.
struct JointTrajectories {
  double rate_hz = 0;
  int joint_count = 0;                        // All of a skeleton, or kStandardJointCount.
  std::vector<Eigen::Vector3d> positions_cm;  // [frame × joint]; world space, Y up.

  [[nodiscard]] int frame_count() const {
    return joint_count == 0 ? 0 : static_cast<int>(positions_cm.size() / joint_count);
  }
  [[nodiscard]] const Eigen::Vector3d& at(int frame, int joint) const {
    return positions_cm[static_cast<std::size_t>(frame) * joint_count + joint];
  }
  [[nodiscard]] const Eigen::Vector3d& at(int frame, StandardJoint joint) const {
    return at(frame, static_cast<int>(joint));
  }
};

}  // namespace kinebase
