// A skeleton as arrays, one row a joint.

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/asf.h"
#include "motion/npz_arrays.h"

namespace kinebase::internal {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kDofKinds = 7;

std::string DofNames(const std::vector<Dof>& dofs) {
  std::string names;
  for (const Dof dof : dofs) {
    names.append(names.empty() ? "" : " ").append(ToLower(ToString(static_cast<AsfDof>(dof))));
  }
  return names;
}

std::vector<Dof> ParseDofs(const std::string& names, NpzSource& source) {
  std::vector<Dof> dofs;
  for (const std::string_view name : SplitTokens(names)) {
    std::size_t dof = 0;
    while (dof < kDofKinds && !EqualsIgnoringCase(name, ToString(static_cast<AsfDof>(dof)))) ++dof;
    if (dof == kDofKinds) {
      source.Fail(fmt::format("array 'dofs': {} is no degree of freedom; tx ty tz rx ry rz l are",
                              Quoted(name)));
    }
    dofs.push_back(static_cast<Dof>(dof));
  }
  return dofs;
}

// What one unit of a DOF's limit is inside: radians stay, lengths are scaled.
double LimitUnit(Dof dof, double unit_cm) { return IsRotation(dof) ? 1 : unit_cm; }

void AddLimits(const std::vector<Joint>& joints, double unit_cm, NpzTarget& target) {
  std::size_t most = 0;
  for (const Joint& joint : joints) most = std::max(most, joint.limits.size());
  std::vector<double> limits(joints.size() * most * 2, kNoLimit);
  std::vector<std::int32_t> counts;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    counts.push_back(static_cast<std::int32_t>(joints[j].limits.size()));
    for (std::size_t d = 0; d < joints[j].limits.size(); ++d) {
      double* const row = limits.data() + (j * most + d) * 2;
      const double unit = LimitUnit(joints[j].dofs[d], unit_cm);
      row[0] = joints[j].limits[d].low / unit;
      row[1] = joints[j].limits[d].high / unit;
    }
  }
  target.Add("limits", {joints.size(), most, 2}, std::move(limits));
  target.Add("limit_counts", {joints.size()}, std::move(counts));
}

void TakeLimits(NpzSource& source, double unit_cm, std::vector<Joint>& joints) {
  if (!source.Has("limits")) return;
  const NpzShape found = source.Need("limits").shape;
  const std::size_t most = found.size() == 3 ? found[1] : 0;
  const auto limits = source.Numbers("limits", {joints.size(), most, 2}, "bones × DOFs × 2");
  const auto counts = source.Integers("limit_counts", {joints.size()}, "bones");
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (counts[j] == 0) continue;
    const std::size_t dofs = joints[j].dofs.size();
    if (counts[j] != static_cast<std::int64_t>(dofs) || dofs > most) {
      source.Fail(
          fmt::format("array 'limit_counts': bone {} has {} limits for {} degrees of freedom",
                      Quoted(joints[j].bone_name), counts[j], dofs));
    }
    for (std::size_t d = 0; d < dofs; ++d) {
      const double* const row = limits.data() + (j * most + d) * 2;
      const double unit = LimitUnit(joints[j].dofs[d], unit_cm);
      joints[j].limits.push_back({row[0] * unit, row[1] * unit});
    }
  }
}

// One array for each property of the joints.
void AddJoints(const std::vector<Joint>& joints, double unit_cm, NpzTarget& target) {
  const NpzShape shape = {joints.size()};
  std::vector<std::string> names, bones, orders, dofs;
  std::vector<std::int32_t> parents;
  std::vector<double> lengths;
  std::vector<Eigen::Vector3d> offsets, directions, axes;
  for (const Joint& joint : joints) {
    names.push_back(joint.name);
    bones.push_back(joint.bone_name);
    orders.emplace_back(ToString(joint.euler_order));
    dofs.push_back(DofNames(joint.dofs));
    parents.push_back(joint.parent);
    lengths.push_back(joint.length_cm / unit_cm);
    offsets.push_back(joint.offset_cm);
    directions.push_back(joint.direction);
    axes.push_back(joint.axis_rad);
  }
  target.Add("bone_names", shape, std::move(bones));
  target.Add("joint_names", shape, std::move(names));
  target.Add("parents", shape, std::move(parents));
  target.AddVectors("offsets", shape, offsets, 1 / unit_cm);
  target.AddVectors("directions", shape, directions, 1);
  target.Add("lengths", shape, std::move(lengths));
  target.AddVectors("axis", shape, axes, 1);
  target.Add("euler_order", shape, std::move(orders));
  target.Add("dofs", shape, std::move(dofs));
  AddLimits(joints, unit_cm, target);
}

