#include "kinebase/features/pose_stream.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "features/poses.h"
#include "support/files.h"

namespace kinebase {
namespace {

using test::At;

// Joints anywhere, hips apart; the same numbers everywhere.
JointTrajectories AnyJoints(int frames, double rate_hz) {
  JointTrajectories joints = test::Still({}, frames, rate_hz);
  for (std::size_t i = 0; i < joints.positions_cm.size(); ++i) {
    const auto x = static_cast<double>(i);
    joints.positions_cm[i] = {40 * std::sin(x), 90 + 60 * std::cos(1.7 * x),
                              30 * std::sin(2.3 * x)};
  }
  return joints;
}

void ExpectSame(const PoseStream& a, const PoseStream& b) {
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i)
    ASSERT_NEAR(a.values[i], b.values[i], 1e-5) << i;
}

TEST(PoseStream, HasTheColumnsOfTheFeatures) {
  const FeatureSet features = LoadFeatureSet("bonn");
  for (const double rate_hz : {120.0, 60.0, 50.0, 25.0}) {
    for (int frames = 1; frames < 40; ++frames) {
      const JointTrajectories joints = AnyJoints(frames, rate_hz);
      EXPECT_EQ(ExtractPoses(joints, 30).column_count(),
                ExtractFeatures(joints, features, 30).column_count())
          << frames << " at " << rate_hz;
    }
  }
}

// Where somebody stands, which way he faces and how tall he is makes no difference.
RC_GTEST_PROP(PoseStream, IsTheSameAnywhereAndForAnySize, ()) {
  const double angle = *rc::gen::inRange(-314, 314) / 100.0;
  const double size = *rc::gen::inRange(50, 200) / 100.0;
  const Eigen::Vector3d there(*rc::gen::inRange(-500, 500), 7, *rc::gen::inRange(-500, 500));
  const JointTrajectories joints = AnyJoints(20, 60);
  JointTrajectories moved = joints;
  const Eigen::AngleAxisd turn(angle, Eigen::Vector3d::UnitY());
  for (Eigen::Vector3d& place : moved.positions_cm) place = turn * place * size + there;
  ExpectSame(ExtractPoses(joints), ExtractPoses(moved));
}

TEST(PoseStream, PointsTheHipsToXAndTheFrontToZ) {
  JointTrajectories joints = AnyJoints(1, 30);
  At(joints, 0, StandardJoint::kRoot) = {100, 90, 100};
  At(joints, 0, StandardJoint::kLhip) = {100, 95, 110};  // Faces −x, so left is +z.
  At(joints, 0, StandardJoint::kRhip) = {100, 85, 90};
  At(joints, 0, StandardJoint::kHead) = {70, 90, 100};
  const PoseStream poses = ExtractPoses(joints);
  const auto place = [&](StandardJoint joint) {
    return poses.Column(0).subspan(3 * static_cast<std::size_t>(joint), 3);
  };
  EXPECT_FLOAT_EQ(place(StandardJoint::kRoot)[0], 0);
  EXPECT_GT(place(StandardJoint::kLhip)[0], 0);
  EXPECT_NEAR(place(StandardJoint::kLhip)[2], 0, 1e-6);
  EXPECT_NEAR(place(StandardJoint::kLhip)[0] / place(StandardJoint::kLhip)[1], 2, 1e-5);
  EXPECT_NEAR(place(StandardJoint::kHead)[0], 0, 1e-6);
  EXPECT_GT(place(StandardJoint::kHead)[2], 0);
  EXPECT_FLOAT_EQ(place(StandardJoint::kRhip)[0], -place(StandardJoint::kLhip)[0]);
}

TEST(PoseStream, NeedsTheStandardJoints) {
  const auto code_of = [](const JointTrajectories& joints) {
    return test::ErrorOf([&] { (void)ExtractPoses(joints); }).code();
  };
  EXPECT_EQ(code_of(test::Still({}, 0)), ErrorCode::kInvalidArgument);
  JointTrajectories few{.rate_hz = 30, .joint_count = 1};
  few.positions_cm.assign(1, Eigen::Vector3d::Zero());
  EXPECT_EQ(code_of(few), ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace kinebase
