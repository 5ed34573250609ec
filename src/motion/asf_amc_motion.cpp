#include "kinebase/motion/asf_amc_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"

namespace kinebase {
namespace {

constexpr double kCentimetresPerInch = 2.54;
constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr double kSmallestStatureCm = 120;
constexpr double kLargestStatureCm = 220;
constexpr double kWrittenLengthUnit = 0.45;  // What HDM05 and CMU have; every reader knows it.

using BonesByName = std::map<std::string, const AsfBone*>;

EulerOrder OrderOrFail(const std::string& text, const std::string& where) {
  if (const auto order = ParseEulerOrder(text)) return *order;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("{}: '{}' is no Euler order; expected one such as XYZ", where, text));
}

std::vector<Dof> ToDofs(const std::vector<AsfDof>& dofs) {
  std::vector<Dof> result;
  for (const AsfDof dof : dofs) result.push_back(static_cast<Dof>(dof));
  return result;
}

bool IsRotation(Dof dof) { return dof == Dof::kRx || dof == Dof::kRy || dof == Dof::kRz; }
int AxisOf(Dof dof) { return static_cast<int>(dof) % 3; }  // Not for kLength.

// Height of the figure in its neutral pose, in file units.
double NeutralHeight(const AsfSkeleton& asf) {
  BonesByName bones;
  for (const auto& bone : asf.bones) bones[bone.name] = &bone;
  std::map<std::string, double> height = {{"root", 0.0}};
  double low = 0;
  double high = 0;
  for (const auto& family : asf.hierarchy) {
    for (const auto& child : family.children) {
      const AsfBone& bone = *bones.at(child);
      const Eigen::Vector3d direction = Eigen::Vector3d(bone.direction.data()).normalized();
      const double y = height[family.parent] + direction.y() * bone.length;
      height[child] = y;
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  return high - low;
}

bool IsHumanStature(double stature_cm) {
  return stature_cm >= kSmallestStatureCm && stature_cm <= kLargestStatureCm;
}

class SkeletonBuilder {
 public:
  SkeletonBuilder(const AsfSkeleton& asf, double cm_per_unit, Diagnostics& diagnostics)
      : asf_(asf), cm_per_unit_(cm_per_unit), diagnostics_(diagnostics) {
    for (const auto& bone : asf.bones) bones_[bone.name] = &bone;
    for (const auto& family : asf.hierarchy) {
      auto& children = children_[family.parent];
      children.insert(children.end(), family.children.begin(), family.children.end());
    }
  }

  std::vector<Joint> Build() {
    Joint root{.name = "root", .bone_name = "root"};
    root.euler_order = OrderOrFail(asf_.root_axis, "':root axis'");
    root.dofs = ToDofs(asf_.root_order);
    joints_.push_back(std::move(root));
    AddChildren(0);
    return std::move(joints_);
  }

 private:
  // Depth first. A stack of its own: a file may nest deeper than the program's stack allows.
  void AddChildren(int root) {
    std::vector<std::pair<int, std::string>> open;
    const auto push = [&](int parent) {
      const auto found = children_.find(joints_[static_cast<std::size_t>(parent)].bone_name);
      if (found == children_.end()) return;
      for (auto child = found->second.rbegin(); child != found->second.rend(); ++child) {
        open.emplace_back(parent, *child);
      }
    };
    push(root);
    while (!open.empty()) {
      const auto [parent, name] = std::move(open.back());
      open.pop_back();
      joints_.push_back(MakeJoint(*bones_.at(name), parent));
      push(static_cast<int>(joints_.size()) - 1);
    }
  }

  Joint MakeJoint(const AsfBone& bone, int parent) {
    const double to_rad = asf_.angle_is_degrees ? kRadiansPerDegree : 1;
    Joint joint;
    joint.bone_name = bone.name;
    joint.name = joints_[static_cast<std::size_t>(parent)].bone_name + "_@_" + bone.name;
    joint.parent = parent;
    joint.direction = Eigen::Vector3d(bone.direction.data()).normalized();
    joint.length_cm = bone.length * cm_per_unit_;
    joint.offset_cm = joint.direction * joint.length_cm;
    joint.axis_rad = Eigen::Vector3d(bone.axis.data()) * to_rad;
    joint.euler_order = OrderOrFail(bone.axis_order, fmt::format("bone '{}'", bone.name));
    joint.dofs = ToDofs(bone.dofs);
    if (bone.limits.size() == bone.dofs.size()) {
      for (std::size_t i = 0; i < bone.limits.size(); ++i) {
        const double unit = IsRotation(joint.dofs[i]) ? to_rad : cm_per_unit_;
        joint.limits.push_back({bone.limits[i].low * unit, bone.limits[i].high * unit});
      }
    } else if (!bone.limits.empty()) {
      diagnostics_.push_back(
          {Severity::kWarning,
           fmt::format("bone '{}' has {} limits for {} degrees of freedom; they are left out",
                       bone.name, bone.limits.size(), bone.dofs.size()),
           bone.line});
    }
    return joint;
  }

  const AsfSkeleton& asf_;
  double cm_per_unit_;
  Diagnostics& diagnostics_;
  BonesByName bones_;
  std::map<std::string, std::vector<std::string>> children_;
  std::vector<Joint> joints_;
};

// Which joint and DOFs the columns of one AMC bone belong to.
struct BoneColumns {
  int joint = 0;
  std::size_t first_column = 0;
  std::vector<Dof> dofs;
};

// The DOFs of a file whose bones all have three values: the skeleton's own first, in their order,
// then the rotations that the skeleton lacks. Seen in a file next to the one it was made from.
std::vector<Dof> ThreeDofs(std::vector<Dof> dofs) {
  for (const Dof dof : {Dof::kRx, Dof::kRy, Dof::kRz}) {
    if (std::ranges::find(dofs, dof) == dofs.end()) dofs.push_back(dof);
  }
  return dofs;
}

std::string DofList(const std::vector<Dof>& dofs) {
  std::string text;
  for (const Dof dof : dofs)
    text.append(text.empty() ? "" : " ").append(ToString(static_cast<AsfDof>(dof)));
  return text.empty() ? "none" : text;
}

std::vector<BoneColumns> MatchColumns(const AmcMotion& amc, const Skeleton& skeleton,
                                      Diagnostics& diagnostics) {
  std::vector<BoneColumns> columns;
  std::vector<bool> moved(skeleton.joints().size(), false);
  for (const AmcBone& bone : amc.bones) {
    const auto joint = skeleton.FindBone(bone.name);
    if (!joint) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("bone '{}' is not in the skeleton {}; name the right one with "
                              "--skeleton",
                              bone.name, skeleton.source().file_name),
                  {.line = bone.line});
    }
    std::vector<Dof> dofs = skeleton.joints()[static_cast<std::size_t>(*joint)].dofs;
    if (amc.all_bones_have_three_dofs && *joint != 0) dofs = ThreeDofs(std::move(dofs));
    if (bone.column_count != dofs.size()) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("bone '{}' has {} values, but {} degrees of freedom ({}) in the "
                              "skeleton {}; name the right one with --skeleton",
                              bone.name, bone.column_count, dofs.size(), DofList(dofs),
                              skeleton.source().file_name),
                  {.line = bone.line});
    }
    moved[static_cast<std::size_t>(*joint)] = true;
    columns.push_back({*joint, bone.first_column, std::move(dofs)});
  }
  std::string still;
  for (const int joint : skeleton.animated()) {
    if (moved[static_cast<std::size_t>(joint)]) continue;
    still +=
        (still.empty() ? "" : ", ") + skeleton.joints()[static_cast<std::size_t>(joint)].bone_name;
  }
  if (!still.empty()) {
    diagnostics.push_back(
        {Severity::kWarning, "bones without values stay in the neutral pose: " + still});
  }
  return columns;
}

