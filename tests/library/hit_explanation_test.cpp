#include "kinebase/library/hit_explanation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "library/one_feature_takes.h"
#include "support/files.h"

namespace kinebase {
namespace {

using testing::HasSubstr;

using test::OneFeatureTemplate;

TakeFeatures MakeTake() { return test::OneFeatureTake(50, {{10, 14}, {30, 33}}); }

TEST(HitExplanation, IsThatOfTheBestHitUnlessOneIsNamed) {
  const HitExplanation best = ExplainHit(OneFeatureTemplate(), MakeTake());
  // Columns 9 to 15 are frames 37 to 64.
  EXPECT_EQ(best.hit.first_frame, 37);
  EXPECT_EQ(best.hit.last_frame, 64);
  EXPECT_EQ(best.hit.cost, 0);
  ASSERT_EQ(best.cells.size(), 7);
  for (const ExplainedCell& cell : best.cells) EXPECT_EQ(cell.disagreed, 0);
}

TEST(HitExplanation, IsThatOfAnyHitOfASearch) {
  const std::vector<TakeFeatures> takes = {MakeTake()};
  const std::vector<TakeHit> hits = SearchTakes(OneFeatureTemplate(), takes, {.tau = 1});
  ASSERT_GT(hits.size(), 1);
  for (const TakeHit& hit : hits) {
    EXPECT_EQ(ExplainHit(OneFeatureTemplate(), takes[0], hit.last_frame).hit, hit);
  }
  // Any frame of a column stands for it.
  EXPECT_EQ(ExplainHit(OneFeatureTemplate(), takes[0], 62).hit.last_frame, 64);
  EXPECT_EQ(ExplainHit(OneFeatureTemplate(), takes[0], 199).hit.last_frame, 199);
}

TEST(HitExplanation, NeedsAPathThere) {
  const auto error_of = [](std::int64_t frame) {
    return test::ErrorOf([&] { (void)ExplainHit(OneFeatureTemplate(), MakeTake(), frame); });
  };
  EXPECT_EQ(error_of(8).code(), ErrorCode::kNotFound);
  EXPECT_THAT(error_of(8).what(), HasSubstr("nothing that ends at frame 8"));
  EXPECT_EQ(error_of(0).code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(error_of(200).what(), HasSubstr("take.amc: has frames 1 to 199, not 200"));
  TakeFeatures brief = MakeTake();
  brief.features.columns.resize(2);
  EXPECT_THAT(test::ErrorOf([&] { (void)ExplainHit(OneFeatureTemplate(), brief); }).what(),
              HasSubstr("too short"));
}

}  // namespace
}  // namespace kinebase
