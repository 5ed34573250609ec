// Where joints are, against poses worked out by hand and against plain matrix products.

#include "kinebase/motion/kinematics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "kinebase/core/error.h"
#include "motion/figure.h"
#include "support/files.h"

namespace kinebase {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;

// Written out, so that nothing of Eigen's or our own rotations is asked.
Matrix3d About(char axis, double degrees) {
  const double c = std::cos(degrees * kDegree);
  const double s = std::sin(degrees * kDegree);
  Matrix3d m;
  if (axis == 'X') m << 1, 0, 0, 0, c, -s, 0, s, c;
  if (axis == 'Y') m << c, 0, s, 0, 1, 0, -s, 0, c;
  if (axis == 'Z') m << c, -s, 0, s, c, 0, 0, 0, 1;
  return m;
}

// Two bones in lengths of one centimetre: an upper arm of 2 cm along x, a forearm of 1 cm along x.
AsfSkeleton Arm() {
  AsfSkeleton asf;
  asf.length_unit = 1;
  asf.root_order = {AsfDof::kTx, AsfDof::kTy, AsfDof::kTz, AsfDof::kRx, AsfDof::kRy, AsfDof::kRz};
  AsfBone upper{.name = "upper", .direction = {3, 0, 0}, .length = 2};
  upper.dofs = {AsfDof::kRx, AsfDof::kRy, AsfDof::kRz};
  AsfBone lower{.name = "lower", .direction = {1, 0, 0}, .length = 1};
  lower.dofs = {AsfDof::kRz};
  asf.bones = {upper, lower};
  asf.hierarchy = {{"root", {"upper"}}, {"upper", {"lower"}}};
  return asf;
}

// Joints of one frame: root, end of upper, end of lower.
std::vector<Vector3d> Pose(const AsfSkeleton& asf, const std::string& amc) {
  const AsfBuildOptions options{LengthReading::kMultiplyToCentimetres};
  Diagnostics diagnostics;
  const auto skeleton = BuildSkeleton(asf, options, diagnostics);
  const Motion motion =
      BuildMotion(ParseAmc(amc, "arm.amc"), asf, skeleton, 120, options, diagnostics);
  return ForwardKinematics(motion).positions_cm;
}

void ExpectAt(const Vector3d& position, double x, double y, double z) {
  EXPECT_LE((position - Vector3d(x, y, z)).norm(), 1e-12) << position.transpose();
}

TEST(ForwardKinematics, TurnsATwoBoneArm) {
  const auto pose = Pose(Arm(), "1\nroot 0 0 0 0 0 0\nupper 0 0 90\nlower 90\n");
  ExpectAt(pose[0], 0, 0, 0);
  ExpectAt(pose[1], 0, 2, 0);
  ExpectAt(pose[2], -1, 2, 0);
}

TEST(ForwardKinematics, ReadsRadiansWhereTheMotionSaysSoAndElseAsTheSkeletonSays) {
  AsfSkeleton asf = Arm();
  const std::string turn = "1\nroot 0 0 0 0 0 0\nupper 0 0 1.5707963267948966\nlower 0\n";
  ExpectAt(Pose(asf, ":RADIANS\n" + turn)[1], 0, 2, 0);
  asf.angle_is_degrees = false;
  ExpectAt(Pose(asf, turn)[1], 0, 2, 0);
  ExpectAt(Pose(asf, ":DEGREES\n1\nroot 0 0 0 0 0 0\nupper 0 0 90\nlower 0\n")[1], 0, 2, 0);
}

TEST(ForwardKinematics, TurnsAboutTheBonesOwnAxes) {
  AsfSkeleton asf = Arm();
  // The bone's x axis is the world's y axis: turning about it takes x to −z.
  asf.bones[0].axis = {0, 0, 90};
  const auto pose = Pose(asf, "1\nroot 0 0 0 0 0 0\nupper 90 0 0\nlower 0\n");
  ExpectAt(pose[1], 0, 0, -2);
  ExpectAt(pose[2], 0, 0, -3);
}

TEST(ForwardKinematics, ReadsTheAxisInXyzOrderWhateverTheTokenSays) {
  AsfSkeleton asf = Arm();
  asf.bones[0].axis = {90, 90, 0};
  asf.bones[0].axis_order = "ZYX";
  const Matrix3d c = About('Y', 90) * About('X', 90);
  const Matrix3d e = About('X', 30) * About('Y', 40) * About('Z', 50);  // Z first.
  const auto pose = Pose(asf, "1\nroot 0 0 0 0 0 0\nupper 30 40 50\nlower 0\n");
  const Vector3d expected = c * e * c.transpose() * Vector3d(2, 0, 0);
  ExpectAt(pose[1], expected.x(), expected.y(), expected.z());
}

TEST(ForwardKinematics, TurnsInEveryEulerOrder) {
  for (const char* order : {"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"}) {
    AsfSkeleton asf = Arm();
    asf.bones[0].axis_order = order;
    asf.bones[0].axis = {10, 20, 30};
    const double angles[] = {35, -50, 110};
    // The first letter turns first, so it stands rightmost.
    Matrix3d e = Matrix3d::Identity();
    for (const char* axis = order; *axis != '\0'; ++axis) e = About(*axis, angles[*axis - 'X']) * e;
    const Matrix3d c = About('Z', 30) * About('Y', 20) * About('X', 10);
    const auto pose = Pose(asf, "1\nroot 0 0 0 0 0 0\nupper 35 -50 110\nlower 90\n");
    const Matrix3d upper = c * e * c.transpose();
    const Vector3d elbow = upper * Vector3d(2, 0, 0);
    const Vector3d hand = elbow + upper * About('Z', 90) * Vector3d(1, 0, 0);
    EXPECT_LE((pose[1] - elbow).norm(), 1e-12) << order;
    EXPECT_LE((pose[2] - hand).norm(), 1e-12) << order;
  }
}

TEST(ForwardKinematics, ReadsDofsInTheOrderOfTheirColumns) {
  AsfSkeleton asf = Arm();
  asf.bones[0].dofs = {AsfDof::kRz, AsfDof::kRx};
  asf.root_order = {AsfDof::kRy, AsfDof::kTz, AsfDof::kTx};
  const auto pose = Pose(asf, "1\nroot 90 5 6\nupper 90 0\nlower 0\n");
  ExpectAt(pose[0], 6, 0, 5);
  ExpectAt(pose[1], 6, 2, 5);
}

TEST(ForwardKinematics, AddsTheRootsPositionAndTurnsItFromTheLeft) {
  AsfSkeleton asf = Arm();
  asf.root_position = {1, 2, 3};
  asf.root_orientation = {0, 90, 0};
  const auto pose = Pose(asf, "1\nroot 10 20 30 0 0 90\nupper 0 0 0\nlower 0\n");
  ExpectAt(pose[0], 11, 22, 33);
  // Rz(90) takes x to y, which Ry(90) leaves; the other way round it would be −z.
  ExpectAt(pose[1], 11, 24, 33);
}

TEST(ForwardKinematics, TurnsTheRootInTheOrderOfItsAxis) {
  AsfSkeleton asf = Arm();
  asf.root_axis = "ZXY";
  asf.root_order = {AsfDof::kRx, AsfDof::kRy, AsfDof::kRz};
  const auto pose = Pose(asf, "1\nroot 10 20 30\nupper 0 0 0\nlower 0\n");
  const Vector3d expected = About('Y', 20) * About('X', 10) * About('Z', 30) * Vector3d(2, 0, 0);
  ExpectAt(pose[1], expected.x(), expected.y(), expected.z());
}

TEST(ForwardKinematics, MovesAndStretchesBones) {
  AsfSkeleton asf = Arm();
  asf.bones[0].axis = {0, 0, 90};
  asf.bones[0].dofs = {AsfDof::kTx, AsfDof::kRz, AsfDof::kLength, AsfDof::kTz};
  // Along the bone's own axes, x being the world's y; then 90° about z; half a centimetre longer.
  const auto pose = Pose(asf, "1\nroot 0 0 0 0 0 0\nupper 3 90 0.5 4\nlower 0\n");
  ExpectAt(pose[1], 0, 3 + 2.5, 4);
  ExpectAt(pose[2], 0, 3 + 2.5 + 1, 4);
}

TEST(ForwardKinematics, NeverMovesABoneWithoutDofs) {
  AsfSkeleton asf = Arm();
  asf.bones[1].dofs.clear();
  const auto pose = Pose(asf, "1\nroot 0 0 0 0 0 0\nupper 0 0 90\n");
  ExpectAt(pose[2], 0, 3, 0);
}

TEST(NeutralPose, IsThatOfTheOffsets) {
  Diagnostics diagnostics;
  const auto skeleton = BuildSkeleton(Arm(), {LengthReading::kMultiplyToCentimetres}, diagnostics);
  const auto pose = NeutralPose(*skeleton);
  ExpectAt(pose[1], 2, 0, 0);
  ExpectAt(pose[2], 3, 0, 0);
}

Vector3d AnyAngles() {
  const auto degrees = [] { return *rc::gen::inRange(-1800, 1801) / 10.0; };
  return Vector3d(degrees(), degrees(), degrees()) * kDegree;
}

RC_GTEST_PROP(EulerToQuaternion, IsTheProductOfThreeTurns, ()) {
  const auto order = static_cast<EulerOrder>(*rc::gen::inRange(0, 6));
  const Vector3d angles = AnyAngles();
  Matrix3d expected = Matrix3d::Identity();
  for (const char axis : ToString(order)) {
    expected = About(axis, angles[axis - 'X'] / kDegree) * expected;
  }
  const Matrix3d turned = EulerToQuaternion(angles, order).toRotationMatrix();
  RC_ASSERT((turned - expected).norm() < 1e-12);
}

// Turns by nothing are left out of the product, which they do not change.
TEST(EulerToQuaternion, HasTheDigitsOfTheWholeProductWhereAnglesAreZero) {
  const std::array<Vector3d, 3> axes = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (int zeros = 0; zeros < 8; ++zeros) {
    Vector3d angles(0.3, -1.7, 2.9);
    for (int axis = 0; axis < 3; ++axis) {
      if (((zeros >> axis) & 1) != 0) angles[axis] = 0;
    }
    for (int order = 0; order < 6; ++order) {
      const std::string_view name = ToString(static_cast<EulerOrder>(order));
      const auto turn = [&](std::size_t place) {
        const auto axis = static_cast<std::size_t>(name[place] - 'X');
        return Eigen::Quaterniond(
            Eigen::AngleAxisd(angles[static_cast<Eigen::Index>(axis)], axes[axis]));
      };
      const Eigen::Quaterniond expected = turn(2) * turn(1) * turn(0);
      EXPECT_EQ(EulerToQuaternion(angles, static_cast<EulerOrder>(order)).coeffs(),
                expected.coeffs());
    }
  }
}

RC_GTEST_PROP(QuaternionToEuler, FindsAnglesOfTheSameRotation, ()) {
  const auto order = static_cast<EulerOrder>(*rc::gen::inRange(0, 6));
  Vector3d angles = AnyAngles();
  const int middle = ToString(order)[1] - 'X';
  // Every other time in gimbal lock or a hair beside it.
  if (*rc::gen::arbitrary<bool>()) {
    angles[middle] = *rc::gen::element(-90, 90) * kDegree +
                     *rc::gen::element(0.0, 1e-15, 1e-12, -1e-9, 1e-8, -1e-6, 1e-4);
  }
  const Eigen::Quaterniond rotation = EulerToQuaternion(angles, order);
  const Vector3d found = QuaternionToEuler(rotation, order);
  RC_ASSERT(std::abs(found[middle]) <= std::numbers::pi / 2 + 1e-12);
  RC_ASSERT(EulerToQuaternion(found, order).angularDistance(rotation) < 1e-13);
}

RC_GTEST_PROP(QuaternionToEuler, FindsTheAnglesThemselvesAwayFromGimbalLock, ()) {
  const auto order = static_cast<EulerOrder>(*rc::gen::inRange(0, 6));
  Vector3d angles = AnyAngles();
  const int middle = ToString(order)[1] - 'X';
  angles[middle] *= 0.49;
  const Vector3d found = QuaternionToEuler(EulerToQuaternion(angles, order), order);
  for (int i = 0; i < 3; ++i) {
    RC_ASSERT(std::abs(std::remainder(found[i] - angles[i], 2 * std::numbers::pi)) < 1e-10);
  }
}

// A skeleton of the root and one bone with some rotational DOFs.
std::shared_ptr<const Skeleton> OneBone(const std::vector<Dof>& dofs, EulerOrder order) {
  Joint root{.name = "root", .bone_name = "root"};
  Joint bone{.name = "root_@_bone", .bone_name = "bone", .parent = 0};
  bone.offset_cm = bone.direction = Vector3d::UnitX();
  bone.length_cm = 1;
  bone.axis_rad = {0.3, -0.4, 0.5};
  bone.euler_order = order;
  bone.dofs = dofs;
  return std::make_shared<const Skeleton>(std::vector{root, bone});
}

// The other triples of the same rotation would need an axis that the joint cannot turn about.
RC_GTEST_PROP(EulerAngles, UsesNoAxisThatTheJointLacks, ()) {
  std::vector<Dof> dofs;
  for (const Dof dof : {Dof::kRx, Dof::kRy, Dof::kRz}) {
    if (*rc::gen::arbitrary<bool>()) dofs.push_back(dof);
  }
  const auto order = static_cast<EulerOrder>(*rc::gen::inRange(0, 6));
  const auto skeleton = OneBone(dofs, order);
  Motion motion{.skeleton = skeleton, .rate_hz = 120, .frame_count = 5};
  motion.root_position_cm.assign(5, Vector3d::Zero());
  for (int frame = 0; frame < 5; ++frame) {
    Vector3d angles = Vector3d::Zero();
    for (const Dof dof : dofs) {
      angles[static_cast<int>(dof) - 3] = *rc::gen::inRange(-36, 37) * 5 * kDegree;
    }
    const auto& axis = skeleton->axis(1);
    motion.rotations.push_back(Eigen::Quaterniond::Identity());
    motion.rotations.push_back(axis * EulerToQuaternion(angles, order) * axis.conjugate());
  }
  const auto found = EulerAngles(motion, 1);
  for (int frame = 0; frame < 5; ++frame) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool has = std::ranges::find(dofs, static_cast<Dof>(3 + axis)) != dofs.end();
      RC_ASSERT(has || std::abs(found[frame][axis]) < 1e-9);
    }
    const auto& axis = skeleton->axis(1);
    const auto again = axis * EulerToQuaternion(found[frame], order) * axis.conjugate();
    RC_ASSERT(again.angularDistance(motion.rotation(frame, 1)) < 1e-12);
  }
}

