// Templates made by hand and put together.
#include "kinebase/templates/editing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "kinebase/core/error.h"
#include "kinebase/features/vocabulary.h"
#include "kinebase/templates/quantized_template.h"
#include "support/files.h"
#include "support/test_data.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A learned template with a threshold, of made-up rows.
MotionTemplate TemplateOf(TemplateMatrix matrix, const std::string& name = "wave") {
  MotionTemplate result;
  result.name = name;
  result.feature_set = "made up";
  result.feature_set_hash = 7;
  result.matrix = std::move(matrix);
  result.clips = {{name + ".amc", 0, 0}};
  result.rounds = 3;
  result.tau = 0.04;
  result.tau_origin = "training";
  result.contrast = Contrast{};
  result.calibration = Calibration{.slope = 30, .offset = -4};
  return result;
}

const MotionTemplate kThreeColumns =
    TemplateOf(MakeMatrix({{0, 1, 0.5}, {1, 1, 0.25}, {0, 0, 1}}, {1, 0.75, 1.5}));

void ExpectChanged(const MotionTemplate& changed, const std::string& origin) {
  EXPECT_EQ(changed.tau, std::nullopt);
  EXPECT_EQ(changed.tau_origin, "");
  EXPECT_FALSE(changed.contrast || changed.calibration);
  EXPECT_EQ(changed.clips, kThreeColumns.clips);
  EXPECT_EQ(changed.name, kThreeColumns.name);
  EXPECT_EQ(changed.origin, origin);
}

void ExpectRefused(const std::function<void()>& action, const std::string& part) {
  const Error error = ErrorOf(action);
  EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(error.what(), HasSubstr(part));
}

// The paper's "sweeping with a hand brush": 50 columns, three rows one, all else free.
TEST(Drawing, MakesThePapersTemplate) {
  const FeatureSet features = LoadFeatureSet("bonn");
  MotionTemplate brush = BlankTemplate("brush", features, 50);
  brush = WithEntries(brush, FindFeatures(features, "F13,F32,F33"), {0, 49}, 1);
  EXPECT_EQ(brush.matrix.column_count(), 50);
  EXPECT_EQ(brush.matrix.rate_hz, 30);
  EXPECT_EQ(brush.feature_set_hash, features.hash);
  const QuantizedTemplate quantized = Quantize(brush.matrix, brush.quantisation, brush.matching);
  constexpr std::uint64_t kRows = 1ULL << 12U | 1ULL << 31U | 1ULL << 32U;
  for (const QuantizedColumn& column : quantized.columns) {
    EXPECT_EQ(column.consistent, kRows);
    EXPECT_EQ(column.ones, kRows);
    EXPECT_EQ(column.scale, 1.0 / 3);
  }
}

TEST(Drawing, BeginsWithNothingAskedWhateverTheQuantisation) {
  const MotionTemplate blank = BlankTemplate("blank", LoadFeatureSet("bonn"), 1, 120);
  EXPECT_THAT(blank.matrix.values, Each(kAnyValue));
  for (const double delta : {0.0, 0.1, 0.49}) {
    EXPECT_EQ(Quantize(blank.matrix, delta, Profile::kBonn).columns[0].consistent, 0U);
  }
}

TEST(Drawing, RefusesLengthsAndRatesThatMakeNoSense) {
  const FeatureSet features = LoadFeatureSet("bonn");
  for (const int columns : {0, -1, kMostTemplateColumns + 1}) {
    ExpectRefused([&] { (void)BlankTemplate("a", features, columns); }, "expected 1 to 100000");
  }
  ExpectRefused([&] { (void)BlankTemplate("a", features, 5, 50); }, "50");
}

TEST(Entries, ChangeInTheirRowsAndColumnsOnly) {
  const std::vector<int> rows = {0, 2};
  const MotionTemplate changed = WithEntries(kThreeColumns, rows, {1, 2}, 0.75);
  EXPECT_EQ(changed.matrix,
            MakeMatrix({{0, 1, 0.5}, {0.75, 1, 0.75}, {0.75, 0, 0.75}}, {1, 0.75, 1.5}));
  ExpectChanged(changed, "2 of 3 rows set to 0.75 in columns 1 to 2");
}

TEST(Entries, OutsideAreRefused) {
  const auto set = [](std::vector<int> rows, ColumnRange columns, double value) {
    (void)WithEntries(kThreeColumns, rows, columns, value);
  };
  ExpectRefused([&] { set({3}, {0, 0}, 1); }, "row 3 of template 'wave'; it has rows 0 to 2");
  ExpectRefused([&] { set({-1}, {0, 0}, 1); }, "row -1");
  ExpectRefused([&] { set({0}, {0, 3}, 1); }, "columns 0 to 3 of template 'wave'");
  ExpectRefused([&] { set({0}, {-1, 2}, 1); }, "columns -1 to 2");
  ExpectRefused([&] { set({0}, {2, 1}, 1); }, "columns 2 to 1");
  ExpectRefused([&] { set({0}, {0, 0}, 1.5); }, "value 1.5");
  ExpectRefused([&] { set({0}, {0, 0}, std::numeric_limits<double>::quiet_NaN()); }, "value nan");
}

