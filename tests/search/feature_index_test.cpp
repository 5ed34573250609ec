#include "kinebase/search/feature_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>

#include "kinebase/core/error.h"
#include "search/scans.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

FeatureMatrix Words(std::vector<std::uint64_t> columns) {
  return {.rate_hz = 30, .feature_count = 4, .columns = std::move(columns)};
}

TEST(FeatureIndex, GivesTheLongestStretchesOfAPattern) {
  const std::vector<FeatureMatrix> recordings = {Words({1, 1, 3, 0, 1}), Words({}), Words({3})};
  const FeatureIndex index(recordings, 0b11);
  EXPECT_EQ(index.pattern_count(), 3U);
  EXPECT_THAT(index.Find({.tested = 0b01, .ones = 0b01}),
              ElementsAre(Stretch{0, 0, 2}, Stretch{0, 4, 4}, Stretch{2, 0, 0}));
  EXPECT_THAT(index.Find({.tested = 0b11, .ones = 0b11}),
              ElementsAre(Stretch{0, 2, 2}, Stretch{2, 0, 0}));
  EXPECT_THAT(index.Find({.tested = 0b11, .ones = 0b10}), IsEmpty());
  EXPECT_THAT(index.Find({.tested = 0b11, .ones = 0b10, .misses = 1}),
              ElementsAre(Stretch{0, 2, 3}, Stretch{2, 0, 0}));
}

TEST(FeatureIndex, DoesNotLookAtOtherFeatures) {
  const std::vector<FeatureMatrix> recordings = {Words({0b0100, 0b1000, 0b0001})};
  EXPECT_EQ(FeatureIndex(recordings, 0b0011).pattern_count(), 2U);
  const Error error =
      ErrorOf([&] { (void)FeatureIndex(recordings, 0b0011).Find({.tested = 0b0101}); });
  EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
}

// Column by column.
RC_GTEST_PROP(FeatureIndex, FindsWhatAScanOfAllColumnsFinds, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  std::vector<FeatureMatrix> recordings;
  for (int i = random.Below(4); i >= 0; --i) {
    recordings.push_back({.rate_hz = 30,
                          .feature_count = 8,
                          .columns = RandomRecording(random, random.Below(200), 8)});
  }
  const std::uint64_t indexed = random.Word() & AllFeatures(8);
  FeaturePattern pattern{.tested = random.Word() & indexed, .ones = random.Word()};
  pattern.misses = random.Below(3);
  std::vector<Stretch> expected;
  for (int i = 0; i < std::ssize(recordings); ++i) {
    bool before = false;
    for (int column = 0; column < recordings[i].column_count(); ++column) {
      int differs = 0;
      for (int bit = 0; bit < 8; ++bit) {
        const bool tested = ((pattern.tested >> bit) & 1U) != 0;
        if (tested && recordings[i].at(column, bit) != (((pattern.ones >> bit) & 1U) != 0)) {
          ++differs;
        }
      }
      const bool admitted = differs <= pattern.misses;
      if (admitted && before) expected.back().last = column;
      if (admitted && !before) expected.push_back({i, column, column});
      before = admitted;
    }
  }
  RC_ASSERT(FeatureIndex(recordings, indexed).Find(pattern) == expected);
}

}  // namespace
}  // namespace kinebase::test
