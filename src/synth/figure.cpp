#include "synth/figure.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace kinebase::internal {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kRadians = std::numbers::pi / 180;

// Legs reach this much of their length at most, so that knees never snap straight.
constexpr double kComfortableReach = 0.991;
constexpr double kLongestReach = 0.9995;
constexpr double kSoftMinimumCm = 0.5;
constexpr double kSoftSlope = 0.02;

Matrix3d AboutX(double rad) { return AngleAxisd(rad, Vector3d::UnitX()).toRotationMatrix(); }
Matrix3d AboutY(double rad) { return AngleAxisd(rad, Vector3d::UnitY()).toRotationMatrix(); }
Matrix3d AboutZ(double rad) { return AngleAxisd(rad, Vector3d::UnitZ()).toRotationMatrix(); }

double SideSign(Side side) { return side == Side::kLeft ? 1 : -1; }

// Orthonormal also where the two are perpendicular only to the digits of a file.
Matrix3d Basis(const Vector3d& bone, const Vector3d& rough_hinge) {
  const Vector3d hinge = (rough_hinge - rough_hinge.dot(bone) * bone).normalized();
  Matrix3d basis;
  basis << bone, hinge, hinge.cross(bone);
  return basis;
}

// The smaller of two with the corner rounded off over `width`.
double SoftMinimum(double a, double b, double width) {
  const double overlap = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - overlap * overlap * width / 4;
}

double SmoothStep(double low, double high, double value) {
  const double u = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

// How far a leg stretches towards something that is `distance` leg lengths away: all the way while
// that is comfortable, then less and less, so that the knee does not snap.
double SoftReach(double distance) {
  if (distance <= kComfortableReach) return distance;
  const double room = kLongestReach - kComfortableReach;
  return kLongestReach - room * std::exp((kComfortableReach - distance) / room);
}

double WrapAngle(double rad) {
  return rad - 2 * std::numbers::pi * std::round(rad / (2 * std::numbers::pi));
}

// A joint of the foot that turns about its own x axis (and then by `side_rad` about z): which way
// its bone slopes. The slope is the sine of the angle with the floor, positive upwards.
class Hinge {
 public:
  Hinge(const Quaterniond& axis, const Matrix3d& parent, const Vector3d& direction,
        double side_rad) {
    const Vector3d bone = axis.conjugate() * direction;
    const Vector3d up =
        AboutZ(-side_rad) * (axis.conjugate() * (parent.transpose() * Vector3d::UnitY()));
    constant_ = up.x() * bone.x();
    cosine_ = up.y() * bone.y() + up.z() * bone.z();
    sine_ = up.z() * bone.y() - up.y() * bone.z();
  }

  [[nodiscard]] double Slope(double angle_rad) const {
    return constant_ + cosine_ * std::cos(angle_rad) + sine_ * std::sin(angle_rad);
  }

  // Of the two angles with that slope the one from which bending upwards raises the bone.
  [[nodiscard]] double AngleFor(double slope) const {
    return WrapAngle(std::atan2(sine_, cosine_) + Spread(slope));
  }

  // Of the two angles with that slope the one nearer to `angle_rad`.
  [[nodiscard]] double NearestAngleFor(double slope, double angle_rad) const {
    const double other = WrapAngle(std::atan2(sine_, cosine_) - Spread(slope));
    const double usual = AngleFor(slope);
    return std::abs(other - angle_rad) < std::abs(usual - angle_rad) ? other : usual;
  }

 private:
  [[nodiscard]] double Spread(double slope) const {
    const double ratio = (slope - constant_) / std::hypot(cosine_, sine_);
    return std::acos(std::clamp(ratio, -1.0, 1.0));
  }

  double constant_, cosine_, sine_;
};

}  // namespace

