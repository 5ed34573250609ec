#include "kinebase/search/example_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "kinebase/core/error.h"
#include "kinebase/templates/quantized_template.h"
#include "search/scans.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

using ::testing::HasSubstr;

FeatureMatrix Features(Random& random, int columns, int features) {
  return {.rate_hz = 30,
          .feature_count = features,
          .columns = RandomRecording(random, columns, features)};
}

// One joint, whose numbers the test says.
JointStream Stream(JointStreamKind kind, std::vector<float> values) {
  return {.kind = kind, .rate_hz = 30, .joint_count = 1, .values = std::move(values)};
}

JointStream RandomStream(Random& random, JointStreamKind kind, int columns) {
  JointStream stream{.kind = kind, .rate_hz = 30, .joint_count = 3};
  for (int i = 0; i < columns * stream.joint_count; ++i) {
    Eigen::Vector4d numbers;
    for (double& number : numbers) number = 2 * random.Unit() - 1;
    if (kind == JointStreamKind::kRotations) numbers.normalize();
    for (int j = 0; j < stream.numbers_per_joint(); ++j) {
      stream.values.push_back(static_cast<float>(numbers[j]));
    }
  }
  return stream;
}

// The cheapest of all paths to (k, l), every step counting once.
template <typename Cost>
double CheapestPath(const Cost& cost, int k, int l) {
  if (k < 0 || l < 0) return std::numeric_limits<double>::infinity();
  if (k == 0) return cost(0, l);
  return cost(k, l) + std::min({CheapestPath(cost, k - 1, l - 1), CheapestPath(cost, k - 1, l - 2),
                                CheapestPath(cost, k - 2, l - 1)});
}

template <typename Cost>
void AssertCheapestPaths(const DeltaCurve& curve, int rows, const Cost& cost, double tolerance) {
  for (int l = 0; l < std::ssize(curve.delta); ++l) {
    const double expected = CheapestPath(cost, rows - 1, l) / rows;
    const double actual = curve.delta[static_cast<std::size_t>(l)];
    RC_ASSERT(actual == expected || std::abs(actual - expected) < tolerance);
  }
}

// An example is a template that leaves nothing free, so the two ways must agree to the last bit.
RC_GTEST_PROP(ExampleOfFeatures, IsFoundAsATemplateOfOneClipIs, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const int features = 1 + random.Below(64);
  const FeatureMatrix example = Features(random, 1 + random.Below(30), features);
  const std::vector<FeatureMatrix> recordings = {Features(random, random.Below(200), features),
                                                 Features(random, 150, features)};
  for (const Profile matching : {Profile::kBonn, Profile::kPaper}) {
    const QuantizedTemplate quantized = Quantize(ToTemplateMatrix(example), 0, matching);
    const DeltaCurve curve = ComputeExampleDelta(example, recordings[0], matching);
    const DeltaCurve expected = ComputeDelta(quantized, recordings[0].columns);
    RC_ASSERT(curve.delta == expected.delta);
    RC_ASSERT(curve.start == expected.start);
    const SearchOptions options{.tau = 0.4, .threads = 2};
    RC_ASSERT(SearchExample(example, recordings, options, matching) ==
              SearchTemplate(quantized, recordings, options));
  }
}

RC_GTEST_PROP(ExampleOfPoses, CostsTheCheapestPath, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  for (const auto kind : {JointStreamKind::kRotations, JointStreamKind::kPositions}) {
    const JointStream example = RandomStream(random, kind, 1 + random.Below(6));
    const JointStream recording = RandomStream(random, kind, random.Below(10));
    const auto cost = [&](int k, int l) {
      double sum = 0;
      for (int joint = 0; joint < 3; ++joint) {
        if (kind == JointStreamKind::kRotations) {
          const auto quaternion = [&](const JointStream& stream, int column) {
            const auto q = stream.Column(column).subspan(static_cast<std::size_t>(joint) * 4, 4);
            return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
          };
          // Half the angle between the rotations, a quarter turn and more being 1.
          sum +=
              quaternion(example, k).angularDistance(quaternion(recording, l)) / std::numbers::pi;
        } else {
          double squares = 0;
          for (std::size_t i = 3 * joint; i < 3 * joint + 3U; ++i) {
            squares += std::pow(example.Column(k)[i] - recording.Column(l)[i], 2);
          }
          sum += std::sqrt(squares);
        }
      }
      return sum / 3;
    };
    // acos near 1 makes 3e-4 of a float's last bit.
    AssertCheapestPaths(ComputeExampleDelta(example, recording, Profile::kPaper),
                        example.column_count(), cost, 1e-3);
  }
}

// A quarter turn is half of the farthest that rotations can be apart; q and −q are the same.
TEST(ExampleOfPoses, MeasuresRotationsByTheirAngle) {
  const float s = std::sqrt(0.5F);
  const JointStream still = Stream(JointStreamKind::kRotations, {1, 0, 0, 0});
  const JointStream turned =
      Stream(JointStreamKind::kRotations, {1, 0, 0, 0, -1, 0, 0, 0, s, s, 0, 0, 0, 0, 0, 1});
  const std::vector<double> delta = ComputeExampleDelta(still, turned).delta;
  const std::vector<double> expected = {0, 0, 0.5, 1};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(delta[i], expected[i], 1e-6);
}

