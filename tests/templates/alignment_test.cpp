#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "kinebase/templates/learning.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

using Cells = std::vector<std::pair<int, int>>;

Cells CellsOf(const Alignment& alignment) {
  Cells cells;
  for (const AlignedColumns& cell : alignment.path) cells.emplace_back(cell.reference, cell.other);
  return cells;
}

double LocalCost(const TemplateMatrix& reference, int k, const TemplateMatrix& other, int l,
                 Profile profile) {
  double sum = 0;
  for (int f = 0; f < reference.feature_count; ++f) {
    sum += std::abs(reference.Column(k)[f] - other.Column(l)[f]);
  }
  if (profile == Profile::kPaper) return sum;
  return sum / reference.feature_count * ((reference.weights[k] + other.weights[l]) / 2);
}

// The textbook's table, cell by cell, with the steps kept.
Alignment AlignPlainly(const TemplateMatrix& reference, const TemplateMatrix& other,
                       Profile profile) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const int rows = reference.column_count();
  const int columns = other.column_count();
  std::vector<std::vector<double>> cost(rows, std::vector<double>(columns, kInfinity));
  std::vector<std::vector<AlignedColumns>> from(rows, std::vector<AlignedColumns>(columns));
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < columns; ++l) {
      double best = k == 0 && l == 0 ? 0 : kInfinity;
      for (const auto& [dk, dl] : Cells{{1, 1}, {0, 1}, {1, 0}}) {
        if (k < dk || l < dl || cost[k - dk][l - dl] >= best) continue;
        best = cost[k - dk][l - dl];
        from[k][l] = {k - dk, l - dl};
      }
      cost[k][l] = best + LocalCost(reference, k, other, l, profile);
    }
  }
  Alignment alignment{.path = {{rows - 1, columns - 1}}, .cost = cost[rows - 1][columns - 1]};
  while (alignment.path.back().reference > 0 || alignment.path.back().other > 0) {
    const AlignedColumns cell = alignment.path.back();
    alignment.path.push_back(from[cell.reference][cell.other]);
  }
  std::ranges::reverse(alignment.path);
  return alignment;
}

// The least cost of all paths from (k, l) on, by trying every one.
double CheapestPath(const TemplateMatrix& reference, int k, const TemplateMatrix& other, int l) {
  if (k >= reference.column_count() || l >= other.column_count()) {
    return std::numeric_limits<double>::infinity();
  }
  const double here = LocalCost(reference, k, other, l, Profile::kPaper);
  if (k == reference.column_count() - 1 && l == other.column_count() - 1) return here;
  return here + std::min({CheapestPath(reference, k + 1, other, l + 1),
                          CheapestPath(reference, k, other, l + 1),
                          CheapestPath(reference, k + 1, other, l)});
}

TEST(Alignment, PrefersTheDiagonalThenTheOtherWhereAllCostsAreEqual) {
  const TemplateMatrix two = MakeMatrix({{0}, {0}});
  const TemplateMatrix three = MakeMatrix({{0}, {0}, {0}});
  EXPECT_EQ(CellsOf(Align(two, three, Profile::kPaper)), (Cells{{0, 0}, {0, 1}, {1, 2}}));
  EXPECT_EQ(CellsOf(Align(three, two, Profile::kPaper)), (Cells{{0, 0}, {1, 0}, {2, 1}}));
}

// Both ways round the expensive middle cost the same; the last step is the one along the other.
TEST(Alignment, PrefersTheStepAlongTheOtherToTheStepAlongTheReference) {
  const TemplateMatrix reference = MakeMatrix({{1}, {0}, {1}});
  const TemplateMatrix other = MakeMatrix({{0}, {1}, {0}});
  const Alignment alignment = Align(reference, other, Profile::kPaper);
  EXPECT_EQ(alignment.cost, 2);
  EXPECT_EQ(CellsOf(alignment), (Cells{{0, 0}, {1, 0}, {2, 1}, {2, 2}}));
}

TEST(Alignment, WeighsBonnCostsByFeaturesAndMeanWeight) {
  const TemplateMatrix reference = MakeMatrix({{1, 0, 0, 0.5}}, {2});
  const TemplateMatrix other = MakeMatrix({{0, 0, 0, 0}}, {1});
  EXPECT_EQ(Align(reference, other, Profile::kPaper).cost, 1.5);
  EXPECT_EQ(Align(reference, other, Profile::kBonn).cost, 1.5 / 4 * 1.5);
}

RC_GTEST_PROP(Alignment, EqualsThePlainTableInEveryBit, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const int features = 1 + random.Below(40);
  const TemplateMatrix a = RandomMatrix(random, 1 + random.Below(20), features);
  const TemplateMatrix b = RandomMatrix(random, 1 + random.Below(20), features);
  for (const Profile profile : {Profile::kBonn, Profile::kPaper}) {
    const Alignment fast = Align(a, b, profile);
    const Alignment plain = AlignPlainly(a, b, profile);
    RC_ASSERT(fast.cost == plain.cost);
    RC_ASSERT(CellsOf(fast) == CellsOf(plain));
  }
}

// Small whole numbers, so that sums are exact in any order.
RC_GTEST_PROP(Alignment, FindsTheCheapestOfAllPaths, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const int features = 1 + random.Below(4);
  const TemplateMatrix a = RandomPerformance(random, 1 + random.Below(6), features);
  const TemplateMatrix b = RandomPerformance(random, 1 + random.Below(6), features);
  RC_ASSERT(Align(a, b, Profile::kPaper).cost == CheapestPath(a, 0, b, 0));
}

TEST(Warping, SharesAWeightAmongTheReferenceColumnsOfAColumn) {
  const TemplateMatrix other = MakeMatrix({{1, 0}, {0.5, 1}}, {3, 1});
  const Alignment alignment{.path = {{0, 0}, {1, 0}, {2, 0}, {3, 1}}, .cost = 0};
  EXPECT_EQ(WarpToReference(other, alignment, 4),
            MakeMatrix({{1, 0}, {1, 0}, {1, 0}, {0.5, 1}}, {1, 1, 1, 1}));
}

TEST(Warping, AveragesByWeightTheColumnsOfOneReferenceColumn) {
  const TemplateMatrix other = MakeMatrix({{1, 0}, {0, 1}, {0, 0}}, {3, 1, 2});
  const Alignment alignment{.path = {{0, 0}, {0, 1}, {1, 2}}, .cost = 0};
  EXPECT_EQ(WarpToReference(other, alignment, 2), MakeMatrix({{0.75, 0.25}, {0, 0}}, {4, 2}));
}

RC_GTEST_PROP(Warping, KeepsTheTotalWeight, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const TemplateMatrix reference = RandomMatrix(random, 1 + random.Below(30), 5);
  const TemplateMatrix other = RandomMatrix(random, 1 + random.Below(30), 5);
  const TemplateMatrix warped =
      WarpToReference(other, Align(reference, other, Profile::kBonn), reference.column_count());
  RC_ASSERT(warped.column_count() == reference.column_count());
  RC_ASSERT(std::abs(warped.total_weight() - other.total_weight()) < 1e-12);
}

TEST(Averaging, WeighsValuesAndTakesTheMeanOfWeights) {
  const std::vector<TemplateMatrix> matrices = {MakeMatrix({{1, 0}, {1, 1}}, {1, 2}),
                                                MakeMatrix({{0, 0}, {0.5, 0}}, {3, 2})};
  EXPECT_EQ(AverageMatrices(matrices), MakeMatrix({{0.25, 0}, {0.75, 0.5}}, {2, 2}));
}

}  // namespace
}  // namespace kinebase::test