Figure::Figure(std::shared_ptr<const Skeleton> skeleton)
    : skeleton_(std::move(skeleton)),
      legs_{MakeLeg(Side::kLeft), MakeLeg(Side::kRight)},
      arms_{MakeArm(Side::kLeft), MakeArm(Side::kRight)},
      spine_(FindBones({"lowerback", "upperback", "thorax"})),
      neck_(FindBones({"lowerneck", "upperneck", "head"})) {
  leg_length_cm_ = legs_[0].thigh_cm + legs_[0].shank_cm;
}

double Figure::hip_half_width() const { return legs_[0].hip_cm.x() / leg_length_cm_; }

std::array<int, 3> Figure::FindBones(const std::array<const char*, 3>& names) const {
  return {*skeleton_->FindBone(names[0]), *skeleton_->FindBone(names[1]),
          *skeleton_->FindBone(names[2])};
}

Figure::Leg Figure::MakeLeg(Side side) const {
  const std::string prefix = side == Side::kLeft ? "l" : "r";
  const auto bone = [&](const char* name) { return *skeleton_->FindBone(prefix + name); };
  const auto joint = [&](int index) -> const Joint& { return skeleton_->joints()[index]; };
  Leg leg{};
  leg.femur = bone("femur");
  leg.tibia = bone("tibia");
  leg.foot = bone("foot");
  leg.toes = bone("toes");
  leg.hip_cm = joint(bone("hipjoint")).offset_cm;
  leg.thigh_cm = joint(leg.femur).length_cm;
  leg.shank_cm = joint(leg.tibia).length_cm;
  const Vector3d hinge = skeleton_->axis(leg.tibia) * Vector3d::UnitX();
  leg.femur_basis = Basis(joint(leg.femur).direction, hinge);
  const Vector3d hanging_foot = Basis(-Vector3d::UnitY(), Vector3d::UnitX()) *
                                leg.femur_basis.transpose() * joint(leg.foot).offset_cm;
  leg.ankle_height_cm = -hanging_foot.y();
  leg.instep_cm = hanging_foot.z();
  return leg;
}

Figure::Arm Figure::MakeArm(Side side) const {
  const std::string prefix = side == Side::kLeft ? "l" : "r";
  const auto bone = [&](const char* name) { return *skeleton_->FindBone(prefix + name); };
  Arm arm{.clavicle = bone("clavicle"),
          .humerus = bone("humerus"),
          .radius = bone("radius"),
          .wrist = bone("wrist"),
          .hand = bone("hand"),
          .fingers = bone("fingers"),
          .humerus_basis = {}};
  arm.humerus_basis = Basis(skeleton_->joints()[arm.humerus].direction,
                            skeleton_->axis(arm.radius) * Vector3d::UnitX());
  return arm;
}

// Angles in rad about the joint's own axes.
Quaterniond Figure::JointRotation(int joint, const Vector3d& angles) const {
  const Quaterniond& axis = skeleton_->axis(joint);
  return axis * EulerToQuaternion(angles, EulerOrder::kXyz) * axis.conjugate();
}

Figure::FootPlace Figure::PlaceFoot(const Pose& pose, Side side) const {
  const Leg& leg = legs_[static_cast<std::size_t>(side)];
  const double unit = leg_length_cm_;
  FootPlace foot{};
  foot.lift_cm = pose.at(Limb::kFootLift, side) * unit;
  const double pitch_rad = pose.at(Limb::kFootPitch, side) * kRadians;
  const Matrix3d yaw = AboutY(SideSign(side) * pose.at(Limb::kFootTurn, side) * kRadians);
  const Matrix3d pitch = AboutX(pitch_rad);
  const Vector3d origin(SideSign(side) * pose.at(Limb::kFootSide, side) * unit, foot.lift_cm,
                        pose.at(Limb::kFootForward, side) * unit);
  Vector3d ball(0, 0, leg.instep_cm);
  if (pitch_rad < 0) {
    // Toes up: the foot turns about the heel, a little behind the ankle.
    const Vector3d heel(0, 0, -0.4 * leg.instep_cm);
    ball = heel + pitch * (ball - heel);
  }
  foot.ball_cm = origin + yaw * ball;
  foot.ankle_cm = foot.ball_cm + yaw * pitch * Vector3d(0, leg.ankle_height_cm, -leg.instep_cm);
  foot.ahead = yaw * Vector3d::UnitZ();
  return foot;
}