TEST(ExampleOfPoses, MeasuresPlacesByTheirDistance) {
  const JointStream example = Stream(JointStreamKind::kPositions, {0, 0, 0});
  const JointStream recording = Stream(JointStreamKind::kPositions, {0, 3, 4, 0, 0, -2});
  EXPECT_EQ(ComputeExampleDelta(example, recording).delta, (std::vector<double>{5, 2}));
}

RC_GTEST_PROP(UnquantizedTemplate, CostsTheCheapestPathOfAllItsValues, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const int features = 1 + random.Below(64);
  const TemplateMatrix matrix = RandomMatrix(random, 1 + random.Below(6), features);
  const FeatureMatrix recording = Features(random, random.Below(10), features);
  const auto cost = [&](int k, int l) {
    double sum = 0;
    for (int i = 0; i < features; ++i) {
      const double value = matrix.Column(k)[static_cast<std::size_t>(i)];
      sum += std::abs(value - (recording.at(l, i) ? 1 : 0));
    }
    return sum / features;
  };
  AssertCheapestPaths(ComputeUnquantizedDelta(matrix, recording, Profile::kPaper),
                      matrix.column_count(), cost, 1e-12);
}

// One column of weight 3 costs (3 + 1) / 2 times as much in profile bonn.
TEST(UnquantizedTemplate, WeighsItsColumnsAsAQuantisedOneDoes) {
  const TemplateMatrix matrix = MakeMatrix({{0.25, 0.5}}, {3});
  const FeatureMatrix recording{.rate_hz = 30, .feature_count = 2, .columns = {0b00, 0b01}};
  EXPECT_EQ(ComputeUnquantizedDelta(matrix, recording).delta, (std::vector<double>{0.75, 1.25}));
  EXPECT_EQ(ComputeUnquantizedDelta(matrix, recording, Profile::kPaper).delta,
            (std::vector<double>{0.375, 0.625}));
}

TEST(UnquantizedTemplate, OfOneClipIsThatClip) {
  Random random(61);
  const FeatureMatrix example = Features(random, 20, 39);
  const std::vector<FeatureMatrix> recordings = {Features(random, 300, 39)};
  const DeltaCurve curve = ComputeUnquantizedDelta(ToTemplateMatrix(example), recordings[0]);
  const DeltaCurve expected = ComputeExampleDelta(example, recordings[0]);
  for (std::size_t l = 0; l < expected.delta.size(); ++l) {
    if (std::isinf(expected.delta[l])) continue;
    ASSERT_NEAR(curve.delta[l], expected.delta[l], 1e-12);
  }
  EXPECT_FALSE(SearchUnquantized(ToTemplateMatrix(example), recordings, {.tau = 0.5}).empty());
}

TEST(ExampleSearch, GivesTheHitsOfEachCurveOnAnyNumberOfThreads) {
  Random random(62);
  const JointStream example = RandomStream(random, JointStreamKind::kPositions, 8);
  std::vector<JointStream> recordings;
  for (const int columns : {200, 0, 60, 3}) {
    recordings.push_back(RandomStream(random, JointStreamKind::kPositions, columns));
  }
  std::vector<Hit> expected;
  for (int i = 0; i < std::ssize(recordings); ++i) {
    const DeltaCurve curve = ComputeExampleDelta(example, recordings[static_cast<std::size_t>(i)]);
    for (const Hit& hit : ExtractHits(curve, 2, i)) expected.push_back(hit);
  }
  expected = BestHits(expected, 12);
  ASSERT_EQ(expected.size(), 12U);
  for (const int threads : {1, 3}) {
    EXPECT_EQ(SearchExample(example, recordings, {.tau = 2, .most_hits = 12, .threads = threads}),
              expected);
  }
}

TEST(ExampleSearch, RefusesWhatCannotBeCompared) {
  Random random(63);
  const auto expect = [](ErrorCode code, const char* text, auto search) {
    const Error error = ErrorOf(search);
    EXPECT_EQ(error.code(), code);
    EXPECT_THAT(error.what(), HasSubstr(text));
  };
  const JointStream positions = RandomStream(random, JointStreamKind::kPositions, 5);
  const JointStream rotations = RandomStream(random, JointStreamKind::kRotations, 5);
  expect(ErrorCode::kMismatch,
         "rotations of 3 joints and 30 columns a second, the example positions", [&] {
           (void)SearchExample(positions, std::vector{positions, rotations});
         });
  const FeatureMatrix example = Features(random, 5, 39);
  FeatureMatrix other = Features(random, 5, 38);
  expect(ErrorCode::kMismatch, "38 features",
         [&] { (void)SearchExample(example, std::vector{other}); });
  expect(ErrorCode::kMismatch, "38 features",
         [&] { (void)SearchUnquantized(ToTemplateMatrix(example), std::vector{other}); });
  other = example;
  other.rate_hz = 60;
  expect(ErrorCode::kMismatch, "60 columns a second",
         [&] { (void)ComputeExampleDelta(example, other); });
  expect(ErrorCode::kInvalidArgument, "at least one column", [&] {
    (void)ComputeExampleDelta(FeatureMatrix{.rate_hz = 30, .feature_count = 39}, example);
  });
  TemplateMatrix bad = ToTemplateMatrix(example);
  bad.values[0] = 2;
  expect(ErrorCode::kInvalidArgument, "value 2 of feature 1",
         [&] { (void)SearchUnquantized(bad, std::vector{example}); });
  expect(ErrorCode::kInvalidArgument, "threshold tau",
         [&] { (void)SearchExample(example, std::vector{example}, {.tau = -1}); });
}

}  // namespace
}  // namespace kinebase::test
