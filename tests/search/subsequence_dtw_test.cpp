#include "kinebase/search/subsequence_dtw.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <limits>
#include <set>

#include "search/scans.h"

namespace kinebase::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double Disagreement(const QuantizedColumn& column, std::uint64_t features) {
  return std::popcount((features ^ column.ones) & column.consistent) * column.scale;
}

// All paths that end at (k, l), as (cost, start).
std::vector<std::pair<double, int>> AllPaths(const QuantizedTemplate& motion_template,
                                             const std::vector<std::uint64_t>& recording, int k,
                                             int l) {
  if (k < 0 || l < 0) return {};
  const double here = Disagreement(motion_template.columns[k], recording[l]);
  if (k == 0) return {{here, l}};
  std::vector<std::pair<double, int>> paths;
  constexpr std::pair<int, int> kSteps[] = {{1, 1}, {1, 2}, {2, 1}};
  for (const auto& [dk, dl] : kSteps) {
    for (const auto& [cost, start] : AllPaths(motion_template, recording, k - dk, l - dl)) {
      paths.emplace_back(cost + here, start);
    }
  }
  return paths;
}

RC_GTEST_PROP(PaperDelta, IsTheCheapestOfAllPaths, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const int features = 1 + random.Below(6);
  const QuantizedTemplate motion_template =
      RandomQuantized(random, 1 + random.Below(7), features, Profile::kPaper);
  const std::vector<std::uint64_t> recording =
      RandomRecording(random, 1 + random.Below(11), features);
  const DeltaCurve curve = ComputeDeltaReference(motion_template, recording);
  const int rows = motion_template.column_count();
  for (int l = 0; l < std::ssize(recording); ++l) {
    const auto paths = AllPaths(motion_template, recording, rows - 1, l);
    if (paths.empty()) {
      RC_ASSERT(curve.delta[l] == kInfinity);
      RC_ASSERT(curve.start[l] == -1);
      continue;
    }
    const double cheapest = std::ranges::min(paths).first;
    RC_ASSERT(std::abs(curve.delta[l] - cheapest / rows) < 1e-12);
    std::set<int> starts;
    for (const auto& [cost, start] : paths) {
      if (cost < cheapest + 1e-12) starts.insert(start);
    }
    RC_ASSERT(starts.contains(curve.start[l]));
  }
}

// The rule of profile bonn as it is written, without a table.
struct BonnCell {
  double cost = kInfinity;
  int start = -1;
};

BonnCell BonnCellAt(const QuantizedTemplate& motion_template,
                    const std::vector<std::uint64_t>& recording, int k, int l) {
  if (k < 0 || l < 0) return {};
  const double here = Disagreement(motion_template.columns[k], recording[l]);
  if (k == 0) return {here, l};
  const BonnCell one_one = BonnCellAt(motion_template, recording, k - 1, l - 1);
  const BonnCell one_two = BonnCellAt(motion_template, recording, k - 1, l - 2);
  const BonnCell two_one = BonnCellAt(motion_template, recording, k - 2, l - 1);
  if (one_one.cost <= one_two.cost && one_one.cost <= two_one.cost) {
    return {one_one.cost + here, one_one.start};
  }
  if (one_two.cost <= two_one.cost) return {one_two.cost + here, one_two.start};
  return {two_one.cost + 2 * here, two_one.start};
}

RC_GTEST_PROP(BonnDelta, FollowsTheRuleAsItIsWritten, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const int features = 1 + random.Below(6);
  const QuantizedTemplate motion_template =
      RandomQuantized(random, 1 + random.Below(7), features, Profile::kBonn);
  const std::vector<std::uint64_t> recording =
      RandomRecording(random, 1 + random.Below(11), features);
  const DeltaCurve curve = ComputeDeltaReference(motion_template, recording);
  const int rows = motion_template.column_count();
  for (int l = 0; l < std::ssize(recording); ++l) {
    const BonnCell cell = BonnCellAt(motion_template, recording, rows - 1, l);
    RC_ASSERT(curve.delta[l] == cell.cost / rows);
    RC_ASSERT(curve.start[l] == cell.start);
  }
}

