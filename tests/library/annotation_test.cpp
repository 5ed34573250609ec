#include "kinebase/library/annotation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinebase/core/error.h"
#include "library/one_feature_takes.h"

namespace kinebase {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

AnnotationCandidate Candidate(int motion_class, std::int64_t first, std::int64_t last, double cost,
                              double tau = 0.1) {
  return {.motion_class = motion_class, .first = first, .last = last, .cost = cost, .tau = tau};
}

double Worth(const std::vector<AnnotationCandidate>& segments) {
  double worth = 0;
  for (const AnnotationCandidate& c : segments) {
    worth += static_cast<double>(c.last - c.first + 1) * (1 - c.cost / c.tau);
  }
  return worth;
}

TEST(FindCandidates, AreTheMatchesThatCostNoMoreThanTau) {
  const TakeFeatures take = test::OneFeatureTake(20, {{10, 14}});
  const AnnotationTemplate one{
      .motion_class = 3, .quantized = test::OneFeatureTemplate(), .tau = 0};
  // Columns 9 to 15, and to 16 by the step that passes over one; four frames each.
  EXPECT_THAT(FindCandidates(one, take.features),
              ElementsAre(Candidate(3, 9, 15, 0, 0), Candidate(3, 9, 16, 0, 0)));
  EXPECT_THAT(FindCandidates(one, take),
              ElementsAre(Candidate(3, 37, 64, 0, 0), Candidate(3, 37, 68, 0, 0)));
}

TEST(FindCandidates, RefuseOtherFeatures) {
  FeatureMatrix other{.rate_hz = 60, .feature_count = 1};
  other.columns.resize(9);
  const AnnotationTemplate one{.quantized = test::OneFeatureTemplate()};
  EXPECT_THROW((void)FindCandidates(one, other), Error);
}

TEST(ChooseSegments, TakesTheBetterOfTwoThatOverlap) {
  EXPECT_THAT(ChooseSegments({Candidate(0, 1, 10, 0.05), Candidate(1, 4, 13, 0.02)}),
              ElementsAre(Candidate(1, 4, 13, 0.02)));
  // By its own threshold: .05 of .1 is worse than .06 of .2.
  EXPECT_THAT(ChooseSegments({Candidate(0, 1, 10, 0.05), Candidate(1, 4, 13, 0.06, 0.2)}),
              ElementsAre(Candidate(1, 4, 13, 0.06, 0.2)));
}

TEST(ChooseSegments, PrefersTwoNeighboursToTheBestBetweenThem) {
  const std::vector<AnnotationCandidate> candidates = {
      Candidate(0, 1, 10, 0.02), Candidate(0, 11, 20, 0.02), Candidate(1, 6, 15, 0)};
  EXPECT_THAT(ChooseSegments(candidates), ElementsAre(candidates[0], candidates[1]));
}

TEST(ChooseSegments, LeavesOutWhatCostsAsMuchAsItsThreshold) {
  EXPECT_THAT(ChooseSegments({Candidate(0, 1, 10, 0.1)}), IsEmpty());
  EXPECT_THAT(ChooseSegments({Candidate(0, 1, 10, 0, 0)}), ElementsAre(Candidate(0, 1, 10, 0, 0)));
  EXPECT_THAT(ChooseSegments({}), IsEmpty());
}

TEST(ChooseSegments, LetsOtherTracksOverlap) {
  const std::vector<AnnotationCandidate> candidates = {
      Candidate(0, 1, 10, 0.05), Candidate(1, 4, 13, 0.02), Candidate(2, 5, 9, 0.03)};
  const std::vector<int> tracks = {7, 0, 7};
  EXPECT_THAT(ChooseSegments(candidates, tracks), ElementsAre(candidates[0], candidates[1]));
}

TEST(ChooseSegments, SettlesTheBorderOfNeighboursThatOverlapALittle) {
  // Lengths 40 and 80 may give 2 and 4 places; of three that they share they give 1 and 2.
  const auto segments = ChooseSegments({Candidate(0, 1, 40, 0), Candidate(1, 38, 117, 0.01)});
  EXPECT_THAT(segments, ElementsAre(Candidate(0, 1, 39, 0), Candidate(1, 40, 117, 0.01)));
  // Seven places are more than both may give.
  EXPECT_THAT(ChooseSegments({Candidate(0, 1, 40, 0), Candidate(1, 34, 113, 0.01)}),
              ElementsAre(Candidate(1, 34, 113, 0.01)));
}

TEST(ChooseSegments, RefusesWhatMakesNoSense) {
  EXPECT_THROW((void)ChooseSegments({Candidate(0, 5, 4, 0)}), Error);
  EXPECT_THROW((void)ChooseSegments({Candidate(0, 1, 4, 0.2)}), Error);
  const std::vector<int> tracks = {0};
  EXPECT_THROW((void)ChooseSegments({Candidate(1, 1, 4, 0)}, tracks), Error);
}

// Every subset, for a handful of candidates.
double BestWorthOfAllSubsets(const std::vector<AnnotationCandidate>& candidates) {
  double best = 0;
  for (unsigned subset = 0; subset < (1U << candidates.size()); ++subset) {
    std::vector<AnnotationCandidate> chosen;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (((subset >> i) & 1U) != 0) chosen.push_back(candidates[i]);
    }
    std::ranges::sort(chosen, {}, &AnnotationCandidate::first);
    const auto overlap = [](const AnnotationCandidate& a, const AnnotationCandidate& b) {
      return b.first <= a.last;
    };
    if (std::ranges::adjacent_find(chosen, overlap) == chosen.end()) {
      best = std::max(best, Worth(chosen));
    }
  }
  return best;
}