// Bones by name, parent and offset; the rest follows from these until it is told.
std::vector<Joint> TakeBones(NpzSource& source, double unit_cm) {
  const std::size_t count = source.Need("bone_names").size();
  const auto names = source.Texts("bone_names", {count}, "bones");
  const auto parents = source.Integers("parents", {count}, "bones");
  const auto offsets = source.Vectors("offsets", {count, 3}, "bones × 3");
  std::vector<Joint> joints(count);
  for (std::size_t j = 0; j < count; ++j) {
    Joint& joint = joints[j];
    const bool is_after_parent =
        j == 0 ? parents[j] == -1 : parents[j] >= 0 && parents[j] < static_cast<std::int64_t>(j);
    if (!is_after_parent || !offsets[j].allFinite()) {
      source.Fail(
          fmt::format("bone {} has the parent {} and the offset ({}, {}, {}); parents come "
                      "first, by their 0-based index, and the first bone alone has -1",
                      j, parents[j], offsets[j].x(), offsets[j].y(), offsets[j].z()));
    }
    joint.bone_name = names[j];
    joint.parent = static_cast<int>(parents[j]);
    joint.name = j == 0 ? names[j] : names[static_cast<std::size_t>(parents[j])] + "_@_" + names[j];
    joint.offset_cm = offsets[j] * unit_cm;
    joint.length_cm = joint.offset_cm.norm();
    if (joint.length_cm > 0) joint.direction = joint.offset_cm / joint.length_cm;
    joint.dofs = {Dof::kRx, Dof::kRy, Dof::kRz};
    if (j == 0) joint.dofs.insert(joint.dofs.begin(), {Dof::kTx, Dof::kTy, Dof::kTz});
  }
  return joints;
}

void TakeDetails(NpzSource& source, double unit_cm, std::vector<Joint>& joints) {
  const std::size_t count = joints.size();
  const auto for_each = [&](const auto& values, auto assign) {
    for (std::size_t j = 0; j < count; ++j) assign(joints[j], values[j]);
  };
  if (source.Has("joint_names")) {
    for_each(source.Texts("joint_names", {count}, "bones"),
             [](Joint& joint, const std::string& name) { joint.name = name; });
  }
  if (source.Has("directions")) {
    for_each(source.Vectors("directions", {count, 3}, "bones × 3"),
             [](Joint& joint, const Eigen::Vector3d& v) { joint.direction = v; });
  }
  if (source.Has("lengths")) {
    for_each(source.Numbers("lengths", {count}, "bones"),
             [&](Joint& joint, double length) { joint.length_cm = length * unit_cm; });
  }
  if (source.Has("axis")) {
    for_each(source.Vectors("axis", {count, 3}, "bones × 3"),
             [](Joint& joint, const Eigen::Vector3d& v) { joint.axis_rad = v; });
  }
  if (source.Has("euler_order")) {
    for_each(
        source.Texts("euler_order", {count}, "bones"), [&](Joint& joint, const std::string& text) {
          const auto order = ParseEulerOrder(text);
          if (!order) {
            source.Fail(
                fmt::format("array 'euler_order': {} is no Euler order such as XYZ", Quoted(text)));
          }
          joint.euler_order = *order;
        });
  }
  if (source.Has("dofs")) {
    for_each(source.Texts("dofs", {count}, "bones"), [&](Joint& joint, const std::string& names) {
      joint.dofs = ParseDofs(names, source);
    });
  }
  TakeLimits(source, unit_cm, joints);
}