TEST(Restricting, FreesAllOtherFeatures) {
  const std::vector<int> rows = {1};
  const MotionTemplate changed = RestrictToFeatures(kThreeColumns, rows);
  EXPECT_EQ(changed.matrix,
            MakeMatrix({{0.5, 1, 0.5}, {0.5, 1, 0.5}, {0.5, 0, 0.5}}, {1, 0.75, 1.5}));
  ExpectChanged(changed, "restricted to 1 of 3 rows");
  EXPECT_THAT(RestrictToFeatures(kThreeColumns, {}).matrix.values, Each(kAnyValue));
  const std::vector<int> outside = {3};
  ExpectRefused([&] { (void)RestrictToFeatures(kThreeColumns, outside); }, "row 3");
}

TEST(Cutting, KeepsColumnsWithTheirWeights) {
  const MotionTemplate changed = CutTemplate(kThreeColumns, {1, 2});
  EXPECT_EQ(changed.matrix, MakeMatrix({{1, 1, 0.25}, {0, 0, 1}}, {0.75, 1.5}));
  ExpectChanged(changed, "cut to columns 1 to 2");
  EXPECT_EQ(CutTemplate(kThreeColumns, {2, 2}).matrix.column_count(), 1);
  ExpectRefused([] { (void)CutTemplate(kThreeColumns, {1, 3}); }, "columns 1 to 3");
}

// Time 0 to 1, 1 to 1.75 and 1.75 to 3.25 becomes 0 to 1.625 and 1.625 to 3.25.
TEST(Stretching, AveragesWhatFallsIntoAColumn) {
  const MotionTemplate changed = StretchTemplate(kThreeColumns, 2);
  const double first = 0.625 / 1.625;
  const double second = 0.125 / 1.625;
  ExpectNear(changed.matrix,
             MakeMatrix({{first, 1, 0.5 * (1 - first) + 0.25 * first},
                         {second, second, 0.25 * second + 1 - second}}),
             1e-15);
  ExpectChanged(changed, "stretched to 2 columns");
  ExpectRefused([] { (void)StretchTemplate(kThreeColumns, 0); }, "expected 1 to");
}

RC_GTEST_PROP(Stretching, RepeatsColumnsWhereTheLengthIsAMultiple, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  TemplateMatrix matrix = RandomMatrix(random, 1 + random.Below(20), 1 + random.Below(10));
  matrix.weights.assign(matrix.weights.size(), 1.0);
  const int times = 1 + random.Below(4);
  const auto stretched = StretchTemplate(TemplateOf(matrix), times * matrix.column_count()).matrix;
  for (int c = 0; c < stretched.column_count(); ++c) {
    for (int row = 0; row < matrix.feature_count; ++row) {
      RC_ASSERT(std::abs(stretched.Column(c)[row] - matrix.Column(c / times)[row]) < 1e-9);
    }
  }
}

RC_GTEST_PROP(Stretching, KeepsTheMeanOverTime, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const TemplateMatrix matrix = RandomMatrix(random, 1 + random.Below(40), 3);
  const auto stretched = StretchTemplate(TemplateOf(matrix), 1 + random.Below(90)).matrix;
  const auto mean = [](const TemplateMatrix& of, int row) {
    double sum = 0;
    for (int c = 0; c < of.column_count(); ++c) sum += of.Column(c)[row] * of.weights[c];
    return sum / of.total_weight();
  };
  for (int row = 0; row < 3; ++row) {
    RC_ASSERT(std::abs(mean(matrix, row) - mean(stretched, row)) < 1e-9);
  }
  for (const double value : stretched.values) RC_ASSERT(value >= 0 && value <= 1);
}

TEST(Extending, PutsFreeColumnsAround) {
  const MotionTemplate changed = ExtendTemplate(CutTemplate(kThreeColumns, {2, 2}), 1, 2);
  const std::vector<double> any(3, 0.5);
  EXPECT_EQ(changed.matrix, MakeMatrix({any, {0, 0, 1}, any, any}, {1, 1.5, 1, 1}));
  ExpectChanged(changed, "cut to columns 2 to 2; extended by 1 and 2 columns");
  ExpectRefused([] { (void)ExtendTemplate(kThreeColumns, -1, 0); }, "-1 columns before");
  constexpr int kHuge = std::numeric_limits<int>::max();
  ExpectRefused([] { (void)ExtendTemplate(kThreeColumns, kHuge, kHuge); }, "expected 1 to 100000");
}

TEST(Concatenating, PutsOneAfterTheOther) {
  MotionTemplate kick = TemplateOf(MakeMatrix({{1, 1, 1}}), "kick");
  kick.rounds = 5;
  const std::vector<MotionTemplate> both = {CutTemplate(kThreeColumns, {0, 0}), kick};
  const MotionTemplate result = ConcatenateTemplates(both, 1);
  EXPECT_EQ(result.matrix, MakeMatrix({{0, 1, 0.5}, {0.5, 0.5, 0.5}, {1, 1, 1}}));
  EXPECT_EQ(result.name, "wave + kick");
  EXPECT_EQ(result.origin, "one after the other: 'wave', 'kick'");
  EXPECT_THAT(result.clips,
              ElementsAre(TemplateClip{"wave.amc", 0, 0}, TemplateClip{"kick.amc", 0, 0}));
  EXPECT_EQ(result.rounds, 5);
  EXPECT_EQ(result.tau, std::nullopt);
}

