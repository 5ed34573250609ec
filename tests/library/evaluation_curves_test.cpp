#include "kinebase/library/evaluation_curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace kinebase::test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

// right, wrong, excused, right, wrong, wrong, right; one of four clips is never found.
std::vector<JudgedHit> Ranking() {
  return {{.right = true}, {}, {.excused = true}, {.right = true}, {}, {}, {.right = true}};
}

// As the definition says, level by level.
double HighestPrecisionFrom(double recall, const std::vector<std::pair<double, double>>& points) {
  double highest = 0;
  for (const auto& [point_recall, precision] : points) {
    if (point_recall >= recall - 1e-12) highest = std::max(highest, precision);
  }
  return highest;
}

TEST(InterpolatedPrecision, IsTheHighestWithAsMuchRecallOrMore) {
  const std::vector<double> precision = InterpolatedPrecision(Ranking(), 4);
  ASSERT_THAT(precision, SizeIs(kRecallLevels));
  // Recall and precision at each right hit, the excused one left out.
  const std::vector<std::pair<double, double>> points = {
      {0.25, 1.0}, {0.5, 2.0 / 3}, {0.75, 3.0 / 6}};
  for (std::size_t i = 0; i < kRecallLevels; ++i) {
    EXPECT_DOUBLE_EQ(precision[i], HighestPrecisionFrom(static_cast<double>(i) / 100, points)) << i;
  }
  EXPECT_EQ(precision[25], 1);
  EXPECT_EQ(precision[75], 0.5);
  EXPECT_EQ(precision[76], 0);
}

TEST(InterpolatedPrecision, RisesWhereLaterHitsAreBetter) {
  // Wrong first, then all three: precisions 1/2, 2/3, 3/4 become 3/4 everywhere.
  const std::vector<JudgedHit> hits = {{}, {.right = true}, {.right = true}, {.right = true}};
  EXPECT_THAT(InterpolatedPrecision(hits, 3), Each(0.75));
}

TEST(InterpolatedPrecision, IsOneForAPerfectRankingAndNothingForNone) {
  const std::vector<JudgedHit> perfect(7, {.right = true});
  EXPECT_THAT(InterpolatedPrecision(perfect, 7), Each(1.0));
  EXPECT_THAT(InterpolatedPrecision({}, 7), Each(0.0));
}

TEST(MacroPrecision, IsTheMeanOverActorsThenClasses) {
  const std::vector<JudgedHit> perfect = {{.right = true}};
  const std::vector<JudgedHit> second = {{}, {.right = true}};
  MethodResult result;
  result.classes.resize(3);
  result.classes[0].hits = {{"a", perfect}, {"b", second}};
  result.classes[0].relevant = {{"a", 1}, {"b", 1}};
  result.classes[1].hits = {{"a", {}}};  // Never found.
  result.classes[1].relevant = {{"a", 1}};
  // Nobody was tested on the third.
  EXPECT_THAT(MeanPrecision(result.classes[0]), Each(0.75));
  EXPECT_THAT(MeanPrecision(result.classes[1]), Each(0.0));
  EXPECT_THAT(MeanPrecision(result.classes[2]), IsEmpty());
  EXPECT_THAT(MacroPrecision(result), Each(0.375));
  EXPECT_THAT(MacroPrecision({}), IsEmpty());
}

TEST(CountConfusion, CountsClipsByWhatTheyShowAndWereTakenFor) {
  MethodResult result;
  for (const char* name : {"jump", "kick", "squat"}) {
    result.classes.push_back({.class_name = name});
  }
  const auto add = [&](const char* shown, const char* taken_for, int times) {
    for (int i = 0; i < times; ++i) {
      result.clips.push_back({.class_name = shown, .taken_for = taken_for});
    }
  };
  add("jump", "jump", 3);
  add("jump", "squat", 2);
  add("kick", "kick", 1);
  add("squat", "", 1);
  const Confusion confusion = CountConfusion(result);
  EXPECT_THAT(confusion.classes, ElementsAre("jump", "kick", "squat"));
  EXPECT_THAT(confusion.counts, ElementsAre(ElementsAre(3, 0, 2, 0), ElementsAre(0, 1, 0, 0),
                                            ElementsAre(0, 0, 0, 1)));
  EXPECT_EQ(confusion.right(), 4);
  EXPECT_EQ(confusion.all(), 7);
}

}  // namespace
}  // namespace kinebase::test