// One feature; the template wants 0 and 1, the recording has them after a wrong column.
TEST(Delta, IsZeroWhereTheTemplateFitsAndCountsMismatchesElsewhere) {
  const QuantizedTemplate motion_template =
      Quantize(MakeMatrix({{0}, {1}, {1}}), 0.1, Profile::kPaper);
  const std::vector<std::uint64_t> recording = {1, 0, 1, 1, 0};
  const DeltaCurve curve = ComputeDelta(motion_template, recording);
  EXPECT_EQ(curve.delta[0], kInfinity);
  EXPECT_EQ(curve.delta[1], 1.0 * 2 / 3);  // Steps over the middle: both columns disagree.
  EXPECT_EQ(curve.delta[2], 0);            // The same step, from the 0 before.
  EXPECT_EQ(curve.delta[3], 0);
  EXPECT_EQ(curve.delta[4], 1.0 / 3);
  EXPECT_EQ(curve.start, (std::vector<std::int32_t>{-1, 0, 1, 1, 1}));
}

// Into the last cell, cost 1: (1,1) would come from cost ½, (2,1) from cost 0. Bonn takes the
// latter and pays double, 2, where the former would have cost 1½.
TEST(Delta, PicksThePredecessorBeforeItDoublesTheCellInBonn) {
  const TemplateMatrix matrix = MakeMatrix({{0, 0}, {1, 0}, {1, 1}});
  const std::vector<std::uint64_t> recording = {0b00, 0b00, 0b00};
  const DeltaCurve bonn = ComputeDelta(Quantize(matrix, 0.1, Profile::kBonn), recording);
  EXPECT_EQ(bonn.delta[2], 2.0 / 3);
  EXPECT_EQ(bonn.start[2], 1);
  const DeltaCurve paper = ComputeDelta(Quantize(matrix, 0.1, Profile::kPaper), recording);
  EXPECT_EQ(paper.delta[2], 1.0 / 3);
  EXPECT_EQ(paper.start[2], 1);
}

TEST(Delta, IsInfiniteInRecordingsShorterThanHalfTheTemplate) {
  Random random(31);
  const QuantizedTemplate motion_template = RandomQuantized(random, 21, 39, Profile::kBonn);
  const DeltaCurve ten = ComputeDelta(motion_template, RandomRecording(random, 10, 39));
  for (const double delta : ten.delta) EXPECT_EQ(delta, kInfinity);
  for (const std::int32_t start : ten.start) EXPECT_EQ(start, -1);
  const DeltaCurve eleven = ComputeDelta(motion_template, RandomRecording(random, 11, 39));
  EXPECT_LT(eleven.delta[10], kInfinity);
  EXPECT_EQ(eleven.start[10], 0);
}

bool IsStep(const PathCell& from, const PathCell& to) {
  const int dk = to.template_column - from.template_column;
  const int dl = to.recording_column - from.recording_column;
  return (dk == 1 && (dl == 1 || dl == 2)) || (dk == 2 && dl == 1);
}

RC_GTEST_PROP(TracedPath, LeadsFromTheStartAndCostsDelta, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const Profile matching = random.Below(2) == 0 ? Profile::kBonn : Profile::kPaper;
  const int rows = 1 + random.Below(25);
  const QuantizedTemplate motion_template = RandomQuantized(random, rows, 39, matching);
  const std::vector<std::uint64_t> recording = RandomRecording(random, 1 + random.Below(150), 39);
  const DeltaCurve curve = ComputeDeltaReference(motion_template, recording);
  for (int last = 0; last < std::ssize(recording); ++last) {
    const std::vector<PathCell> path = TracePath(motion_template, recording, last);
    RC_ASSERT(path.empty() == (curve.start[last] < 0));
    if (path.empty()) continue;
    RC_ASSERT(path.front() == (PathCell{0, curve.start[last]}));
    RC_ASSERT(path.back() == (PathCell{rows - 1, last}));
    double cost = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double here = Disagreement(motion_template.columns[path[i].template_column],
                                       recording[path[i].recording_column]);
      cost += here;
      if (i == 0) continue;
      RC_ASSERT(IsStep(path[i - 1], path[i]));
      const bool skips = path[i].template_column - path[i - 1].template_column == 2;
      if (skips && matching == Profile::kBonn) cost += here;
    }
    RC_ASSERT(std::abs(cost / rows - curve.delta[last]) < 1e-12);
  }
}

TEST(TracedPath, IsEmptyOutsideTheRecording) {
  Random random(32);
  const QuantizedTemplate motion_template = RandomQuantized(random, 3, 39, Profile::kBonn);
  const std::vector<std::uint64_t> recording = RandomRecording(random, 20, 39);
  EXPECT_TRUE(TracePath(motion_template, recording, -1).empty());
  EXPECT_TRUE(TracePath(motion_template, recording, 20).empty());
}

}  // namespace
}  // namespace kinebase::test
