// What the filter rules out is no hit: against the reference, on every instruction set.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/search/template_search.h"
#include "search/delta_target.h"
#include "search/kernels/filter_plan.h"
#include "search/scans.h"

namespace kinebase::test {
namespace {

using internal::ColumnRun;
using internal::FilterPlan;
using internal::FilterRange;

constexpr int kTemplateLengths[] = {1, 2, 3, 5, 8, 17, 40};
constexpr int kRecordingLengths[] = {1, 2, 3, 31, 33, 64, 100, 1023, 1024, 1025, 1500, 2100};
constexpr double kTaus[] = {1e-6, 0.01, 0.06, 0.1, 0.3};

// As a template with a contrast is matched: every mismatch has a cost of its own, some none.
void GiveWeights(Random& random, QuantizedTemplate& motion_template) {
  const auto features = static_cast<std::size_t>(motion_template.feature_count);
  for (std::size_t column = 0; column < motion_template.columns.size(); ++column) {
    motion_template.columns[column].consistent = AllFeatures(motion_template.feature_count);
    for (std::size_t feature = 0; feature < features; ++feature) {
      const double cost =
          random.Below(3) == 0 ? 0 : random.Below(1000) / (250.0 * motion_template.feature_count);
      motion_template.costs.push_back(cost);
    }
  }
}

// Here and there what the template asks for, slower or faster, with a few features wrong.
void Perform(Random& random, const QuantizedTemplate& motion_template,
             std::vector<std::uint64_t>& recording) {
  const auto columns = motion_template.columns.size();
  for (std::size_t at = 0; at + 2 * columns < recording.size(); at += 3 * columns + 10) {
    const std::size_t length =
        columns + static_cast<std::size_t>(random.Below(static_cast<int>(columns) / 2 + 1));
    for (std::size_t i = 0; i < length; ++i) {
      const QuantizedColumn& asked = motion_template.columns[i * columns / length];
      std::uint64_t& word = recording[at + i];
      word = (word & ~asked.consistent) | (asked.ones & asked.consistent);
      if (random.Below(3) == 0)
        word ^= std::uint64_t{1} << random.Below(motion_template.feature_count);
    }
  }
}

struct Case {
  QuantizedTemplate motion_template;
  std::vector<std::uint64_t> recording;
};

// Calls f(case) for templates and recordings of all lengths, with and without weights.
template <typename F>
void ForEachCase(Random& random, const F& f) {
  for (const int columns : kTemplateLengths) {
    for (const int length : kRecordingLengths) {
      for (const Profile matching : {Profile::kBonn, Profile::kPaper}) {
        for (const bool weighted : {false, true}) {
          const int features = 1 + random.Below(64);
          Case one{.motion_template = RandomQuantized(random, columns, features, matching),
                   .recording = RandomRecording(random, length, features)};
          if (weighted) GiveWeights(random, one.motion_template);
          Perform(random, one.motion_template, one.recording);
          SCOPED_TRACE(testing::Message() << columns << " x " << length << ", " << features
                                          << " features" << (weighted ? ", weighted" : ""));
          f(one);
        }
      }
    }
  }
}

class Filter : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(Filter, LeavesEveryColumnWhereAPathOfCostTauEnds) {
  const DeltaTarget target(GetParam());
  Random random(31);
  int columns_within = 0;
  ForEachCase(random, [&](const Case& one) {
    const DeltaCurve curve = ComputeDeltaReference(one.motion_template, one.recording);
    for (const double tau : kTaus) {
      const FilterPlan plan(one.motion_template, tau);
      if (!plan.rules_out()) continue;
      std::vector<char> is_left(one.recording.size());
      for (const ColumnRun& run : FilterRange(plan, one.recording, 0, one.recording.size())) {
        ASSERT_LE(run.first, run.last);
        ASSERT_LT(run.last, one.recording.size());
        std::fill(is_left.begin() + static_cast<std::ptrdiff_t>(run.first),
                  is_left.begin() + static_cast<std::ptrdiff_t>(run.last) + 1, 1);
      }
      for (std::size_t i = 0; i < is_left.size(); ++i) {
        if (curve.delta[i] > tau) continue;
        ++columns_within;
        ASSERT_EQ(is_left[i], 1) << "column " << i << ", tau " << tau;
      }
    }
  });
  EXPECT_GT(columns_within, 10'000);  // Else nothing was tested.
}

// Wherever the range begins and ends, the same columns of it are left, but for what closes gaps.
TEST_P(Filter, OfAPartLeavesItsColumns) {
  const DeltaTarget target(GetParam());
  Random random(32);
  ForEachCase(random, [&](const Case& one) {
    const FilterPlan plan(one.motion_template, 0.1);
    if (!plan.rules_out()) return;
    const DeltaCurve curve = ComputeDeltaReference(one.motion_template, one.recording);
    const std::size_t begin = one.recording.size() / 3;
    const std::size_t end = begin + one.recording.size() / 2;
    std::vector<char> is_left(one.recording.size());
    for (const ColumnRun& run : FilterRange(plan, one.recording, begin, end)) {
      ASSERT_GE(run.first, begin);
      ASSERT_LT(run.last, end);
      std::fill(is_left.begin() + static_cast<std::ptrdiff_t>(run.first),
                is_left.begin() + static_cast<std::ptrdiff_t>(run.last) + 1, 1);
    }
    for (std::size_t i = begin; i < end; ++i) {
      if (curve.delta[i] > 0.1) continue;
      ASSERT_EQ(is_left[i], 1) << i;
    }
  });
}

TEST_P(Filter, GivesTheHitsOfTheWholeCurve) {
  const DeltaTarget target(GetParam());
  Random random(33);
  ForEachCase(random, [&](const Case& one) {
    const FeatureMatrix recording{.rate_hz = one.motion_template.rate_hz,
                                  .feature_count = one.motion_template.feature_count,
                                  .columns = one.recording};
    const DeltaCurve curve = ComputeDeltaReference(one.motion_template, one.recording);
    for (const double tau : kTaus) {
      EXPECT_EQ(SearchTemplate(one.motion_template, {&recording, 1}, {.tau = tau}),
                BestHits(ExtractHits(curve, tau), 500));
    }
  });
}

TEST_P(Filter, RulesOutWhatIsFarOff) {
  const DeltaTarget target(GetParam());
  Random random(34);
  for (const bool weighted : {false, true}) {
    TemplateMatrix matrix{.rate_hz = 30, .feature_count = 39};
    matrix.values.assign(std::size_t{39} * 50, 1.0);
    matrix.weights.assign(50, 1.0);
    QuantizedTemplate motion_template = Quantize(matrix, 0.1, Profile::kBonn);
    if (weighted) GiveWeights(random, motion_template);
    const FilterPlan plan(motion_template, 0.1);
    ASSERT_TRUE(plan.rules_out());
    // Half of what it asks for never holds.
    const std::vector<std::uint64_t> recording(5000, 0x2AAAAAAAAA);
    EXPECT_THAT(FilterRange(plan, recording, 0, recording.size()), testing::IsEmpty());
  }
}

// Their quotients are infinite, or nothing: still no column within τ may be lost.
TEST_P(Filter, LosesNothingToTheSmallestAndLargestNumbers) {
  const DeltaTarget target(GetParam());
  Random random(36);
  const double least = std::numeric_limits<double>::denorm_min();
  const double smallest = std::numeric_limits<double>::min();
  const double largest = std::numeric_limits<double>::max();
  for (const double weight : {2 * least, smallest / 1000, smallest, 1e-300, 1.0, largest / 64}) {
    for (const double tau : {least, smallest, 1e-300, 1e-6, 0.3}) {
      SCOPED_TRACE(testing::Message() << "weight " << weight << ", tau " << tau);
      QuantizedTemplate motion_template = RandomQuantized(random, 5, 39, Profile::kBonn);
      motion_template.costs.assign(motion_template.columns.size() * 39, weight);
      std::vector<std::uint64_t> recording = RandomRecording(random, 200, 39);
      Perform(random, motion_template, recording);
      const FilterPlan plan(motion_template, tau);
      if (!plan.rules_out()) continue;
      std::vector<char> is_left(recording.size());
      for (const ColumnRun& run : FilterRange(plan, recording, 0, recording.size())) {
        std::fill(is_left.begin() + static_cast<std::ptrdiff_t>(run.first),
                  is_left.begin() + static_cast<std::ptrdiff_t>(run.last) + 1, 1);
      }
      const DeltaCurve curve = ComputeDeltaReference(motion_template, recording);
      for (std::size_t i = 0; i < is_left.size(); ++i) {
        if (curve.delta[i] > tau) continue;
        ASSERT_EQ(is_left[i], 1) << i;
      }
    }
  }
}

// A path of one column reaches nowhere, and yet what lies close by is computed in one go.
TEST_P(Filter, JoinsWhatATemplateOfOneColumnLeaves) {
  const DeltaTarget target(GetParam());
  TemplateMatrix matrix{.rate_hz = 30, .feature_count = 39};
  matrix.values.assign(39, 1.0);
  matrix.weights.assign(1, 1.0);
  const QuantizedTemplate motion_template = Quantize(matrix, 0.1, Profile::kBonn);
  const FilterPlan plan(motion_template, 0.1);
  ASSERT_TRUE(plan.rules_out());
  std::vector<std::uint64_t> recording(5000, 0);
  for (const std::size_t match : {100, 102, 164, 1000, 1023, 1024, 3000}) {
    recording[match] = AllFeatures(39);
  }
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (const ColumnRun& run : FilterRange(plan, recording, 0, recording.size())) {
    runs.emplace_back(run.first, run.last);
  }
  EXPECT_THAT(runs, testing::ElementsAre(testing::Pair(100, 164), testing::Pair(1000, 1024),
                                         testing::Pair(3000, 3000)));
}

INSTANTIATE_TEST_SUITE_P(Targets, Filter, ::testing::ValuesIn(SupportedDeltaTargets()),
                         [](const auto& target) { return DeltaTargetName(target.param); });

TEST(FilterPlan, IsForThresholdsThatRuleSomethingOut) {
  Random random(35);
  const QuantizedTemplate motion_template = RandomQuantized(random, 20, 39, Profile::kBonn);
  EXPECT_TRUE(FilterPlan(motion_template, 0.1).rules_out());
  EXPECT_FALSE(FilterPlan(motion_template, 0).rules_out());
  EXPECT_FALSE(FilterPlan(motion_template, 0.31).rules_out());
  EXPECT_FALSE(FilterPlan(motion_template, std::numeric_limits<double>::infinity()).rules_out());
  QuantizedTemplate any = motion_template;
  for (QuantizedColumn& column : any.columns) column = {};
  EXPECT_FALSE(FilterPlan(any, 0.1).rules_out());
  QuantizedTemplate tiny = motion_template;
  for (QuantizedColumn& column : tiny.columns) column.consistent = AllFeatures(39);
  tiny.costs.assign(tiny.columns.size() * 39, 1e-323);  // All of a column, divided by 255, is 0.
  EXPECT_FALSE(FilterPlan(tiny, 0.1).rules_out());
  tiny.costs.assign(tiny.columns.size() * 39, 1e-306);  // 65535 / all of a column is infinite.
  EXPECT_FALSE(FilterPlan(tiny, 1e-310).rules_out());
  EXPECT_TRUE(FilterPlan(tiny, 0.1).rules_out());
}

}  // namespace
}  // namespace kinebase::test