void AddSource(const SkeletonSource& source, NpzTarget& target) {
  target.Add("skeleton_file", source.file_name);
  target.Add("skeleton_type", source.file_type);
  target.Add("skeleton_name", source.name);
  target.Add("skeleton_version", source.version);
  if (source.mass_unit) target.Add("skeleton_mass_unit", *source.mass_unit);
  if (source.length_unit) target.Add("skeleton_length_unit", *source.length_unit);
  target.Add("skeleton_angle_is_degrees", {}, std::vector<bool>{source.angle_is_degrees});
  target.Add("skeleton_documentation", {source.documentation.size()}, source.documentation);
}

SkeletonSource TakeSource(NpzSource& source) {
  const auto text = [&](std::string_view name) {
    return source.Has(name) ? source.Text(name) : std::string();
  };
  SkeletonSource result{.file_name = text("skeleton_file"),
                        .file_type = text("skeleton_type"),
                        .name = text("skeleton_name"),
                        .version = text("skeleton_version")};
  if (source.Has("skeleton_mass_unit")) result.mass_unit = source.Number("skeleton_mass_unit");
  if (source.Has("skeleton_length_unit")) {
    result.length_unit = source.Number("skeleton_length_unit");
  }
  if (source.Has("skeleton_angle_is_degrees")) {
    result.angle_is_degrees = source.Number("skeleton_angle_is_degrees") != 0;
  }
  if (source.Has("skeleton_documentation")) {
    const std::size_t lines = source.Need("skeleton_documentation").size();
    result.documentation = source.Texts("skeleton_documentation", {lines}, "lines");
  }
  return result;
}

// Which joints stand for the standard ones, 0-based; -1 = none.
void AddNameMap(const Skeleton::NameMap& map, NpzTarget& target) {
  std::vector<std::int32_t> rotations, trajectories;
  for (const NameMapEntry& entry : map) {
    rotations.push_back(entry.rotation_joint);
    trajectories.push_back(entry.trajectory_joint);
  }
  target.Add("standard_rotation", {map.size()}, std::move(rotations));
  target.Add("standard_trajectory", {map.size()}, std::move(trajectories));
}

std::optional<Skeleton::NameMap> TakeNameMap(NpzSource& source, std::size_t joint_count) {
  if (!source.Has("standard_trajectory")) return std::nullopt;
  Skeleton::NameMap map;
  const auto rotations = source.Integers("standard_rotation", {map.size()}, "standard joints");
  const auto trajectories = source.Integers("standard_trajectory", {map.size()}, "standard joints");
  const auto is_joint = [&](std::int64_t index) {
    return index >= -1 && index < static_cast<std::int64_t>(joint_count);
  };
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!is_joint(rotations[i]) || !is_joint(trajectories[i])) {
      source.Fail(fmt::format("standard joint {} points to the bones {} and {}; there are {}",
                              ToString(static_cast<StandardJoint>(i)), rotations[i],
                              trajectories[i], joint_count));
    }
    map[i] = {static_cast<int>(rotations[i]), static_cast<int>(trajectories[i])};
  }
  return map;
}

}  // namespace

void AddSkeleton(const Skeleton& skeleton, double unit_cm, NpzTarget& target) {
  AddJoints(skeleton.joints(), unit_cm, target);
  target.AddVectors("skeleton_position", {}, {skeleton.root_position_cm()}, 1 / unit_cm);
  target.AddVectors("skeleton_orientation", {}, {skeleton.root_orientation_rad()}, 1);
  AddNameMap(skeleton.name_map(), target);
  AddSource(skeleton.source(), target);
}

std::shared_ptr<const Skeleton> TakeSkeleton(NpzSource& source, double unit_cm) {
  std::vector<Joint> joints = TakeBones(source, unit_cm);
  TakeDetails(source, unit_cm, joints);
  const auto vector = [&](std::string_view name) -> Eigen::Vector3d {
    if (!source.Has(name)) return Eigen::Vector3d::Zero();
    return source.Vectors(name, {3}, "x, y and z").front();
  };
  const Eigen::Vector3d position = vector("skeleton_position") * unit_cm;
  const Eigen::Vector3d orientation = vector("skeleton_orientation");
  const auto name_map = TakeNameMap(source, joints.size());
  try {
    return std::make_shared<Skeleton>(std::move(joints), TakeSource(source), position, orientation,
                                      name_map);
  } catch (const Error& error) {
    source.Fail("the bones make no skeleton: " + error.message());
  }
}

}  // namespace kinebase::internal
