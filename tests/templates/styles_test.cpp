#include "kinebase/templates/styles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "templates/matrices.h"

namespace kinebase::test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr int kFeatures = 6;

// A performance where feature i is one in the i-th sixth of the time, from the last to the first
// if `backwards`; one bit in twenty is wrong.
TemplateMatrix Performance(Random& random, bool backwards) {
  TemplateMatrix matrix{.rate_hz = 30, .feature_count = kFeatures};
  const int columns = 30 + random.Below(13);
  for (int column = 0; column < columns; ++column) {
    const int phase = column * kFeatures / columns;
    for (int feature = 0; feature < kFeatures; ++feature) {
      const bool is_one = feature == (backwards ? kFeatures - 1 - phase : phase);
      matrix.values.push_back(is_one != (random.Below(20) == 0) ? 1 : 0);
    }
    matrix.weights.push_back(1);
  }
  return matrix;
}

std::vector<TemplateMatrix> Performances(std::initializer_list<int> backwards) {
  Random random(5);
  std::vector<TemplateMatrix> performances;
  for (const int each : backwards) performances.push_back(Performance(random, each != 0));
  return performances;
}

TEST(Styles, AreThoseThatTheClipsWereMadeWith) {
  for (const Profile profile : {Profile::kBonn, Profile::kPaper}) {
    EXPECT_THAT(FindStyles(Performances({0, 1, 0, 1, 1, 0, 0}), profile),
                ElementsAre(0, 1, 0, 1, 1, 0, 0));
  }
}

TEST(Styles, AreNumberedByTheirFirstPerformance) {
  EXPECT_THAT(FindStyles(Performances({1, 1, 0, 0, 0, 1}), Profile::kBonn),
              ElementsAre(0, 0, 1, 1, 1, 0));
}

TEST(Styles, AreNotMadeOfFewerThanThree) {
  EXPECT_THAT(FindStyles(Performances({0, 0, 0, 0, 0, 1, 1}), Profile::kBonn), Each(0));
  EXPECT_THAT(FindStyles(Performances({0, 0, 0, 1, 1}), Profile::kBonn), Each(0));
  EXPECT_THAT(FindStyles({}, Profile::kBonn), IsEmpty());
}

TEST(Styles, AreOneWherePerformancesDifferByChanceAlone) {
  EXPECT_THAT(FindStyles(Performances({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), Profile::kBonn),
              Each(0));
  // All the same, so that no two are nearer than others.
  const std::vector<TemplateMatrix> same(8, Performances({0}).front());
  EXPECT_THAT(FindStyles(same, Profile::kBonn), Each(0));
}

// Two that break off half way: too few for a style, and nearer to those that go on.
TEST(Styles, TakeWhatIsLeftOver) {
  std::vector<TemplateMatrix> performances = Performances({0, 1, 0, 1, 0, 1, 0, 1, 0, 0});
  for (const std::size_t broken : {8, 9}) {
    std::vector<double>& values = performances[broken].values;
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end(), 0);
  }
  EXPECT_THAT(FindStyles(performances, Profile::kBonn), ElementsAre(0, 1, 0, 1, 0, 1, 0, 1, 0, 0));
}

}  // namespace
}  // namespace kinebase::test