// Values with the missing ones replaced by those of the frame before (or, at the start, by the
// first that there is).
std::vector<double> FillMissing(const AmcMotion& amc, Diagnostics& diagnostics) {
  std::vector<double> values = amc.values;
  std::size_t missing = 0;
  for (std::size_t column = 0; column < amc.column_count; ++column) {
    double last = 0;
    for (std::size_t i = column; i < values.size(); i += amc.column_count) {
      if (!std::isfinite(values[i])) continue;
      last = values[i];
      break;
    }
    for (std::size_t i = column; i < values.size(); i += amc.column_count) {
      if (!std::isfinite(values[i])) {
        values[i] = last;
        ++missing;
      }
      last = values[i];
    }
  }
  if (missing > 0) {
    diagnostics.push_back(
        {Severity::kWarning,
         fmt::format("{} missing values are replaced by those of the frame before", missing)});
  }
  return values;
}

// What one line of an AMC frame says about its joint, in rad and cm.
struct DofValues {
  Eigen::Vector3d angles_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation_cm = Eigen::Vector3d::Zero();
  double length_cm = 0;
};

DofValues ReadDofs(const BoneColumns& bone, const double* frame, double to_rad, double to_cm) {
  DofValues result;
  for (std::size_t i = 0; i < bone.dofs.size(); ++i) {
    const double value = frame[bone.first_column + i];
    const Dof dof = bone.dofs[i];
    if (dof == Dof::kLength) {
      result.length_cm = value * to_cm;
    } else if (IsRotation(dof)) {
      result.angles_rad[AxisOf(dof)] = value * to_rad;
    } else {
      result.translation_cm[AxisOf(dof)] = value * to_cm;
    }
  }
  return result;
}

