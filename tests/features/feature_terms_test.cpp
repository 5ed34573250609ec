// Each term type on poses and movements whose value is known.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "features/poses.h"
#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"
#include "motion/figure.h"
#include "support/files.h"

namespace kinebase {
namespace {

using Eigen::Vector3d;
using test::At;
using test::SetOf;
using test::Still;
using enum StandardJoint;

double ValueOf(const std::string& term, const std::string& unit, const JointTrajectories& joints) {
  return FeatureValues(joints, SetOf(term, unit), 0).front();
}

TEST(PlaneTerm, IsTheSignedDistanceFromThePlaneOfThreeJoints) {
  // (a − c) × (b − c) = x × z = −y; the plane y = 2 goes through c.
  auto joints =
      Still({{kNeck, {5, 2, 0}}, {kRhip, {0, 2, 7}}, {kLhip, {0, 2, 0}}, {kRwrist, {9, 5, 9}}});
  const std::string term = R"({ type = "plane", joints = ["neck", "rhip", "lhip", "rwrist"] })";
  EXPECT_DOUBLE_EQ(ValueOf(term, "cm", joints), -3);
  At(joints, 0, kRwrist).y() = 0;
  EXPECT_DOUBLE_EQ(ValueOf(term, "cm", joints), 2);
}

TEST(NormalPlaneTerm, IsTheSignedDistanceAlongADirection) {
  const auto joints =
      Still({{kChest, {0, 1, 0}}, {kNeck, {0, 1, -4}}, {kRhip, {1, 1, 2}}, {kRwrist, {8, 8, 7}}});
  EXPECT_DOUBLE_EQ(
      ValueOf(R"({ type = "normal_plane", joints = ["chest", "neck", "rhip", "rwrist"] })", "cm",
              joints),
      -5);
  EXPECT_DOUBLE_EQ(
      ValueOf(
          R"({ type = "normal_plane", joints = ["chest", "neck", "rhip", "rwrist"], absolute = true })",
          "cm", joints),
      5);
  EXPECT_DOUBLE_EQ(
      ValueOf(
          R"({ type = "normal_plane", joints = ["chest", "neck", "rhip", "rwrist"], absolute = true, factor = -1 })",
          "cm", joints),
      -5);
}

TEST(AngleTerm, IsBetweenTheDirectionsFromBToAAndFromDToC) {
  const std::string term =
      R"({ type = "angle", joints = ["relbow", "rshoulder", "neck", "root"] })";
  const auto angle = [&](const Vector3d& first, const Vector3d& second) {
    return ValueOf(term, "deg",
                   Still({{kRelbow, first + Vector3d(1, 2, 3)},
                          {kRshoulder, {1, 2, 3}},
                          {kNeck, second},
                          {kRoot, {0, 0, 0}}}));
  };
  EXPECT_NEAR(angle({3, 0, 0}, {0, 0, 5}), 90, 1e-12);
  EXPECT_NEAR(angle({3, 0, 0}, {2, 2, 0}), 45, 1e-12);
  EXPECT_NEAR(angle({3, 0, 0}, {-9, 0, 0}), 180, 1e-12);
  // Rounding must not push the cosine out of its range.
  EXPECT_NEAR(angle({0.1, 0.2, 0.3}, {0.3, 0.6, 0.9}), 0, 1e-5);
}

TEST(AngleWithUpTerm, IsFromTheYAxis) {
  const std::string term = R"({ type = "angle_with_up", joints = ["root", "neck"] })";
  const auto angle = [&](const Vector3d& neck) {
    return ValueOf(term, "deg", Still({{kRoot, {1, 1, 1}}, {kNeck, neck + Vector3d(1, 1, 1)}}));
  };
  EXPECT_NEAR(angle({0, 7, 0}), 0, 1e-12);
  EXPECT_NEAR(angle({3, 0, 4}), 90, 1e-12);
  EXPECT_NEAR(angle({0, -1, 1}), 135, 1e-12);
}

// `joints` whose right wrist moves by `step` a frame.
JointTrajectories Moving(const test::Pose& pose, const Vector3d& step, int frames = 50) {
  auto joints = Still(pose, frames);
  for (int t = 0; t < frames; ++t) At(joints, t, kRwrist) += t * step;
  return joints;
}

TEST(FastTerm, IsExactForUniformMotionAtEveryFrame) {
  for (const char* window : {"0", "100", "250", "10000"}) {
    const auto values = FeatureValues(
        Moving({}, {1, 2, 2}),
        SetOf(std::string(R"({ type = "fast", joints = ["rwrist"], window_ms = )") + window + " }",
              "cm/s"),
        0);
    ASSERT_EQ(values.size(), 50);
    for (const double value : values) EXPECT_NEAR(value, 3 * 120, 1e-9);
  }
}

TEST(FastTerm, RepeatsTheLastDifference) {
  auto joints = Still({}, 4);
  for (int t = 0; t < 4; ++t) At(joints, t, kRwrist).x() = t * t;
  EXPECT_EQ(FeatureValues(joints, SetOf(R"({ type = "fast", joints = ["rwrist"] })", "cm/s"), 0),
            (std::vector<double>{120, 360, 600, 600}));
}

TEST(FastTerm, IsZeroForASingleFrame) {
  EXPECT_EQ(ValueOf(R"({ type = "fast", joints = ["rwrist"], window_ms = 100 })", "cm/s",
                    Still({{kRwrist, {1, 2, 3}}})),
            0);
}

TEST(FastTerm, SmoothsTheVelocityNotTheSpeed) {
  // There and back a frame each: speed without smoothing, none with.
  auto joints = Still({}, 40);
  for (int t = 0; t < 40; ++t) At(joints, t, kRwrist).x() = t % 2;
  const auto rough =
      FeatureValues(joints, SetOf(R"({ type = "fast", joints = ["rwrist"] })", "cm/s"), 0);
  const auto smooth = FeatureValues(
      joints, SetOf(R"({ type = "fast", joints = ["rwrist"], window_ms = 100 })", "cm/s"), 0);
  EXPECT_DOUBLE_EQ(rough[20], 120);
  EXPECT_NEAR(smooth[20], 0, 1e-12);
}

TEST(NormalMoveTerm, IsTheVelocityAlongADirection) {
  // Along chest → neck (y), relative to the root, which moves along.
  auto joints = Moving({{kChest, {0, 1, 0}}, {kNeck, {0, 9, 0}}}, {1, 2, 3});
  for (int t = 0; t < 50; ++t) At(joints, t, kRoot).y() = 0.5 * t;
  const auto values = FeatureValues(
      joints,
      SetOf(
          R"({ type = "normal_move", joints = ["chest", "neck", "root", "rwrist"], window_ms = 250 })",
          "cm/s"),
      0);
  for (const double value : values) EXPECT_NEAR(value, 1.5 * 120, 1e-9);
}

TEST(NormalMoveTerm, UsesTheDirectionOfTheCurrentFrame) {
  auto joints = Moving({{kNeck, {0, 1, 0}}}, {1, 0, 0}, 20);
  for (int t = 10; t < 20; ++t) At(joints, t, kNeck) = {1, 0, 0};
  const auto values = FeatureValues(
      joints,
      SetOf(
          R"({ type = "normal_move", joints = ["chest", "neck", "chest", "rwrist"], window_ms = 250 })",
          "cm/s"),
      0);
  EXPECT_NEAR(values[9], 0, 1e-12);
  EXPECT_NEAR(values[10], 120, 1e-9);
}

TEST(PlaneMoveTerm, IsTheVelocityAlongTheNormalOfAPlane) {
  const auto joints =
      Moving({{kNeck, {5, 2, 0}}, {kRhip, {0, 2, 7}}, {kLhip, {0, 2, 0}}}, {1, 2, 3});
  for (const double value : FeatureValues(
           joints,
           SetOf(R"({ type = "plane_move", joints = ["neck", "rhip", "lhip", "rwrist"] })", "cm/s"),
           0)) {
    EXPECT_NEAR(value, -2 * 120, 1e-9);
  }
}

TEST(ApproachTerm, IsPositiveForFeetThatCloseSideways) {
  // The right ankle, at −x, moves towards the left one.
  auto joints = Still(
      {{kLhip, {10, 90, 0}}, {kRhip, {-10, 90, 0}}, {kLankle, {30, 0, 0}}, {kRankle, {-30, 0, 0}}},
      30);
  for (int t = 0; t < 30; ++t) At(joints, t, kRankle).x() += 0.25 * t;
  const std::string term =
      R"({ type = "approach", joints = ["lhip", "rhip", "lankle", "rankle"] })";
  for (const double value : FeatureValues(joints, SetOf(term, "cm/s"), 0))
    EXPECT_NEAR(value, 30, 1e-9);
  // Feet one behind the other: the way is not sideways.
  for (int t = 0; t < 30; ++t) {
    At(joints, t, kLankle) = {0, 0, 30};
    At(joints, t, kRankle) = {0, 0, -30 + 0.25 * t};
  }
  for (const double value : FeatureValues(joints, SetOf(term, "cm/s"), 0))
    EXPECT_NEAR(value, 0, 1e-9);
}

TEST(HeightTerm, IsOverTheLowestJointThatIsNotIgnored) {
  test::Pose pose;
  for (int j = 0; j < kStandardJointCount; ++j)
    pose[static_cast<StandardJoint>(j)] = {0, 50.0 + j, 0};
  pose[kRwrist] = {0, 12, 0};
  pose[kRfingers] = {0, 3, 0};
  pose[kLtoes] = {0, 7, 0};
  const auto joints = Still(pose);
  EXPECT_EQ(ValueOf(R"({ type = "height", joints = ["rwrist"] })", "cm", joints), 9);
  EXPECT_EQ(ValueOf(R"({ type = "height", joints = ["rwrist"], ignore = ["rfingers", "rwrist"] })",
                    "cm", joints),
            5);
  EXPECT_EQ(
      ValueOf(R"({ type = "height", joints = ["rfingers"], ignore = ["rfingers"] })", "cm", joints),
      -4);
}

TEST(ExtentTerms, MeasureTheWholeBodyOrSomeJoints) {
  const auto joints = Still({{kHeadtop, {0, 170, 0}},
                             {kLtoes, {0, -5, 0}},
                             {kRfingers, {30, 0, 40}},
                             {kLwrist, {-3, 0, -4}}});
  EXPECT_EQ(ValueOf(R"({ type = "height_extent" })", "cm", joints), 175);
  EXPECT_DOUBLE_EQ(ValueOf(R"({ type = "ground_extent" })", "cm", joints), 55);
  EXPECT_DOUBLE_EQ(ValueOf(R"({ type = "ground_extent", joints = ["lwrist", "root", "headtop"] })",
                           "cm", joints),
                   5);
}

TEST(Terms, AddUpOrGiveTheSmallest) {
  const auto joints = Still({{kHeadtop, {0, 170, 0}}, {kRwrist, {3, 0, 4}}});
  const std::string terms =
      "{ type = \"height_extent\" },\n{ type = \"ground_extent\", factor = -1 }";
  EXPECT_DOUBLE_EQ(ValueOf(terms, "cm", joints), 165);
  EXPECT_DOUBLE_EQ(
      FeatureValues(joints, SetOf(terms, "cm", "combine = \"smallest\"\nstrong = 1\nweak = 1\n"), 0)
          .front(),
      -5);
}

TEST(FeatureValues, RefuseAFeatureThatTheSetLacks) {
  const auto joints = Still({});
  const FeatureSet set = LoadFeatureSet("bonn");
  for (const int feature : {-1, 39}) {
    EXPECT_EQ(test::ErrorOf([&] { (void)FeatureValues(joints, set, feature); }).code(),
              ErrorCode::kInvalidArgument);
  }
}

// Whether a feature looks at a joint.
bool Uses(const FeatureSet& set, const Feature& feature, StandardJoint joint) {
  const auto has = [&](const auto& joints) {
    return std::ranges::find(joints, joint) != joints.end();
  };
  if (feature.length >= 0) {
    for (const auto& [a, b] : set.lengths[feature.length].segments) {
      if (a == joint || b == joint) return true;
    }
  }
  return std::ranges::any_of(feature.terms, [&](const FeatureTerm& term) {
    return has(term.joints) || term.type == TermType::kHeightExtent ||
           (term.type == TermType::kHeight && !has(term.ignored_joints)) ||
           (term.type == TermType::kGroundExtent && term.joints.empty());
  });
}

class MissingJoints : public testing::TestWithParam<std::string> {};

TEST_P(MissingJoints, NeverCountAsTrueAndTouchNoOtherFeature) {
  const FeatureSet set = LoadFeatureSet(GetParam());
  const auto joints = StandardJoints(test::SmoothMotion(test::FigureSkeleton(), 5, 120, 120));
  const FeatureMatrix whole = ExtractFeatures(joints, set, 120);
  for (int j = 0; j < kStandardJointCount; ++j) {
    const auto joint = static_cast<StandardJoint>(j);
    auto missing = joints;
    for (int t = 0; t < 120; ++t) At(missing, t, joint).setConstant(std::nan(""));
    const FeatureMatrix matrix = ExtractFeatures(missing, set, 120);
    for (int row = 0; row < set.feature_count(); ++row) {
      const bool uses = Uses(set, set.features[row], joint);
      for (int column = 0; column < matrix.column_count(); ++column) {
        ASSERT_EQ(matrix.at(column, row), !uses && whole.at(column, row))
            << ToString(joint) << " " << set.features[row].id;
      }
    }
  }
}

TEST_P(MissingJoints, MissOnlyAroundTheFramesThatLackThem) {
  const FeatureSet set = LoadFeatureSet(GetParam());
  auto joints = StandardJoints(test::SmoothMotion(test::FigureSkeleton(), 6, 200, 120));
  for (int j = 0; j < kStandardJointCount; ++j) {
    At(joints, 100, static_cast<StandardJoint>(j)).setConstant(std::nan(""));
  }
  for (int row = 0; row < set.feature_count(); ++row) {
    const auto values = FeatureValues(joints, set, row);
    EXPECT_TRUE(std::isnan(values[100])) << set.features[row].id;
    // The longest window is a quarter of a second: 30 frames.
    for (int t = 0; t < 200; ++t) EXPECT_TRUE(std::abs(t - 100) <= 16 || !std::isnan(values[t]));
  }
}

INSTANTIATE_TEST_SUITE_P(Profiles, MissingJoints, testing::Values("bonn", "paper"));

}  // namespace
}  // namespace kinebase
