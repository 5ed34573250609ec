// Three searches in one take of the authors' own features.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kinebase/search/hits.h"
#include "kinebase/search/subsequence_dtw.h"
#include "kinebase/search/template_search.h"
#include "support/test_data.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

FeatureMatrix TakeFeatures() {
  const TemplateMatrix matrix = ReadMatrix(TestData("golden/search/take_features.csv"));
  FeatureMatrix features{.rate_hz = 30, .feature_count = 39, .columns = {}};
  for (int c = 0; c < matrix.column_count(); ++c) {
    std::uint64_t word = 0;
    for (int f = 0; f < 39; ++f) {
      if (matrix.Column(c)[f] != 0) word |= std::uint64_t{1} << f;
    }
    features.columns.push_back(word);
  }
  return features;
}

TemplateMatrix GoldenTemplate(const std::string& name) {
  return ReadMatrix(TestData("golden/search/search_" + name + "_template.csv"));
}

// Rows of left and right exchanged, as the mirror table of the features says.
TemplateMatrix ExchangeSides(const TemplateMatrix& matrix) {
  constexpr int kRows[] = {2,  1,  4,  3,  6,  5,  8,  7,  9,  10, 12, 11, 14,
                           13, 16, 15, 18, 17, 19, 21, 20, 22, 23, 24, 26, 25,
                           28, 27, 30, 29, 31, 32, 34, 33, 36, 35, 37, 38, 39};
  TemplateMatrix exchanged = matrix;
  for (std::size_t i = 0; i < matrix.values.size(); ++i) {
    exchanged.values[i] = matrix.values[i - i % 39 + kRows[i % 39] - 1];
  }
  return exchanged;
}

struct GoldenSearchCase {
  std::string name;
  bool mirrored = false;

  [[nodiscard]] std::string full_name() const { return name + (mirrored ? "_mirrored" : ""); }
  [[nodiscard]] QuantizedTemplate Template() const {
    const TemplateMatrix matrix = GoldenTemplate(name);
    return Quantize(mirrored ? ExchangeSides(matrix) : matrix, 0.1, Profile::kBonn);
  }
  [[nodiscard]] nlohmann::json Hits() const {
    return nlohmann::json::parse(ReadText(TestData("golden/search/search_hits.json")))
        .at(full_name());
  }
};

// For messages of the test framework.
void PrintTo(const GoldenSearchCase& golden, std::ostream* out) { *out << golden.full_name(); }

class GoldenSearch : public ::testing::TestWithParam<GoldenSearchCase> {};

TEST_P(GoldenSearch, GivesTheSameCurveAndStarts) {
  KINEBASE_NEEDS_TEST_DATA();
  const FeatureMatrix take = TakeFeatures();
  const CsvTable golden =
      ReadCsv(TestData("golden/search/search_" + GetParam().full_name() + "_delta.csv"));
  const std::size_t delta = golden.Column("delta");
  const std::size_t start = golden.Column("start");
  ASSERT_EQ(golden.rows.size(), take.columns.size());
  for (const DeltaCurve& curve : {ComputeDeltaReference(GetParam().Template(), take.columns),
                                  ComputeDelta(GetParam().Template(), take.columns)}) {
    for (std::size_t l = 0; l < take.columns.size(); ++l) {
      const double expected = NumberIn(golden, l, delta);
      if (std::isinf(expected)) {
        EXPECT_EQ(curve.delta[l], expected) << "column " << l;
      } else {
        EXPECT_NEAR(curve.delta[l], expected, 1e-9) << "column " << l;
      }
      EXPECT_EQ(curve.start[l], NumberIn(golden, l, start)) << "column " << l;
    }
  }
}

TEST_P(GoldenSearch, FindsTheSameHitsInTheSameOrder) {
  KINEBASE_NEEDS_TEST_DATA();
  const FeatureMatrix take = TakeFeatures();
  const nlohmann::json golden = GetParam().Hits();
  EXPECT_EQ(GetParam().Template().column_count(), golden.at("K").get<int>());
  const std::vector<Hit> hits = SearchTemplate(GetParam().Template(), {&take, 1}, {.tau = 0.175});
  ASSERT_EQ(hits.size(), golden.at("hits").size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const nlohmann::json& expected = golden.at("hits").at(i);
    EXPECT_EQ(hits[i].first, expected.at("first").get<int>()) << "hit " << i;
    EXPECT_EQ(hits[i].last, expected.at("last").get<int>()) << "hit " << i;
    EXPECT_NEAR(hits[i].cost, expected.at("cost").get<double>(), 1e-9) << "hit " << i;
  }
}

TEST_P(GoldenSearch, WarpsTheBestFourHitsAlongTheSamePaths) {
  KINEBASE_NEEDS_TEST_DATA();
  const FeatureMatrix take = TakeFeatures();
  const QuantizedTemplate motion_template = GetParam().Template();
  const nlohmann::json golden = GetParam().Hits();
  int paths = 0;
  for (const nlohmann::json& hit : golden.at("hits")) {
    if (hit.at("path").is_null()) continue;
    std::vector<std::vector<int>> path;
    for (const PathCell& cell :
         TracePath(motion_template, take.columns, hit.at("last").get<int>())) {
      path.push_back({cell.template_column, cell.recording_column});
    }
    EXPECT_EQ(path, hit.at("path").get<std::vector<std::vector<int>>>());
    ++paths;
  }
  EXPECT_EQ(paths, 4);
}

INSTANTIATE_TEST_SUITE_P(Take, GoldenSearch,
                         ::testing::Values(GoldenSearchCase{"squat"},
                                           GoldenSearchCase{"elbow_left"},
                                           GoldenSearchCase{"elbow_left", true}),
                         [](const auto& golden) { return golden.param.full_name(); });

// Where people saw the motions in this take, to half a second.
TEST(GoldenSearchTruth, FindsTheFourSquatsFirst) {
  KINEBASE_NEEDS_TEST_DATA();
  const FeatureMatrix take = TakeFeatures();
  std::vector<Hit> hits =
      SearchTemplate(GoldenSearchCase{"squat"}.Template(), {&take, 1}, {.tau = 0.1});
  ASSERT_EQ(hits.size(), 4U);
  std::ranges::sort(hits, {}, &Hit::first);
  constexpr std::pair<int, int> kSquats[] = {{805, 851}, {852, 902}, {903, 953}, {954, 1005}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(hits[i].first, kSquats[i].first, 15);
    EXPECT_NEAR(hits[i].last, kSquats[i].second, 15);
  }
}

}  // namespace
}  // namespace kinebase::test
