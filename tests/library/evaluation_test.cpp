#include "kinebase/library/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;

using testing::DoubleNear;

// right, wrong, excused, right, and a third clip that is not found.
std::vector<JudgedHit> Ranking() {
  return {{.cost = 0.01, .right = true},
          {.cost = 0.02},
          {.cost = 0.03, .excused = true},
          {.cost = 0.05, .right = true}};
}

TEST(ScoreRanking, IsWhatTheProtocolSays) {
  const Scores scores = ScoreRanking(Ranking(), 3, std::vector{0.01, 0.03, 0.1}, 0.02);
  EXPECT_DOUBLE_EQ(scores.ap_strict, (1.0 + 2.0 / 4) / 3);
  EXPECT_DOUBLE_EQ(scores.ap_lenient, (1.0 + 2.0 / 3) / 3);
  EXPECT_DOUBLE_EQ(scores.r_precision, 1.0 / 3);  // One right of the first three.
  EXPECT_DOUBLE_EQ(scores.recall_in_5, 2.0 / 3);
  ASSERT_EQ(scores.at.size(), 3);
  EXPECT_DOUBLE_EQ(scores.at[0].precision, 1);
  EXPECT_DOUBLE_EQ(scores.at[0].recall, 1.0 / 3);
  EXPECT_DOUBLE_EQ(scores.at[0].f1, 0.5);
  EXPECT_DOUBLE_EQ(scores.at[1].precision, 0.5);  // The excused one does not count.
  EXPECT_DOUBLE_EQ(scores.at[2].precision, 2.0 / 3);
  EXPECT_DOUBLE_EQ(scores.at[2].recall, 2.0 / 3);
  EXPECT_DOUBLE_EQ(scores.at_own.tau, 0.02);
  EXPECT_DOUBLE_EQ(scores.at_own.precision, 0.5);
}

TEST(ScoreRanking, OfNothingFoundIsNothing) {
  const Scores scores = ScoreRanking({}, 2, std::vector{0.1}, 0.1);
  EXPECT_EQ(scores.ap_lenient, 0);
  EXPECT_EQ(scores.r_precision, 0);
  EXPECT_EQ(scores.at[0].recall, 0);
  EXPECT_EQ(scores.at[0].f1, 0);
}

TEST(Reliability, ComparesConfidenceWithWhatIsRight) {
  MethodResult result;
  std::vector<JudgedHit>& hits = result.classes.emplace_back().hits["a"];
  for (int i = 0; i < 40; ++i) hits.push_back({.right = i < 30, .confidence = 0.95});
  for (int i = 0; i < 60; ++i) hits.push_back({.right = i < 3, .confidence = 0.05});
  for (int i = 0; i < 29; ++i) hits.push_back({.right = false, .confidence = 0.55});
  for (int i = 0; i < 99; ++i) hits.push_back({.excused = true, .confidence = 0.95});
  const std::vector<ReliabilityBin> bins = MeasureReliability(result);
  ASSERT_EQ(bins.size(), 10);
  EXPECT_EQ(bins[9].hits, 40);
  EXPECT_DOUBLE_EQ(bins[9].right, 0.75);
  EXPECT_NEAR(bins[9].confidence, 0.95, 1e-12);
  // Bins of fewer than 30 hits are left out.
  EXPECT_NEAR(CalibrationError(bins), (40 * 0.2 + 60 * 0.0) / 100, 1e-12);
  EXPECT_EQ(CalibrationError({}), 0);
}

TEST(PossiblyRelevant, KnowsStretchesAndWholeTrials) {
  const TemporaryFolder folder;
  const fs::path table = folder.path() / "relevant.csv";
  const fs::path labels = folder.path() / "labels.csv";
  WriteText(table, "class,trial,label\nsquat,*,Squat\njump,01_01,hop\nwalk,02_01,*\n");
  WriteText(labels,
            "trial,source,label,first_frame_1based,last_frame_1based\n"
            "13_29,x,Squat,100,200\n01_01,x,hop,1,50\n13_29,x,hop,1,50\n");
  const PossiblyRelevant relevant = PossiblyRelevant::Read(table, labels);
  EXPECT_TRUE(relevant.MayShow("squat", "13_29", 100));
  EXPECT_TRUE(relevant.MayShow("squat", "13_29", 200));
  EXPECT_FALSE(relevant.MayShow("squat", "13_29", 200.5));
  EXPECT_FALSE(relevant.MayShow("squat", "01_01", 150));
  EXPECT_TRUE(relevant.MayShow("jump", "01_01", 20));
  EXPECT_FALSE(relevant.MayShow("jump", "13_29", 20));
  EXPECT_TRUE(relevant.MayShow("walk", "02_01", 1e6));
  EXPECT_FALSE(relevant.MayShow("run", "02_01", 1));
  EXPECT_FALSE(PossiblyRelevant().MayShow("squat", "13_29", 150));
  WriteText(labels, "trial,label,first_frame_1based,last_frame_1based\n13_29,Squat,soon,200\n");
  EXPECT_EQ(ErrorOf([&] { (void)PossiblyRelevant::Read(table, labels); }).code(),
            ErrorCode::kMalformedFile);
}

