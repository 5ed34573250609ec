#include "kinebase/library/long_take.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "kinebase/core/error.h"

namespace kinebase {
namespace {

// A matrix whose columns hold their own number, from `first`.
FeatureMatrix Numbered(std::uint64_t first, int columns, double rate_hz = 30) {
  FeatureMatrix matrix{.rate_hz = rate_hz, .feature_count = 64};
  for (int i = 0; i < columns; ++i) {
    matrix.columns.push_back(first + static_cast<std::uint64_t>(i));
  }
  return matrix;
}

std::vector<ClipOfClass> Clips() {
  std::vector<ClipOfClass> clips;
  constexpr int kCount = 20;
  clips.reserve(kCount);
  for (int i = 0; i < kCount; ++i) {
    clips.push_back(
        {Numbered(std::uint64_t{1000} * static_cast<std::uint64_t>(i + 1), 10 + i), i % 3});
  }
  return clips;
}

TEST(MakeLongTake, HoldsEveryClipWhereTheTruthSays) {
  const std::vector<ClipOfClass> clips = Clips();
  const std::vector<FeatureMatrix> fillers = {Numbered(1, 400), Numbered(500, 50)};
  const LongTake take = MakeLongTake(clips, fillers, 1);
  std::set<std::size_t> seen;
  int next = 0;
  for (const LongTake::Segment& segment : take.truth) {
    const auto begin = take.features.columns.begin();
    const std::vector<std::uint64_t> columns(begin + segment.first, begin + segment.last + 1);
    const std::size_t clip = columns.front() / 1000 - 1;
    ASSERT_LT(clip, clips.size());
    seen.insert(clip);
    EXPECT_EQ(columns, clips[clip].features.columns);
    EXPECT_EQ(segment.motion_class, clips[clip].motion_class);
    const int gap = segment.first - next;
    EXPECT_GE(gap, 60);  // 2 to 10 seconds of fillers.
    EXPECT_LE(gap, 300);
    for (int i = next; i < segment.first; ++i) {
      EXPECT_LT(take.features.columns[static_cast<std::size_t>(i)], 1000U);
    }
    next = segment.last + 1;
  }
  EXPECT_EQ(seen.size(), clips.size());
  EXPECT_GE(take.features.column_count() - next, 60);
}

TEST(MakeLongTake, DependsOnTheSeedAlone) {
  const std::vector<ClipOfClass> clips = Clips();
  const std::vector<FeatureMatrix> fillers = {Numbered(1, 400)};
  EXPECT_EQ(MakeLongTake(clips, fillers, 7).features.columns,
            MakeLongTake(clips, fillers, 7).features.columns);
  EXPECT_NE(MakeLongTake(clips, fillers, 7).features.columns,
            MakeLongTake(clips, fillers, 8).features.columns);
}

TEST(MakeLongTake, RefusesWhatDoesNotFit) {
  const std::vector<ClipOfClass> clips = Clips();
  EXPECT_THROW((void)MakeLongTake(clips, {}, 1), Error);
  const std::vector<FeatureMatrix> other_rate = {Numbered(1, 400, 60)};
  EXPECT_THROW((void)MakeLongTake(clips, other_rate, 1), Error);
  const std::vector<FeatureMatrix> empty = {Numbered(1, 0)};
  EXPECT_THROW((void)MakeLongTake(clips, empty, 1), Error);
}

}  // namespace
}  // namespace kinebase
