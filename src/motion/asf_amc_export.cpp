// The way back: a Skeleton as an ASF record, a Motion as an AMC record.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/core/units.h"
#include "kinebase/motion/asf_amc_motion.h"
#include "kinebase/motion/kinematics.h"
#include "motion/point_writing.h"

namespace kinebase {
namespace {

constexpr double kWrittenLengthUnit = 0.45;  // What HDM05 and CMU have; every reader knows it.
constexpr double kWrittenCmPerUnit = kCentimetresPerInch / kWrittenLengthUnit;
constexpr double kNoticeableAngle = 1e-6;  // rad; far below what any recording resolves.

// What the translational DOFs of the root must hold, cm; 0 for its rotations.
Eigen::VectorXd RootOffsets(const Motion& motion, int frame) {
  const auto& dofs = motion.skeleton->joints().front().dofs;
  const Eigen::Vector3d translation = motion.root_position_cm[static_cast<std::size_t>(frame)] -
                                      motion.skeleton->root_position_cm();
  Eigen::VectorXd offsets = Eigen::VectorXd::Zero(std::ssize(dofs));
  for (Eigen::Index i = 0; i < offsets.size(); ++i) {
    const Dof dof = dofs[static_cast<std::size_t>(i)];
    if (!IsRotation(dof) && dof != Dof::kLength) offsets[i] = translation[AxisOf(dof)];
  }
  return offsets;
}

// The same for a bone. Its extra offset is the sum of its DOFs, each times what one unit of it
// does; where several could do the work they share it.
Eigen::VectorXd BoneOffsets(const Motion& motion, int frame, int joint) {
  const Skeleton& skeleton = *motion.skeleton;
  const Joint& bone = skeleton.joints()[static_cast<std::size_t>(joint)];
  if (motion.extra_offsets_cm.empty()) return Eigen::VectorXd::Zero(std::ssize(bone.dofs));
  const Eigen::Quaterniond into_bone =
      motion.rotation(frame, joint).conjugate() * skeleton.axis(joint);
  Eigen::MatrixXd effects = Eigen::MatrixXd::Zero(3, std::ssize(bone.dofs));
  for (Eigen::Index i = 0; i < effects.cols(); ++i) {
    const Dof dof = bone.dofs[static_cast<std::size_t>(i)];
    if (dof == Dof::kLength) {
      effects.col(i) = bone.direction;
    } else if (!IsRotation(dof)) {
      effects.col(i) = into_bone * Eigen::Vector3d::Unit(AxisOf(dof));
    }
  }
  const auto row = static_cast<std::size_t>(frame) * skeleton.joints().size();
  return effects.completeOrthogonalDecomposition().solve(
      motion.extra_offsets_cm[row + static_cast<std::size_t>(joint)]);
}

// Writes the values of an AMC line, in degrees and file units.
void WriteDofs(const Motion& motion, int frame, int joint, const Eigen::Vector3d& angles_rad,
               double* values) {
  const auto& dofs = motion.skeleton->joints()[static_cast<std::size_t>(joint)].dofs;
  const Eigen::VectorXd offsets =
      joint == 0 ? RootOffsets(motion, frame) : BoneOffsets(motion, frame, joint);
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    values[i] = IsRotation(dofs[i]) ? angles_rad[AxisOf(dofs[i])] / kRadiansPerDegree
                                    : offsets[static_cast<Eigen::Index>(i)] / kWrittenCmPerUnit;
  }
}

// The largest angle of `angles` that the joint's DOFs cannot hold.
double LostAngle(const Joint& joint, const Eigen::Vector3d& angles_rad) {
  double lost = 0;
  for (const Dof dof : {Dof::kRx, Dof::kRy, Dof::kRz}) {
    if (std::ranges::find(joint.dofs, dof) == joint.dofs.end()) {
      lost = std::max(lost, std::abs(angles_rad[AxisOf(dof)]));
    }
  }
  return lost;
}

std::array<double, 3> ToArray(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::vector<AsfDof> ToAsfDofs(const std::vector<Dof>& dofs) {
  std::vector<AsfDof> result;
  result.reserve(dofs.size());
  for (const Dof dof : dofs) result.push_back(static_cast<AsfDof>(dof));
  return result;
}

// Bones as the files can name them: one word, no comment and no keyword, none twice.
// diagnostics  Those that change.
std::vector<std::string> WritableNames(const Skeleton& skeleton, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const Joint& joint : skeleton.joints()) {
    const std::string& name = joint.bone_name;
    const bool is_keyword = name.starts_with(':') || EqualsIgnoringCase(name, "begin") ||
                            EqualsIgnoringCase(name, "end");
    names.push_back(is_keyword ? "_" + name : name);
  }
  return internal::WritableLabels(names, " #", '_', diagnostics);
}

AsfBone ToAsfBone(const Joint& joint, int id, const std::string& name) {
  AsfBone bone{.id = id,
               .name = name,
               .direction = ToArray(joint.direction),
               .length = joint.length_cm / kWrittenCmPerUnit,
               .axis = ToArray(joint.axis_rad / kRadiansPerDegree),
               .axis_order = std::string(ToString(joint.euler_order)),
               .dofs = ToAsfDofs(joint.dofs)};
  for (std::size_t d = 0; d < joint.limits.size(); ++d) {
    const double unit = IsRotation(joint.dofs[d]) ? kRadiansPerDegree : kWrittenCmPerUnit;
    bone.limits.push_back({joint.limits[d].low / unit, joint.limits[d].high / unit});
  }
  return bone;
}

}  // namespace