Figure::PelvisPlace Figure::PlacePelvis(const Pose& pose) const {
  PelvisPlace pelvis;
  pelvis.rotation = AboutY(pose[Body::kTurn] * kRadians) * AboutX(pose[Body::kLean] * kRadians) *
                    AboutZ(-pose[Body::kTilt] * kRadians);
  const Vector3d middle_of_hips = (legs_[0].hip_cm + legs_[1].hip_cm) / 2;
  const double unit = leg_length_cm_;
  pelvis.root_cm =
      Vector3d(pose[Body::kSide] * unit, pose[Body::kHeight] * unit + legs_[0].ankle_height_cm,
               pose[Body::kForward] * unit) -
      pelvis.rotation * middle_of_hips;
  return pelvis;
}

double Figure::PelvisDrop(const Pose& pose) const {
  const PelvisPlace pelvis = PlacePelvis(pose);
  double highest_cm = 0;  // Relative to where the pose has the root.
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const Leg& leg = legs_[static_cast<std::size_t>(side)];
    const FootPlace foot = PlaceFoot(pose, side);
    const double reach = kComfortableReach * (leg.thigh_cm + leg.shank_cm);
    const Vector3d apart = pelvis.root_cm + pelvis.rotation * leg.hip_cm - foot.ankle_cm;
    const double across = std::hypot(apart.x(), apart.z());
    const double up = std::sqrt(std::max(reach * reach - across * across, 0.0));
    // A foot in the air, or a leg that goes its own way, ties the pelvis less and less.
    const double slack = 4 * foot.lift_cm + 80 * pose.at(Limb::kFree, side);
    highest_cm = SoftMinimum(highest_cm, up - apart.y() + slack, kSoftMinimumCm);
  }
  return -highest_cm;
}

Figure::LegAngles Figure::StandingLeg(const Leg& leg, const FootPlace& foot, const Vector3d& root,
                                      const Matrix3d& pelvis) const {
  const Vector3d hip = root + pelvis * leg.hip_cm;
  const Vector3d apart = foot.ankle_cm - hip;
  const double a = leg.thigh_cm;
  const double b = leg.shank_cm;
  const double distance = (a + b) * SoftReach(apart.norm() / (a + b));
  const double cosine = (distance * distance - a * a - b * b) / (2 * a * b);
  LegAngles angles{};
  angles.knee_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double hip_rad =
      std::atan2(b * std::sin(angles.knee_rad), a + b * std::cos(angles.knee_rad));
  // The knee points where the toes point, swung along with the leg.
  const Vector3d along = apart.normalized();
  const Vector3d ahead = Quaterniond::FromTwoVectors(-Vector3d::UnitY(), along) * foot.ahead;
  const Vector3d pole = (ahead - ahead.dot(along) * along).normalized();
  const Vector3d hinge = pole.cross(along);
  const Vector3d bone = std::cos(hip_rad) * along + std::sin(hip_rad) * pole;
  const Matrix3d femur = Basis(bone, hinge) * leg.femur_basis.transpose();
  angles.femur = Quaterniond(pelvis.transpose() * femur).normalized();
  const Vector3d neutral_hinge = leg.femur_basis.col(1);
  const Matrix3d tibia = femur * AngleAxisd(angles.knee_rad, neutral_hinge).toRotationMatrix();
  const Vector3d ankle = hip + a * bone + tibia * skeleton_->joints()[leg.tibia].offset_cm;
  AimFoot(leg, foot, tibia, ankle, angles);
  return angles;
}

