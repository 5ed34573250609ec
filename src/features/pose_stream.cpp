#include "kinebase/features/pose_stream.h"

#include <cmath>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/motion/motion_editing.h"

namespace kinebase {
namespace {

double BodySize(const JointTrajectories& joints) {
  using enum StandardJoint;
  const auto length_of = [&](std::initializer_list<StandardJoint> chain) {
    double length = 0;
    for (const auto* joint = chain.begin(); joint + 1 != chain.end(); ++joint) {
      length += (joints.at(0, static_cast<int>(joint[1])) - joints.at(0, static_cast<int>(*joint)))
                    .norm();
    }
    return length;
  };
  return length_of({kRoot, kBelly, kChest, kNeck}) +
         (length_of({kLhip, kLknee, kLankle}) + length_of({kRhip, kRknee, kRankle})) / 2;
}

// About the vertical, so that the way from the right hip to the left one has no z.
Eigen::Matrix3d TurnOfHips(const JointTrajectories& joints, int frame) {
  const Eigen::Vector3d left = joints.at(frame, static_cast<int>(StandardJoint::kLhip)) -
                               joints.at(frame, static_cast<int>(StandardJoint::kRhip));
  const double length = std::hypot(left.x(), left.z());
  if (!(length > 0)) return Eigen::Matrix3d::Identity();
  const double cosine = left.x() / length;
  const double sine = left.z() / length;
  Eigen::Matrix3d turn;
  turn << cosine, 0, sine, 0, 1, 0, -sine, 0, cosine;
  return turn;
}

}  // namespace

PoseStream ExtractPoses(const JointTrajectories& standard_joints, double rate_hz) {
  if (standard_joints.joint_count != kStandardJointCount || standard_joints.frame_count() == 0) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("poses need the {} standard joints and a frame; found {} joints, {} "
                            "frames",
                            kStandardJointCount, standard_joints.joint_count,
                            standard_joints.frame_count()));
  }
  const JointTrajectories joints = ResampleTrajectories(standard_joints, rate_hz);
  const double size = BodySize(joints);
  const double scale = size > 0 ? 1 / size : 0;
  PoseStream poses{.rate_hz = rate_hz};
  poses.values.reserve(static_cast<std::size_t>(joints.frame_count()) * kPoseValues);
  for (int frame = 0; frame < joints.frame_count(); ++frame) {
    const Eigen::Matrix3d turn = TurnOfHips(joints, frame);
    const Eigen::Vector3d& root = joints.at(frame, static_cast<int>(StandardJoint::kRoot));
    for (int joint = 0; joint < kStandardJointCount; ++joint) {
      const Eigen::Vector3d place = turn * (joints.at(frame, joint) - root) * scale;
      for (const double value : place) poses.values.push_back(static_cast<float>(value));
    }
  }
  return poses;
}

}  // namespace kinebase
