// The authors' own stored templates and those of an independent second implementation.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "kinebase/templates/learning.h"
#include "support/test_data.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

TemplateMatrix Golden(const std::string& name) {
  return ReadMatrix(TestData("golden/learning/" + name + ".csv"));
}

nlohmann::json GoldenJson(const std::string& name) {
  return nlohmann::json::parse(ReadText(TestData("golden/learning/" + name + ".json")));
}

std::vector<TemplateMatrix> GoldenCartwheels(const std::string& stage) {
  std::vector<TemplateMatrix> matrices;
  for (const char* number : {"1", "2", "3", "4"}) {
    matrices.push_back(Golden("cartwheel_" + stage + "_" + number));
  }
  return matrices;
}

TEST(GoldenLearning, AveragesTheAlignedCartwheels) {
  KINEBASE_NEEDS_TEST_DATA();
  const TemplateMatrix average = AverageMatrices(GoldenCartwheels("warped"));
  ExpectNear(average, Golden("cartwheel_average"), 1e-15);
}

TEST(GoldenLearning, UnwarpsTheAverageCartwheelToTheSameBits) {
  KINEBASE_NEEDS_TEST_DATA();
  const TemplateMatrix average = AverageMatrices(GoldenCartwheels("warped"));
  EXPECT_EQ(Unwarp(average, Profile::kBonn), Golden("cartwheel_pass1_1"));
}

// Whole passes: a tie settled otherwise changes a path, and with it columns and costs.
TEST(GoldenLearning, FollowsTheCartwheelsThroughEveryPass) {
  KINEBASE_NEEDS_TEST_DATA();
  std::vector<TemplateMatrix> matrices = GoldenCartwheels("pass1");
  const TemplateMatrix golden_final = Golden("cartwheel_final_1");
  const nlohmann::json trace = GoldenJson("cartwheel_trace");
  ASSERT_EQ(trace.size(), 31U);
  for (const nlohmann::json& pass : trace) {
    SCOPED_TRACE("pass " + pass.at("iteration").dump());
    if (pass.at("iteration") == 32) ExpectNear(matrices[0], golden_final, 1e-12);
    LearningRound round = LearnRound(matrices, Profile::kBonn);
    EXPECT_NEAR(round.largest_cost, pass.at("largest_cost").get<double>(), 1e-12);
    std::vector<int> columns;
    for (const TemplateMatrix& matrix : round.matrices) columns.push_back(matrix.column_count());
    EXPECT_EQ(columns, pass.at("columns").get<std::vector<int>>());
    matrices = std::move(round.matrices);
  }
}

TEST(GoldenLearning, LearnsTheCartwheelInThirtyPasses) {
  KINEBASE_NEEDS_TEST_DATA();
  const LearnedMatrix learned =
      LearnTemplate(GoldenCartwheels("pass1"), {.max_rounds = 30, .cost_limit = 0});
  EXPECT_EQ(learned.largest_costs.size(), 30U);
  ExpectNear(learned.matrix, Golden("cartwheel_final_1"), 1e-12);
}

TEST(GoldenLearning, LearnsElbowToKneeFromFiveClips) {
  KINEBASE_NEEDS_TEST_DATA();
  std::vector<TemplateMatrix> clips;
  for (const char* actor : {"bd", "bk", "dg", "mm", "tr"}) {
    clips.push_back(Golden(std::string("elbow_input_") + actor));
  }
  const nlohmann::json golden = GoldenJson("elbow_learning");
  const LearnedMatrix learned = LearnTemplate(clips);
  ExpectNear(learned.matrix, Golden("elbow_template"), 1e-12);
  EXPECT_EQ(learned.matrix.column_count(), golden.at("columns").get<int>());
  EXPECT_NEAR(learned.matrix.total_weight(), golden.at("total_weight").get<double>(), 1e-12);
  const auto costs = golden.at("largest_cost_per_iteration").get<std::vector<double>>();
  ASSERT_EQ(learned.largest_costs.size(), costs.size());
  for (std::size_t i = 0; i < costs.size(); ++i) {
    EXPECT_NEAR(learned.largest_costs[i], costs[i], 1e-12) << "round " << i + 1;
  }
}

}  // namespace
}  // namespace kinebase::test
