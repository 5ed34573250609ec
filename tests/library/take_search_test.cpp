#include "kinebase/library/take_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/search/subsequence_dtw.h"
#include "library/one_feature_takes.h"
#include "support/files.h"

namespace kinebase {
namespace {

using test::OneFeatureTake;
using test::OneFeatureTemplate;

TEST(TakeSearch, GivesFramesAndSecondsOfTheTake) {
  const std::vector<TakeFeatures> takes = {OneFeatureTake(20, {{30, 40}}),
                                           OneFeatureTake(20, {{10, 14}})};
  const std::vector<TakeHit> hits = SearchTakes(OneFeatureTemplate(), takes, {.tau = 0});
  ASSERT_EQ(hits.size(), 1);
  EXPECT_EQ(hits[0].take, 1);
  EXPECT_EQ(hits[0].cost, 0);
  // Columns 9 to 15 are frames 37 to 64, one column four frames.
  EXPECT_EQ(hits[0].first_frame, 37);
  EXPECT_EQ(hits[0].last_frame, 64);
  EXPECT_DOUBLE_EQ(hits[0].start_s, 36 / 120.0);
  EXPECT_DOUBLE_EQ(hits[0].end_s, 64 / 120.0);
}

TEST(TakeSearch, EndsWithTheTake) {
  const std::vector<TakeFeatures> takes = {OneFeatureTake(16, {{10, 14}})};
  const std::vector<TakeHit> hits = SearchTakes(OneFeatureTemplate(), takes, {.tau = 0});
  ASSERT_EQ(hits.size(), 1);
  EXPECT_EQ(hits[0].last_frame, takes[0].frame_count);  // 63: its last column has three frames.
}

TEST(TakeSearch, FindsNothingInNothing) {
  EXPECT_TRUE(SearchTakes(OneFeatureTemplate(), std::vector<TakeView>{}).empty());
}

// "The feature five times, and the first pose value is 1."
MotionTemplate TemplateWithPoses() {
  MotionTemplate result{.name = "a"};
  result.matrix = {.rate_hz = 30, .feature_count = 1, .values = {1, 1, 1, 1, 1}};
  result.matrix.weights.assign(5, 1);
  Contrast contrast{.entry_weights = {1, 1, 1, 1, 1}, .places = {}};
  for (int value = 0; value < 5 * kPoseValues; ++value) {
    const float first = value % kPoseValues == 0 ? 1.0F : 0.0F;
    contrast.places.mean.push_back(first);
    contrast.places.weight.push_back(first);
  }
  contrast.places.spread.assign(kPoseValues, 0.25F);
  result.contrast = contrast;
  return result;
}

TEST(CostCurve, OfAPlainTemplateIsDelta) {
  MotionTemplate plain = TemplateWithPoses();
  plain.contrast.reset();
  const TakeFeatures take = OneFeatureTake(20, {{6, 8}, {12, 17}});
  const DeltaCurve reference = ComputeDeltaReference(Quantize(plain), take.features.columns);
  const std::vector<double> curve = CostCurve(plain, take);
  EXPECT_EQ(curve, reference.delta);
  EXPECT_TRUE(std::isinf(curve[1]));  // Five columns need three.
  EXPECT_TRUE(CostCurve(plain, OneFeatureTake(0, {})).empty());
}

TEST(CostCurve, IsWhatHitsCostWherePosesCount) {
  const MotionTemplate motion_template = TemplateWithPoses();
  TakeFeatures take = OneFeatureTake(20, {{6, 12}});
  take.poses = {.rate_hz = 30, .values = std::vector<float>(std::size_t{20} * kPoseValues, 0.5F)};
  const std::vector<double> curve = CostCurve(motion_template, take);
  const DeltaCurve delta = ComputeDeltaReference(Quantize(motion_template), take.features.columns);
  ASSERT_EQ(curve.size(), 20U);
  for (std::size_t i = 2; i < curve.size(); ++i) {
    // Half a unit off, of a variance of a quarter, in each column of a path; weighs a tenth.
    EXPECT_NEAR(curve[i], delta.delta[i] + 0.1, 1e-6) << i;
  }
  const auto hits = RankTakes({&motion_template, 1}, {&take, 1}, {.tau = 9}).at(0);
  ASSERT_FALSE(hits.empty());
  for (const TakeHit& hit : hits) {
    EXPECT_EQ(curve[static_cast<std::size_t>((hit.last_frame - 1) / 4)], hit.cost);
  }
}

TEST(CostCurve, RefusesOtherFeatures) {
  TakeFeatures take = OneFeatureTake(20, {});
  take.features.feature_count = 2;
  EXPECT_EQ(test::ErrorOf([&] { (void)CostCurve(TemplateWithPoses(), take); }).code(),
            ErrorCode::kMismatch);
}

}  // namespace
}  // namespace kinebase