TEST(Calibrate, PutsTheThresholdHalfWayToWrongHits) {
  const Evidence evidence = {{"a",
                              {.unseen = {{0.10, true}, {0.14, true}, {0.12, true}, {0.50, false}},
                               .seen = {{0.00, true}, {0.02, true}, {0.01, true}, {0.40, false}}}},
                             {"only right", {.seen = {{0.1, true}}}},
                             {"alone", {.seen = {{0.1, true}}, .unlabelled = {0.9, 0.4, 0.1}}},
                             {"mistaken", {.seen = {{0.3, true}, {0.2, false}}}}};
  std::vector<MotionTemplate> templates;
  for (const char* name : {"a", "only right", "alone", "mistaken", "unknown"}) {
    templates.push_back({.name = name, .tau = 0.7});
  }
  Calibrate(evidence, templates);
  // Right hits: half way between .12 and .01; the best wrong one costs .4.
  EXPECT_NEAR(*templates[0].tau, 0.065 + (0.4 - 0.065) / 2, 1e-12);
  EXPECT_NEAR(Confidence(*templates[0].calibration, *templates[0].tau), 0.5, 1e-12);
  EXPECT_GT(Confidence(*templates[0].calibration, 0.065), 0.9);
  EXPECT_LT(Confidence(*templates[0].calibration, 0.4), 0.01);
  EXPECT_NEAR(*templates[2].tau, 0.1 + (0.4 - 0.1) / 2, 1e-12);
  for (const std::size_t i : {1, 3, 4}) {
    EXPECT_EQ(templates[i].tau, 0.7) << i;
    EXPECT_FALSE(templates[i].calibration) << i;
  }
}

// Found in quality.md of the method's description: figures of an independent implementation on the
// same clips and takes, and the bars for what is more than the paper's method.
TEST(EvaluationOfRealClips, ReproducesPlainTemplatesAndPassesThem) {
  KINEBASE_NEEDS_TEST_DATA();
  const fs::path cmu = TestData("data/cmu");
  std::vector<fs::path> distractors;
  for (const auto& entry : fs::recursive_directory_iterator(cmu)) {
    if (entry.path().extension() == ".amc") distractors.push_back(entry.path());
  }
  std::ranges::sort(distractors);
  const FeatureSet features = LoadFeatureSet("bonn");
  EvaluationData data = LoadEvaluationData({TestData("data/hdm05/clips.csv"), {}, distractors},
                                           features, 30, {}, 0, {});
  data.possibly_relevant = PossiblyRelevant::Read(cmu / "labels/possibly_relevant.csv",
                                                  cmu / "labels/frame_segments_120hz.csv");
  ASSERT_TRUE(data.failures.empty());
  EXPECT_EQ(data.clips.size(), 146);
  EXPECT_EQ(data.distractors.size(), 37);
  const Evaluation evaluation =
      Evaluate(data, features, {.methods = {*FindMethod("mt"), *FindMethod("mt+")}});
  const Scores& plain = evaluation.methods[0].macro;
  EXPECT_THAT(plain.ap_strict, DoubleNear(0.905, 0.002));
  EXPECT_THAT(plain.ap_lenient, DoubleNear(0.921, 0.002));
  EXPECT_THAT(plain.r_precision, DoubleNear(0.856, 0.002));
  const Scores& more = evaluation.methods[1].macro;
  EXPECT_GE(more.ap_strict, 0.94);
  EXPECT_GE(more.ap_lenient, 0.97);
  EXPECT_GE(more.classified, 0.995);
  for (const ClassResult& each : evaluation.methods[1].classes) {
    EXPECT_GE(each.mean.ap_lenient, 0.90) << each.class_name;
  }
  for (const ClassResult& each : evaluation.methods[1].classes) {
    EXPECT_GE(each.mean.ap_lenient, 0.9) << each.class_name;
  }
  EXPECT_LE(CalibrationError(MeasureReliability(evaluation.methods[1])), 0.05);
}

TEST(Evaluation, NeedsTwoActors) {
  EvaluationData data;
  data.clips.resize(2);
  EXPECT_EQ(ErrorOf([&] { (void)Evaluate(data, LoadFeatureSet("bonn"), {}); }).code(),
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace kinebase::test
