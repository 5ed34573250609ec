// Units and axes of a BVH file, which says nothing of either: told by how the figure stands.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "fmt/format.h"
#include "kinebase/core/units.h"
#include "kinebase/motion/kinematics.h"
#include "motion/bvh_figure.h"

namespace kinebase::internal {
namespace {

using enum StandardJoint;

constexpr double kSmallestStatureCm = 120;
constexpr double kLargestStatureCm = 220;
constexpr int kSampledFrames = 200;

int TrajectoryJoint(const RawFigure& figure, StandardJoint joint) {
  return figure.rig.name_map[static_cast<std::size_t>(joint)].trajectory_joint;
}

// From the feet to the head, or as far up as there is something; empty if no joint is known.
std::optional<Eigen::Vector3d> Upward(const RawFigure& figure,
                                      const std::vector<Eigen::Vector3d>& pose) {
  const auto place = [&](StandardJoint joint) {
    return pose[static_cast<std::size_t>(TrajectoryJoint(figure, joint))];
  };
  const auto known = [&](StandardJoint joint) { return TrajectoryJoint(figure, joint) >= 0; };
  if (!known(kLankle) || !known(kRankle)) return std::nullopt;
  const StandardJoint top = known(kHeadtop) ? kHeadtop : known(kNeck) ? kNeck : kRoot;
  const Eigen::Vector3d up = place(top) - (place(kLankle) + place(kRankle)) / 2;
  return up.norm() > 0 ? std::optional(up.normalized()) : std::nullopt;
}

// The mean of Upward over the frames; short where the figure turns all ways.
Eigen::Vector3d MeanUpward(const RawFigure& figure) {
  const Motion& motion = figure.motion;
  std::vector<Eigen::Vector3d> pose(figure.joints.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const int step = std::max(1, motion.frame_count / kSampledFrames);
  int count = 0;
  for (int frame = 0; frame < motion.frame_count; frame += step, ++count) {
    ForwardKinematics(motion, frame, pose.data());
    sum += Upward(figure, pose).value_or(Eigen::Vector3d::Zero());
  }
  return sum / std::max(count, 1);
}

// Y or Z if a direction tells between them.
std::optional<UpAxis> AxisAlong(const Eigen::Vector3d& direction) {
  constexpr double kClearly = 0.5;  // Half upright, on the mean, and twice the other axis.
  if (direction.y() > kClearly && direction.y() > 2 * direction.z()) return UpAxis::kY;
  if (direction.z() > kClearly && direction.z() > 2 * direction.y()) return UpAxis::kZ;
  return std::nullopt;
}

// Along the bones from a joint up to one of its ancestors; 0 if it is none.
double LengthBetween(const RawFigure& figure, StandardJoint from, StandardJoint to) {
  const int end = TrajectoryJoint(figure, to);
  double length = 0;
  for (int i = TrajectoryJoint(figure, from); i > end;) {
    const Joint& joint = figure.joints[static_cast<std::size_t>(i)];
    length += joint.offset_cm.norm();
    i = joint.parent;
    if (i == end) return length;
  }
  return 0;
}

double HeightOf(const std::vector<Eigen::Vector3d>& pose, UpAxis up) {
  const auto [low, high] = std::ranges::minmax(
      pose, {}, [&](const Eigen::Vector3d& place) { return place[static_cast<int>(up)]; });
  return high[static_cast<int>(up)] - low[static_cast<int>(up)];
}

}  // namespace

UpAxis GuessUpAxis(const RawFigure& figure, Diagnostics& diagnostics) {
  if (const auto axis = AxisAlong(MeanUpward(figure))) {
    if (*axis != UpAxis::kY) {
      diagnostics.push_back({Severity::kInfo,
                             "Z is taken as up, as the figure stands along it; "
                             "--source-up says another"});
    }
    return *axis;
  }
  const auto rest = Upward(figure, NeutralPose(*figure.motion.skeleton));
  const UpAxis axis = AxisAlong(rest.value_or(Eigen::Vector3d::Zero())).value_or(UpAxis::kY);
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format("{} is taken as up, as {}; --source-up says another", ToString(axis),
                   rest ? "the neutral pose stands along it and the motion tells nothing"
                        : "no legs are known that would tell")});
  return axis;
}

double EstimateStature(const RawFigure& figure, UpAxis up) {
  // What lies below the ankles (Winter, Biomechanics and Motor Control, Fig. 4.1).
  constexpr double kShareOfFoot = 0.039;
  const double left = LengthBetween(figure, kLknee, kLhip) + LengthBetween(figure, kLankle, kLknee);
  const double right =
      LengthBetween(figure, kRknee, kRhip) + LengthBetween(figure, kRankle, kRknee);
  const double trunk = LengthBetween(figure, kHeadtop, kRoot);
  const std::vector<Eigen::Vector3d> pose = NeutralPose(*figure.motion.skeleton);
  if (left <= 0 || right <= 0 || trunk <= 0) return HeightOf(pose, up);
  // The hips hang below the root; the neutral pose may lie, so along the trunk.
  const auto place = [&](StandardJoint joint) {
    return pose[static_cast<std::size_t>(TrajectoryJoint(figure, joint))];
  };
  const Eigen::Vector3d down = (place(kRoot) - place(kHeadtop)).normalized();
  const double drop = down.dot((place(kLhip) + place(kRhip)) / 2 - place(kRoot));
  return ((left + right) / 2 + trunk + std::max(drop, 0.0)) / (1 - kShareOfFoot);
}

void ReportMissingBones(const RawFigure& figure, Diagnostics& diagnostics) {
  std::string pairs;
  for (const JointSource& source : figure.rig.sources) {
    const auto parent = StandardParent(source.joint);
    const bool at_neck = source.joint == kLclavicle || source.joint == kRclavicle;
    if (!parent || at_neck || source.match != JointMatch::kTable) continue;
    if (figure.rig.sources[static_cast<std::size_t>(*parent)].match != JointMatch::kTable) continue;
    const int joint = TrajectoryJoint(figure, source.joint);
    bool is_bone = false;
    int i = joint;
    while (i > TrajectoryJoint(figure, *parent) && !is_bone) {
      is_bone = figure.joints[static_cast<std::size_t>(i)].length_cm > 0;
      i = figure.joints[static_cast<std::size_t>(i)].parent;
    }
    if (is_bone) continue;
    pairs += fmt::format("{}{} and {}", pairs.empty() ? "" : ", ", ToString(*parent),
                         ToString(source.joint));
  }
  if (pairs.empty()) return;
  diagnostics.push_back(
      {Severity::kWarning,
       "joints that lie in one place, as the file lacks the bone between them: " + pairs});
}

std::string GuessUnits(const RawFigure& figure, UpAxis up, Diagnostics& diagnostics) {
  const double stature = EstimateStature(figure, up);
  for (const std::string_view unit : kSourceUnits) {  // No stature is human in two of them.
    const double stature_cm = stature * CentimetresInOrFail(unit);
    if (stature_cm < kSmallestStatureCm || stature_cm > kLargestStatureCm) continue;
    diagnostics.push_back(
        {Severity::kInfo,
         fmt::format(
             "lengths are read as {}, which makes the figure about {:.0f} cm tall; --source-units "
             "says another",
             unit, stature_cm)});
    return std::string(unit);
  }
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format(
           "lengths are read as cm, though the figure is then {:.4g} cm tall: in no unit is "
           "it human; --source-units says another",
           stature)});
  return "cm";
}

}  // namespace kinebase::internal
