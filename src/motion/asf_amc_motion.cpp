#include "kinebase/motion/asf_amc_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <ranges>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/units.h"
#include "kinebase/motion/rig_mapping.h"
#include "motion/name_map.h"

namespace kinebase {
namespace {

constexpr double kSmallestStatureCm = 120;
constexpr double kLargestStatureCm = 220;

using BonesByName = std::map<std::string, const AsfBone*>;

EulerOrder OrderOrFail(const std::string& text, const std::string& where) {
  if (const auto order = ParseEulerOrder(text)) return *order;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("{}: '{}' is no Euler order; expected one such as XYZ", where, text));
}

std::vector<Dof> ToDofs(const std::vector<AsfDof>& dofs) {
  std::vector<Dof> result;
  result.reserve(dofs.size());
  for (const AsfDof dof : dofs) result.push_back(static_cast<Dof>(dof));
  return result;
}

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
      // The last pushed is taken first.
      for (const std::string& child : std::views::reverse(found->second)) {
        open.emplace_back(parent, child);
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
    if (moved[static_cast<std::size_t>(*joint)]) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("bone '{}' stands for the same bone of the skeleton {} as one before",
                              bone.name, skeleton.source().file_name),
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

// Values without gaps. A motion has a pose in every frame, so what is missing is taken from the
// frame before; at the start of a take from the first frame that has it; a value that no frame has
// is 0, the neutral pose. Each is said.
std::vector<double> FillMissing(const AmcMotion& amc, Diagnostics& diagnostics) {
  std::vector<double> values = amc.values;
  std::size_t missing = 0;
  std::string never_given;
  for (const AmcBone& bone : amc.bones) {
    bool is_given = true;
    for (std::size_t c = bone.first_column; c < bone.first_column + bone.column_count; ++c) {
      std::size_t known = c;
      while (known < values.size() && !std::isfinite(values[known])) known += amc.column_count;
      is_given = is_given && known < values.size();
      double last = known < values.size() ? values[known] : 0;
      for (std::size_t i = c; i < values.size(); i += amc.column_count) {
        if (!std::isfinite(values[i])) {
          values[i] = last;
          ++missing;
        }
        last = values[i];
      }
    }
    if (!is_given) never_given += (never_given.empty() ? "" : ", ") + bone.name;
  }
  if (missing > 0) {
    diagnostics.push_back(
        {Severity::kWarning,
         fmt::format("{} missing values are replaced by those of the frame before, at the start by "
                     "the first that there are",
                     missing)});
  }
  if (!never_given.empty()) {
    diagnostics.push_back(
        {Severity::kWarning,
         "bones with a value that no frame has; it stays as in the neutral pose: " + never_given});
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

// Where bones have other names than in HDM05 and CMU (as in a skeleton that came from BVH), the
// shape of the tree tells the standard joints; empty where it does not, either.
std::optional<Skeleton::NameMap> MapOtherNames(std::span<const Joint> joints,
                                               Diagnostics& diagnostics) {
  if (internal::NamesStandardJoints(joints)) return std::nullopt;
  const RigMapping mapping = MapRigByTopology(joints);
  const auto knee = static_cast<std::size_t>(StandardJoint::kLknee);
  if (mapping.sources[knee].match != JointMatch::kTopology) return std::nullopt;
  diagnostics.push_back({Severity::kInfo,
                         "few bones have names that are known; the standard joints are told by the "
                         "shape of the skeleton"});
  return mapping.name_map;
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
  std::vector<Joint> joints = SkeletonBuilder(asf, cm_per_unit, diagnostics).Build();
  const auto name_map = MapOtherNames(joints, diagnostics);
  return std::make_shared<const Skeleton>(
      std::move(joints), std::move(source), Eigen::Vector3d(asf.root_position.data()) * cm_per_unit,
      Eigen::Vector3d(asf.root_orientation.data()) * to_rad, name_map);
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

}  // namespace kinebase