// Sets one joint in one frame from what its line says.
void ApplyDofs(const DofValues& values, int joint, int frame, Motion& motion) {
  const Skeleton& skeleton = *motion.skeleton;
  const auto row = static_cast<std::size_t>(frame) * skeleton.joints().size();
  const Joint& bone = skeleton.joints()[static_cast<std::size_t>(joint)];
  const Eigen::Quaterniond own = EulerToQuaternion(values.angles_rad, bone.euler_order);
  const Eigen::Quaterniond& axis = skeleton.axis(joint);
  const Eigen::Quaterniond local = axis * own * axis.conjugate();
  motion.rotations[row + joint] = local;
  if (joint == 0) {
    motion.root_position_cm[static_cast<std::size_t>(frame)] += values.translation_cm;
  } else if (!motion.extra_offsets_cm.empty()) {
    motion.extra_offsets_cm[row + joint] =
        bone.direction * values.length_cm + local.conjugate() * (axis * values.translation_cm);
  }
}

bool HasTranslation(const BoneColumns& bone) {
  return bone.joint != 0 && !std::ranges::all_of(bone.dofs, IsRotation);
}

// Values of an AMC line for a joint's DOFs, degrees and file units.
std::vector<double> WriteDofs(const Motion& motion, int frame, int joint,
                              const Eigen::Vector3d& angles_rad, double cm_per_unit) {
  const Skeleton& skeleton = *motion.skeleton;
  const Joint& bone = skeleton.joints()[static_cast<std::size_t>(joint)];
  const auto dof_count = static_cast<Eigen::Index>(bone.dofs.size());
  Eigen::VectorXd offsets = Eigen::VectorXd::Zero(dof_count);
  if (joint == 0) {
    const Eigen::Vector3d translation =
        motion.root_position_cm[static_cast<std::size_t>(frame)] - skeleton.root_position_cm();
    for (Eigen::Index i = 0; i < dof_count; ++i) {
      if (!IsRotation(bone.dofs[i]) && bone.dofs[i] != Dof::kLength) {
        offsets[i] = translation[AxisOf(bone.dofs[i])];
      }
    }
  } else if (!motion.extra_offsets_cm.empty()) {
    // extra offset = Σ dof · what one unit of it does; several DOFs may share the work.
    const Eigen::Quaterniond into_bone =
        motion.rotation(frame, joint).conjugate() * skeleton.axis(joint);
    Eigen::MatrixXd effects = Eigen::MatrixXd::Zero(3, dof_count);
    for (Eigen::Index i = 0; i < dof_count; ++i) {
      if (bone.dofs[i] == Dof::kLength) {
        effects.col(i) = bone.direction;
      } else if (!IsRotation(bone.dofs[i])) {
        effects.col(i) = into_bone * Eigen::Vector3d::Unit(AxisOf(bone.dofs[i]));
      }
    }
    const auto row = static_cast<std::size_t>(frame) * skeleton.joints().size();
    offsets = effects.completeOrthogonalDecomposition().solve(motion.extra_offsets_cm[row + joint]);
  }
  std::vector<double> values;
  for (Eigen::Index i = 0; i < dof_count; ++i) {
    values.push_back(IsRotation(bone.dofs[i]) ? angles_rad[AxisOf(bone.dofs[i])] / kRadiansPerDegree
                                              : offsets[i] / cm_per_unit);
  }
  return values;
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

}  // namespace

double CentimetresPerUnit(const AsfSkeleton& asf, LengthReading reading) {
  const double unit = asf.length_unit.value_or(1);
  return reading == LengthReading::kMultiplyToCentimetres ? unit : kCentimetresPerInch / unit;
}

