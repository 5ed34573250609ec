#include "kinebase/templates/learning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "kinebase/core/error.h"
#include "kinebase/search/subsequence_dtw.h"
#include "support/files.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

using ::testing::HasSubstr;

constexpr Profile kProfiles[] = {Profile::kBonn, Profile::kPaper};

std::vector<TemplateMatrix> RandomPerformances(std::uint32_t seed, int count) {
  Random random(seed);
  std::vector<TemplateMatrix> performances;
  for (int i = 0; i < count; ++i) {
    performances.push_back(RandomPerformance(random, 20 + random.Below(15), 39));
  }
  return performances;
}

TEST(Learning, ReturnsASinglePerformanceAsItIs) {
  const std::vector<TemplateMatrix> performances = RandomPerformances(1, 1);
  for (const Profile profile : kProfiles) {
    const LearnedMatrix learned = LearnTemplate(performances, {.profile = profile});
    EXPECT_EQ(learned.matrix, performances[0]);
    EXPECT_EQ(learned.largest_costs, std::vector<double>{0});
  }
}

// Ties decide which way a path goes, so sums must not differ in their last bit.
TEST(Learning, IsTheSameInEveryBitOnEveryInstructionSet) {
  for (const Profile profile : kProfiles) {
    Random random(11);
    std::vector<TemplateMatrix> performances;
    for (const int columns : {1, 7, 8, 9, 16, 17, 31}) {
      performances.push_back(RandomPerformance(random, columns, 39));
    }
    std::vector<LearnedMatrix> learned;
    for (const std::int64_t target : SupportedDeltaTargets()) {
      UseDeltaTarget(target);
      learned.push_back(LearnTemplate(performances, {.profile = profile}));
    }
    UseDeltaTarget(0);
    for (const LearnedMatrix& other : learned) {
      EXPECT_EQ(other.matrix, learned.front().matrix);
      EXPECT_EQ(other.largest_costs, learned.front().largest_costs);
    }
  }
}

TEST(Learning, ReturnsIdenticalPerformancesAsTheyAre) {
  const std::vector<TemplateMatrix> performances(5, RandomPerformances(2, 1)[0]);
  for (const Profile profile : kProfiles) {
    const LearnedMatrix learned = LearnTemplate(performances, {.profile = profile});
    EXPECT_EQ(learned.matrix, performances[0]);
    EXPECT_EQ(learned.largest_costs, std::vector<double>{0});
  }
}

