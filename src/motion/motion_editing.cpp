#include "kinebase/motion/motion_editing.h"

#include <algorithm>
#include <string>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "motion/sampling.h"

namespace kinebase {

using internal::SampleGrid;

namespace {

const Eigen::DiagonalMatrix<double, 3> kReflection(-1, 1, 1);

// The name with left and right exchanged; empty if it names no side.
std::string OtherSide(const std::string& name) {
  const std::pair<std::string, std::string> words[] = {
      {"Left", "Right"}, {"left", "right"}, {"LEFT", "RIGHT"}};
  for (const auto& [left, right] : words) {
    if (const auto at = name.find(left); at != std::string::npos) {
      return std::string(name).replace(at, left.size(), right);
    }
    if (const auto at = name.find(right); at != std::string::npos) {
      return std::string(name).replace(at, right.size(), left);
    }
  }
  return {};
}

std::string OtherSideByInitial(std::string name) {
  constexpr std::pair<char, char> kInitials[] = {{'l', 'r'}, {'L', 'R'}};
  for (const auto& [left, right] : kInitials) {
    if (name[0] == left || name[0] == right) {
      name[0] = name[0] == left ? right : left;
      return name;
    }
  }
  return name;
}

// Index of the joint on the other side for each joint.
std::vector<int> MirrorJoints(const Skeleton& skeleton) {
  std::vector<int> mirror;
  for (int i = 0; i < skeleton.joint_count(); ++i) {
    const std::string& name = skeleton.joints()[static_cast<std::size_t>(i)].bone_name;
    const std::string other = OtherSide(name);
    if (!other.empty()) {
      const auto joint = skeleton.FindBone(other);
      if (!joint) {
        throw Error(ErrorCode::kMismatch,
                    fmt::format("cannot mirror: bone '{}' has no counterpart '{}'", name, other),
                    {skeleton.source().file_name});
      }
      mirror.push_back(*joint);
      continue;
    }
    // 'lowerback' begins with l too: an initial counts only where the counterpart exists.
    mirror.push_back(name.empty() ? i : skeleton.FindBone(OtherSideByInitial(name)).value_or(i));
  }
  return mirror;
}

Eigen::Quaterniond Reflected(const Eigen::Quaterniond& q) { return {q.w(), q.x(), -q.y(), -q.z()}; }

}  // namespace

Motion CutMotion(const Motion& motion, int first, int last) {
  if (first < 0 || last < first || last >= motion.frame_count) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("cannot cut frames {} to {}: the motion has frames 1 to {}", first + 1,
                            last + 1, motion.frame_count));
  }
  Motion cut = motion;
  cut.frame_count = last - first + 1;
  cut.first_frame = motion.first_frame + first;
  const auto slice = [&](auto& values, int per_frame) {
    if (values.empty()) return;
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(last + 1) * per_frame, values.end());
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first) * per_frame);
  };
  slice(cut.root_position_cm, 1);
  slice(cut.rotations, motion.joint_count());
  slice(cut.extra_offsets_cm, motion.joint_count());
  return cut;
}

Motion ResampleMotion(const Motion& motion, double rate_hz) {
  const SampleGrid grid(motion.first_frame, motion.frame_count, motion.rate_hz, rate_hz);
  Motion result{.skeleton = motion.skeleton,
                .rate_hz = rate_hz,
                .frame_count = grid.count(),
                .first_frame = grid.first_number()};
  const auto joints = static_cast<std::size_t>(motion.joint_count());
  const auto blend = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share) {
    return Eigen::Vector3d(a + (b - a) * share);
  };
  for (int sample = 0; sample < grid.count(); ++sample) {
    const auto place = grid.Place(sample);
    const auto a = static_cast<std::size_t>(place.before);
    const auto b = static_cast<std::size_t>(place.after);
    result.root_position_cm.push_back(
        blend(motion.root_position_cm[a], motion.root_position_cm[b], place.share));
    for (std::size_t joint = 0; joint < joints; ++joint) {
      const Eigen::Quaterniond& from = motion.rotations[a * joints + joint];
      result.rotations.push_back(
          place.share == 0 ? from : from.slerp(place.share, motion.rotations[b * joints + joint]));
      if (motion.extra_offsets_cm.empty()) continue;
      result.extra_offsets_cm.push_back(blend(motion.extra_offsets_cm[a * joints + joint],
                                              motion.extra_offsets_cm[b * joints + joint],
                                              place.share));
    }
  }
  return result;
}

JointTrajectories ResampleTrajectories(const JointTrajectories& trajectories, double rate_hz) {
  const SampleGrid grid(1, trajectories.frame_count(), trajectories.rate_hz, rate_hz);
  JointTrajectories result{.rate_hz = rate_hz, .joint_count = trajectories.joint_count};
  result.positions_cm.reserve(static_cast<std::size_t>(grid.count()) * trajectories.joint_count);
  for (int sample = 0; sample < grid.count(); ++sample) {
    const auto place = grid.Place(sample);
    for (int joint = 0; joint < trajectories.joint_count; ++joint) {
      const Eigen::Vector3d& a = trajectories.at(place.before, joint);
      const Eigen::Vector3d& b = trajectories.at(place.after, joint);
      result.positions_cm.emplace_back(place.share == 0 ? a : a + (b - a) * place.share);
    }
  }
  return result;
}

// A reflection M turns a local rotation L into M·L·M, and the root's O·E (O the skeleton's fixed
// orientation) into M·O·E·M, so that E becomes O⁻¹·(M·O·M)·(M·E·M).
Motion MirrorMotion(const Motion& motion) {
  const std::vector<int> mirror = MirrorJoints(*motion.skeleton);
  const Eigen::Quaterniond orientation = motion.skeleton->root_orientation();
  const Eigen::Quaterniond before_root = orientation.conjugate() * Reflected(orientation);
  Motion result = motion;
  const auto joints = static_cast<std::size_t>(motion.joint_count());
  for (auto& position : result.root_position_cm) position = kReflection * position;
  for (std::size_t frame = 0; frame < static_cast<std::size_t>(motion.frame_count); ++frame) {
    const std::size_t row = frame * joints;
    for (std::size_t joint = 0; joint < joints; ++joint) {
      const std::size_t other = row + static_cast<std::size_t>(mirror[joint]);
      result.rotations[row + joint] = Reflected(motion.rotations[other]);
      if (!motion.extra_offsets_cm.empty()) {
        result.extra_offsets_cm[row + joint] = kReflection * motion.extra_offsets_cm[other];
      }
    }
    result.rotations[row] = before_root * result.rotations[row];
  }
  return result;
}

JointTrajectories MirrorTrajectories(const JointTrajectories& standard_joints) {
  if (standard_joints.joint_count != kStandardJointCount) {
    throw Error(ErrorCode::kInvalidArgument, "only the 24 standard joints can be mirrored");
  }
  JointTrajectories result = standard_joints;
  for (int frame = 0; frame < standard_joints.frame_count(); ++frame) {
    for (int joint = 0; joint < kStandardJointCount; ++joint) {
      const StandardJoint other = Mirrored(static_cast<StandardJoint>(joint));
      result.positions_cm[static_cast<std::size_t>(frame) * kStandardJointCount + joint] =
          kReflection * standard_joints.at(frame, other);
    }
  }
  return result;
}

}  // namespace kinebase
