// Poses as a camera without perspective sees them. Internal.
#pragma once

#include <Eigen/Core>
#include <array>

#include "kinebase/motion/motion.h"
#include "kinebase/pictures/pose_strip.h"

namespace kinebase::internal {

// Directions of the picture in world space, of unit length.
struct PoseCamera {
  Eigen::Vector3d right;
  Eigen::Vector3d up;
  Eigen::Vector3d toward;  // Towards the camera; level unless the camera is above, so that feet do
                           // not count as far for being low.
};

// Where the performer faces in the first frame that tells: level, unit length. +Z if none does.
[[nodiscard]] Eigen::Vector3d Heading(const JointTrajectories& standard_joints);

// heading  Level, unit length.
[[nodiscard]] PoseCamera MakeCamera(PoseView view, const Eigen::Vector3d& heading);

// Where the body stands on the floor (y = 0): below the root, or below the mean of the joints where
// the root is missing.
[[nodiscard]] Eigen::Vector3d GroundPoint(const JointTrajectories& standard_joints, int frame);

// x to the right, y up and z towards the camera, in cm from the body's point on the floor. Joints
// that are missing have NaN.
using SeenPose = std::array<Eigen::Vector3d, kStandardJointCount>;

[[nodiscard]] Eigen::Vector3d Seen(const PoseCamera& camera, const Eigen::Vector3d& offset);
[[nodiscard]] Eigen::Vector3d SeeJoint(const PoseCamera& camera,
                                       const JointTrajectories& standard_joints, int frame,
                                       int joint, double floor_cm);
[[nodiscard]] SeenPose SeePose(const PoseCamera& camera, const JointTrajectories& standard_joints,
                               int frame, double floor_cm);

}  // namespace kinebase::internal
