#include "kinebase/features/joint_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinebase/core/error.h"
#include "kinebase/features/feature_extraction.h"
#include "kinebase/motion/kinematics.h"
#include "motion/figure.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

using ::testing::HasSubstr;

Motion SomeMotion(double rate_hz = 120, int frames = 50) {
  return SmoothMotion(FigureSkeleton(), 3, frames, rate_hz);
}

void ExpectNear(const JointStream& actual, const JointStream& expected, float tolerance) {
  ASSERT_EQ(actual.values.size(), expected.values.size());
  for (std::size_t i = 0; i < expected.values.size(); ++i) {
    ASSERT_NEAR(actual.values[i], expected.values[i], tolerance) << i;
  }
}

TEST(JointStream, HasTheColumnsOfTheFeatures) {
  const FeatureSet features = LoadFeatureSet("bonn");
  for (const double source_hz : {120.0, 60.0, 100.0, 25.0}) {
    Motion motion = SomeMotion(source_hz, 47);
    motion.first_frame = 11;
    for (const double rate_hz : {30.0, 60.0, 120.0}) {
      const FeatureMatrix matrix = ExtractFeatures(StandardJoints(motion), features, rate_hz);
      for (const auto kind : {JointStreamKind::kRotations, JointStreamKind::kPositions}) {
        const JointStream stream = ExtractJointStream(motion, kind, rate_hz);
        EXPECT_EQ(stream.column_count(), matrix.column_count()) << source_hz << " " << rate_hz;
        EXPECT_EQ(stream.rate_hz, rate_hz);
      }
    }
  }
}

TEST(JointStream, HoldsTheRotationsOfTheFile) {
  const Motion motion = SomeMotion();
  const JointStream stream = ExtractJointStream(motion, JointStreamKind::kRotations);
  ASSERT_EQ(stream.joint_count, 18);
  // The left hip is the first after the root, and turns the left thigh.
  const int thigh = motion.skeleton->FindBone("lfemur").value();
  for (int column = 0; column < stream.column_count(); ++column) {
    const Eigen::Quaterniond& rotation = motion.rotation(4 * column, thigh);
    EXPECT_FLOAT_EQ(stream.Column(column)[0], static_cast<float>(rotation.w()));
    EXPECT_FLOAT_EQ(stream.Column(column)[2], static_cast<float>(rotation.y()));
  }
}

// The way from the root to the left hip is one bone that never turns on this figure.
TEST(JointStream, HoldsPlacesAsSeenFromTheRoot) {
  const Motion motion = SomeMotion();
  const JointStream stream = ExtractJointStream(motion, JointStreamKind::kPositions);
  ASSERT_EQ(stream.joint_count, 23);
  const double humerus_cm = std::sqrt(28.0 * 28 + 1);
  for (int column = 0; column < stream.column_count(); ++column) {
    EXPECT_NEAR(stream.Column(column)[0], 9 / humerus_cm, 1e-5);
    EXPECT_NEAR(stream.Column(column)[1], -8 / humerus_cm, 1e-5);
    EXPECT_NEAR(stream.Column(column)[2], 3 / humerus_cm, 1e-5);
  }
}

TEST(JointStream, DoesNotTellWhereSomebodyStandsAndFaces) {
  const Motion motion = SomeMotion();
  Motion moved = motion;
  const auto turn =
      Eigen::Quaterniond(Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, 3).normalized()));
  for (int frame = 0; frame < moved.frame_count; ++frame) {
    moved.root_position_cm[frame] = turn * moved.root_position_cm[frame] + Eigen::Vector3d(9, 8, 7);
    Eigen::Quaterniond& root = moved.rotations[frame * moved.joint_count()];
    root = turn * root;
  }
  for (const auto kind : {JointStreamKind::kRotations, JointStreamKind::kPositions}) {
    ExpectNear(ExtractJointStream(moved, kind), ExtractJointStream(motion, kind), 1e-5F);
  }
}

TEST(JointStream, DoesNotTellHowTallSomebodyIs) {
  AsfSkeleton tall = FigureAsf();
  for (AsfBone& bone : tall.bones) bone.length *= 1.3;
  Diagnostics ignored;
  const Motion motion = SomeMotion();
  Motion grown = motion;
  grown.skeleton = BuildSkeleton(tall, {}, ignored);
  ExpectNear(ExtractJointStream(grown, JointStreamKind::kPositions),
             ExtractJointStream(motion, JointStreamKind::kPositions), 1e-4F);
}

TEST(JointStream, RefusesRatesAndMotionsThatGiveNoColumns) {
  for (const double rate_hz : {0.0, -30.0, 50.0, 240.0, 0.1}) {
    const Error error = ErrorOf(
        [&] { (void)ExtractJointStream(SomeMotion(), JointStreamKind::kPositions, rate_hz); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr("must divide 120 Hz"));
  }
  Motion empty = SomeMotion();
  empty.frame_count = 0;
  EXPECT_THAT(ErrorOf([&] { (void)ExtractJointStream(empty, JointStreamKind::kRotations); }).what(),
              HasSubstr("without frames"));
}

}  // namespace
}  // namespace kinebase::test
