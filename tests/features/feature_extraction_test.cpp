// From values to bits: thresholds, hysteresis, rates, profiles, mirroring.

#include "kinebase/features/feature_extraction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "features/poses.h"
#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_editing.h"
#include "motion/figure.h"
#include "support/files.h"

namespace kinebase {
namespace {

using test::At;
using test::SetOf;
using test::Still;
using testing::ElementsAre;
using testing::HasSubstr;
using enum StandardJoint;

// The bits that the height of the right wrist over the ground gives, one a frame.
std::vector<int> Bits(const std::vector<double>& heights, const std::string& keys,
                      double rate_hz = 120) {
  auto joints = Still({}, static_cast<int>(heights.size()));
  for (std::size_t t = 0; t < heights.size(); ++t) {
    At(joints, static_cast<int>(t), kRwrist).y() = heights[t];
  }
  const FeatureMatrix matrix = ExtractFeatures(
      joints, SetOf(R"({ type = "height", joints = ["rwrist"], ignore = ["rwrist"] })", "cm", keys),
      rate_hz);
  std::vector<int> bits;
  for (int column = 0; column < matrix.column_count(); ++column) {
    EXPECT_LE(matrix.columns[column], 1);
    bits.push_back(matrix.at(column, 0) ? 1 : 0);
  }
  return bits;
}

TEST(Hysteresis, RisesWithTheStrongTestAndFallsWithTheWeakOne) {
  const std::string keys = "test = \"at_least\"\nstrong = 10\nweak = 6\n";
  EXPECT_THAT(Bits({0, 7, 9, 10, 9, 6, 5.9, 7, 9.9, 10}, keys),
              ElementsAre(0, 0, 0, 1, 1, 1, 0, 0, 0, 1));
}

TEST(Hysteresis, CountsTheFirstFrameAsARise) {
  const std::string keys = "test = \"at_least\"\nstrong = 10\nweak = 6\n";
  EXPECT_THAT(Bits({12, 7, 5, 7}, keys), ElementsAre(1, 1, 0, 0));
  EXPECT_THAT(Bits({7, 7}, keys), ElementsAre(0, 0));
}

TEST(Hysteresis, SeesWhatHappensBetweenTheColumns) {
  const std::string keys = "test = \"at_least\"\nstrong = 10\nweak = 6\n";
  // Frame 1 rises, frame 6 falls; columns are frames 0, 4 and 8.
  EXPECT_THAT(Bits({7, 10, 7, 7, 7, 7, 0, 7, 7}, keys, 30), ElementsAre(0, 1, 0));
}

TEST(Threshold, IncludesItselfOrNotAsItsNameSays) {
  EXPECT_THAT(Bits({9, 10, 11}, "test = \"above\"\nstrong = 10\nweak = 10\n"),
              ElementsAre(0, 0, 1));
  EXPECT_THAT(Bits({9, 10, 11}, "test = \"at_least\"\nstrong = 10\nweak = 10\n"),
              ElementsAre(0, 1, 1));
  EXPECT_THAT(Bits({9, 10, 11}, "test = \"below\"\nstrong = 10\nweak = 10\n"),
              ElementsAre(1, 0, 0));
  EXPECT_THAT(Bits({9, 10, 11}, "test = \"at_most\"\nstrong = 10\nweak = 10\n"),
              ElementsAre(1, 1, 0));
  EXPECT_THAT(Bits({9, 10, 11, 12, 13}, "test = \"inside\"\nstrong = [10, 12]\nweak = [10, 12]\n"),
              ElementsAre(0, 1, 1, 1, 0));
  EXPECT_THAT(Bits({9, 10, 9, 8, 7, 9}, "test = \"inside\"\nstrong = [10, 12]\nweak = [8, 12]\n"),
              ElementsAre(0, 1, 1, 1, 0, 0));
}

TEST(Lengths, AreThoseOfTheFirstFrame) {
  const FeatureSet set = ParseFeatureSet(R"(format = "kinebase-feature-set"
version = 1
name = "one"
[lengths]
arm = [["rshoulder", "relbow"], ["relbow", "rwrist"]]
[[feature]]
id = "F1"
name = "high"
test = "at_least"
strong = 2
weak = 2
unit = "arm"
terms = [{ type = "height", joints = ["headtop"] }]
)",
                                         "one.toml");
  // The arm is 3 + 4 cm long in the first frame and 100 cm in the second.
  auto joints = Still({{kRelbow, {3, 0, 0}}, {kRwrist, {3, 4, 0}}, {kHeadtop, {0, 14, 0}}}, 3);
  At(joints, 1, kRelbow) = {100, 0, 0};
  At(joints, 2, kHeadtop) = {0, 13.9, 0};
  const FeatureMatrix matrix = ExtractFeatures(joints, set, 120);
  EXPECT_THAT(matrix.columns, ElementsAre(1, 1, 0));
}

// Hands (or feet) 200 cm apart, on their own sides or crossed.
bool FarApart(const char* profile, const char* feature, double left_x) {
  const FeatureSet set = LoadFeatureSet(profile);
  const auto joints = Still({{kLshoulder, {20, 150, 0}},
                             {kRshoulder, {-20, 150, 0}},
                             {kRelbow, {-20, 120, 0}},
                             {kLwrist, {left_x, 100, 0}},
                             {kRwrist, {-left_x, 100, 0}},
                             {kLhip, {10, 90, 0}},
                             {kRhip, {-10, 90, 0}},
                             {kLankle, {left_x, 0, 0}},
                             {kRankle, {-left_x, 0, 0}}});
  return ExtractFeatures(joints, set).at(0, set.Find(feature).value());
}

TEST(Profiles, DifferInWhetherCrossedHandsAndFeetAreFarApart) {
  for (const char* feature : {"F9", "F19"}) {
    EXPECT_TRUE(FarApart("bonn", feature, 100));
    EXPECT_TRUE(FarApart("paper", feature, 100));
    EXPECT_TRUE(FarApart("bonn", feature, -100));
    EXPECT_FALSE(FarApart("paper", feature, -100));
  }
}

TEST(ExtractFeatures, KeepsEveryColumnThatTheRateAsksFor) {
  const FeatureSet set = LoadFeatureSet("bonn");
  const auto joints = StandardJoints(test::SmoothMotion(test::FigureSkeleton(), 2, 50, 120));
  const FeatureMatrix all = ExtractFeatures(joints, set, 120);
  ASSERT_EQ(all.column_count(), 50);
  EXPECT_EQ(all.feature_count, 39);
  for (const int step : {1, 2, 3, 4, 5, 8, 60}) {
    const FeatureMatrix some = ExtractFeatures(joints, set, 120.0 / step);
    EXPECT_EQ(some.rate_hz, 120.0 / step);
    ASSERT_EQ(some.column_count(), (50 + step - 1) / step);
    for (int column = 0; column < some.column_count(); ++column) {
      EXPECT_EQ(some.columns[column], all.columns[static_cast<std::size_t>(column) * step]);
    }
  }
}

TEST(ExtractFeatures, RefusesRatesThatDoNotDivide) {
  const FeatureSet set = LoadFeatureSet("bonn");
  const auto joints = Still({});
  for (const double rate : {0.0, -30.0, 25.0, 240.0, 31.0, std::nan(""), 1e-30, 1e300}) {
    const Error error = test::ErrorOf([&] { (void)ExtractFeatures(joints, set, rate); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr("must divide"));
  }
}

// Samples i at time i / 120, linear between the frames around it, in whole numbers and fractions.
JointTrajectories PlainResampled(const JointTrajectories& joints, int rate_hz) {
  JointTrajectories result{.rate_hz = 120, .joint_count = kStandardJointCount};
  const int frames = joints.frame_count();
  for (int i = 0; i < (frames - 1) * 120 / rate_hz + 1; ++i) {
    const int before = i * rate_hz / 120;
    const double share = i * rate_hz % 120 / 120.0;
    for (int j = 0; j < kStandardJointCount; ++j) {
      const Eigen::Vector3d& a = joints.at(before, j);
      const Eigen::Vector3d& b = joints.at(std::min(before + 1, frames - 1), j);
      result.positions_cm.emplace_back(a + share * (b - a));
    }
  }
  return result;
}

TEST(ExtractFeatures, BringsOtherRatesTo120HzFirst) {
  for (const char* profile : {"bonn", "paper"}) {
    const FeatureSet set = LoadFeatureSet(profile);
    for (const int rate : {30, 60, 100, 25, 240}) {
      const auto joints =
          StandardJoints(test::SmoothMotion(test::FigureSkeleton(), 8, 2 * rate + 1, rate));
      const FeatureMatrix matrix = ExtractFeatures(joints, set);
      EXPECT_EQ(matrix.column_count(), (2 * 120 + 1 + 3) / 4) << rate;
      EXPECT_EQ(matrix.columns, ExtractFeatures(PlainResampled(joints, rate), set).columns) << rate;
    }
  }
}

TEST(ExtractFeatures, HasAsManySamplesAsTheTimeHolds) {
  const FeatureSet set = LoadFeatureSet("bonn");
  for (const int rate : {60, 100, 25, 50}) {
    for (int frames = 1; frames < 40; ++frames) {
      EXPECT_EQ(ExtractFeatures(Still({}, frames, rate), set, 120).column_count(),
                (frames - 1) * 120 / rate + 1);
    }
  }
}

TEST(ExtractFeatures, RefusesWhatIsNoRecordingOfTheStandardJoints) {
  const FeatureSet set = LoadFeatureSet("bonn");
  JointTrajectories none{.rate_hz = 120, .joint_count = kStandardJointCount};
  JointTrajectories others = Still({});
  others.joint_count = 12;
  JointTrajectories timeless = Still({}, 3, 0);
  for (const auto& joints : {none, others, timeless}) {
    EXPECT_EQ(test::ErrorOf([&] { (void)ExtractFeatures(joints, set); }).code(),
              ErrorCode::kInvalidArgument);
  }
}

class Mirroring : public testing::TestWithParam<std::string> {};

// On a figure whose sides are alike: mirrored motion, mirrored rows. F1 and F2 share one plane, and
// the paper's F22 compares unsigned distances.
TEST_P(Mirroring, OfAMotionExchangesTheRowsOfItsMatrix) {
  const FeatureSet set = LoadFeatureSet(GetParam());
  const std::vector<int> rows = set.MirrorRows();
  const auto skeleton = test::FigureSkeleton();
  std::uint64_t ones = 0;
  std::uint64_t zeros = 0;
  for (unsigned seed = 1; seed <= 25; ++seed) {
    const Motion motion = test::SmoothMotion(skeleton, seed, 240, 120, 1 + seed % 3);
    const FeatureMatrix matrix = ExtractFeatures(StandardJoints(motion), set, 120);
    const FeatureMatrix mirrored = ExtractFeatures(StandardJoints(MirrorMotion(motion)), set, 120);
    for (int row = 0; row < set.feature_count(); ++row) {
      const std::string& id = set.features[row].id;
      if (id == "F1" || id == "F2" || (id == "F22" && GetParam() == "paper")) continue;
      for (int column = 0; column < matrix.column_count(); ++column) {
        ASSERT_EQ(mirrored.at(column, rows[row]), matrix.at(column, row))
            << id << " column " << column << " seed " << seed;
      }
    }
    for (const std::uint64_t column : matrix.columns) {
      ones |= column;
      zeros |= ~column;
    }
  }
  // The motions must be varied enough for the claim to mean something.
  EXPECT_GE(std::popcount(ones & zeros), 35);
}

TEST_P(Mirroring, HasThePartnersOfThePaper) {
  const std::vector<int> expected = {2,  1,  4,  3,  6,  5,  8,  7,  9,  10, 12, 11, 14,
                                     13, 16, 15, 18, 17, 19, 21, 20, 22, 23, 24, 26, 25,
                                     28, 27, 30, 29, 31, 32, 34, 33, 36, 35, 37, 38, 39};
  const FeatureSet set = LoadFeatureSet(GetParam());
  std::vector<int> rows = set.MirrorRows();
  for (int& row : rows) ++row;
  EXPECT_EQ(rows, expected);
  for (int row = 0; row < 39; ++row) {
    EXPECT_EQ(set.features[row].id, "F" + std::to_string(row + 1));
    EXPECT_EQ(set.features[row].group, row < 14 ? "upper" : row < 26 ? "lower" : "mix");
  }
}

INSTANTIATE_TEST_SUITE_P(Profiles, Mirroring, testing::Values("bonn", "paper"));

// Columns c … d at 30 Hz are the frames i with c / 30 ≤ i / rate < (d + 1) / 30, in whole numbers;
// a column shorter than a frame is the frame that goes on during it.
FrameRange PlainFrames(std::int64_t c, std::int64_t d, std::int64_t rate, std::int64_t count) {
  FrameRange range{.first = -1};
  for (std::int64_t i = 0; i < count; ++i) {
    if (rate * c > 30 * i || 30 * i >= rate * (d + 1)) continue;
    if (range.first < 0) range.first = i;
    range.last = i;
  }
  if (range.first < 0) range.first = range.last = std::min(rate * c / 30, count - 1);
  return range;
}

TEST(FramesOfColumns, AreThoseInTheSameSpanOfTime) {
  for (const int rate : {120, 60, 25, 30, 100}) {
    const std::int64_t count = 3 * rate + 2;
    const int columns = ((static_cast<int>(count) - 1) * 120 / rate + 4) / 4;
    for (int first = 0; first < columns; ++first) {
      for (const int last : {first, first + 1, first + 7, columns - 1}) {
        if (last < first || last >= columns) continue;
        const FrameRange range = FramesOfColumns(first, last, 30, rate, count);
        const FrameRange expected = PlainFrames(first, last, rate, count);
        EXPECT_EQ(range.first, expected.first) << rate << " Hz, columns " << first << " " << last;
        EXPECT_EQ(range.last, expected.last) << rate << " Hz, columns " << first << " " << last;
      }
    }
  }
}

TEST(FramesOfColumns, AreFourAt120Hz) {
  const FrameRange range = FramesOfColumns(5, 5, 30, 120, 23);
  EXPECT_EQ(range.first, 20);
  EXPECT_EQ(range.last, 22);  // The take ends there.
  EXPECT_EQ(FramesOfColumns(2, 4, 30, 120, 1000).first, 8);
  EXPECT_EQ(FramesOfColumns(2, 4, 30, 120, 1000).last, 19);
}

}  // namespace
}  // namespace kinebase