RC_GTEST_PROP(Concatenating, OfThePartsGivesTheWhole, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const int columns = 2 + random.Below(30);
  const MotionTemplate whole = TemplateOf(RandomMatrix(random, columns, 5));
  const int border = 1 + random.Below(columns - 1);
  const std::vector<MotionTemplate> parts = {CutTemplate(whole, {0, border - 1}),
                                             CutTemplate(whole, {border, columns - 1})};
  RC_ASSERT(ConcatenateTemplates(parts).matrix == whole.matrix);
}

TEST(PuttingTogether, TakesTemplatesOfOneSetAndRateOnly) {
  MotionTemplate other_set = kThreeColumns;
  other_set.name = "other";
  other_set.feature_set_hash = 8;
  MotionTemplate other_rate = kThreeColumns;
  other_rate.matrix.rate_hz = 60;
  for (const auto& [second, part] :
       {std::pair{other_set, "'wave' was made with feature set 'made up' (0000000000000007)"},
        std::pair{other_rate, "only templates of one rate"}}) {
    const std::vector<MotionTemplate> both = {kThreeColumns, second};
    for (const auto& action : std::vector<std::function<void()>>{
             [&] { (void)ConcatenateTemplates(both); }, [&] { (void)CombineTemplates(both); }}) {
      const Error error = ErrorOf(action);
      EXPECT_EQ(error.code(), ErrorCode::kMismatch);
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  }
  ExpectRefused([] { (void)ConcatenateTemplates({}); }, "at least one");
  ExpectRefused([] { (void)CombineTemplates({}); }, "at least one");
  ExpectRefused([] { (void)ConcatenateTemplates({&kThreeColumns, 1}, -1); }, "a gap of -1");
}

// Templates of one clip each are what learning begins with.
TEST(Combining, GivesTheGoldenTemplateOfItsClips) {
  KINEBASE_NEEDS_TEST_DATA();
  std::vector<MotionTemplate> clips;
  for (const char* actor : {"bd", "bk", "dg", "mm", "tr"}) {
    const std::string file = std::string("golden/learning/elbow_input_") + actor + ".csv";
    clips.push_back(TemplateOf(ReadMatrix(TestData(file)), actor));
  }
  const MotionTemplate combined = CombineTemplates(clips);
  ExpectNear(combined.matrix, ReadMatrix(TestData("golden/learning/elbow_template.csv")), 1e-12);
  EXPECT_EQ(combined.name, "bd + bk + dg + mm + tr");
  EXPECT_EQ(combined.origin, "combined from 'bd', 'bk', 'dg', 'mm', 'tr'");
  EXPECT_EQ(combined.clips.size(), 5U);
  EXPECT_EQ(combined.tau, std::nullopt);
}

TEST(Combining, KeepsWhatAllAgreeInAndFreesTheRest) {
  const std::vector<MotionTemplate> two = {
      TemplateOf(MakeMatrix({{1, 0, 0}, {0, 1, 0}, {0, 1, 0}}), "left"),
      TemplateOf(MakeMatrix({{1, 0, 1}, {0, 1, 1}, {0, 1, 1}}), "right")};
  EXPECT_EQ(CombineTemplates(two).matrix, MakeMatrix({{1, 0, 0.5}, {0, 1, 0.5}, {0, 1, 0.5}}));
}

TEST(Durations, AreRoundedToColumnsOfWhichThereIsOneAtLeast) {
  EXPECT_EQ(ColumnsOfDuration(1.67, 30), 50);
  EXPECT_EQ(ColumnsOfDuration(0.3, 30), 9);
  EXPECT_EQ(ColumnsOfDuration(1e-9, 30), 1);
  for (const double bad : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    ExpectRefused([&] { (void)ColumnsOfDuration(bad, 30); }, "expected more than 0");
  }
}

// Columns last 1, 0.75 and 1.5 thirtieths of a second; their middles are at 0.5, 1.375 and 2.5.
TEST(SpansOfTime, AreColumnsWhoseMiddleTheyHold) {
  const TemplateMatrix& matrix = kThreeColumns.matrix;
  EXPECT_EQ(ColumnsBetween(matrix, 0, 1), (ColumnRange{0, 2}));
  EXPECT_EQ(ColumnsBetween(matrix, 0, 1.4 / 30), (ColumnRange{0, 1}));
  EXPECT_EQ(ColumnsBetween(matrix, 0.6 / 30, 2.4 / 30), (ColumnRange{1, 1}));
  ExpectRefused([&] { (void)ColumnsBetween(matrix, 2, 3); }, "lasts 0.11 s");
}

}  // namespace
}  // namespace kinebase::test
