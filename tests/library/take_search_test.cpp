#include "kinebase/library/take_search.h"

#include <gtest/gtest.h>

namespace kinebase {
namespace {

// A take at 120 Hz whose one feature is 1 in columns first … last of its matrix at 30 Hz.
TakeFeatures MakeTake(int columns, int first, int last) {
  TakeFeatures take{.path = "take.amc", .rate_hz = 120, .frame_count = 4 * columns - 1};
  take.features = {.rate_hz = 30, .feature_count = 1};
  for (int c = 0; c < columns; ++c)
    take.features.columns.push_back(first <= c && c <= last ? 1 : 0);
  return take;
}

// "0, then five times 1, then 0".
QuantizedTemplate MakeTemplate() {
  TemplateMatrix matrix{.rate_hz = 30, .feature_count = 1};
  matrix.values = {0, 1, 1, 1, 1, 1, 0};
  matrix.weights.assign(7, 1);
  return Quantize(matrix, 0.1, Profile::kBonn);
}

TEST(TakeSearch, GivesFramesAndSecondsOfTheTake) {
  const std::vector<TakeFeatures> takes = {MakeTake(20, 30, 40), MakeTake(20, 10, 14)};
  const std::vector<TakeHit> hits = SearchTakes(MakeTemplate(), takes, {.tau = 0});
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
  const std::vector<TakeFeatures> takes = {MakeTake(16, 10, 14)};
  const std::vector<TakeHit> hits = SearchTakes(MakeTemplate(), takes, {.tau = 0});
  ASSERT_EQ(hits.size(), 1);
  EXPECT_EQ(hits[0].last_frame, takes[0].frame_count);  // 63: its last column has three frames.
}

TEST(TakeSearch, FindsNothingInNothing) { EXPECT_TRUE(SearchTakes(MakeTemplate(), {}).empty()); }

}  // namespace
}  // namespace kinebase