TEST(EulerAngles, GoOnFromFrameToFrame) {
  const auto skeleton = OneBone({Dof::kRx, Dof::kRy, Dof::kRz}, EulerOrder::kXyz);
  Motion motion{.skeleton = skeleton, .rate_hz = 120, .frame_count = 400};
  motion.root_position_cm.assign(400, Vector3d::Zero());
  const auto& axis = skeleton->axis(1);
  const auto angles_at = [](int t) {
    return Vector3d(0.02 * t, 0.5 * std::sin(0.1 * t), -0.03 * t);
  };
  for (int t = 0; t < 400; ++t) {
    motion.rotations.push_back(Eigen::Quaterniond::Identity());
    motion.rotations.push_back(axis * EulerToQuaternion(angles_at(t), EulerOrder::kXyz) *
                               axis.conjugate());
  }
  const auto found = EulerAngles(motion, 1);
  for (int t = 0; t < 400; ++t) EXPECT_LE((found[t] - angles_at(t)).norm(), 1e-9) << t;
}

TEST(StandardJoints, LieWhereTheirBonesEnd) {
  const auto skeleton = test::FigureSkeleton();
  const Motion motion = test::SmoothMotion(skeleton, 1, 3, 120);
  const JointTrajectories all = ForwardKinematics(motion);
  const JointTrajectories standard = StandardJoints(motion);
  ASSERT_EQ(standard.joint_count, kStandardJointCount);
  EXPECT_EQ(standard.rate_hz, 120);
  const std::pair<StandardJoint, const char*> ends[] = {
      {StandardJoint::kRoot, "root"},       {StandardJoint::kLhip, "lhipjoint"},
      {StandardJoint::kRankle, "rtibia"},   {StandardJoint::kBelly, "lowerback"},
      {StandardJoint::kNeck, "thorax"},     {StandardJoint::kLclavicle, "thorax"},
      {StandardJoint::kHeadtop, "head"},    {StandardJoint::kLshoulder, "lclavicle"},
      {StandardJoint::kRelbow, "rhumerus"}, {StandardJoint::kRfingers, "rfingers"}};
  for (const auto& [joint, bone] : ends) {
    EXPECT_EQ(standard.at(2, joint), all.at(2, skeleton->FindBone(bone).value())) << bone;
  }
}

