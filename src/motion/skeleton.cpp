#include "kinebase/motion/skeleton.h"

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "motion/name_map.h"

namespace kinebase {
namespace {

// The axes in the order in which an Euler order turns about them; fixed axes, so the last one named
// stands leftmost in the product.
constexpr std::array<std::array<int, 3>, 6> kEulerAxes = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
constexpr std::array<std::string_view, 6> kEulerNames = {"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};

Eigen::Quaterniond AboutAxis(int axis, double angle_rad) {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  direction[axis] = std::sin(angle_rad / 2);
  return {std::cos(angle_rad / 2), direction.x(), direction.y(), direction.z()};
}

void CheckJoint(const std::vector<Joint>& joints, int index) {
  const Joint& joint = joints[static_cast<std::size_t>(index)];
  const auto fail = [&](std::string_view problem) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("joint {} ('{}') {}", index, joint.bone_name, problem));
  };
  if (index == 0 && joint.parent != -1) fail("comes first and must be the root");
  if (index > 0 && joint.parent < 0) fail("has no parent; only the first joint may be a root");
  if (joint.parent >= index) fail("comes before its parent");
  if (!joint.limits.empty() && joint.limits.size() != joint.dofs.size()) {
    fail("needs no limits, or one for each degree of freedom");
  }
}

void CheckNameMap(const Skeleton::NameMap& name_map, int joint_count) {
  const auto fits = [&](int joint) { return joint >= -1 && joint < joint_count; };
  for (const NameMapEntry& entry : name_map) {
    if (fits(entry.rotation_joint) && fits(entry.trajectory_joint)) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a name map with joints {} and {}; the skeleton has {}",
                            entry.rotation_joint, entry.trajectory_joint, joint_count));
  }
}

}  // namespace

std::optional<EulerOrder> ParseEulerOrder(std::string_view text) {
  for (std::size_t i = 0; i < kEulerNames.size(); ++i) {
    if (EqualsIgnoringCase(text, kEulerNames[i])) return static_cast<EulerOrder>(i);
  }
  return std::nullopt;
}

std::string_view ToString(EulerOrder order) { return kEulerNames[static_cast<std::size_t>(order)]; }

Eigen::Quaterniond EulerToQuaternion(const Eigen::Vector3d& angles_rad, EulerOrder order) {
  const auto& [first, second, third] = kEulerAxes[static_cast<std::size_t>(order)];
  const auto about = [&](int axis) { return AboutAxis(axis, angles_rad[axis]); };
  // Many joints turn about one axis or two, and a product with no rotation changes no digit.
  if (angles_rad[third] == 0) {
    if (angles_rad[second] == 0) return about(first);
    return angles_rad[first] == 0 ? about(second) : about(second) * about(first);
  }
  const Eigen::Quaterniond outer =
      angles_rad[second] == 0 ? about(third) : about(third) * about(second);
  return angles_rad[first] == 0 ? outer : outer * about(first);
}

// With the axes i, j, k of the order and R = R_k · R_j · R_i, the last row of R in that order is
// (∓sin j, ±cos j sin i, cos j cos i); the sign is that of the permutation (i, j, k). The other two
// angles come from what is left of R without R_i: near gimbal lock i is uncertain, and only so do
// they make up for it.
Eigen::Vector3d QuaternionToEuler(const Eigen::Quaterniond& rotation, EulerOrder order) {
  constexpr double kGimbalLock = 1e-14;  // Below, rounding alone decides i: zero is as good.
  const auto& [i, j, k] = kEulerAxes[static_cast<std::size_t>(order)];
  const double sign = (j - i + 3) % 3 == 1 ? 1 : -1;
  const Eigen::Matrix3d r = rotation.toRotationMatrix();
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  if (std::hypot(r(k, j), r(k, k)) > kGimbalLock) angles[i] = std::atan2(sign * r(k, j), r(k, k));
  const Eigen::Matrix3d rest = r * AboutAxis(i, -angles[i]).toRotationMatrix();
  angles[j] = std::atan2(-sign * rest(k, i), std::abs(rest(k, k)));
  angles[k] = std::atan2(-sign * rest(i, j), rest(j, j));
  return angles;
}

Skeleton::Skeleton(std::vector<Joint> joints, SkeletonSource source,
                   const Eigen::Vector3d& root_position_cm,
                   const Eigen::Vector3d& root_orientation_rad,
                   const std::optional<NameMap>& name_map)
    : joints_(std::move(joints)),
      source_(std::move(source)),
      root_position_cm_(root_position_cm),
      root_orientation_rad_(root_orientation_rad) {
  if (joints_.empty()) throw Error(ErrorCode::kInvalidArgument, "a skeleton needs a joint");
  children_.resize(joints_.size());
  std::set<std::string> names;
  for (int i = 0; i < joint_count(); ++i) {
    CheckJoint(joints_, i);
    const Joint& joint = joints_[i];
    if (!names.insert(joint.bone_name).second) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("two bones named '{}'", joint.bone_name));
    }
    if (i > 0) children_[joint.parent].push_back(i);
    axes_.push_back(EulerToQuaternion(joint.axis_rad, EulerOrder::kXyz));
    (joint.dofs.empty() ? unanimated_ : animated_).push_back(i);
  }
  // A chain goes on with the first child; each further child begins one at its parent.
  for (int i = 0; i < joint_count(); ++i) {
    const bool begins = i == 0 || children_[joints_[i].parent].front() != i;
    if (!begins && joint_count() > 1) continue;
    std::vector<int> chain;
    if (i > 0) chain.push_back(joints_[i].parent);
    for (int j = i;; j = children_[j].front()) {
      chain.push_back(j);
      if (children_[j].empty()) break;
    }
    chains_.push_back(std::move(chain));
  }
  if (name_map) CheckNameMap(*name_map, joint_count());
  name_map_ = name_map ? *name_map : internal::BuildNameMap(joints_);
}

std::optional<int> Skeleton::FindBone(std::string_view bone_name) const {
  std::optional<int> found;
  for (int i = 0; i < joint_count(); ++i) {
    if (joints_[i].bone_name == bone_name) return i;
    if (!found && EqualsIgnoringCase(joints_[i].bone_name, bone_name)) found = i;
  }
  return found;
}

Eigen::Quaterniond Skeleton::root_orientation() const {
  return EulerToQuaternion(root_orientation_rad_, joints_.front().euler_order);
}

}  // namespace kinebase
