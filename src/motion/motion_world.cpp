#include "motion/motion_world.h"

#include <memory>
#include <utility>
#include <vector>

namespace kinebase::internal {
namespace {

// With local axes C, a rotation C · E · C⁻¹ becomes W · C · E · C⁻¹ · W⁻¹: C becomes W · C.
std::shared_ptr<const Skeleton> TurnSkeleton(const Skeleton& skeleton,
                                             const Eigen::Quaterniond& turn) {
  std::vector<Joint> joints = skeleton.joints();
  for (int i = 0; i < skeleton.joint_count(); ++i) {
    Joint& joint = joints[static_cast<std::size_t>(i)];
    joint.offset_cm = turn * joint.offset_cm;
    joint.direction = turn * joint.direction;
    joint.axis_rad = QuaternionToEuler(turn * skeleton.axis(i), EulerOrder::kXyz);
  }
  const Eigen::Quaterniond orientation = turn * skeleton.root_orientation() * turn.conjugate();
  const EulerOrder order = joints.front().euler_order;
  return std::make_shared<Skeleton>(std::move(joints), skeleton.source(),
                                    turn * skeleton.root_position_cm(),
                                    QuaternionToEuler(orientation, order), skeleton.name_map());
}

}  // namespace

Motion TurnMotion(const Motion& motion, const Eigen::Matrix3d& turn) {
  const Eigen::Quaterniond rotation(turn);
  Motion turned = motion;
  turned.skeleton = TurnSkeleton(*motion.skeleton, rotation);
  for (auto& position : turned.root_position_cm) position = turn * position;
  for (auto& offset : turned.extra_offsets_cm) offset = turn * offset;
  for (auto& local : turned.rotations) local = rotation * local * rotation.conjugate();
  return turned;
}

}  // namespace kinebase::internal
