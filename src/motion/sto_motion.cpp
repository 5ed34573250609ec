#include "kinebase/motion/sto_motion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kinebase/core/text_scanner.h"
#include "kinebase/core/units.h"
#include "kinebase/motion/kinematics.h"
#include "motion/point_writing.h"
#include "motion/sto_columns.h"

namespace kinebase {
namespace {

constexpr double kMetresPerCm = .01;
constexpr double kNoticeableAngle = 1e-6;   // rad; far below what any recording resolves.
constexpr double kNoticeableOffset = 1e-9;  // cm

double TimeOf(const Motion& motion, int frame) {
  return static_cast<double>(motion.first_frame + frame - 1) / motion.rate_hz;
}

std::string ColumnName(const Joint& joint, char kind, int axis) {
  return joint.bone_name + '_' + kind + "xyz"[axis];
}

// The axes about which a joint turns, those of its DOFs first.
std::vector<int> TurningAxes(const Joint& joint, const std::vector<Eigen::Vector3d>& angles_rad) {
  std::vector<int> axes;
  for (const Dof dof : joint.dofs) {
    if (IsRotation(dof)) axes.push_back(AxisOf(dof));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const bool turns = joint.parent < 0 || std::ranges::any_of(angles_rad, [&](const auto& each) {
                         return std::abs(each[axis]) > kNoticeableAngle;
                       });
    if (turns && std::ranges::find(axes, axis) == axes.end()) axes.push_back(axis);
  }
  return axes;
}

void AddOffsets(const Motion& motion, int joint, std::vector<internal::StoColumn>& columns) {
  if (motion.extra_offsets_cm.empty()) return;
  const auto offset = [&](int frame) -> const Eigen::Vector3d& {
    return motion.extra_offsets_cm[static_cast<std::size_t>(frame) * motion.joint_count() + joint];
  };
  double largest = 0;
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    largest = std::max(largest, offset(frame).cwiseAbs().maxCoeff());
  }
  if (largest <= kNoticeableOffset) return;
  for (int axis = 0; axis < 3; ++axis) {
    internal::StoColumn column{
        ColumnName(motion.skeleton->joints()[static_cast<std::size_t>(joint)], 't', axis), {}};
    for (int frame = 0; frame < motion.frame_count; ++frame) {
      column.values.push_back(offset(frame)[axis] * kMetresPerCm);
    }
    columns.push_back(std::move(column));
  }
}

// Rotations in the world, [frame × joint].
std::vector<Eigen::Quaterniond> GlobalRotations(const Motion& motion) {
  std::vector<Eigen::Quaterniond> global;
  global.reserve(motion.rotations.size());
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    const std::size_t first = global.size();
    for (int joint = 0; joint < motion.joint_count(); ++joint) {
      const int parent = motion.skeleton->joints()[static_cast<std::size_t>(joint)].parent;
      const Eigen::Quaterniond before = parent < 0
                                            ? motion.skeleton->root_orientation()
                                            : global[first + static_cast<std::size_t>(parent)];
      global.push_back((before * motion.rotation(frame, joint)).normalized());
    }
  }
  return global;
}

bool Turns(const Motion& motion, int joint) {
  const Joint& bone = motion.skeleton->joints()[static_cast<std::size_t>(joint)];
  const bool has_dofs = std::ranges::any_of(bone.dofs, [](Dof dof) { return IsRotation(dof); });
  if (bone.parent < 0 || has_dofs) return true;
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    if (motion.rotation(frame, joint).angularDistance(Eigen::Quaterniond::Identity()) >
        kNoticeableAngle) {
      return true;
    }
  }
  return false;
}

}  // namespace

StoTable ToJointAngles(const Motion& motion) {
  std::vector<internal::StoColumn> columns;
  const auto& joints = motion.skeleton->joints();
  for (int axis = 0; axis < 3; ++axis) {
    internal::StoColumn column{ColumnName(joints.front(), 't', axis), {}};
    for (const Eigen::Vector3d& place : motion.root_position_cm) {
      column.values.push_back(place[axis] * kMetresPerCm);
    }
    columns.push_back(std::move(column));
  }
  for (int joint = 0; joint < motion.joint_count(); ++joint) {
    const std::vector<Eigen::Vector3d> angles = EulerAngles(motion, joint);
    const Joint& bone = joints[static_cast<std::size_t>(joint)];
    if (joint > 0) AddOffsets(motion, joint, columns);
    for (const int axis : TurningAxes(bone, angles)) {
      internal::StoColumn column{ColumnName(bone, 'r', axis), {}};
      for (const auto& each : angles) column.values.push_back(each[axis] / kRadiansPerDegree);
      columns.push_back(std::move(column));
    }
  }
  StoTable table{.header = {{"version", "1"}}, .in_degrees = true};
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    table.times_s.push_back(TimeOf(motion, frame));
  }
  internal::SetColumns(table, columns);
  return table;
}

StoTable ToOrientations(const Motion& motion) {
  StoTable table{.header = {{"DataRate", ToShortestText(motion.rate_hz)}, {"version", "3"}},
                 .data_type = "Quaternion",
                 .component_count = 4};
  const std::vector<Eigen::Quaterniond> global = GlobalRotations(motion);
  std::vector<int> turning;
  for (int joint = 0; joint < motion.joint_count(); ++joint) {
    if (!Turns(motion, joint)) continue;
    turning.push_back(joint);
    table.labels.push_back(
        internal::StoLabel(motion.skeleton->joints()[static_cast<std::size_t>(joint)].bone_name) +
        "_imu");
  }
  std::vector<Eigen::Quaterniond> before(turning.size(), Eigen::Quaterniond::Identity());
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    table.times_s.push_back(TimeOf(motion, frame));
    for (std::size_t i = 0; i < turning.size(); ++i) {
      Eigen::Quaterniond q = global[static_cast<std::size_t>(frame) * motion.joint_count() +
                                    static_cast<std::size_t>(turning[i])];
      if (q.dot(before[i]) < 0) q.coeffs() = -q.coeffs();
      before[i] = q;
      table.values.insert(table.values.end(), {q.w(), q.x(), q.y(), q.z()});
    }
  }
  return table;
}

StoTable ToAnalogTable(const C3dRecording& c3d, Diagnostics& diagnostics) {
  StoTable table{.header = {{"version", "1"}}, .in_degrees = false};
  table.labels = internal::WritableLabels(ChannelLabels(c3d), " \t", '_', diagnostics);
  std::string units;
  for (const auto& unit : AnalogScaling(c3d).units) {
    units.append(units.empty() ? "" : ",").append(unit.empty() ? "?" : Trim(unit));
  }
  if (!units.empty()) table.header.push_back({"units", units});
  table.times_s = internal::AnalogTimes(c3d);
  table.values = ScaledAnalog(c3d);
  return table;
}

}  // namespace kinebase
