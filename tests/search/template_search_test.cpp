#include "kinebase/search/template_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "kinebase/core/error.h"
#include "search/scans.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

using ::testing::HasSubstr;

FeatureMatrix Recording(Random& random, int columns) {
  return {.rate_hz = 30, .feature_count = 39, .columns = RandomRecording(random, columns, 39)};
}

QuantizedTemplate SomeTemplate(std::uint32_t seed) {
  Random random(seed);
  return RandomQuantized(random, 24, 39, Profile::kBonn);
}

// What the search promises, recording by recording with the plain kernel.
std::vector<Hit> SearchPlainly(const QuantizedTemplate& motion_template,
                               const std::vector<FeatureMatrix>& recordings, double tau) {
  std::vector<Hit> hits;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const DeltaCurve curve = ComputeDeltaReference(motion_template, recordings[i].columns);
    for (const Hit& hit : ExtractHits(curve, tau, static_cast<int>(i))) hits.push_back(hit);
  }
  return BestHits(hits, hits.size());
}

TEST(TemplateSearch, EqualsThePlainSearchOfEveryRecordingOnAnyNumberOfThreads) {
  Random random(41);
  std::vector<FeatureMatrix> recordings;
  for (const int columns : {300, 0, 5, 1200, 1, 700, 40}) {
    recordings.push_back(Recording(random, columns));
  }
  const QuantizedTemplate motion_template = SomeTemplate(42);
  const std::vector<Hit> expected = SearchPlainly(motion_template, recordings, 0.3);
  ASSERT_GT(expected.size(), 20U);
  for (const int threads : {1, 2, 3, 8}) {
    EXPECT_EQ(SearchTemplate(motion_template, recordings, {.tau = 0.3, .threads = threads}),
              expected);
  }
}

// Pieces of a long recording overlap by what a path can span, so no border shows.
TEST(TemplateSearch, EqualsThePlainSearchOfARecordingThatIsCutForManyThreads) {
  Random random(43);
  const std::vector<FeatureMatrix> recordings = {Recording(random, 150'000),
                                                 Recording(random, (1 << 17) + 1)};
  const QuantizedTemplate motion_template = SomeTemplate(44);
  const std::vector<Hit> expected = SearchPlainly(motion_template, recordings, 0.3);
  ASSERT_GT(expected.size(), 1000U);
  for (const int threads : {1, 4}) {
    EXPECT_EQ(SearchTemplate(motion_template, recordings,
                             {.tau = 0.3, .most_hits = expected.size(), .threads = threads}),
              expected);
  }
}

// The two halves of a motion in two recordings are no hit; in one recording they are.
TEST(TemplateSearch, LetsNoPathCrossFromOneRecordingToAnother) {
  std::vector<std::vector<double>> columns;
  FeatureMatrix whole{.rate_hz = 30, .feature_count = 5, .columns = {}};
  for (int i = 0; i < 20; ++i) {
    columns.push_back({0, 0, 0, 0, 0});
    for (int bit = 0; bit < 5; ++bit) columns.back()[bit] = ((i + 1) >> bit) & 1;
    whole.columns.push_back(static_cast<std::uint64_t>(i) + 1);
  }
  const QuantizedTemplate motion_template = Quantize(MakeMatrix(columns), 0.1, Profile::kPaper);
  FeatureMatrix first_half = whole;
  first_half.columns.resize(10);
  FeatureMatrix second_half = whole;
  second_half.columns.erase(second_half.columns.begin(), second_half.columns.begin() + 10);
  const SearchOptions exact{.tau = 0};
  EXPECT_TRUE(SearchTemplate(motion_template, std::vector{first_half, second_half}, exact).empty());
  EXPECT_EQ(SearchTemplate(motion_template, std::vector{whole}, exact),
            (std::vector<Hit>{{.recording = 0, .first = 0, .last = 19, .cost = 0}}));
}

// The same best place twice: each recording keeps its own.
TEST(TemplateSearch, LetsNoHitSuppressOneInAnotherRecording) {
  Random random(45);
  const FeatureMatrix recording = Recording(random, 500);
  const QuantizedTemplate motion_template = SomeTemplate(46);
  const std::vector<Hit> once = SearchTemplate(motion_template, {&recording, 1}, {.tau = 0.3});
  const std::vector<Hit> twice =
      SearchTemplate(motion_template, std::vector{recording, recording}, {.tau = 0.3});
  ASSERT_EQ(twice.size(), 2 * once.size());
  EXPECT_EQ(std::ranges::count(twice, 0, &Hit::recording), std::ssize(once));
}

TEST(TemplateSearch, KeepsTheBestHitsOnly) {
  Random random(47);
  const std::vector<FeatureMatrix> recordings = {Recording(random, 2000)};
  const QuantizedTemplate motion_template = SomeTemplate(48);
  std::vector<Hit> all = SearchTemplate(motion_template, recordings, {.tau = 0.4});
  ASSERT_GT(all.size(), 10U);
  all.resize(7);
  EXPECT_EQ(SearchTemplate(motion_template, recordings, {.tau = 0.4, .most_hits = 7}), all);
}

TEST(TemplateSearch, FindsNothingInNothing) {
  EXPECT_TRUE(SearchTemplate(SomeTemplate(49), std::vector<FeatureView>{}).empty());
}

TEST(TemplateSearch, NamesTheRecordingThatDoesNotMatchTheTemplate) {
  Random random(50);
  std::vector<FeatureMatrix> recordings = {Recording(random, 50), Recording(random, 50)};
  recordings[1].rate_hz = 120;
  Error error = ErrorOf([&] { (void)SearchTemplate(SomeTemplate(51), recordings); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), HasSubstr("recording 2 has 120 columns a second"));
  recordings[1] = recordings[0];
  recordings[0].feature_count = 38;
  error = ErrorOf([&] { (void)SearchTemplate(SomeTemplate(51), recordings); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), HasSubstr("recording 1 has 38 features"));
}

TEST(TemplateSearch, RefusesThresholdsThatAreNone) {
  for (const double tau : {-0.1, std::numeric_limits<double>::quiet_NaN()}) {
    const Error error = ErrorOf(
        [&] { (void)SearchTemplate(SomeTemplate(52), std::vector<FeatureView>{}, {.tau = tau}); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
  }
}

TEST(TemplateSearch, ReportsProgressAndCanBeCancelled) {
  Random random(53);
  const std::vector<FeatureMatrix> recordings(6, Recording(random, 20'000));
  std::vector<std::size_t> reported;
  SearchOptions options;
  options.progress = [&](std::string_view, std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 6U);
    reported.push_back(done);
    return true;
  };
  (void)SearchTemplate(SomeTemplate(54), recordings, options);
  EXPECT_EQ(reported, (std::vector<std::size_t>{1, 2, 3, 4, 5, 6}));
  options.progress = [](std::string_view, std::size_t done, std::size_t) { return done < 3; };
  const Error error = ErrorOf([&] { (void)SearchTemplate(SomeTemplate(54), recordings, options); });
  EXPECT_EQ(error.code(), ErrorCode::kCancelled);
}

}  // namespace
}  // namespace kinebase::test
