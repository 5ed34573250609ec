#include "kinebase/templates/contrast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "kinebase/core/error.h"
#include "kinebase/templates/calibration.h"
#include "kinebase/templates/quantized_template.h"
#include "support/files.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

// A recording whose features are these words; value v of its pose in column c is f(c, v).
struct Streams {
  template <typename F>
  Streams(std::vector<std::uint64_t> words, int feature_count, const F& f) {
    features = {.rate_hz = 30, .feature_count = feature_count, .columns = std::move(words)};
    poses.rate_hz = 30;
    for (int column = 0; column < features.column_count(); ++column) {
      for (int value = 0; value < kPoseValues; ++value) {
        poses.values.push_back(static_cast<float>(f(column, value)));
      }
    }
  }

  [[nodiscard]] RecordingStreams streams() const { return {features, &poses}; }

  FeatureMatrix features;
  PoseStream poses;
};

double Still(int /*column*/, int /*value*/) { return 0; }

TEST(Background, CountsOnesAndMeasuresPoses) {
  const Streams a({0b01, 0b01, 0b11}, 2, [](int column, int value) { return column + value; });
  const Streams b({0b00}, 2, [](int /*column*/, int value) { return 5 + value; });
  const std::vector<RecordingStreams> labelled = {a.streams()};
  const std::vector<RecordingStreams> others = {b.streams()};
  const Background background = MeasureBackground(labelled, others);
  // (ones + ½) / (columns + 1), in the labelled ones alone.
  EXPECT_THAT(background.ones, testing::ElementsAre(3.5 / 4, 1.5 / 4));
  // 0, 1, 2 and 5, and v more.
  EXPECT_NEAR(background.places.mean[7], 2 + 7, 1e-9);
  EXPECT_NEAR(background.places.variance[7], (4 + 1 + 0 + 9) / 4.0, 1e-9);
}

