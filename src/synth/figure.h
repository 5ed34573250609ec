// From a posture in anatomical terms to the rotations of a skeleton's joints.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>

#include "kinebase/motion/motion.h"
#include "synth/pose.h"

namespace kinebase::internal {

// Where a performer's floor frame is in the world.
struct FloorFrame {
  double x_cm = 0;
  double z_cm = 0;
  double heading_deg = 0;  // 0 faces +z; positive turns left, towards +x.
};

// A skeleton made by MakeSyntheticSkeleton, ready to be posed. Immutable.
class Figure {
 public:
  explicit Figure(std::shared_ptr<const Skeleton> skeleton);

  // How far the pelvis has to go down at least for both legs to reach where their feet stand.
  [[nodiscard]] double PelvisDrop(const Pose& pose) const;

  // Writes one frame: the root's place and joint_count() rotations. With the pelvis lowered by
  // PelvisDrop or more, feet that stand are exactly where the pose says. Feet never go through the
  // floor.
  void SetPose(const Pose& pose, const FloorFrame& floor, double pelvis_drop_cm,
               Eigen::Vector3d& root_position_cm, Eigen::Quaterniond* rotations) const;

  [[nodiscard]] double leg_length_cm() const { return leg_length_cm_; }
  [[nodiscard]] const std::shared_ptr<const Skeleton>& skeleton() const { return skeleton_; }
  [[nodiscard]] double hip_half_width() const;  // In leg lengths.

 private:
  struct Leg {
    int femur, tibia, foot, toes;
    Eigen::Vector3d hip_cm;  // From the root, in the pelvis.
    double thigh_cm, shank_cm;
    double ankle_height_cm, instep_cm;  // Of a flat foot.
    Eigen::Matrix3d femur_basis;        // Bone, hinge and their cross product, neutral pose.
  };
  struct Arm {
    int clavicle, humerus, radius, wrist, hand, fingers;
    Eigen::Matrix3d humerus_basis;
  };
  struct PelvisPlace {
    Eigen::Vector3d root_cm;  // In the performer's floor frame, as are the feet.
    Eigen::Matrix3d rotation;
  };
  struct FootPlace {
    Eigen::Vector3d ankle_cm;
    Eigen::Vector3d ball_cm;
    double lift_cm;
    Eigen::Vector3d ahead;
  };
  struct LegAngles {
    Eigen::Quaterniond femur;  // Local.
    double knee_rad, ankle_rad, ankle_side_rad, toes_rad;
  };

  [[nodiscard]] std::array<int, 3> FindBones(const std::array<const char*, 3>& names) const;
  [[nodiscard]] Leg MakeLeg(Side side) const;
  [[nodiscard]] Arm MakeArm(Side side) const;
  [[nodiscard]] Eigen::Quaterniond JointRotation(int joint, const Eigen::Vector3d& angles) const;
  [[nodiscard]] FootPlace PlaceFoot(const Pose& pose, Side side) const;
  [[nodiscard]] PelvisPlace PlacePelvis(const Pose& pose) const;
  [[nodiscard]] LegAngles StandingLeg(const Leg& leg, const FootPlace& foot,
                                      const Eigen::Vector3d& root,
                                      const Eigen::Matrix3d& pelvis) const;
  void AimFoot(const Leg& leg, const FootPlace& foot, const Eigen::Matrix3d& tibia,
               const Eigen::Vector3d& ankle, LegAngles& angles) const;
  void RespectFloor(const Leg& leg, const Eigen::Vector3d& root, const Eigen::Matrix3d& pelvis,
                    bool is_free, LegAngles& angles) const;
  [[nodiscard]] LegAngles FreeLeg(const Pose& pose, Side side) const;
  void PoseTrunk(const Pose& pose, Eigen::Quaterniond* rotations) const;
  void PoseArm(const Pose& pose, Side side, Eigen::Quaterniond* rotations) const;

  std::shared_ptr<const Skeleton> skeleton_;
  std::array<Leg, 2> legs_;
  std::array<Arm, 2> arms_;
  std::array<int, 3> spine_;
  std::array<int, 3> neck_;
  double leg_length_cm_ = 0;
};

}  // namespace kinebase::internal
