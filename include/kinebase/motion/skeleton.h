// The bones of one performer: immutable, checked once, shared by all motions that use it.
//
// Read motion/motion.h next. Built from a file's record by motion/asf_amc_motion.h and
// motion/bvh_motion.h.
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 3.1 (`skel`), 4.1 and 4.2.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/motion/standard_skeleton.h"

namespace kinebase {

enum class Dof { kTx, kTy, kTz, kRx, kRy, kRz, kLength };

[[nodiscard]] constexpr bool IsRotation(Dof dof) {
  return dof == Dof::kRx || dof == Dof::kRy || dof == Dof::kRz;
}
// 0 = x, 1 = y, 2 = z; not for kLength, which has none.
[[nodiscard]] constexpr int AxisOf(Dof dof) { return static_cast<int>(dof) % 3; }

// Euler order of a rotation by name: kXyz = about x first, then y, then z, each about the fixed
// axes, so that the matrix is Rz · Ry · Rx.
enum class EulerOrder { kXyz, kXzy, kYxz, kYzx, kZxy, kZyx };

[[nodiscard]] std::optional<EulerOrder> ParseEulerOrder(std::string_view text);  // Any case.
[[nodiscard]] std::string_view ToString(EulerOrder order);                       // "XYZ" …

// The rotation that turns by angles_rad[0] about x, [1] about y and [2] about z in that order.
[[nodiscard]] Eigen::Quaterniond EulerToQuaternion(const Eigen::Vector3d& angles_rad,
                                                   EulerOrder order);

// Angles about x, y, z whose rotation is `rotation`; the middle angle in [-π/2, π/2].
[[nodiscard]] Eigen::Vector3d QuaternionToEuler(const Eigen::Quaterniond& rotation,
                                                EulerOrder order);

struct DofLimits {
  double low = -std::numeric_limits<double>::infinity();  // rad or cm.
  double high = std::numeric_limits<double>::infinity();
};

// A joint together with the bone that ends in it; the root is a joint without a bone.
struct Joint {
  std::string name;       // "upperback_@_thorax": the bone before, the bone that ends here.
  std::string bone_name;  // "thorax"; "root" for the root.
  int parent = -1;        // Index; smaller than the joint's own. -1 for the root.
  Eigen::Vector3d offset_cm =
      Eigen::Vector3d::Zero();  // From the parent, neutral pose, world axes.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // Unit length; zero for the root.
  double length_cm = 0;
  Eigen::Vector3d axis_rad = Eigen::Vector3d::Zero();  // Fixed-axis xyz angles of the local axes.
  EulerOrder euler_order = EulerOrder::kXyz;           // Of the DOFs.
  std::vector<Dof> dofs;                               // In the order of a file's columns.
  std::vector<DofLimits> limits;                       // One for each DOF, or none.
};

// What the source said about the whole skeleton; kept, not interpreted.
struct SkeletonSource {
  std::string file_name;
  std::string file_type;  // "ASF".
  std::string name;
  std::string version;
  std::optional<double> mass_unit;
  std::optional<double> length_unit;
  bool angle_is_degrees = true;
  std::vector<std::string> documentation;
};

// A tree of joints in depth-first order, root first.
class Skeleton {
 public:
  using NameMap = std::array<NameMapEntry, kStandardJointCount>;

  // Checks and completes. `root_orientation` turns the whole figure, from the left of the root's
  // own rotation; `root_position_cm` is added to its translation. Without `name_map` the standard
  // joints are found by the names that ASF files have.
  //
  // Errors  InvalidArgument: no joint, a parent that does not come before its child, a second
  //         root, two bones of one name, limits that are neither none nor one for each DOF, a name
  //         map that points nowhere.
  explicit Skeleton(std::vector<Joint> joints, SkeletonSource source = {},
                    const Eigen::Vector3d& root_position_cm = Eigen::Vector3d::Zero(),
                    const Eigen::Vector3d& root_orientation_rad = Eigen::Vector3d::Zero(),
                    const std::optional<NameMap>& name_map = std::nullopt);

  [[nodiscard]] const std::vector<Joint>& joints() const { return joints_; }
  [[nodiscard]] int joint_count() const { return static_cast<int>(joints_.size()); }
  [[nodiscard]] const std::vector<int>& children(int joint) const { return children_[joint]; }

  // Paths that together visit every bone once, each from the root, or from the joint where it
  // branches off, to a tip.
  [[nodiscard]] const std::vector<std::vector<int>>& chains() const { return chains_; }
  [[nodiscard]] const std::vector<int>& animated() const { return animated_; }  // With DOFs.
  [[nodiscard]] const std::vector<int>& unanimated() const { return unanimated_; }

  // Where each standard joint is found here; -1 where it has no rotation, or the bone is missing.
  [[nodiscard]] const NameMap& name_map() const { return name_map_; }

  [[nodiscard]] std::optional<int> FindBone(std::string_view bone_name) const;  // Or another case.
  [[nodiscard]] const Eigen::Quaterniond& axis(int joint) const { return axes_[joint]; }
  [[nodiscard]] const SkeletonSource& source() const { return source_; }
  [[nodiscard]] const Eigen::Vector3d& root_position_cm() const { return root_position_cm_; }
  [[nodiscard]] const Eigen::Vector3d& root_orientation_rad() const {
    return root_orientation_rad_;
  }
  [[nodiscard]] Eigen::Quaterniond root_orientation() const;

 private:
  std::vector<Joint> joints_;
  std::vector<std::vector<int>> children_;
  std::vector<Eigen::Quaterniond> axes_;
  std::vector<std::vector<int>> chains_;
  std::vector<int> animated_;
  std::vector<int> unanimated_;
  NameMap name_map_{};
  SkeletonSource source_;
  Eigen::Vector3d root_position_cm_;
  Eigen::Vector3d root_orientation_rad_;
};

}  // namespace kinebase
