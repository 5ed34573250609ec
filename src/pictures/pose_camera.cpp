#include "pictures/pose_camera.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

namespace kinebase {
namespace internal {
namespace {

constexpr std::array<std::pair<PoseView, std::string_view>, 4> kViewNames = {{
    {PoseView::kFront, "front"},
    {PoseView::kSide, "side"},
    {PoseView::kTop, "top"},
    {PoseView::kThreeQuarter, "three-quarter"},
}};

constexpr double kThreeQuarterTurn_rad = 40 * std::numbers::pi / 180;
constexpr double kThreeQuarterTilt_rad = 14 * std::numbers::pi / 180;

}  // namespace

Eigen::Vector3d Heading(const JointTrajectories& standard_joints) {
  for (int frame = 0; frame < standard_joints.frame_count(); ++frame) {
    Eigen::Vector3d left = standard_joints.at(frame, StandardJoint::kLhip) -
                           standard_joints.at(frame, StandardJoint::kRhip);
    left.y() = 0;
    // Hips above each other (somebody lies on the side) tell nothing.
    if (left.allFinite() && left.norm() > 1e-6) {
      return left.normalized().cross(Eigen::Vector3d::UnitY());
    }
  }
  return Eigen::Vector3d::UnitZ();
}

PoseCamera MakeCamera(PoseView view, const Eigen::Vector3d& heading) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d left = up.cross(heading);
  if (view == PoseView::kFront) return {left, up, heading};
  if (view == PoseView::kSide) return {heading, up, -left};
  if (view == PoseView::kTop) return {-left, heading, up};
  const double turn_sin = std::sin(kThreeQuarterTurn_rad);
  const double turn_cos = std::cos(kThreeQuarterTurn_rad);
  const Eigen::Vector3d level = turn_cos * heading - turn_sin * left;
  const double tilt_sin = std::sin(kThreeQuarterTilt_rad);
  const double tilt_cos = std::cos(kThreeQuarterTilt_rad);
  return {turn_sin * heading + turn_cos * left, tilt_cos * up - tilt_sin * level, level};
}

Eigen::Vector3d GroundPoint(const JointTrajectories& standard_joints, int frame) {
  Eigen::Vector3d point = standard_joints.at(frame, StandardJoint::kRoot);
  if (!point.allFinite()) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (int joint = 0; joint < kStandardJointCount; ++joint) {
      if (!standard_joints.at(frame, joint).allFinite()) continue;
      sum += standard_joints.at(frame, joint);
      ++count;
    }
    point = count > 0 ? Eigen::Vector3d(sum / count) : sum;
  }
  return {point.x(), 0, point.z()};
}

Eigen::Vector3d Seen(const PoseCamera& camera, const Eigen::Vector3d& offset) {
  return {camera.right.dot(offset), camera.up.dot(offset), camera.toward.dot(offset)};
}

Eigen::Vector3d SeeJoint(const PoseCamera& camera, const JointTrajectories& standard_joints,
                         int frame, int joint, double floor_cm) {
  const Eigen::Vector3d& position = standard_joints.at(frame, joint);
  // An infinite coordinate counts as missing, too.
  if (!position.allFinite()) return Eigen::Vector3d::Constant(std::nan(""));
  const Eigen::Vector3d origin =
      GroundPoint(standard_joints, frame) + floor_cm * Eigen::Vector3d::UnitY();
  return Seen(camera, position - origin);
}

SeenPose SeePose(const PoseCamera& camera, const JointTrajectories& standard_joints, int frame,
                 double floor_cm) {
  SeenPose pose;
  for (int joint = 0; joint < kStandardJointCount; ++joint) {
    pose[joint] = SeeJoint(camera, standard_joints, frame, joint, floor_cm);
  }
  return pose;
}

}  // namespace internal

std::string_view ToString(PoseView view) {
  for (const auto& [named, name] : internal::kViewNames) {
    if (named == view) return name;
  }
  return "";
}

std::optional<PoseView> ParsePoseView(std::string_view text) {
  for (const auto& [view, name] : internal::kViewNames) {
    if (text == name) return view;
  }
  return std::nullopt;
}

}  // namespace kinebase
