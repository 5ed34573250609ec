#include "kinebase/search/explanation.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>

#include "search/scans.h"

namespace kinebase::test {
namespace {

RC_GTEST_PROP(ExplainPath, AccountsForTheWholeCost, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const int features = 1 + random.Below(64);
  const Profile matching = random.Below(2) == 0 ? Profile::kBonn : Profile::kPaper;
  const QuantizedTemplate motion_template =
      RandomQuantized(random, 1 + random.Below(12), features, matching);
  const std::vector<std::uint64_t> recording =
      RandomRecording(random, 1 + random.Below(40), features);
  const DeltaCurve curve = ComputeDeltaReference(motion_template, recording);
  for (int last = 0; last < std::ssize(recording); ++last) {
    const std::vector<ExplainedCell> cells = ExplainPath(motion_template, recording, last);
    RC_ASSERT(cells.empty() == (curve.start[last] < 0));
    double cost = 0;
    double by_features = 0;
    for (const ExplainedCell& each : cells) {
      const QuantizedColumn& column = motion_template.columns[each.cell.template_column];
      RC_ASSERT((each.agreed | each.disagreed) == column.consistent);
      RC_ASSERT((each.agreed & each.disagreed) == 0);
      cost += each.cost;
      for (int feature = 0; feature < features; ++feature) {
        if (((each.disagreed >> feature) & 1U) != 0) {
          by_features += CostOfFeature(motion_template, each, feature);
        }
      }
    }
    if (cells.empty()) continue;
    RC_ASSERT(std::abs(cost - curve.delta[last]) < 1e-12);
    RC_ASSERT(std::abs(by_features - curve.delta[last]) < 1e-12);
  }
}

// The second column asks for both features, the recording has the first alone.
TEST(ExplainPath, SaysWhichFeatureWasWrongWhere) {
  TemplateMatrix matrix{.rate_hz = 30, .feature_count = 2};
  matrix.values = {0, .5, 1, 1};
  matrix.weights.assign(2, 1);
  const QuantizedTemplate motion_template = Quantize(matrix, 0.1, Profile::kPaper);
  const std::vector<std::uint64_t> recording = {0b11, 0b10, 0b01};
  const std::vector<ExplainedCell> cells = ExplainPath(motion_template, recording, 2);
  ASSERT_EQ(cells.size(), 2);
  EXPECT_EQ(cells[0], (ExplainedCell{{0, 1}, 0b01, 0b00, 0, .5}));
  EXPECT_EQ(cells[1], (ExplainedCell{{1, 2}, 0b01, 0b10, .25, .5}));
}

// Two cells; the class has the first value at 1 and the second at 0, other motion a variance of ¼.
TEST(ExplainPlaces, SaysHowManySpreadsEachValueIsOffAndWhatItCosts) {
  PoseModel model;
  model.mean.resize(std::size_t{2} * kPoseValues);
  model.weight.resize(std::size_t{2} * kPoseValues);
  model.spread.assign(kPoseValues, 0.25F);
  model.spread[2] = 0;
  for (const std::size_t column : {0, 1}) {
    model.mean[column * kPoseValues] = 1;
    model.weight[column * kPoseValues] = 0.75F;
    model.weight[column * kPoseValues + 1] = 0.25F;
  }
  PoseStream poses{.rate_hz = 30};
  poses.values.resize(std::size_t{5} * kPoseValues);
  const auto set = [&](int column, float x, float y) {
    poses.values[static_cast<std::size_t>(column) * kPoseValues] = x;
    poses.values[static_cast<std::size_t>(column) * kPoseValues + 1] = y;
  };
  set(2, 0.5F, 0);  // Half below 1: one spread.
  set(4, 1, 10);    // Twenty spreads above; more than two do not cost more.
  const std::vector<ExplainedCell> path = {{.cell = {0, 2}}, {.cell = {1, 4}}};
  const std::vector<ExplainedPlace> places = ExplainPlaces(model, path, poses);
  ASSERT_EQ(places.size(), 2 * kPoseValues);
  // A tenth of the mean over two cells.
  EXPECT_EQ(places[0].off, -1);
  EXPECT_NEAR(places[0].cost, 0.05 * 0.75, 1e-9);
  EXPECT_EQ(places[1], (ExplainedPlace{.off = 0, .cost = 0}));
  EXPECT_EQ(places[kPoseValues], (ExplainedPlace{.off = 0, .cost = 0}));
  EXPECT_EQ(places[kPoseValues + 1].off, 20);
  EXPECT_NEAR(places[kPoseValues + 1].cost, 0.05 * 0.25 * 4, 1e-9);
  for (std::size_t i = 2; i < kPoseValues; ++i) {
    EXPECT_EQ(places[i], (ExplainedPlace{.off = 0, .cost = 0})) << i;
  }
}

}  // namespace
}  // namespace kinebase::test
