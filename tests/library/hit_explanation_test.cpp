#include "kinebase/library/hit_explanation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

using testing::HasSubstr;

// A take at 120 Hz, four frames a column, whose one feature holds in columns 10 to 14 and 30 to 33.
TakeFeatures MakeTake() {
  TakeFeatures take{.path = "take.amc", .rate_hz = 120, .frame_count = 4 * 50 - 1};
  take.features = {.rate_hz = 30, .feature_count = 1};
  for (int c = 0; c < 50; ++c) {
    take.features.columns.push_back((c >= 10 && c <= 14) || (c >= 30 && c <= 33) ? 1 : 0);
  }
  return take;
}

// "0, then five times 1, then 0".
QuantizedTemplate MakeTemplate() {
  TemplateMatrix matrix{.rate_hz = 30, .feature_count = 1};
  matrix.values = {0, 1, 1, 1, 1, 1, 0};
  matrix.weights.assign(7, 1);
  return Quantize(matrix, 0.1, Profile::kBonn);
}

TEST(HitExplanation, IsThatOfTheBestHitUnlessOneIsNamed) {
  const HitExplanation best = ExplainHit(MakeTemplate(), MakeTake());
  // Columns 9 to 15 are frames 37 to 64.
  EXPECT_EQ(best.hit.first_frame, 37);
  EXPECT_EQ(best.hit.last_frame, 64);
  EXPECT_EQ(best.hit.cost, 0);
  ASSERT_EQ(best.cells.size(), 7);
  for (const ExplainedCell& cell : best.cells) EXPECT_EQ(cell.disagreed, 0);
}

TEST(HitExplanation, IsThatOfAnyHitOfASearch) {
  const std::vector<TakeFeatures> takes = {MakeTake()};
  const std::vector<TakeHit> hits = SearchTakes(MakeTemplate(), takes, {.tau = 1});
  ASSERT_GT(hits.size(), 1);
  for (const TakeHit& hit : hits) {
    EXPECT_EQ(ExplainHit(MakeTemplate(), takes[0], hit.last_frame).hit, hit);
  }
  // Any frame of a column stands for it.
  EXPECT_EQ(ExplainHit(MakeTemplate(), takes[0], 62).hit.last_frame, 64);
  EXPECT_EQ(ExplainHit(MakeTemplate(), takes[0], 199).hit.last_frame, 199);
}

TEST(HitExplanation, NeedsAPathThere) {
  const auto error_of = [](std::int64_t frame) {
    return test::ErrorOf([&] { (void)ExplainHit(MakeTemplate(), MakeTake(), frame); });
  };
  EXPECT_EQ(error_of(8).code(), ErrorCode::kNotFound);
  EXPECT_THAT(error_of(8).what(), HasSubstr("nothing that ends at frame 8"));
  EXPECT_EQ(error_of(0).code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(error_of(200).what(), HasSubstr("take.amc: has frames 1 to 199, not 200"));
  TakeFeatures brief = MakeTake();
  brief.features.columns.resize(2);
  EXPECT_THAT(test::ErrorOf([&] { (void)ExplainHit(MakeTemplate(), brief); }).what(),
              HasSubstr("too short"));
}

}  // namespace
}  // namespace kinebase
