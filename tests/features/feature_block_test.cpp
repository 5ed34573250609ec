// Values are computed block by block; nobody is to see where one block ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "features/poses.h"
#include "kinebase/features/feature_extraction.h"
#include "kinebase/features/smoothing.h"

namespace kinebase::test {
namespace {

// A hand on a winding way, the neck on another.
JointTrajectories Waving(int frames) {
  JointTrajectories joints = Still({}, frames);
  for (int t = 0; t < frames; ++t) {
    At(joints, t, StandardJoint::kRwrist) = {40 * std::sin(0.05 * t), 100 + 0.3 * t,
                                             25 * std::cos(0.11 * t)};
    At(joints, t, StandardJoint::kNeck) = {0.1 * t, 150 + std::sin(0.2 * t), 0};
  }
  return joints;
}

// The length of the smoothed velocity from its formula, over the whole recording at once.
std::vector<double> Speed(const JointTrajectories& joints, double window_ms) {
  const int frames = joints.frame_count();
  std::vector<std::vector<double>> axes(3);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> steps(static_cast<std::size_t>(frames));
    for (int t = 0; t < frames; ++t) {
      const int from = std::max(0, std::min(t, frames - 2));
      const int to = std::min(from + 1, frames - 1);
      steps[static_cast<std::size_t>(t)] = joints.at(to, StandardJoint::kRwrist)[axis] -
                                           joints.at(from, StandardJoint::kRwrist)[axis];
    }
    axes[static_cast<std::size_t>(axis)] = BoxFilter(steps, BoxWidth(window_ms, joints.rate_hz));
  }
  std::vector<double> speed(static_cast<std::size_t>(frames));
  for (std::size_t t = 0; t < speed.size(); ++t) {
    speed[t] = joints.rate_hz * std::hypot(axes[0][t], axes[1][t], axes[2][t]);
  }
  return speed;
}

// Around multiples of a block of 128 samples, with its margins; shorter than the window, too.
constexpr std::array kLengths = {1,   2,   3,   29,  31,  127, 128, 129, 142, 143, 144,
                                 157, 158, 255, 256, 257, 271, 286, 287, 384, 1000};

TEST(FeatureValues, AreThoseOfTheWholeRecordingWhateverItsLength) {
  for (const std::string window : {"1", "100", "250", "3000"}) {
    const FeatureSet set =
        SetOf(R"({ type = "fast", joints = ["rwrist"], window_ms = )" + window + " }", "cm/s");
    for (const int frames : kLengths) {
      const JointTrajectories joints = Waving(frames);
      const std::vector<double> expected = Speed(joints, std::stod(window));
      const std::vector<double> values = FeatureValues(joints, set, 0);
      ASSERT_EQ(values.size(), expected.size());
      for (std::size_t t = 0; t < values.size(); ++t) {
        ASSERT_NEAR(values[t], expected[t], 1e-9) << window << ' ' << frames << ' ' << t;
      }
    }
  }
}

TEST(FeatureValues, OfALongRecordingAreMissingOnlyWhereTheJointIs) {
  JointTrajectories joints = Waving(600);
  const int missing = 300;
  At(joints, missing, StandardJoint::kRwrist).setConstant(std::numeric_limits<double>::quiet_NaN());
  const FeatureSet set =
      SetOf(R"({ type = "fast", joints = ["rwrist"], window_ms = 100 })", "cm/s");
  const std::vector<double> values = FeatureValues(joints, set, 0);
  for (int t = 0; t < 600; ++t) {
    // Two steps lack an end, and twelve samples see each.
    const bool sees_it = t >= missing - 1 - 6 && t <= missing + 5;
    EXPECT_EQ(std::isnan(values[static_cast<std::size_t>(t)]), sees_it) << t;
  }
}

TEST(Features, GoOnHoldingFromOneBlockToTheNext) {
  // A slow rise past the strong threshold and half the way back, which keeps the feature.
  JointTrajectories joints = Still({}, 400);
  for (int t = 0; t < 400; ++t) {
    At(joints, t, StandardJoint::kRwrist).y() = t < 100 ? 0.0 : t < 120 ? 20.0 : 10.0;
  }
  const FeatureSet set = SetOf(R"({ type = "height", joints = ["rwrist"], ignore = ["rwrist"] })",
                               "cm", "test = \"above\"\nstrong = 15\nweak = 5\n");
  const FeatureMatrix matrix = ExtractFeatures(joints, set, 120);
  for (int t = 0; t < 400; ++t) EXPECT_EQ(matrix.at(t, 0), t >= 100) << t;
}

}  // namespace
}  // namespace kinebase::test
