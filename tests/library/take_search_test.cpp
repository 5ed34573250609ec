#include "kinebase/library/take_search.h"

#include <gtest/gtest.h>

#include "library/one_feature_takes.h"

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
  EXPECT_TRUE(SearchTakes(OneFeatureTemplate(), {}).empty());
}

}  // namespace
}  // namespace kinebase
