// What templates are compared with, as methods of an evaluation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinebase/core/error.h"
#include "kinebase/library/evaluation.h"
#include "kinebase/search/example_search.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Key;
using testing::SizeIs;

constexpr int kJoints = 2;

// One group each, so that fuzzy queries and keyframes choose.
FeatureSet TwoFeatures() {
  FeatureSet set{.name = "two", .hash = 2};
  set.features.resize(2);
  set.features[0].group = "upper";
  set.features[1].group = "lower";
  return set;
}

JointStream Still(JointStreamKind kind, int columns) {
  JointStream stream{.kind = kind, .rate_hz = 30, .joint_count = kJoints};
  stream.values.resize(static_cast<std::size_t>(columns) * stream.numbers_per_column());
  if (kind == JointStreamKind::kRotations) {
    for (std::size_t i = 0; i < stream.values.size(); i += 4) stream.values[i] = 1;
  }
  return stream;
}

TakeFeatures Take(const std::string& name, int columns) {
  TakeFeatures take{
      .path = name + ".amc", .rate_hz = 120, .frame_count = std::int64_t{4} * columns};
  take.features = {.rate_hz = 30, .feature_count = 2};
  take.features.columns.resize(static_cast<std::size_t>(columns));
  take.rotations = Still(JointStreamKind::kRotations, columns);
  take.positions = Still(JointStreamKind::kPositions, columns);
  return take;
}

// In the middle half "a" has the first feature, "b" the second; the first joint turns half around,
// about x or y, and moves to 1 along x or y.
LabelledClip Clip(const std::string& class_name, const std::string& actor, int number,
                  int columns = 24) {
  LabelledClip clip{Take(class_name + actor + std::to_string(number), columns), class_name, actor};
  const std::size_t axis = class_name == "a" ? 0 : 1;
  for (int column = columns / 4; column < columns - columns / 4; ++column) {
    const auto c = static_cast<std::size_t>(column);
    clip.take.features.columns[c] = axis == 0 ? 0b01 : 0b10;
    clip.take.rotations.values[c * 4 * kJoints] = 0;
    clip.take.rotations.values[c * 4 * kJoints + 1 + axis] = 1;
    clip.take.positions.values[c * 3 * kJoints + axis] = 1;
  }
  return clip;
}

EvaluationData Data() {
  EvaluationData data;
  for (const char* actor : {"x", "y"}) {
    for (const char* name : {"a", "b"}) {
      // Medians of 20, 24, 30 columns: the second.
      for (const int columns : {30, 20, 24}) {
        data.clips.push_back(Clip(name, actor, columns, columns));
      }
    }
  }
  data.distractors.push_back(Take("d", 100));
  return data;
}

Evaluation EvaluateAllBaselines(const EvaluationData& data) {
  EvaluateOptions options;
  options.baselines.assign(Baselines().begin(), Baselines().end());
  return Evaluate(data, TwoFeatures(), options);
}

TEST(Baselines, FindWhatIsPlainToSee) {
  const Evaluation evaluation = EvaluateAllBaselines(Data());
  ASSERT_THAT(evaluation.methods, SizeIs(6));
  for (const MethodResult& result : evaluation.methods) {
    EXPECT_EQ(result.macro.ap_strict, 1) << result.name;
    EXPECT_EQ(result.macro.classified, 1) << result.name;
    EXPECT_FALSE(result.has_confidence);
    EXPECT_EQ(result.has_tau, result.name == "fuzzy");
    EXPECT_THAT(result.clips, SizeIs(12));
  }
}

TEST(Baselines, TakeOfEachActorTheClipOfMedianLength) {
  const Evaluation evaluation = EvaluateAllBaselines(Data());
  for (const MethodResult& result : evaluation.methods) {
    const ClassResult& a = result.classes.front();
    EXPECT_THAT(a.by_actor, ElementsAre(Key("x"), Key("y")));
    const bool by_example = result.name == "rf" || result.name == "3d" || result.name == "q";
    if (by_example) {
      EXPECT_THAT(a.hits, ElementsAre(Key("x/ay24.amc"), Key("y/ax24.amc"))) << result.name;
      EXPECT_THAT(a.relevant, ElementsAre(Key("x/ay24.amc"), Key("y/ax24.amc"))) << result.name;
    } else {
      EXPECT_THAT(a.hits, ElementsAre(Key("x"), Key("y"))) << result.name;
    }
  }
}

