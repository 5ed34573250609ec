// Templates that were drawn or compiled, searched for: the edges of what can be asked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "kinebase/core/error.h"
#include "kinebase/search/template_search.h"
#include "kinebase/templates/quantized_template.h"
#include "kinebase/templates/query.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Columns at 30 Hz with the same features in each: "F3" is bit 2.
FeatureMatrix Stream(const std::vector<std::pair<std::uint64_t, int>>& stretches) {
  FeatureMatrix stream{.rate_hz = 30, .feature_count = 39};
  for (const auto& [word, columns] : stretches) {
    stream.columns.insert(stream.columns.end(), static_cast<std::size_t>(columns), word);
  }
  return stream;
}

constexpr std::uint64_t Bit(int feature) { return std::uint64_t{1} << (feature - 1); }

QuantizedTemplate Compiled(const std::string& query) {
  const MotionTemplate compiled = CompileQuery(query, LoadFeatureSet("bonn")).templates[0];
  return Quantize(compiled.matrix, compiled.quantisation, compiled.matching);
}

std::vector<Hit> Search(const QuantizedTemplate& wanted, const FeatureMatrix& stream,
                        double tau = 0) {
  return SearchTemplate(wanted, {&stream, 1}, {.tau = tau});
}

// One stretch of brushing among others that lack one of the three features each.
TEST(CompiledQuery, FindsThePapersSweepingWithAHandBrush) {
  const std::uint64_t brushing = Bit(13) | Bit(32) | Bit(33);
  const FeatureMatrix stream = Stream({{0, 60},
                                       {Bit(13) | Bit(32), 60},
                                       {Bit(32) | Bit(33), 60},
                                       {brushing | Bit(39), 60},
                                       {Bit(13) | Bit(33), 60}});
  const auto hits =
      Search(Compiled("rhand fast & spine horizontal & rhand lowered for 50 columns"), stream);
  ASSERT_EQ(hits.size(), 1U);
  EXPECT_EQ(hits[0].cost, 0);
  EXPECT_GE(hits[0].first, 180);
  EXPECT_LT(hits[0].last, 240);
}

TEST(CompiledQuery, FindsPhasesInTheirOrderOnly) {
  const QuantizedTemplate wanted = Compiled("F3 & not F4 for 0.3s then F4 & not F3 for 0.3s");
  EXPECT_EQ(Search(wanted, Stream({{0, 20}, {Bit(3), 9}, {Bit(4), 9}, {0, 20}})).size(), 1U);
  EXPECT_THAT(Search(wanted, Stream({{0, 20}, {Bit(4), 9}, {Bit(3), 9}, {0, 20}})), IsEmpty());
}

// A phase of n columns fits from half to twice as many.
TEST(CompiledQuery, FitsFromHalfToTwiceItsDuration) {
  const QuantizedTemplate wanted = Compiled(
      "not F3 for 5 columns then F3 for 20 columns then "
      "not F3 for 5 columns");
  for (int columns = 1; columns <= 60; ++columns) {
    const auto hits = Search(wanted, Stream({{0, 20}, {Bit(3), columns}, {0, 20}}));
    // At the limits the neighbours' first and last columns decide.
    if (std::abs(columns - 10) <= 1 || std::abs(columns - 40) <= 1) continue;
    EXPECT_EQ(hits.size(), columns > 10 && columns < 40 ? 1U : 0U) << columns;
  }
}

// "within 1s": from almost at once to a second later.
TEST(CompiledQuery, BridgesGapsUpToTheDurationThatWithinSays) {
  const QuantizedTemplate wanted = Compiled(
      "F3 & not F4 for 0.2s then within 1s F4 & not F3 for "
      "0.2s");
  const auto hits = [&](int gap) {
    return Search(wanted, Stream({{0, 20}, {Bit(3), 6}, {0, gap}, {Bit(4), 6}, {0, 20}})).size();
  };
  for (const int gap : {4, 8, 15, 25, 30}) EXPECT_EQ(hits(gap), 1U) << gap;
  for (const int gap : {39, 50}) EXPECT_EQ(hits(gap), 0U) << gap;
}

TEST(TemplateOfAny, FitsEverywhereAtNoCost) {
  const MotionTemplate blank = BlankTemplate("blank", LoadFeatureSet("bonn"), 10);
  for (const Profile matching : {Profile::kBonn, Profile::kPaper}) {
    const QuantizedTemplate wanted = Quantize(blank.matrix, blank.quantisation, matching);
    const FeatureMatrix stream = Stream({{Bit(1), 20}, {Bit(2), 20}});
    const DeltaCurve curve = ComputeDelta(wanted, stream.columns);
    // No path of ten columns ends before the fifth column of the stream.
    const std::vector<double> reached(curve.delta.begin() + 5, curve.delta.end());
    EXPECT_THAT(reached, Each(0.0));
    EXPECT_FALSE(Search(wanted, stream).empty());
  }
}

TEST(TemplateOfOneColumn, FitsSingleColumns) {
  const FeatureMatrix stream = Stream({{0, 3}, {Bit(3), 1}, {0, 3}, {Bit(3), 1}});
  EXPECT_THAT(Search(Compiled("F3 for 1 column"), stream),
              ElementsAre(Hit{0, 3, 3, 0}, Hit{0, 7, 7, 0}));
}

TEST(TemplateLongerThanTwiceTheStream, HasNoHits) {
  const QuantizedTemplate wanted = Compiled("F3 for 10s");
  EXPECT_THAT(Search(wanted, Stream({{Bit(3), 149}}), 1), IsEmpty());
  EXPECT_EQ(Search(wanted, Stream({{Bit(3), 160}}), 1).size(), 1U);
}

TEST(TemplateOfAnotherFeatureSet, IsNotSearchedFor) {
  FeatureMatrix stream = Stream({{Bit(3), 20}});
  stream.feature_count = 5;
  EXPECT_EQ(ErrorOf([&] { (void)Search(Compiled("F3"), stream); }).code(), ErrorCode::kMismatch);
}

}  // namespace
}  // namespace kinebase::test