TEST(Background, NeedsColumnsOfOneSet) {
  const Streams two({1}, 2, Still);
  const Streams three({1}, 3, Still);
  const Streams none({}, 2, Still);
  const auto code_of = [](const std::vector<RecordingStreams>& labelled) {
    return ErrorOf([&] { (void)MeasureBackground(labelled); }).code();
  };
  EXPECT_EQ(code_of({two.streams(), three.streams()}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of({none.streams()}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of({}), ErrorCode::kInvalidArgument);
}

double Divergence(double p, double b) {
  return p * std::log(p / b) + (1 - p) * std::log((1 - p) / (1 - b));
}

TEST(Contrast, WeighsEntriesByConsistencyAndSurprise) {
  const MotionTemplate motion_template{.matrix = MakeMatrix({{1, 0.25}, {0.5, 0.5}})};
  const Streams clip({0b01, 0b11}, 2, Still);
  const std::vector<RecordingStreams> clips(3, clip.streams());
  Background background = MeasureBackground(clips);
  background.ones = {0.9, 0.6};
  const Contrast contrast = MeasureContrast(motion_template, clips, background);
  // Three performances: p = (3x + ½) / 4.
  const double first = 1 * (0.3 + Divergence(3.5 / 4, 0.9));
  const double second = std::pow(0.5, 4) * (0.3 + Divergence(1.25 / 4, 0.6));
  ASSERT_EQ(contrast.entry_weights.size(), 4);
  EXPECT_NEAR(contrast.entry_weights[0], first / (first + second), 1e-12);
  EXPECT_NEAR(contrast.entry_weights[1], second / (first + second), 1e-12);
  // Nothing is consistent in the second column, so nothing is asked for.
  EXPECT_EQ(contrast.entry_weights[2], 0);
  EXPECT_EQ(contrast.entry_weights[3], 0);
}

// One value sets the class apart: it is 4 where other motion has 0 ± 1. All others are as in it.
TEST(Contrast, WeighsPosesByHowFarTheyAreFromOthers) {
  constexpr int kTelling = 11;
  const auto noise = [](int column, int value) { return (column + value) % 2 == 0 ? 1.0 : -1.0; };
  const Streams other(std::vector<std::uint64_t>(40, 0b0), 1, noise);
  const Streams clip({0b1, 0b1, 0b1, 0b1}, 1, [&](int column, int value) {
    return value == kTelling ? 4 : noise(column, value);
  });
  const Streams swapped({0b1, 0b1, 0b1, 0b1}, 1, [&](int column, int value) {
    return value == kTelling ? 4 : -noise(column, value);
  });
  const MotionTemplate motion_template{.matrix = MakeMatrix({{1}, {1}, {1}, {1}})};
  const Background background = MeasureBackground(std::vector{other.streams()});
  const Contrast contrast =
      MeasureContrast(motion_template, std::vector{clip.streams(), swapped.streams()}, background);
  for (std::size_t column = 0; column < 4; ++column) {
    const auto weights =
        std::span(contrast.places.weight).subspan(column * kPoseValues, kPoseValues);
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-5);
    EXPECT_GT(weights[kTelling], 0.95);
    EXPECT_NEAR(contrast.places.mean[column * kPoseValues + kTelling], 4, 1e-6);
    EXPECT_NEAR(contrast.places.mean[column * kPoseValues + 3], 0, 1e-6);
  }
  EXPECT_NEAR(contrast.places.spread[kTelling], 1, 1e-6);
}

// The class and what is taken for it share the first feature; the general background knows neither.
TEST(Contrast, WeighsWhatTellsCounterexamplesApart) {
  const MotionTemplate motion_template{.matrix = MakeMatrix({{1, 1}, {1, 1}})};
  const Streams clip({0b11, 0b11}, 2, Still);
  const Streams wrong({0b01, 0b11}, 2,
                      [](int /*column*/, int value) { return value == 5 ? 3 : 0; });
  Background background = MeasureBackground(std::vector{clip.streams()});
  background.ones = {0.25, 0.25};
  background.places.variance.assign(kPoseValues, 1);
  const std::vector<RecordingStreams> clips(3, clip.streams());
  const std::vector<RecordingStreams> counterexamples(3, wrong.streams());
  const Contrast contrast = MeasureContrast(motion_template, clips, background, counterexamples);
  // (b + three times what they show) / 4, column by column; p = 3.5 / 4 everywhere.
  const double shared = 0.3 + Divergence(3.5 / 4, 3.25 / 4);
  const double telling = 0.3 + Divergence(3.5 / 4, 0.25 / 4);
  EXPECT_NEAR(contrast.entry_weights[0], shared / (shared + telling), 1e-12);
  EXPECT_NEAR(contrast.entry_weights[1], telling / (shared + telling), 1e-12);
  EXPECT_NEAR(contrast.entry_weights[2], 0.5, 1e-12);
  EXPECT_NEAR(contrast.entry_weights[3], 0.5, 1e-12);
  EXPECT_EQ(MeasureEntryWeights(motion_template, 3, background, counterexamples),
            contrast.entry_weights);
  // Where they lie elsewhere tells more than where they lie as the class does.
  EXPECT_GT(contrast.places.weight[5], contrast.places.weight[4]);
  EXPECT_EQ(contrast.places.spread[5], 1);
  EXPECT_EQ(contrast.background, background);
  EXPECT_EQ(MeasureContrast(motion_template, clips, background).background, background);
}

TEST(Contrast, NeedsPerformancesOfItsFeatures) {
  const MotionTemplate motion_template{.matrix = MakeMatrix({{1, 0}})};
  const Streams clip({0b01}, 2, Still);
  const Streams other({0b01}, 3, Still);
  const Background background = MeasureBackground(std::vector{clip.streams()});
  EXPECT_EQ(ErrorOf([&] { (void)MeasureContrast(motion_template, {}, background); }).code(),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(ErrorOf([&] {
              (void)MeasureContrast(motion_template, std::vector{other.streams()}, background);
            }).code(),
            ErrorCode::kMismatch);
}

TEST(Contrast, DecidesWhatIsAskedForAndWhatItCosts) {
  MotionTemplate motion_template{.matching = Profile::kBonn,
                                 .matrix = MakeMatrix({{0.6, 0.2, 0.5}}, {1.5})};
  motion_template.contrast = Contrast{.entry_weights = {0.75, 0.25, 0}};
  const QuantizedTemplate quantized = Quantize(motion_template);
  EXPECT_EQ(quantized.columns[0].consistent, 0b011U);
  EXPECT_EQ(quantized.columns[0].ones & 0b011U, 0b001U);
  EXPECT_THAT(quantized.costs, testing::ElementsAre(0.75 * 1.25, 0.25 * 1.25, 0));
  motion_template.matching = Profile::kPaper;
  EXPECT_THAT(Quantize(motion_template).costs, testing::ElementsAre(0.75, 0.25, 0));
  // Without it nothing of this is consistent enough.
  motion_template.contrast.reset();
  EXPECT_EQ(Quantize(motion_template).columns[0].consistent, 0U);
  EXPECT_TRUE(Quantize(motion_template).costs.empty());
}

TEST(Confidence, IsAHalfAtTheThresholdAndFallsWithTheCost) {
  const Calibration calibration{.slope = 40, .offset = -8};
  EXPECT_DOUBLE_EQ(Confidence(calibration, 0.2), 0.5);
  EXPECT_NEAR(Confidence(calibration, 0.1), 1 / (1 + std::exp(-4)), 1e-12);
  EXPECT_NEAR(Confidence(calibration, 0.3), 1 / (1 + std::exp(4)), 1e-12);
  EXPECT_EQ(Confidence(calibration, 1e6), 0);
  EXPECT_EQ(Confidence(calibration, -1e6), 1);
}

TEST(Confidence, TellsTheCostOfWhoWantsToBeThatSure) {
  const Calibration calibration{.slope = 40, .offset = -8};
  EXPECT_DOUBLE_EQ(CostAt(calibration, 0.5), 0.2);
  EXPECT_DOUBLE_EQ(CostAt(calibration, 0.9), 0.2 - std::log(9) / 40);
  EXPECT_DOUBLE_EQ(CostAt(calibration, 0.1), 0.2 + std::log(9) / 40);
  EXPECT_LT(CostAt(calibration, 0.9999), 0);  // What costs nothing is less sure.
}

TEST(Confidence, MovesAsAWhole) {
  const Calibration calibration{.slope = 40, .offset = -8};
  const Calibration moved = HalfAt(0.3, calibration.slope);
  for (const double cost : {0.0, 0.17, 0.2, 0.4}) {
    EXPECT_NEAR(Confidence(moved, cost + 0.1), Confidence(calibration, cost), 1e-12);
  }
}

}  // namespace
}  // namespace kinebase::test
