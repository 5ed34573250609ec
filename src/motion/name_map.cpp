#include "motion/name_map.h"

#include <algorithm>

#include "kinebase/core/csv.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase::internal {

std::string_view EmbeddedData_asf();

namespace {

const CsvTable& NameMapTable() {
  static const CsvTable table = ParseCsv(EmbeddedData_asf(), "asf.csv");
  return table;
}

int FindBone(std::span<const Joint> joints, std::string_view name) {
  const auto found = std::ranges::find_if(
      joints, [&](const Joint& joint) { return EqualsIgnoringCase(joint.bone_name, name); });
  return name.empty() || found == joints.end() ? -1 : static_cast<int>(found - joints.begin());
}

}  // namespace

std::array<NameMapEntry, kStandardJointCount> BuildNameMap(std::span<const Joint> joints) {
  const CsvTable& table = NameMapTable();
  const std::size_t joint_column = table.Column("joint");
  const std::size_t trajectory_column = table.Column("trajectory_bone");
  const std::size_t rotation_column = table.Column("rotation_bone");
  std::array<NameMapEntry, kStandardJointCount> map{};
  for (const auto& row : table.rows) {
    const auto joint = ParseStandardJoint(row[joint_column]);
    if (!joint) continue;
    map[static_cast<std::size_t>(*joint)] = {
        .rotation_joint = FindBone(joints, row[rotation_column]),
        .trajectory_joint = FindBone(joints, row[trajectory_column])};
  }
  return map;
}

bool NamesStandardJoints(std::span<const Joint> joints) {
  const auto named = std::ranges::count_if(
      BuildNameMap(joints), [](const NameMapEntry& entry) { return entry.trajectory_joint > 0; });
  return named * 2 >= kStandardJointCount - 1;  // The root is always there.
}

std::string TrajectoryBoneName(StandardJoint joint) {
  const CsvTable& table = NameMapTable();
  for (const auto& row : table.rows) {
    if (row[table.Column("joint")] == ToString(joint)) return row[table.Column("trajectory_bone")];
  }
  return std::string(ToString(joint));
}

}  // namespace kinebase::internal