// Two angles bring the ball of the foot to its place.
void Figure::AimFoot(const Leg& leg, const FootPlace& foot, const Matrix3d& tibia,
                     const Vector3d& ankle, LegAngles& angles) const {
  const Matrix3d axis = skeleton_->axis(leg.foot).toRotationMatrix();
  const Vector3d from = axis.transpose() * skeleton_->joints()[leg.foot].direction;
  const Vector3d to = axis.transpose() * tibia.transpose() * (foot.ball_cm - ankle).normalized();
  angles.ankle_side_rad = std::atan2(to.x(), -to.y());
  angles.ankle_rad =
      WrapAngle(std::atan2(to.z(), -std::hypot(to.x(), to.y())) - std::atan2(from.z(), from.y()));
}

// Feet do not go through the floor: the ankle gives way for the ball of the foot, and then the
// toes, which else go on straight, bend.
void Figure::RespectFloor(const Leg& leg, const Vector3d& root, const Matrix3d& pelvis,
                          bool is_free, LegAngles& angles) const {
  const Matrix3d femur = pelvis * angles.femur.toRotationMatrix();
  const Matrix3d tibia =
      femur * JointRotation(leg.tibia, {angles.knee_rad, 0, 0}).toRotationMatrix();
  const auto joint = [&](int index) -> const Joint& { return skeleton_->joints()[index]; };
  const Vector3d ankle = root + pelvis * leg.hip_cm + femur * joint(leg.femur).offset_cm +
                         tibia * joint(leg.tibia).offset_cm;
  const auto steepest = [](double height_cm, double length_cm) {
    return std::clamp(-height_cm / length_cm, -1.0, 0.9);
  };
  if (is_free) {
    const Hinge hinge(skeleton_->axis(leg.foot), tibia, joint(leg.foot).direction,
                      angles.ankle_side_rad);
    const double limit = steepest(ankle.y(), joint(leg.foot).length_cm);
    if (hinge.Slope(angles.ankle_rad) < limit) {
      angles.ankle_rad = hinge.NearestAngleFor(limit, angles.ankle_rad);
    }
  }
  const Matrix3d foot =
      tibia *
      JointRotation(leg.foot, {angles.ankle_rad, 0, angles.ankle_side_rad}).toRotationMatrix();
  const double ball_cm = (ankle + foot * joint(leg.foot).offset_cm).y();
  const Hinge hinge(skeleton_->axis(leg.toes), foot, joint(leg.toes).direction, 0);
  const double limit = steepest(ball_cm, joint(leg.toes).length_cm);
  angles.toes_rad = hinge.AngleFor(-SoftMinimum(-hinge.Slope(0), -limit, kSoftSlope));
}

Figure::LegAngles Figure::FreeLeg(const Pose& pose, Side side) const {
  const Leg& leg = legs_[static_cast<std::size_t>(side)];
  const double sign = SideSign(side);
  const auto angle = [&](Limb channel) { return pose.at(channel, side) * kRadians; };
  const Matrix3d hanging = Basis(-Vector3d::UnitY(), Vector3d::UnitX());
  const Matrix3d femur =
      AboutX(-angle(Limb::kHipFlexion)) * AboutZ(sign * angle(Limb::kHipAbduction)) *
      AboutY(sign * angle(Limb::kHipRotation)) * hanging * leg.femur_basis.transpose();
  return {.femur = Quaterniond(femur),
          .knee_rad = angle(Limb::kKnee),
          .ankle_rad = angle(Limb::kAnkle),
          .ankle_side_rad = 0,
          .toes_rad = 0};
}

void Figure::PoseTrunk(const Pose& pose, Quaterniond* rotations) const {
  const auto spread = [&](const std::array<int, 3>& joints, const Vector3d& degrees) {
    for (const int joint : joints) {
      rotations[joint] = JointRotation(joint, degrees * kRadians / 3);
    }
  };
  spread(spine_, {pose[Body::kBend], pose[Body::kTwist], -pose[Body::kSideBend]});
  spread(neck_, {pose[Body::kNod], pose[Body::kHeadTurn], -pose[Body::kHeadTilt]});
}