RC_GTEST_PROP(ChooseSegments, IsTheBestOfAllChoices, ()) {
  std::vector<AnnotationCandidate> candidates;
  const int count = *rc::gen::inRange(0, 10);
  for (int i = 0; i < count; ++i) {
    const int first = *rc::gen::inRange(0, 40);
    const int length = *rc::gen::inRange(1, 19);  // Too short to give anything at a border.
    const int hundredths = *rc::gen::inRange(0, 10);
    candidates.push_back(Candidate(*rc::gen::inRange(0, 3), first, first + length - 1,
                                   static_cast<double>(hundredths) / 100));
  }
  const auto chosen = ChooseSegments(candidates);
  for (std::size_t i = 1; i < chosen.size(); ++i) {
    RC_ASSERT(chosen[i - 1].last < chosen[i].first);
  }
  RC_ASSERT(std::abs(Worth(chosen) - BestWorthOfAllSubsets(candidates)) < 1e-9);
}

RC_GTEST_PROP(ChooseSegments, NeverOverlapsAndTakesNoMoreThanAMargin, ()) {
  std::vector<AnnotationCandidate> candidates;
  const int count = *rc::gen::inRange(0, 30);
  for (int i = 0; i < count; ++i) {
    const int first = *rc::gen::inRange(0, 400);
    candidates.push_back(Candidate(i, first, first + *rc::gen::inRange(0, 120), 0));
  }
  const auto chosen = ChooseSegments(candidates);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto& whole = candidates[static_cast<std::size_t>(chosen[i].motion_class)];
    const std::int64_t margin = (whole.last - whole.first + 1) / 20;
    RC_ASSERT(chosen[i].first >= whole.first && chosen[i].first <= whole.first + margin);
    RC_ASSERT(chosen[i].last <= whole.last && chosen[i].last >= whole.last - margin);
    if (i > 0) RC_ASSERT(chosen[i - 1].last < chosen[i].first);
  }
}

TEST(MergeSegments, JoinsRepetitionsOfAClassOverShortPauses) {
  const std::vector<AnnotationCandidate> segments = {
      Candidate(0, 1, 10, 0.02), Candidate(0, 13, 42, 0.06), Candidate(1, 43, 50, 0),
      Candidate(0, 51, 60, 0)};
  const auto merged = MergeSegments(segments, 2);
  ASSERT_EQ(merged.size(), 3);
  EXPECT_EQ(merged[0].first, 1);
  EXPECT_EQ(merged[0].last, 42);
  EXPECT_DOUBLE_EQ(merged[0].cost, (10 * 0.02 + 30 * 0.06) / 40);
  EXPECT_THAT(MergeSegments(segments, 1), ::testing::ElementsAreArray(segments));
}

