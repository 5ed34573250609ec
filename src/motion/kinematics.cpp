#include "kinebase/motion/kinematics.h"

#include <cmath>
#include <numbers>
#include <string>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "motion/name_map.h"

namespace kinebase {
namespace {

// The triple that means the same rotation as `angles` and lies nearest to `before`: each angle may
// gain full turns, and (a + π, π − b, c + π) is the same rotation as (a, b, c).
Eigen::Vector3d NearestEquivalent(const Eigen::Vector3d& angles, const Eigen::Vector3d& before,
                                  int middle) {
  constexpr double kPi = std::numbers::pi;
  Eigen::Vector3d flipped = angles + Eigen::Vector3d::Constant(kPi);
  flipped[middle] = kPi - angles[middle];
  const auto unwind = [&](Eigen::Vector3d triple) {
    for (int i = 0; i < 3; ++i) {
      triple[i] -= 2 * kPi * std::round((triple[i] - before[i]) / (2 * kPi));
    }
    return triple;
  };
  const Eigen::Vector3d first = unwind(angles);
  const Eigen::Vector3d second = unwind(flipped);
  return (second - before).squaredNorm() < (first - before).squaredNorm() ? second : first;
}

int MiddleAxis(EulerOrder order) {
  const char axis = ToString(order)[1];
  return axis - 'X';
}

}  // namespace

void ForwardKinematics(const Motion& motion, int frame, Eigen::Vector3d* positions_cm) {
  const auto& joints = motion.skeleton->joints();
  const std::size_t row = static_cast<std::size_t>(frame) * joints.size();
  const Eigen::Quaterniond* rotations = motion.rotations.data() + row;
  // Matrices, not quaternions: turning a vector by a matrix takes half the multiplications.
  thread_local std::vector<Eigen::Matrix3d> global;
  global.resize(joints.size());
  global[0] = (motion.skeleton->root_orientation() * rotations[0]).toRotationMatrix();
  positions_cm[0] = motion.root_position_cm[static_cast<std::size_t>(frame)];
  for (std::size_t i = 1; i < joints.size(); ++i) {
    const auto parent = static_cast<std::size_t>(joints[i].parent);
    global[i].noalias() = global[parent] * rotations[i].toRotationMatrix();
    Eigen::Vector3d offset = joints[i].offset_cm;
    if (!motion.extra_offsets_cm.empty()) offset += motion.extra_offsets_cm[row + i];
    positions_cm[i].noalias() = positions_cm[parent] + global[i] * offset;
  }
}

JointTrajectories ForwardKinematics(const Motion& motion) {
  JointTrajectories result{.rate_hz = motion.rate_hz, .joint_count = motion.joint_count()};
  const auto joint_count = static_cast<std::size_t>(motion.joint_count());
  result.positions_cm.resize(static_cast<std::size_t>(motion.frame_count) * joint_count);
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    ForwardKinematics(motion, frame,
                      result.positions_cm.data() + static_cast<std::size_t>(frame) * joint_count);
  }
  return result;
}

std::vector<Eigen::Vector3d> NeutralPose(const Skeleton& skeleton) {
  std::vector<Eigen::Vector3d> pose(skeleton.joints().size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 1; i < pose.size(); ++i) {
    const Joint& joint = skeleton.joints()[i];
    pose[i] = pose[static_cast<std::size_t>(joint.parent)] + joint.offset_cm;
  }
  return pose;
}

JointTrajectories StandardJoints(const Skeleton& skeleton, const JointTrajectories& all_joints) {
  std::string missing;
  for (int j = 0; j < kStandardJointCount; ++j) {
    if (skeleton.name_map()[static_cast<std::size_t>(j)].trajectory_joint >= 0) continue;
    const auto joint = static_cast<StandardJoint>(j);
    missing += fmt::format("{}'{}' (for {})", missing.empty() ? "" : ", ",
                           internal::TrajectoryBoneName(joint), ToString(joint));
  }
  if (!missing.empty()) {
    throw Error(ErrorCode::kMismatch,
                "the skeleton lacks bones of the standard skeleton: " + missing,
                {skeleton.source().file_name});
  }
  JointTrajectories result{.rate_hz = all_joints.rate_hz, .joint_count = kStandardJointCount};
  const int frames = all_joints.frame_count();
  result.positions_cm.reserve(static_cast<std::size_t>(frames) * kStandardJointCount);
  for (int frame = 0; frame < frames; ++frame) {
    for (const NameMapEntry& entry : skeleton.name_map()) {
      result.positions_cm.push_back(all_joints.at(frame, entry.trajectory_joint));
    }
  }
  return result;
}

JointTrajectories StandardJoints(const Motion& motion) {
  return StandardJoints(*motion.skeleton, ForwardKinematics(motion));
}

std::vector<Eigen::Vector3d> EulerAngles(const Motion& motion, int joint) {
  const EulerOrder order = motion.skeleton->joints()[static_cast<std::size_t>(joint)].euler_order;
  const Eigen::Quaterniond& axis = motion.skeleton->axis(joint);
  std::vector<Eigen::Vector3d> result;
  result.reserve(static_cast<std::size_t>(motion.frame_count));
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    const Eigen::Quaterniond own = axis.conjugate() * motion.rotation(frame, joint) * axis;
    before = NearestEquivalent(QuaternionToEuler(own, order), before, MiddleAxis(order));
    result.push_back(before);
  }
  return result;
}

BoundingBox ComputeBoundingBox(const JointTrajectories& trajectories) {
  BoundingBox box;
  if (trajectories.positions_cm.empty()) return box;
  box.low_cm = box.high_cm = trajectories.positions_cm.front();
  for (const Eigen::Vector3d& position : trajectories.positions_cm) {
    box.low_cm = box.low_cm.cwiseMin(position);
    box.high_cm = box.high_cm.cwiseMax(position);
  }
  return box;
}

}  // namespace kinebase