TEST(StandardJoints, NamesTheBonesThatTheSkeletonLacks) {
  AsfSkeleton asf = test::FigureAsf();
  std::erase_if(asf.hierarchy, [](const auto& family) {
    return family.children.front() == "lfingers" || family.children.front() == "head";
  });
  Diagnostics diagnostics;
  const auto skeleton = BuildSkeleton(asf, {}, diagnostics);
  const Error error =
      test::ErrorOf([&] { (void)StandardJoints(test::SmoothMotion(skeleton, 1, 1, 120)); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), HasSubstr("figure.asf"));
  EXPECT_THAT(error.what(), HasSubstr("'lfingers' (for lfingers)"));
  EXPECT_THAT(error.what(), HasSubstr("'head' (for headtop)"));
}

TEST(BoundingBox, HoldsAllJointsOfAllFrames) {
  JointTrajectories joints{.rate_hz = 120, .joint_count = 2};
  joints.positions_cm = {{1, -2, 3}, {0, 0, 0}, {-4, 5, 6}, {2, 2, -7}};
  const BoundingBox box = ComputeBoundingBox(joints);
  EXPECT_EQ(box.low_cm, Vector3d(-4, -2, -7));
  EXPECT_EQ(box.high_cm, Vector3d(2, 5, 6));
  EXPECT_EQ(ComputeBoundingBox({}).high_cm, Vector3d::Zero());
}

}  // namespace
}  // namespace kinebase
