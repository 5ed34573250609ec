#include "kinebase/motion/motion_editing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_file.h"
#include "motion/figure.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

Motion Smooth(int frames, double rate_hz) {
  return test::SmoothMotion(test::FigureSkeleton(), 7, frames, rate_hz);
}

TEST(CutMotion, TakesTheFramesAndTheirNumbers) {
  Motion motion = Smooth(10, 120);
  motion.first_frame = 2925;
  const Motion cut = CutMotion(motion, 3, 6);
  EXPECT_EQ(cut.frame_count, 4);
  EXPECT_EQ(cut.first_frame, 2928);
  EXPECT_EQ(cut.rate_hz, 120);
  ASSERT_EQ(cut.root_position_cm.size(), 4);
  ASSERT_EQ(cut.rotations.size(), 4 * motion.skeleton->joints().size());
  for (int frame = 0; frame < 4; ++frame) {
    EXPECT_EQ(cut.root_position_cm[frame], motion.root_position_cm[frame + 3]);
    EXPECT_EQ(cut.rotation(frame, 5).coeffs(), motion.rotation(frame + 3, 5).coeffs());
  }
  EXPECT_EQ(CutMotion(motion, 0, 9).rotations.size(), motion.rotations.size());
}

TEST(CutMotion, RefusesRangesThatLeaveTheMotion) {
  const Motion motion = Smooth(10, 120);
  for (const auto& [first, last] : {std::pair(-1, 3), {0, 10}, {5, 4}, {10, 10}}) {
    const Error error = test::ErrorOf([&] { (void)CutMotion(motion, first, last); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr("has frames 1 to 10"));
  }
}

TEST(ResampleMotion, PicksFramesExactlyWhereTheRateDivides) {
  const Motion motion = Smooth(42, 120);
  const Motion slow = ResampleMotion(motion, 30);
  ASSERT_EQ(slow.frame_count, 11);
  EXPECT_EQ(slow.rate_hz, 30);
  for (int frame = 0; frame < 11; ++frame) {
    EXPECT_EQ(slow.root_position_cm[frame], motion.root_position_cm[std::size_t{4} * frame]);
    for (int joint = 0; joint < motion.joint_count(); ++joint) {
      EXPECT_EQ(slow.rotation(frame, joint).coeffs(), motion.rotation(4 * frame, joint).coeffs());
    }
  }
}

// 120 Hz: frame 7 is at 6 / 120 s, and so between samples 2 (4 / 120 s) and 3 (8 / 120 s) of 30 Hz.
TEST(ResampleMotion, KeepsTheTimeOfNumberedFrames) {
  const Motion motion = Smooth(42, 120);
  const Motion slow = ResampleMotion(CutMotion(motion, 6, 41), 30);
  EXPECT_EQ(slow.first_frame, 3);
  ASSERT_EQ(slow.frame_count, 9);  // Frames 9, 13 … 41.
  for (int frame = 0; frame < slow.frame_count; ++frame) {
    EXPECT_EQ(slow.root_position_cm[frame],
              motion.root_position_cm[4 * (slow.first_frame - 1 + frame)]);
  }
  const Motion whole = ResampleMotion(motion, 50);
  const Motion part = ResampleMotion(CutMotion(motion, 10, 30), 50);
  for (int frame = 0; frame < part.frame_count; ++frame) {
    EXPECT_LT((part.root_position_cm[frame] - whole.root_position_cm[part.first_frame - 1 + frame])
                  .norm(),
              1e-9);
  }
}

TEST(ResampleMotion, TakesTheFirstOfTooFewFrames) {
  const Motion motion = Smooth(42, 120);
  const Motion slow = ResampleMotion(CutMotion(motion, 5, 6), 30);  // 5 / 120 and 6 / 120 s.
  ASSERT_EQ(slow.frame_count, 1);
  EXPECT_EQ(slow.first_frame, 2);  // 4 / 120 s is nearer than 8 / 120 s.
  EXPECT_EQ(slow.root_position_cm[0], motion.root_position_cm[5]);
}

// The formula itself in whole numbers: ⌊(n − 1) · 120 / 25⌋ + 1 = ⌊(n − 1) · 24 / 5⌋ + 1.
TEST(ResampleMotion, HasAsManyFramesAsTheTimeHolds) {
  for (int frames = 1; frames < 60; ++frames) {
    EXPECT_EQ(ResampleMotion(Smooth(frames, 25), 120).frame_count, (frames - 1) * 24 / 5 + 1);
    EXPECT_EQ(ResampleMotion(Smooth(frames, 120), 25).frame_count, (frames - 1) * 5 / 24 + 1);
  }
}

TEST(ResampleMotion, GoesStraightInPlaceAndEvenlyInAngle) {
  Motion motion = Smooth(2, 10);
  motion.root_position_cm = {{0, 0, 0}, {10, -20, 30}};
  motion.rotations[0] = EulerToQuaternion({0, 0, 0.2}, EulerOrder::kXyz);
  auto& last = motion.rotations[motion.skeleton->joints().size()];
  last = EulerToQuaternion({0, 0, 1}, EulerOrder::kXyz);
  last.coeffs() *= -1;  // The same rotation: the way there must not be the long one.
  const Motion fast = ResampleMotion(motion, 40);
  ASSERT_EQ(fast.frame_count, 5);
  EXPECT_LE((fast.root_position_cm[1] - Vector3d(2.5, -5, 7.5)).norm(), 1e-12);
  EXPECT_LE(fast.rotation(1, 0).angularDistance(EulerToQuaternion({0, 0, 0.4}, EulerOrder::kXyz)),
            1e-7);
  EXPECT_LE(fast.rotation(4, 0).angularDistance(motion.rotation(1, 0)), 1e-7);
}

TEST(ResampleMotion, RefusesRatesThatMakeNoSense) {
  Motion motion = Smooth(3, 120);
  for (const double rate : {0.0, -30.0, std::nan(""), 1e18}) {
    EXPECT_EQ(test::ErrorOf([&] { (void)ResampleMotion(motion, rate); }).code(),
              ErrorCode::kInvalidArgument);
  }
  motion.rate_hz = 0;
  EXPECT_EQ(test::ErrorOf([&] { (void)ResampleMotion(motion, 30); }).code(),
            ErrorCode::kInvalidArgument);
}

TEST(ResampleTrajectories, IsLinearBetweenFrames) {
  JointTrajectories joints{.rate_hz = 60, .joint_count = 1};
  joints.positions_cm = {{0, 0, 0}, {2, 4, -6}, {10, 0, 0}};
  const JointTrajectories fast = ResampleTrajectories(joints, 120);
  EXPECT_EQ(fast.rate_hz, 120);
  ASSERT_EQ(fast.frame_count(), 5);
  EXPECT_EQ(fast.at(1, 0), Vector3d(1, 2, -3));
  EXPECT_EQ(fast.at(2, 0), Vector3d(2, 4, -6));
  EXPECT_EQ(fast.at(3, 0), Vector3d(6, 2, -3));
}

TEST(ResampleTrajectories, MissesOnlyWhatNeedsAMissingFrame) {
  const double nan = std::nan("");
  JointTrajectories joints{.rate_hz = 60, .joint_count = 1};
  joints.positions_cm = {{0, 0, 0}, {nan, nan, nan}, {10, 0, 0}, {20, 0, 0}};
  const JointTrajectories fast = ResampleTrajectories(joints, 120);
  for (int frame = 0; frame < 7; ++frame) {
    EXPECT_EQ(fast.at(frame, 0).hasNaN(), frame >= 1 && frame <= 3) << frame;
  }
}

RC_GTEST_PROP(MirrorMotion, TwiceIsTheMotionItself, ()) {
  AsfSkeleton asf = test::FigureAsf();
  asf.root_orientation = {10, 20, 30};
  asf.root_axis = "YZX";
  Diagnostics ignored;
  const Motion motion = test::SmoothMotion(BuildSkeleton(asf, {}, ignored),
                                           *rc::gen::arbitrary<unsigned>(), 10, 120, 3);
  const Motion twice = MirrorMotion(MirrorMotion(motion));
  RC_ASSERT(test::LargestDistance(ForwardKinematics(twice), ForwardKinematics(motion)) < 1e-9);
}

RC_GTEST_PROP(MirrorMotion, MirrorsEveryJointOfASymmetricFigure, ()) {
  AsfSkeleton asf = test::FigureAsf();
  asf.root_orientation = {10, 20, 30};
  Diagnostics ignored;
  const Motion motion = test::SmoothMotion(BuildSkeleton(asf, {}, ignored),
                                           *rc::gen::arbitrary<unsigned>(), 10, 120, 3);
  const JointTrajectories mirrored = StandardJoints(MirrorMotion(motion));
  RC_ASSERT(test::LargestDistance(mirrored, MirrorTrajectories(StandardJoints(motion))) < 1e-9);
}

TEST(MirrorMotion, MirrorsARealFigureUpToTheDifferencesOfItsSides) {
  KINEBASE_NEEDS_TEST_DATA();
  const Motion motion = LoadRecording(test::TestData("data/hdm05/cut_amc/throwBasketball/"
                                                     "HDM_bd_throwBasketball_001_120.amc"))
                            .motion;
  const Skeleton& skeleton = *motion.skeleton;
  // However the chain from the root bends, its end is off by at most the sum of the differences.
  double asymmetry_cm = 0;
  for (int joint = 1; joint < skeleton.joint_count(); ++joint) {
    const Joint& bone = skeleton.joints()[joint];
    const auto other = skeleton.FindBone(test::OtherSide(bone.bone_name));
    const Vector3d& offset = skeleton.joints()[other.value_or(joint)].offset_cm;
    asymmetry_cm +=
        (bone.offset_cm - Vector3d(-offset.x(), offset.y(), offset.z())).norm() / (other ? 2 : 1);
  }
  const double distance = test::LargestDistance(StandardJoints(MirrorMotion(motion)),
                                                MirrorTrajectories(StandardJoints(motion)));
  EXPECT_GT(distance, 0);
  EXPECT_LE(distance, asymmetry_cm);
  EXPECT_LE(distance, 10);
}

TEST(MirrorMotion, NamesABoneWithoutCounterpart) {
  Joint root{.name = "root", .bone_name = "root"};
  Joint arm{.name = "arm", .bone_name = "LeftArm", .parent = 0};
  Motion motion{.skeleton = std::make_shared<const Skeleton>(std::vector{root, arm})};
  motion.frame_count = 0;
  const Error error = test::ErrorOf([&] { (void)MirrorMotion(motion); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), HasSubstr("'LeftArm' has no counterpart 'RightArm'"));
}

TEST(MirrorTrajectories, ExchangesTheSides) {
  JointTrajectories joints{.rate_hz = 120, .joint_count = kStandardJointCount};
  for (int j = 0; j < kStandardJointCount; ++j) joints.positions_cm.emplace_back(j + 1, 10 + j, -j);
  const JointTrajectories mirrored = MirrorTrajectories(joints);
  const Vector3d lwrist = joints.at(0, StandardJoint::kLwrist);
  EXPECT_EQ(mirrored.at(0, StandardJoint::kRwrist), Vector3d(-lwrist.x(), lwrist.y(), lwrist.z()));
  EXPECT_EQ(mirrored.at(0, StandardJoint::kRoot), Vector3d(-1, 10, 0));
  EXPECT_EQ(MirrorTrajectories(mirrored).positions_cm, joints.positions_cm);
  joints.joint_count = 12;
  EXPECT_EQ(test::ErrorOf([&] { (void)MirrorTrajectories(joints); }).code(),
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace kinebase
