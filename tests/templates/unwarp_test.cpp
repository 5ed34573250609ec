#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "kinebase/templates/learning.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

TEST(UnwarpBonn, StretchesByTheRoundedWeightHalvesUp) {
  const TemplateMatrix matrix = MakeMatrix({{0.25}, {0.5}, {1}}, {1.5, 2.5, 1.25});
  EXPECT_EQ(Unwarp(matrix, Profile::kBonn),
            MakeMatrix({{0.25}, {0.25}, {0.5}, {0.5}, {0.5}, {1}},
                       {0.75, 0.75, 2.5 / 3, 2.5 / 3, 2.5 / 3, 1.25}));
}

TEST(UnwarpBonn, MergesNeighboursUntilTheyWeighThreeQuarters) {
  const TemplateMatrix matrix = MakeMatrix({{1}, {0}, {1}, {0}, {1}}, {0.5, 0.25, 0.5, 0.5, 1});
  EXPECT_EQ(Unwarp(matrix, Profile::kBonn), MakeMatrix({{0.5 / 0.75}, {0.5}, {1}}, {0.75, 1, 1}));
}

TEST(UnwarpBonn, StretchesAgainWhatMergingMadeTooHeavy) {
  const TemplateMatrix matrix = MakeMatrix({{1}, {0}}, {0.5, 1.25});
  EXPECT_EQ(Unwarp(matrix, Profile::kBonn),
            MakeMatrix({{0.5 / 1.75}, {0.5 / 1.75}}, {0.875, 0.875}));
}

TEST(UnwarpBonn, JoinsALightRestWithTheColumnBefore) {
  const TemplateMatrix matrix = MakeMatrix({{0}, {1}, {0}}, {1, 0.75, 0.25});
  EXPECT_EQ(Unwarp(matrix, Profile::kBonn), MakeMatrix({{0}, {0.75}}, {1, 1}));
}

// Columns 2 and 3 form a group; the rest joins column 3 alone and column 2 is lost, as in the
// authors' toolbox.
TEST(UnwarpBonn, LosesTheOtherMembersOfTheGroupThatALightRestJoins) {
  const TemplateMatrix matrix = MakeMatrix({{0}, {1}, {0}, {1}}, {1, 0.25, 0.5, 0.25});
  const TemplateMatrix unwarped = Unwarp(matrix, Profile::kBonn);
  EXPECT_EQ(unwarped, MakeMatrix({{0}, {0.25 / 0.75}}, {1, 0.75}));
  EXPECT_EQ(unwarped.total_weight(), matrix.total_weight() - 0.25);
}

TEST(UnwarpPaper, KeepsAllMembersOfTheGroupThatALightRestJoins) {
  const TemplateMatrix matrix = MakeMatrix({{0}, {1}, {0}, {1}}, {1, 0.25, 0.5, 0.5});
  EXPECT_EQ(Unwarp(matrix, Profile::kPaper), MakeMatrix({{0}, {0.75 / 1.25}}, {1, 1.25}));
}

TEST(UnwarpPaper, CutsColumnsWhereAUnitOfTimeEnds) {
  const TemplateMatrix matrix = MakeMatrix({{1}, {0}}, {1.5, 2.25});
  EXPECT_EQ(Unwarp(matrix, Profile::kPaper), MakeMatrix({{1}, {0.5}, {0}, {0}}, {1, 1, 1, 0.75}));
}

TEST(UnwarpPaper, LetsAHeavyRestStandAlone) {
  const TemplateMatrix matrix = MakeMatrix({{1}, {0}}, {1, 0.875});
  EXPECT_EQ(Unwarp(matrix, Profile::kPaper), matrix);
}

TEST(Unwarp, KeepsASingleColumnHoweverLight) {
  const TemplateMatrix matrix = MakeMatrix({{0.3, 1}}, {0.25});
  EXPECT_EQ(Unwarp(matrix, Profile::kBonn), matrix);
  EXPECT_EQ(Unwarp(matrix, Profile::kPaper), matrix);
}

TEST(Unwarp, LeavesColumnsOfWeightOneAlone) {
  Random random(7);
  TemplateMatrix matrix = RandomMatrix(random, 40, 39);
  matrix.weights.assign(40, 1.0);
  EXPECT_EQ(Unwarp(matrix, Profile::kBonn), matrix);
  EXPECT_EQ(Unwarp(matrix, Profile::kPaper), matrix);
}

double WeightedSum(const TemplateMatrix& matrix, int feature) {
  double sum = 0;
  for (int c = 0; c < matrix.column_count(); ++c) {
    sum += matrix.Column(c)[feature] * matrix.weights[c];
  }
  return sum;
}

RC_GTEST_PROP(UnwarpPaper, KeepsTotalWeightAndWhatEachFeatureHeld, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const TemplateMatrix matrix = RandomMatrix(random, 1 + random.Below(60), 4);
  const TemplateMatrix unwarped = Unwarp(matrix, Profile::kPaper);
  RC_ASSERT(std::abs(unwarped.total_weight() - matrix.total_weight()) < 1e-12);
  for (int feature = 0; feature < 4; ++feature) {
    RC_ASSERT(std::abs(WeightedSum(unwarped, feature) - WeightedSum(matrix, feature)) < 1e-12);
  }
  for (int c = 0; c + 1 < unwarped.column_count(); ++c) RC_ASSERT(unwarped.weights[c] == 1);
  if (matrix.total_weight() > 1) {
    RC_ASSERT(unwarped.weights.back() >= 0.75);
    RC_ASSERT(unwarped.weights.back() < 1.75 + 1e-12);
  }
}

RC_GTEST_PROP(UnwarpBonn, GivesWeightsAboutOneAndLosesOnlyLightColumns, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const TemplateMatrix matrix = RandomMatrix(random, 1 + random.Below(60), 4);
  const TemplateMatrix unwarped = Unwarp(matrix, Profile::kBonn);
  const double lost = matrix.total_weight() - unwarped.total_weight();
  RC_ASSERT(lost > -1e-12);
  RC_ASSERT(lost < 0.75);
  if (matrix.total_weight() < 1.5) return;
  for (const double weight : unwarped.weights) RC_ASSERT(weight < 1.5);
}

RC_GTEST_PROP(Unwarp, KeepsValuesBetweenZeroAndOne, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const TemplateMatrix matrix = RandomMatrix(random, 1 + random.Below(60), 4);
  for (const Profile profile : {Profile::kBonn, Profile::kPaper}) {
    for (const double value : Unwarp(matrix, profile).values) {
      RC_ASSERT(value >= 0);
      RC_ASSERT(value <= 1);
    }
  }
}

}  // namespace
}  // namespace kinebase::test