AsfSkeleton ToAsf(const Skeleton& skeleton) {
  const SkeletonSource& source = skeleton.source();
  const Joint& root = skeleton.joints().front();
  AsfSkeleton asf{.version = "1.10",
                  .name = source.name.empty() ? "KINEBASE" : source.name,
                  .mass_unit = source.mass_unit.value_or(1),
                  .length_unit = kWrittenLengthUnit,
                  .documentation = source.documentation,
                  .root_order = ToAsfDofs(root.dofs),
                  .root_axis = std::string(ToString(root.euler_order)),
                  .root_position = ToArray(skeleton.root_position_cm() / kWrittenCmPerUnit),
                  .root_orientation = ToArray(skeleton.root_orientation_rad() / kRadiansPerDegree)};
  Diagnostics ignored;  // ToAmc says them.
  const std::vector<std::string> names = WritableNames(skeleton, ignored);
  for (int i = 0; i < skeleton.joint_count(); ++i) {
    const auto bone = static_cast<std::size_t>(i);
    if (i > 0) asf.bones.push_back(ToAsfBone(skeleton.joints()[bone], i, names[bone]));
    if (skeleton.children(i).empty()) continue;
    AsfSkeleton::Family family{.parent = names[bone]};
    for (const int child : skeleton.children(i)) {
      family.children.push_back(names[static_cast<std::size_t>(child)]);
    }
    asf.hierarchy.push_back(std::move(family));
  }
  return asf;
}

AmcMotion ToAmc(const Motion& motion, Diagnostics& diagnostics) {
  const Skeleton& skeleton = *motion.skeleton;
  // The format has no field for the rate; this comment is what other writers leave, and we read.
  AmcMotion amc{
      .header = {"# " + ToShortestText(motion.rate_hz) + " fps", ":FULLY-SPECIFIED", ":DEGREES"},
      .angle_unit = AmcAngleUnit::kDegrees};
  const std::vector<std::string> names = WritableNames(skeleton, diagnostics);
  for (const int joint : skeleton.animated()) {
    const auto bone = static_cast<std::size_t>(joint);
    const std::size_t dofs = skeleton.joints()[bone].dofs.size();
    amc.bones.push_back({names[bone], amc.column_count, dofs});
    amc.column_count += dofs;
  }
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    amc.frame_numbers.push_back(motion.first_frame + frame);
  }
  amc.values.resize(amc.column_count * amc.frame_count());
  std::string lossy;
  std::size_t first_column = 0;  // Of the joint's values; joints without DOFs have none.
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    const Joint& bone = skeleton.joints()[static_cast<std::size_t>(joint)];
    const std::vector<Eigen::Vector3d> angles = EulerAngles(motion, joint);
    double lost = 0;
    for (std::size_t frame = 0; frame < angles.size(); ++frame) {
      lost = std::max(lost, LostAngle(bone, angles[frame]));
      WriteDofs(motion, static_cast<int>(frame), joint, angles[frame],
                amc.values.data() + frame * amc.column_count + first_column);
    }
    first_column += bone.dofs.size();
    if (lost > kNoticeableAngle) {
      lossy += fmt::format("{}{} ({:.2f}°)", lossy.empty() ? "" : ", ", bone.bone_name,
                           lost / kRadiansPerDegree);
    }
  }
  if (!lossy.empty()) {
    diagnostics.push_back(
        {Severity::kWarning,
         "rotations that the bones' degrees of freedom cannot hold are left out: " + lossy});
  }
  return amc;
}

}  // namespace kinebase