LengthReading ChooseLengthReading(const AsfSkeleton& asf, LengthReading wanted,
                                  Diagnostics& diagnostics) {
  if (wanted != LengthReading::kAuto || !asf.length_unit) {
    return wanted == LengthReading::kAuto ? LengthReading::kDivideToInches : wanted;
  }
  const double height = NeutralHeight(asf);
  const double inches = height * CentimetresPerUnit(asf, LengthReading::kDivideToInches);
  const double centimetres =
      height * CentimetresPerUnit(asf, LengthReading::kMultiplyToCentimetres);
  if (IsHumanStature(inches)) return LengthReading::kDivideToInches;
  if (IsHumanStature(centimetres)) {
    diagnostics.push_back(
        {Severity::kInfo,
         fmt::format("':units length' is read as a factor to centimetres, which gives a stature of "
                     "{:.0f} cm; as a divisor to inches it would be {:.0f} cm",
                     centimetres, inches)});
    return LengthReading::kMultiplyToCentimetres;
  }
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format("the figure is {:.0f} cm tall with ':units length' read as a divisor to inches, "
                   "{:.0f} cm as a factor to centimetres; neither is human, inches are taken",
                   inches, centimetres)});
  return LengthReading::kDivideToInches;
}

std::shared_ptr<const Skeleton> BuildSkeleton(const AsfSkeleton& asf,
                                              const AsfBuildOptions& options,
                                              Diagnostics& diagnostics) {
  const LengthReading reading = ChooseLengthReading(asf, options.length_reading, diagnostics);
  const double cm_per_unit = CentimetresPerUnit(asf, reading);
  SkeletonSource source{.file_name = asf.file_name,
                        .file_type = "ASF",
                        .name = asf.name,
                        .version = asf.version,
                        .mass_unit = asf.mass_unit,
                        .length_unit = asf.length_unit,
                        .angle_is_degrees = asf.angle_is_degrees,
                        .documentation = asf.documentation};
  const double to_rad = asf.angle_is_degrees ? kRadiansPerDegree : 1;
  return std::make_shared<const Skeleton>(SkeletonBuilder(asf, cm_per_unit, diagnostics).Build(),
                                          std::move(source),
                                          Eigen::Vector3d(asf.root_position.data()) * cm_per_unit,
                                          Eigen::Vector3d(asf.root_orientation.data()) * to_rad);
}

Motion BuildMotion(const AmcMotion& amc, const AsfSkeleton& asf,
                   std::shared_ptr<const Skeleton> skeleton, double rate_hz,
                   const AsfBuildOptions& options, Diagnostics& diagnostics) {
  const std::vector<BoneColumns> columns = MatchColumns(amc, *skeleton, diagnostics);
  const std::vector<double> values = FillMissing(amc, diagnostics);
  Diagnostics said_before;  // BuildSkeleton has reported the reading.
  const double to_cm =
      CentimetresPerUnit(asf, ChooseLengthReading(asf, options.length_reading, said_before));
  const bool degrees = amc.angle_unit == AmcAngleUnit::kUnstated
                           ? asf.angle_is_degrees
                           : amc.angle_unit == AmcAngleUnit::kDegrees;
  const double to_rad = degrees ? kRadiansPerDegree : 1;

  Motion motion{.skeleton = std::move(skeleton),
                .rate_hz = rate_hz,
                .frame_count = static_cast<int>(amc.frame_count()),
                .first_frame = amc.frame_numbers.empty() ? 1 : amc.frame_numbers.front()};
  const std::size_t cells = amc.frame_count() * motion.skeleton->joints().size();
  motion.root_position_cm.assign(amc.frame_count(), motion.skeleton->root_position_cm());
  motion.rotations.assign(cells, Eigen::Quaterniond::Identity());
  if (std::ranges::any_of(columns, HasTranslation)) {
    motion.extra_offsets_cm.assign(cells, Eigen::Vector3d::Zero());
  }
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    const double* row = values.data() + static_cast<std::size_t>(frame) * amc.column_count;
    for (const BoneColumns& bone : columns) {
      ApplyDofs(ReadDofs(bone, row, to_rad, to_cm), bone.joint, frame, motion);
    }
  }
  return motion;
}