TEST(MergeSegments, KnowsAConfidenceOnlyIfAllHaveOne) {
  std::vector<AnnotationCandidate> segments = {Candidate(0, 1, 10, 0), Candidate(0, 11, 20, 0)};
  segments[0].confidence = 0.5;
  EXPECT_FALSE(MergeSegments(segments, 0).front().confidence);
  segments[1].confidence = 1;
  EXPECT_DOUBLE_EQ(*MergeSegments(segments, 0).front().confidence, 0.75);
}

TEST(UncoveredStretches, AreWhatIsLeft) {
  const std::vector<AnnotationCandidate> segments = {Candidate(0, 3, 5, 0), Candidate(1, 4, 8, 0),
                                                     Candidate(0, 9, 10, 0)};
  EXPECT_THAT(UncoveredStretches(segments, {1, 12}),
              ElementsAre(PlaceRange{1, 2}, PlaceRange{11, 12}));
  EXPECT_THAT(UncoveredStretches({}, {1, 12}), ElementsAre(PlaceRange{1, 12}));
  EXPECT_THAT(UncoveredStretches(segments, {3, 10}), IsEmpty());
}

// A template that asks for these features and leaves the others free.
AnnotationTemplate AsksFor(int motion_class, std::uint64_t features, const FeatureSet& set) {
  AnnotationTemplate one{.motion_class = motion_class};
  one.quantized.feature_count = set.feature_count();
  one.quantized.columns = {{.consistent = features}};
  return one;
}

TEST(TracksByBodyPart, SeparateArmsFromLegs) {
  const FeatureSet set = LoadFeatureSet("bonn");  // F1 to F14 arms, F15 to F26 legs, then mixed.
  const std::uint64_t arm = 1U << 2;
  const std::uint64_t leg = 1U << 20;
  const std::vector<AnnotationTemplate> apart = {AsksFor(0, arm, set), AsksFor(1, leg, set),
                                                 AsksFor(2, 1U << 5, set)};
  EXPECT_THAT(TracksByBodyPart(apart, 3, set), ElementsAre(0, 1, 0));
  const std::vector<AnnotationTemplate> through_a_third = {
      AsksFor(0, arm, set), AsksFor(1, leg, set), AsksFor(2, arm | leg, set)};
  EXPECT_THAT(TracksByBodyPart(through_a_third, 3, set), ElementsAre(0, 0, 0));
}

TEST(ThresholdFromBackground, IsAShareOfTheSecondBestRecording) {
  const MotionTemplate one{.matrix = test::OneFeatureMatrix()};
  const std::vector<TakeFeatures> takes = {test::OneFeatureTake(20, {{10, 14}}),
                                           test::OneFeatureTake(20, {}),
                                           test::OneFeatureTake(2, {})};
  std::vector<RecordingStreams> background;
  background.reserve(takes.size());
  for (const TakeFeatures& take : takes) background.push_back({.features = take.features});
  // The first recording is a perfect match, the second 0 throughout, the third too short.
  const DeltaCurve curve =
      ComputeDeltaReference(test::OneFeatureTemplate(), takes[1].features.columns);
  const double least = *std::ranges::min_element(curve.delta);
  ASSERT_GT(least, 0);
  EXPECT_DOUBLE_EQ(ThresholdFromBackground(one, background).value(), 0.7 * least);
  background.erase(background.begin());
  EXPECT_DOUBLE_EQ(ThresholdFromBackground(one, background).value(), 0.7 * least);
  background.erase(background.begin());
  EXPECT_FALSE(ThresholdFromBackground(one, background));  // Too short for the template.
}

}  // namespace
}  // namespace kinebase