// A motion at half the speed: both hold the same, and the template takes the mean time.
TEST(Learning, TakesTheMeanTimeOfASlowAndAFastPerformance) {
  const TemplateMatrix fast = MakeMatrix({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  const TemplateMatrix slow =
      MakeMatrix({{0, 0}, {0, 0}, {1, 0}, {1, 0}, {1, 1}, {1, 1}, {0, 1}, {0, 1}});
  const std::vector<TemplateMatrix> performances = {fast, slow};
  for (const Profile profile : kProfiles) {
    const LearnedMatrix learned =
        LearnTemplate(performances, {.profile = profile, .max_rounds = 1});
    EXPECT_DOUBLE_EQ(learned.matrix.total_weight(), 6);
    EXPECT_EQ(learned.largest_costs, std::vector<double>{0});
  }
  EXPECT_EQ(LearnTemplate(performances, {.profile = Profile::kPaper, .max_rounds = 1}).matrix,
            MakeMatrix({{0, 0}, {0.5, 0}, {1, 0}, {1, 1}, {0.5, 1}, {0, 1}}));
}

// One of four features differs in the only column: a quarter of disagreement in either profile.
TEST(Learning, MeasuresTheLargestCostPerFeatureAndWeight) {
  const std::vector<TemplateMatrix> performances = {MakeMatrix({{0, 1, 0, 1}}),
                                                    MakeMatrix({{0, 1, 0, 0}})};
  for (const Profile profile : kProfiles) {
    EXPECT_EQ(LearnRound(performances, profile).largest_cost, 0.25);
  }
}

TEST(Learning, TakesEveryMatrixAsReferenceInARound) {
  const std::vector<TemplateMatrix> performances = RandomPerformances(3, 4);
  for (const Profile profile : kProfiles) {
    const LearningRound round = LearnRound(performances, profile);
    ASSERT_EQ(round.matrices.size(), performances.size());
    for (std::size_t r = 0; r < performances.size(); ++r) {
      std::vector<TemplateMatrix> warped;
      for (std::size_t i = 0; i < performances.size(); ++i) {
        warped.push_back(i == r ? performances[r]
                                : WarpToReference(performances[i],
                                                  Align(performances[r], performances[i], profile),
                                                  performances[r].column_count()));
      }
      EXPECT_EQ(round.matrices[r], Unwarp(AverageMatrices(warped), profile)) << "reference " << r;
    }
  }
}

TEST(Learning, GivesTheSameBitsOnAnyNumberOfThreads) {
  const std::vector<TemplateMatrix> performances = RandomPerformances(4, 7);
  for (const Profile profile : kProfiles) {
    const LearnedMatrix alone = LearnTemplate(performances, {.profile = profile, .threads = 1});
    for (const int threads : {2, 3, 8}) {
      const LearnedMatrix together =
          LearnTemplate(performances, {.profile = profile, .threads = threads});
      EXPECT_EQ(together.matrix, alone.matrix);
      EXPECT_EQ(together.largest_costs, alone.largest_costs);
    }
  }
}

TEST(Learning, StopsInTheFirstRoundWithinTheCostLimit) {
  const std::vector<TemplateMatrix> performances = RandomPerformances(5, 4);
  const std::vector<double> costs =
      LearnTemplate(performances, {.max_rounds = 6, .cost_limit = 0}).largest_costs;
  ASSERT_GE(costs.size(), 3U);
  ASSERT_LT(costs[2], costs[0]);
  const double limit = costs[2];
  const std::size_t expected =
      static_cast<std::size_t>(std::ranges::find_if(costs, [&](double c) { return c <= limit; }) -
                               costs.begin()) +
      1;
  const LearnedMatrix learned = LearnTemplate(performances, {.cost_limit = limit});
  EXPECT_EQ(learned.largest_costs,
            std::vector<double>(costs.begin(), costs.begin() + static_cast<long>(expected)));
}

// Two performances that stay apart by the same amount, however often they are averaged.
TEST(Learning, StopsWhenTheLargestCostNoLongerChanges) {
  const std::vector<TemplateMatrix> performances = {
      MakeMatrix({{1, 1}, {0, 0}, {1, 0}}),
      MakeMatrix({{1, 1}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {0, 0}})};
  const std::vector<double> costs = LearnTemplate(performances).largest_costs;
  ASSERT_EQ(costs.size(), 2U);
  EXPECT_NEAR(costs[0], 2.0 / 9, 1e-15);
  EXPECT_EQ(costs[1], costs[0]);
}

TEST(Learning, StopsAfterTheRoundsThatAreAllowed) {
  const std::vector<TemplateMatrix> performances = RandomPerformances(6, 4);
  for (const int rounds : {1, 2, 3}) {
    const LearnedMatrix learned =
        LearnTemplate(performances, {.max_rounds = rounds, .cost_limit = 0});
    EXPECT_EQ(learned.largest_costs.size(), static_cast<std::size_t>(rounds));
  }
}

TEST(Learning, ReportsEveryRoundAndCanBeCancelled) {
  std::vector<std::size_t> reported;
  LearnOptions options{.max_rounds = 5, .cost_limit = 0};
  options.progress = [&](std::string_view, std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 5U);
    reported.push_back(done);
    return done < 2;
  };
  const Error error = ErrorOf([&] { (void)LearnTemplate(RandomPerformances(7, 4), options); });
  EXPECT_EQ(error.code(), ErrorCode::kCancelled);
  EXPECT_EQ(reported, (std::vector<std::size_t>{0, 1, 2}));
}

struct BadInput {
  const char* expected;
  std::vector<TemplateMatrix> performances;
  LearnOptions options;
};

TEST(Learning, NamesWhatIsWrongWithItsInput) {
  const TemplateMatrix good = MakeMatrix({{0, 1}, {1, 1}});
  TemplateMatrix empty = good;
  empty.weights.clear();
  empty.values.clear();
  TemplateMatrix slow = good;
  slow.rate_hz = 15;
  TemplateMatrix torn = good;
  torn.values.pop_back();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const BadInput cases[] = {
      {"no performances", {}, {}},
      {"performance 2 has no columns", {good, empty, torn}, {}},
      {"performance 3 has 3 values", {good, good, torn}, {}},
      {"performance 2 has 1 features", {good, MakeMatrix({{1}})}, {}},
      {"performance 2 has 15 columns a second", {good, slow}, {}},
      {"performance 1 has value 1.5", {MakeMatrix({{1.5}})}, {}},
      {"performance 1 has value nan", {MakeMatrix({{nan}})}, {}},
      {"performance 1 has weight 0", {MakeMatrix({{1}}, {0})}, {}},
      {"0 rounds", {good}, {.max_rounds = 0}},
      {"cost limit nan", {good}, {.cost_limit = nan}},
      {"cost limit -1", {good}, {.cost_limit = -1}},
  };
  for (const BadInput& bad : cases) {
    const Error error = ErrorOf([&] { (void)LearnTemplate(bad.performances, bad.options); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr(bad.expected));
  }
}

}  // namespace
}  // namespace kinebase::test
