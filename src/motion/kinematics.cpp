#include "kinebase/motion/kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "motion/name_map.h"

namespace kinebase {
namespace {

// `angles` with full turns added where that brings them nearer to `before`.
Eigen::Vector3d Unwound(Eigen::Vector3d angles, const Eigen::Vector3d& before) {
  constexpr double kTurn = 2 * std::numbers::pi;
  for (int i = 0; i < 3; ++i) angles[i] -= kTurn * std::round((angles[i] - before[i]) / kTurn);
  return angles;
}

// The triple that means the same rotation as `angles` and lies nearest to `before`: each angle may
// gain full turns, and (a + π, π − b, c + π) is the same rotation as (a, b, c).
Eigen::Vector3d NearestEquivalent(const Eigen::Vector3d& angles, const Eigen::Vector3d& before,
                                  int middle) {
  constexpr double kPi = std::numbers::pi;
  Eigen::Vector3d flipped = angles + Eigen::Vector3d::Constant(kPi);
  flipped[middle] = kPi - angles[middle];
  const Eigen::Vector3d first = Unwound(angles, before);
  const Eigen::Vector3d second = Unwound(flipped, before);
  return (second - before).squaredNorm() < (first - before).squaredNorm() ? second : first;
}

int AxisAt(EulerOrder order, std::size_t place) { return ToString(order)[place] - 'X'; }

// The angle about `axis` by which `r` turns the plane across it.
double AngleAbout(int axis, const Eigen::Matrix3d& r) {
  const int a = (axis + 1) % 3;
  const int b = (axis + 2) % 3;
  return std::atan2(r(b, a) - r(a, b), r(a, a) + r(b, b));
}

// The angles of a rotation that is one about `first` and then one about `second`, both fixed axes.
// R = R₂·R₁: column `first` of R is that of R₂, row `second` of R is that of R₁. Unlike a general
// triple they are unique and well-conditioned everywhere.
Eigen::Vector3d TwoAngles(const Eigen::Matrix3d& r, int first, int second) {
  const int third = 3 - first - second;
  const double sign = (second - first + 3) % 3 == 1 ? 1 : -1;
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  angles[second] = std::atan2(-sign * r(third, first), r(first, first));
  angles[first] = std::atan2(-sign * r(second, third), r(second, second));
  return angles;
}

// The angles with those about other axes than the joint's own at zero, where that gives `rotation`.
std::optional<Eigen::Vector3d> AnglesOfDofs(const Eigen::Quaterniond& rotation,
                                            const Joint& joint) {
  constexpr double kSameRotation = 1e-7;  // rad; a bone of a metre then ends within 0.1 µm.
  std::vector<int> axes;                  // In the Euler order.
  for (std::size_t place = 0; place < 3; ++place) {
    const int axis = AxisAt(joint.euler_order, place);
    const auto dof = static_cast<Dof>(static_cast<int>(Dof::kRx) + axis);
    if (std::ranges::find(joint.dofs, dof) != joint.dofs.end()) axes.push_back(axis);
  }
  if (axes.empty() || axes.size() == 3) return std::nullopt;
  const Eigen::Matrix3d r = rotation.toRotationMatrix();
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  if (axes.size() == 2) {
    angles = TwoAngles(r, axes[0], axes[1]);
  } else {
    angles[axes[0]] = AngleAbout(axes[0], r);
  }
  const Eigen::Quaterniond again = EulerToQuaternion(angles, joint.euler_order);
  if (again.angularDistance(rotation) > kSameRotation) return std::nullopt;
  return angles;
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

void CheckStandardJoints(const Skeleton& skeleton) {
  std::string missing;
  int count = 0;
  for (int j = 0; j < kStandardJointCount; ++j) {
    if (skeleton.name_map()[static_cast<std::size_t>(j)].trajectory_joint >= 0) continue;
    const auto joint = static_cast<StandardJoint>(j);
    missing += fmt::format("{}'{}' (for {})", missing.empty() ? "" : ", ",
                           internal::TrajectoryBoneName(joint), ToString(joint));
    ++count;
  }
  if (count == 0) return;
  std::string message = "the skeleton lacks bones of the standard skeleton: " + missing;
  if (count > kStandardJointCount / 2) {
    message = fmt::format(
        "the skeleton lacks bones for {} of the {} standard joints; it is no person, or has names "
        "and a shape that are not known",
        count, kStandardJointCount);
  }
  throw Error(ErrorCode::kMismatch, message, {skeleton.source().file_name});
}

JointTrajectories StandardJoints(const Skeleton& skeleton, const JointTrajectories& all_joints) {
  CheckStandardJoints(skeleton);
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
  const Joint& bone = motion.skeleton->joints()[static_cast<std::size_t>(joint)];
  const EulerOrder order = bone.euler_order;
  const Eigen::Quaterniond& axis = motion.skeleton->axis(joint);
  std::vector<Eigen::Vector3d> result;
  result.reserve(static_cast<std::size_t>(motion.frame_count));
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    const Eigen::Quaterniond own = axis.conjugate() * motion.rotation(frame, joint) * axis;
    if (const auto angles = AnglesOfDofs(own, bone)) {
      before = Unwound(*angles, before);
    } else {
      before = NearestEquivalent(QuaternionToEuler(own, order), before, AxisAt(order, 1));
    }
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
