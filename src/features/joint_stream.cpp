#include "kinebase/features/joint_stream.h"

#include <cmath>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_editing.h"

namespace kinebase {
namespace {

constexpr double kSampleRateHz = 120;  // That of the built-in feature sets.
constexpr double kRounding = 1e-9;

// Samples from one column to the next.
int StepOf(double rate_hz) {
  const double step = kSampleRateHz / rate_hz;
  if (!(rate_hz > 0) || step > kSampleRateHz || std::abs(step - std::round(step)) > kRounding) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("rate {} Hz must divide {} Hz evenly and be at least 1, as 30 Hz is",
                            rate_hz, kSampleRateHz));
  }
  return static_cast<int>(std::lround(step));
}

// Frames as features count them: from the recording's first, whatever its number.
Motion AtSampleRate(const Motion& motion) {
  Motion numbered_from_one = motion;
  numbered_from_one.first_frame = 1;
  return ResampleMotion(numbered_from_one, kSampleRateHz);
}

// Not the root, and not the tips of the body, where no bone begins.
std::vector<std::size_t> RotatingJoints() {
  std::vector<bool> has_child(kStandardJointCount);
  for (int joint = 0; joint < kStandardJointCount; ++joint) {
    const auto parent = StandardParent(static_cast<StandardJoint>(joint));
    if (parent) has_child[static_cast<std::size_t>(*parent)] = true;
  }
  std::vector<std::size_t> joints;
  for (std::size_t joint = 1; joint < has_child.size(); ++joint) {
    if (has_child[joint]) joints.push_back(joint);
  }
  return joints;
}

void AppendRotations(const Motion& motion, int frame, std::span<const std::size_t> joints,
                     std::vector<float>& values) {
  for (const std::size_t joint : joints) {
    const int bone = motion.skeleton->name_map()[joint].rotation_joint;
    const Eigen::Quaterniond rotation =
        bone < 0 ? Eigen::Quaterniond::Identity() : motion.rotation(frame, bone);
    for (const double number : {rotation.w(), rotation.x(), rotation.y(), rotation.z()}) {
      values.push_back(static_cast<float>(number));
    }
  }
}

void AppendPositions(const Motion& motion, const JointTrajectories& joints, int frame,
                     double length_cm, std::vector<float>& values) {
  const Eigen::Quaterniond turned_back =
      (motion.skeleton->root_orientation() * motion.rotation(frame, 0)).conjugate();
  const Eigen::Vector3d& root = joints.at(frame, StandardJoint::kRoot);
  for (int joint = 1; joint < kStandardJointCount; ++joint) {
    const Eigen::Vector3d place = turned_back * (joints.at(frame, joint) - root) / length_cm;
    for (const double number : place) values.push_back(static_cast<float>(number));
  }
}

double HumerusLength(const JointTrajectories& joints) {
  const double length_cm =
      (joints.at(0, StandardJoint::kRshoulder) - joints.at(0, StandardJoint::kRelbow)).norm();
  if (length_cm > 0) return length_cm;
  throw Error(ErrorCode::kInvalidArgument,
              "the right upper arm has no length, so positions cannot be compared; name a skeleton "
              "that has one");
}

}  // namespace

JointStream ExtractJointStream(const Motion& motion, JointStreamKind kind, double rate_hz) {
  const int step = StepOf(rate_hz);
  if (motion.frame_count < 1) {
    throw Error(ErrorCode::kInvalidArgument, "a motion without frames has no poses to compare");
  }
  CheckStandardJoints(*motion.skeleton);
  const Motion samples = AtSampleRate(motion);
  JointStream stream{.kind = kind, .rate_hz = rate_hz};
  if (kind == JointStreamKind::kRotations) {
    const std::vector<std::size_t> rotating = RotatingJoints();
    stream.joint_count = static_cast<int>(rotating.size());
    for (int frame = 0; frame < samples.frame_count; frame += step) {
      AppendRotations(samples, frame, rotating, stream.values);
    }
    return stream;
  }
  stream.joint_count = kStandardJointCount - 1;
  const JointTrajectories joints = StandardJoints(samples);
  const double length_cm = HumerusLength(joints);
  for (int frame = 0; frame < samples.frame_count; frame += step) {
    AppendPositions(samples, joints, frame, length_cm, stream.values);
  }
  return stream;
}

}  // namespace kinebase