void Figure::PoseArm(const Pose& pose, Side side, Quaterniond* rotations) const {
  const Arm& arm = arms_[static_cast<std::size_t>(side)];
  const double sign = SideSign(side);
  const auto angle = [&](Limb channel) { return pose.at(channel, side) * kRadians; };
  const double elevation = angle(Limb::kElevation);
  // The shoulder girdle takes part in raising the arm: about a third, less at the beginning.
  const double raised = std::abs(WrapAngle(elevation));
  const double girdle = 22 * kRadians * SmoothStep(40 * kRadians, 180 * kRadians, raised);
  const double shrug = angle(Limb::kShrug) + girdle;
  rotations[arm.clavicle] =
      JointRotation(arm.clavicle, {0, -sign * angle(Limb::kReach), sign * shrug});

  const double plane = angle(Limb::kPlane);
  const Vector3d outwards(sign * std::cos(plane), 0, std::sin(plane));
  const Matrix3d hanging = Basis(-Vector3d::UnitY(), -Vector3d::UnitX());
  const Vector3d swing_axis = (-Vector3d::UnitY()).cross(outwards);
  const Matrix3d in_chest = AngleAxisd(elevation, swing_axis).toRotationMatrix() *
                            AboutY(-sign * angle(Limb::kArmTwist)) * hanging *
                            arm.humerus_basis.transpose();
  rotations[arm.humerus] =
      (rotations[arm.clavicle].conjugate() * Quaterniond(in_chest)).normalized();
  rotations[arm.radius] = JointRotation(arm.radius, {angle(Limb::kElbow), 0, 0});
  rotations[arm.wrist] = JointRotation(arm.wrist, {0, angle(Limb::kForearm), 0});
  rotations[arm.hand] = JointRotation(arm.hand, {angle(Limb::kWrist), 0, 0});
  rotations[arm.fingers] = JointRotation(arm.fingers, {angle(Limb::kGrip), 0, 0});
}

void Figure::SetPose(const Pose& pose, const FloorFrame& floor, double pelvis_drop_cm,
                     Vector3d& root_position_cm, Quaterniond* rotations) const {
  std::fill_n(rotations, skeleton_->joint_count(), Quaterniond::Identity());
  PelvisPlace place = PlacePelvis(pose);
  place.root_cm.y() -= pelvis_drop_cm;
  const auto& [root, pelvis] = place;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const auto index = static_cast<std::size_t>(side);
    const Leg& leg = legs_[index];
    LegAngles angles = StandingLeg(leg, PlaceFoot(pose, side), root, pelvis);
    const double share = std::clamp(pose.at(Limb::kFree, side), 0.0, 1.0);
    if (share > 0) {
      const LegAngles free = FreeLeg(pose, side);
      angles.femur = angles.femur.slerp(share, free.femur);
      angles.knee_rad += share * (free.knee_rad - angles.knee_rad);
      angles.ankle_rad += share * (free.ankle_rad - angles.ankle_rad);
      angles.ankle_side_rad += share * (free.ankle_side_rad - angles.ankle_side_rad);
    }
    RespectFloor(leg, root, pelvis, share > 0, angles);
    rotations[leg.femur] = angles.femur.normalized();
    rotations[leg.tibia] = JointRotation(leg.tibia, {angles.knee_rad, 0, 0});
    rotations[leg.foot] = JointRotation(leg.foot, {angles.ankle_rad, 0, angles.ankle_side_rad});
    rotations[leg.toes] = JointRotation(leg.toes, {angles.toes_rad, 0, 0});
  }
  PoseTrunk(pose, rotations);
  for (const Side side : {Side::kLeft, Side::kRight}) PoseArm(pose, side, rotations);

  const Matrix3d heading = AboutY(floor.heading_deg * kRadians);
  root_position_cm = heading * root + Vector3d(floor.x_cm, 0, floor.z_cm);
  rotations[0] = Quaterniond(heading * pelvis);
}

}  // namespace kinebase::internal
