#include "kinebase/library/source_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <tuple>
#include <vector>

#include "kinebase/templates/quantized_template.h"
#include "library/two_sets_of_takes.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using test::TwoSetsOfTakes;
using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr double kTau = 0.3;

class SourceSearch : public testing::Test {
 protected:
  // What, where, for how much: a hit as it is compared.
  using Found = std::tuple<fs::path, std::int64_t, std::int64_t, double>;

  static std::vector<Found> Of(const SourceHits& all, std::size_t query) {
    std::vector<Found> found;
    found.reserve(all.hits.size());
    for (const auto& [which, file, hit] : all.hits) {
      if (which == query) found.emplace_back(file, hit.first_frame, hit.last_frame, hit.cost);
    }
    std::ranges::sort(found);
    return found;
  }

  // The same over the files of those takes that have the features.
  [[nodiscard]] std::vector<Found> OverFiles(const FeatureSet& features, std::size_t first,
                                             std::size_t last) const {
    const std::vector<TakeFeatures> takes = sets_.Read(features, first, last);
    std::vector<Found> found;
    for (const TakeHit& hit :
         SearchTakes(Quantize(sets_.Template(features, kTau)), takes, {.tau = kTau})) {
      found.emplace_back(takes[hit.take].path, hit.first_frame, hit.last_frame, hit.cost);
    }
    std::ranges::sort(found);
    return found;
  }

  TwoSetsOfTakes sets_;
  std::vector<SearchQuery> queries_ = {
      {.motion_template = sets_.Template(sets_.paper(), kTau), .features = sets_.paper()},
      {.motion_template = sets_.Template(sets_.bonn(), kTau), .features = sets_.bonn()}};
};

TEST_F(SourceSearch, FindsWithEachSetWhatItsTakesShowAndNamesTheOthers) {
  for (const std::int64_t memory_bytes : {std::int64_t{1}, kDefaultMemoryBytes}) {
    SCOPED_TRACE(memory_bytes);
    const SourceHits found = SearchSource({sets_.library(), {}, memory_bytes}, queries_);
    EXPECT_THAT(Of(found, 0), Not(IsEmpty()));
    EXPECT_THAT(Of(found, 1), Not(IsEmpty()));
    EXPECT_EQ(Of(found, 0), OverFiles(sets_.paper(), 2, 5));
    EXPECT_EQ(Of(found, 1), OverFiles(sets_.bonn(), 0, 3));
    EXPECT_TRUE(std::ranges::is_sorted(found.hits, {},
                                       [](const SourceHit& each) { return each.hit.score; }));
    std::vector<fs::path> failed;
    for (const TakeFailure& failure : found.failures) failed.push_back(failure.path);
    std::ranges::sort(failed);
    EXPECT_THAT(failed, ElementsAre(sets_.File(0), sets_.File(1), sets_.File(4), sets_.File(5)));
    EXPECT_EQ(found.takes, 6U);
    EXPECT_EQ(found.frames, 40 + 70 + 100 + 130 + 160 + 190);
  }
}

TEST_F(SourceSearch, NamesATakeThatFailsAllQueriesAlikeOnce) {
  const fs::path file = sets_.File(0);
  test::WriteText(file, "no motion");
  const SourceHits found = SearchSource({{{.file = file}, {.file = sets_.File(2)}}, {}}, queries_);
  EXPECT_THAT(found.failures, ElementsAre(Field(&TakeFailure::path, file)));
  EXPECT_EQ(found.takes, 1U);
  EXPECT_THAT(Of(found, 0), Not(IsEmpty()));
  EXPECT_THAT(Of(found, 1), Not(IsEmpty()));
}

TEST_F(SourceSearch, KeepsTheBestOfAllQueries) {
  const SourceHits all = SearchSource({sets_.library(), {}, 1}, queries_);
  const SourceHits best = SearchSource({sets_.library(), {}, 1}, queries_, {.most_hits = 3});
  ASSERT_THAT(best.hits, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_THAT(best.hits[i], AllOf(Field(&SourceHit::query, all.hits[i].query),
                                    Field(&SourceHit::file, all.hits[i].file)));
  }
}

TEST_F(SourceSearch, ShowsTheTakesOfEachQuery) {
  std::vector<std::size_t> takes(2);
  (void)SearchSource({sets_.library(), {}, 1}, queries_,
                     {.on_takes = [&](std::size_t query, std::span<const TakeView> some) {
                       takes.at(query) += some.size();
                     }});
  EXPECT_THAT(takes, ElementsAre(4, 4));
}

}  // namespace
}  // namespace kinebase
