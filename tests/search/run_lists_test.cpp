#include "kinebase/search/run_lists.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "kinebase/core/error.h"
#include "search/scans.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

FeatureMatrix TwoFeatures(std::vector<std::uint64_t> columns) {
  return {.rate_hz = 30, .feature_count = 2, .columns = std::move(columns)};
}

TEST(RunLists, AreWrittenAsDocumented) {
  // Feature 1 holds from column 1 to 2, feature 2 in column 0 and again to the end.
  EXPECT_EQ(FormatRunLists(TwoFeatures({0b10, 0b01, 0b01, 0b00, 0b10})),
            std::string("\x02\x01\x02\x03\x00\x01\x03", 7));
  FeatureMatrix late = TwoFeatures(std::vector<std::uint64_t>(500, 0));
  late.columns.back() = 1;  // From column 499 = 3 · 128 + 115.
  EXPECT_EQ(FormatRunLists(late), std::string("\x02\xF3\x03\x00", 4));
  EXPECT_EQ(FormatRunLists(TwoFeatures({})), std::string(2, '\0'));
}

TEST(RunLists, FindWhatTheyWereMadeOf) {
  const FeatureMatrix recording = TwoFeatures({0b10, 0b01, 0b01, 0b00, 0b10});
  const std::string bytes = FormatRunLists(recording);
  const RunLists lists(bytes, 2, 5);
  EXPECT_THAT(lists.Find({.tested = 0b01, .ones = 0b01}, 7), ElementsAre(Stretch{7, 1, 2}));
  EXPECT_THAT(lists.Find({.tested = 0b10, .ones = 0b10}, 7),
              ElementsAre(Stretch{7, 0, 0}, Stretch{7, 4, 4}));
  EXPECT_THAT(lists.Find({.tested = 0b11, .ones = 0b01, .misses = 1}, 0),
              ElementsAre(Stretch{0, 1, 3}));
  EXPECT_THAT(lists.Find({.tested = 0b11, .ones = 0b11}, 0), IsEmpty());
  EXPECT_THAT(lists.Find({}, 0), ElementsAre(Stretch{0, 0, 4}));
  const std::string nothing = FormatRunLists(TwoFeatures({}));
  EXPECT_THAT(RunLists(nothing, 2, 0).Find({}, 0), IsEmpty());
}

RC_GTEST_PROP(RunLists, FindWhatTheFeatureIndexFinds, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const FeatureMatrix recording{
      .rate_hz = 30, .feature_count = 8, .columns = RandomRecording(random, random.Below(400), 8)};
  FeaturePattern pattern{.tested = random.Word() & AllFeatures(8), .ones = random.Word()};
  pattern.misses = random.Below(4);
  const std::string bytes = FormatRunLists(recording);
  const RunLists lists(bytes, 8, recording.column_count());
  const FeatureIndex index(std::vector{recording}, AllFeatures(8));
  RC_ASSERT(lists.Find(pattern, 0) == index.Find(pattern));
}

TEST(RunLists, OfOtherBytesAreRefused) {
  using namespace std::literals;
  const auto error_of = [](std::string_view bytes, int misses) {
    return ErrorOf([&] {
      (void)RunLists(bytes, 2, 5).Find({.tested = 0b11, .ones = 0b11, .misses = misses}, 0);
    });
  };
  // Cut off; a stretch of no column, one too long, a number longer than it need be, one without an
  // end, one of more than 32 bits.
  for (const std::string_view bytes :
       {""sv, "\x00"sv, "\x03\x01"sv, "\x02\x01\x00\x00"sv, "\x02\x03\x02\x00"sv,
        "\x02\x81\x00\x00"sv, "\x01\x81\x00"sv, "\x05\xFF\xFF\xFF\xFF\x7F\x00"sv}) {
    for (const int misses : {0, 1}) {
      EXPECT_EQ(error_of(bytes, misses).code(), ErrorCode::kMalformedFile);
      EXPECT_THAT(error_of(bytes, misses).what(), HasSubstr("list of"));
    }
  }
  EXPECT_THAT(error_of("\x00\x00\x00"sv, 0).what(), HasSubstr("1 bytes follow"));
}

}  // namespace
}  // namespace kinebase::test