AsfSkeleton ToAsf(const Skeleton& skeleton) {
  const double cm_per_unit = kCentimetresPerInch / kWrittenLengthUnit;
  const auto to_array = [](const Eigen::Vector3d& v) { return std::array{v.x(), v.y(), v.z()}; };
  AsfSkeleton asf{.version = "1.10",
                  .name = skeleton.source().name.empty() ? "KINEBASE" : skeleton.source().name,
                  .mass_unit = skeleton.source().mass_unit.value_or(1),
                  .length_unit = kWrittenLengthUnit,
                  .documentation = skeleton.source().documentation};
  const Joint& root = skeleton.joints().front();
  for (const Dof dof : root.dofs) asf.root_order.push_back(static_cast<AsfDof>(dof));
  asf.root_axis = ToString(root.euler_order);
  asf.root_position = to_array(skeleton.root_position_cm() / cm_per_unit);
  asf.root_orientation = to_array(skeleton.root_orientation_rad() / kRadiansPerDegree);
  for (int i = 0; i < skeleton.joint_count(); ++i) {
    const Joint& joint = skeleton.joints()[static_cast<std::size_t>(i)];
    if (!skeleton.children(i).empty()) {
      AsfSkeleton::Family family{.parent = joint.bone_name};
      for (const int child : skeleton.children(i)) {
        family.children.push_back(skeleton.joints()[static_cast<std::size_t>(child)].bone_name);
      }
      asf.hierarchy.push_back(std::move(family));
    }
    if (i == 0) continue;
    AsfBone bone{.id = i,
                 .name = joint.bone_name,
                 .direction = to_array(joint.direction),
                 .length = joint.length_cm / cm_per_unit,
                 .axis = to_array(joint.axis_rad / kRadiansPerDegree),
                 .axis_order = std::string(ToString(joint.euler_order))};
    for (const Dof dof : joint.dofs) bone.dofs.push_back(static_cast<AsfDof>(dof));
    for (std::size_t d = 0; d < joint.limits.size(); ++d) {
      const double unit = IsRotation(joint.dofs[d]) ? kRadiansPerDegree : cm_per_unit;
      bone.limits.push_back({joint.limits[d].low / unit, joint.limits[d].high / unit});
    }
    asf.bones.push_back(std::move(bone));
  }
  return asf;
}

AmcMotion ToAmc(const Motion& motion, Diagnostics& diagnostics) {
  const Skeleton& skeleton = *motion.skeleton;
  const double cm_per_unit = kCentimetresPerInch / kWrittenLengthUnit;
  constexpr double kNoticeableAngle = 1e-6;  // rad; far below what any recording resolves.
  AmcMotion amc{.header = {":FULLY-SPECIFIED", ":DEGREES"}, .angle_unit = AmcAngleUnit::kDegrees};
  for (const int joint : skeleton.animated()) {
    const Joint& bone = skeleton.joints()[static_cast<std::size_t>(joint)];
    amc.bones.push_back({bone.bone_name, amc.column_count, bone.dofs.size()});
    amc.column_count += bone.dofs.size();
  }
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    amc.frame_numbers.push_back(motion.first_frame + frame);
  }
  amc.values.resize(amc.column_count * amc.frame_count());
  std::string lossy;
  std::size_t next_bone = 0;
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    const Joint& bone = skeleton.joints()[static_cast<std::size_t>(joint)];
    const std::vector<Eigen::Vector3d> angles = EulerAngles(motion, joint);
    double lost = 0;
    for (int frame = 0; frame < motion.frame_count; ++frame) {
      lost = std::max(lost, LostAngle(bone, angles[static_cast<std::size_t>(frame)]));
      if (bone.dofs.empty()) continue;
      const auto values =
          WriteDofs(motion, frame, joint, angles[static_cast<std::size_t>(frame)], cm_per_unit);
      std::ranges::copy(values, amc.values.begin() +
                                    static_cast<std::ptrdiff_t>(frame * amc.column_count +
                                                                amc.bones[next_bone].first_column));
    }
    if (!bone.dofs.empty()) ++next_bone;
    if (lost > kNoticeableAngle) {
      lossy += fmt::format("{}{} ({:.2f}°)", lossy.empty() ? "" : ", ", bone.bone_name,
                           lost / kRadiansPerDegree);
    }
  }
  if (!lossy.empty()) {
    diagnostics.push_back({Severity::kWarning,
                           "rotations that the bones' degrees of freedom cannot hold are left "
                           "out: " +
                               lossy});
  }
  return amc;
}

}  // namespace kinebase