double MedianOf(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

// Müller & Röder, SCA 2006, Sect. 5.5, of one example, counted plainly.
double SeparationOfExample(const EvaluationData& data, const LabelledClip& example,
                           const std::string& actor, std::span<const JudgedHit> hits) {
  std::vector<double> deltas;
  const auto add = [&](const TakeFeatures& take) {
    for (const double delta : ComputeExampleDelta(example.take.features, take.features).delta) {
      if (std::isfinite(delta)) deltas.push_back(delta);
    }
  };
  for (const LabelledClip& clip : data.clips) {
    if (clip.actor == actor) add(clip.take);
  }
  for (const TakeFeatures& take : data.distractors) add(take);
  std::vector<double> costs;
  for (std::size_t i = 0; i < hits.size() && i < 10; ++i) {
    if (hits[i].right) costs.push_back(hits[i].cost);
  }
  return MedianOf(deltas) / MedianOf(costs);
}

TEST(Separation, IsTheUsualDeltaInCostsOfRightHits) {
  EvaluationData data = Data();
  // Right hits shall cost something: what the clips of x show is interrupted.
  for (LabelledClip& clip : data.clips) {
    if (clip.actor != "x") continue;
    auto& columns = clip.take.features.columns;
    const auto middle = columns.begin() + std::ssize(columns) / 2;
    std::fill(middle - 2, middle + 2, 0b11);  // Too long to be stepped over.
  }
  const EvaluateOptions options{.baselines = {*FindBaseline("rf"), *FindBaseline("fuzzy")}};
  const Evaluation evaluation = Evaluate(data, TwoFeatures(), options);
  const ClassResult& a = evaluation.methods[0].classes.front();
  const auto example = std::ranges::find_if(
      data.clips, [](const LabelledClip& clip) { return clip.take.path == "ay24.amc"; });
  const double separation = SeparationOfExample(data, *example, "x", a.hits.at("x/ay24.amc"));
  EXPECT_TRUE(std::isfinite(separation));
  EXPECT_DOUBLE_EQ(a.by_actor.at("x").separation, separation);
  EXPECT_EQ(evaluation.methods[1].macro.separation, 0);  // Fuzzy retrieval has no Δ.
}

TEST(Baselines, NeedTheirPartsOfTakes) {
  EXPECT_FALSE(PartsFor({}).rotations);
  EXPECT_TRUE(PartsFor(std::vector{*FindBaseline("q")}).rotations);
  EXPECT_FALSE(PartsFor(std::vector{*FindBaseline("q")}).positions);
  EXPECT_TRUE(PartsFor(std::vector{*FindBaseline("3d")}).positions);
  EXPECT_EQ(FindBaseline("mt"), nullptr);
  EvaluationData data = Data();
  data.distractors.front().rotations = {};
  EvaluateOptions options{.baselines = {*FindBaseline("q")}};
  EXPECT_THROW((void)Evaluate(data, TwoFeatures(), options), Error);
}

// Figures of an independent implementation on the same clips and takes; the order is the paper's.
TEST(BaselinesOnRealClips, KeepTheirOrder) {
  KINEBASE_NEEDS_TEST_DATA();
  std::vector<fs::path> distractors;
  for (const auto& entry : fs::recursive_directory_iterator(TestData("data/cmu"))) {
    if (entry.path().extension() == ".amc") distractors.push_back(entry.path());
  }
  std::ranges::sort(distractors);
  const FeatureSet features = LoadFeatureSet("bonn");
  const EvaluateOptions options{
      .baselines = {*FindBaseline("rf"), *FindBaseline("3d"), *FindBaseline("q")}};
  const EvaluationData data =
      LoadEvaluationData({TestData("data/hdm05/clips.csv"), {}, distractors}, features, 30, {}, 0,
                         {}, PartsFor(options.baselines));
  const Evaluation evaluation = Evaluate(data, features, options);
  EXPECT_THAT(evaluation.methods[0].macro.ap_strict, DoubleNear(0.803, 0.002));
  EXPECT_THAT(evaluation.methods[1].macro.ap_strict, DoubleNear(0.759, 0.002));
  EXPECT_THAT(evaluation.methods[2].macro.ap_strict, DoubleNear(0.745, 0.002));
}

}  // namespace
}  // namespace kinebase::test
