#include "kinebase/search/fuzzy_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <tuple>

#include "kinebase/core/error.h"
#include "search/scans.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

FeatureMatrix Words(std::vector<std::uint64_t> columns) {
  return {.rate_hz = 30, .feature_count = 4, .columns = std::move(columns)};
}

FuzzyElement Exactly(std::uint64_t word) { return {{{.tested = 0b11, .ones = word}}}; }

std::vector<Hit> Search(const FuzzyQuery& query, const std::vector<FeatureMatrix>& recordings,
                        int faults = 0) {
  return SearchFuzzy(query, recordings, {.faults = faults});
}

// Feature 3 is not selected: it neither parts segments nor hinders hits.
TEST(FuzzySearch, FindsTheElementsInOrderHoweverLongTheyLast) {
  const FuzzyQuery query = MakeFuzzyQuery(Words({1, 3, 3, 2}), 0b11);
  ASSERT_EQ(query.elements.size(), 3U);
  EXPECT_THAT(Search(query, {Words({0, 1, 5, 3, 2, 2, 6, 0, 1, 3, 7, 7, 2}), Words({1, 2, 3}),
                             Words({1, 3, 2})}),
              ElementsAre(Hit{0, 1, 6, 0}, Hit{0, 8, 12, 0}, Hit{2, 0, 2, 0}));
}

TEST(FuzzySearch, CountsElementsLeftOutAndSegmentsThatBelongToNone) {
  const FuzzyQuery query = MakeFuzzyQuery(Words({1, 3, 2}), 0b11);
  const std::vector<FeatureMatrix> recordings = {Words({0, 1, 1, 2, 0}), Words({1, 0, 3, 2}),
                                                 Words({1, 0, 2})};
  EXPECT_THAT(Search(query, recordings), IsEmpty());
  // In the first the second element is left out, in the second the first one: that is shorter than
  // passing over the 0, at as many faults.
  EXPECT_THAT(Search(query, recordings, 1),
              ElementsAre(Hit{0, 1, 3, 1.0 / 3}, Hit{1, 2, 3, 1.0 / 3}));
  // With two faults any one element is a hit.
  EXPECT_THAT(Search(query, {recordings[2]}, 2),
              ElementsAre(Hit{0, 0, 0, 2.0 / 3}, Hit{0, 2, 2, 2.0 / 3}));
}

// Leaving out what stands before the 0 would be two faults.
TEST(FuzzySearch, PassesOverSegmentsThatBelongToNoElement) {
  const FuzzyQuery query = MakeFuzzyQuery(Words({1, 3, 2, 1}), 0b11);
  EXPECT_THAT(Search(query, {Words({1, 3, 0, 2, 1})}, 1), ElementsAre(Hit{0, 0, 4, 1.0 / 4}));
}

TEST(FuzzySearch, TakesSetsOfVectors) {
  const FuzzyQuery query{
      .features = 0b11,
      .elements = {{{{.tested = 0b11, .ones = 0}, {.tested = 0b11, .ones = 3}}}, Exactly(1)}};
  EXPECT_THAT(Search(query, {Words({0, 1, 2, 3, 0, 1})}),
              ElementsAre(Hit{0, 0, 1, 0}, Hit{0, 4, 5, 0}));
}

// The second element asks for less than the first: one segment can be both.
TEST(FuzzySearch, LetsNeighboursShareASegment) {
  const FuzzyQuery query{
      .features = 0b11,
      .elements = {Exactly(1), {{{.tested = 0b01, .ones = 0b01}}}, {{{.tested = 0}}}, Exactly(2)}};
  EXPECT_THAT(Search(query, {Words({0, 1, 2, 1, 3, 0, 2})}),
              ElementsAre(Hit{0, 1, 2, 0}, Hit{0, 3, 6, 0}));
}

TEST(FuzzyQuery, OfATemplateFollowsItsConsistentEntries) {
  const QuantizedTemplate motion_template = Quantize(
      MakeMatrix(
          {{0.5, 1, 0.5}, {1, 0, 0.5}, {1, 1, 0}, {0.5, 0, 0}, {0, 0.5, 1}, {0.5, 0.5, 0.5}}),
      0.1, Profile::kPaper);
  const auto pattern = [](std::uint64_t tested, std::uint64_t ones) {
    return FuzzyElement{{{.tested = tested, .ones = ones}}};
  };
  EXPECT_THAT(MakeFuzzyQuery(motion_template, 0b001).elements,
              ElementsAre(pattern(1, 1), pattern(0, 0), pattern(1, 0)));
  EXPECT_THAT(MakeFuzzyQuery(motion_template, 0b100).elements,
              ElementsAre(pattern(4, 0), pattern(4, 4)));
  const Error error = ErrorOf([&] { (void)MakeFuzzyQuery(motion_template, 0b1000); });
  EXPECT_THAT(error.what(), HasSubstr("leaves all of the selected features free"));
}

// All ways to give segments to elements, as (faults, −first segment).
class AllMatches {
 public:
  AllMatches(const FuzzyQuery& query, std::vector<std::uint64_t> segments)
      : query_(query), segments_(std::move(segments)) {}

  std::pair<int, int> BestEndingIn(int segment) const {
    std::pair<int, int> best = {1000, 0};
    const int elements = static_cast<int>(query_.elements.size());
    for (int element = 0; element < elements; ++element) {
      Go(element, segment, elements - 1 - element, best);
    }
    return best;
  }

 private:
  static constexpr int kMostFaults = 2;

  bool Admits(int element, int segment) const {
    return std::ranges::any_of(query_.elements[element].patterns, [&](const FeaturePattern& p) {
      return p.Admits(segments_[segment]);
    });
  }

  // `element` has `segment`; what comes before?
  void Go(int element, int segment, int faults, std::pair<int, int>& best) const {
    if (faults > kMostFaults || !Admits(element, segment)) return;
    best = std::min(best, {faults + element, -segment});
    for (int other = element - 1; other >= 0; --other) {
      Go(other, segment, faults + element - 1 - other, best);
    }
    for (int before = segment - 1; before >= 0; --before) {
      const int skipped = segment - 1 - before;
      Go(element, before, faults + skipped, best);
      for (int other = element - 1; other >= 0; --other) {
        Go(other, before, faults + skipped + element - 1 - other, best);
      }
    }
  }

  const FuzzyQuery& query_;
  std::vector<std::uint64_t> segments_;
};

RC_GTEST_PROP(FuzzySearch, FindsWhatTryingEverythingFinds, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  // Each column differs from the one before, so that columns are segments.
  FeatureMatrix recording = Words({});
  for (int i = random.Below(14); i > 0; --i) {
    const std::uint64_t before = recording.columns.empty() ? 0 : recording.columns.back();
    recording.columns.push_back((before + 1 + static_cast<std::uint64_t>(random.Below(3))) % 4);
  }
  FuzzyQuery query{.features = 0b11, .elements = {}};
  for (int i = 1 + random.Below(4); i > 0; --i) {
    const std::uint64_t tested = 1 + random.Word() % 3;
    query.elements.push_back({{{.tested = tested, .ones = random.Word() & tested}}});
  }
  const int faults = random.Below(std::min(3, static_cast<int>(query.elements.size())));
  const AllMatches all(query, recording.columns);
  std::vector<Hit> expected;
  for (int end = 0; end < recording.column_count(); ++end) {
    const auto [needed, first] = all.BestEndingIn(end);
    if (needed > faults) continue;
    expected.push_back(
        {0, -first, end, static_cast<double>(needed) / static_cast<double>(query.elements.size())});
  }
  std::ranges::sort(expected, {}, [](const Hit& hit) {
    return std::tuple(hit.cost, hit.last - hit.first, hit.first);
  });
  std::vector<Hit> distinct;
  for (const Hit& hit : expected) {
    if (std::ranges::none_of(distinct, [&](const Hit& other) {
          return hit.first <= other.last && other.first <= hit.last;
        })) {
      distinct.push_back(hit);
    }
  }
  RC_ASSERT(Search(query, {recording}, faults) == BestHits(distinct, distinct.size()));
}

TEST(FuzzySearch, RefusesQueriesThatAskForNothing) {
  const auto message = [](auto action) {
    const Error error = ErrorOf(action);
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    return std::string(error.what());
  };
  EXPECT_THAT(message([] { (void)MakeFuzzyQuery(Words({1}), 0); }), HasSubstr("one feature"));
  EXPECT_THAT(message([] { (void)MakeFuzzyQuery(Words({}), 1); }), HasSubstr("one column"));
  const FuzzyQuery query{.features = 0b11, .elements = {Exactly(1)}};
  for (const int faults : {-1, 1}) {
    EXPECT_THAT(message([&] { (void)Search(query, {}, faults); }), HasSubstr("faults in a query"));
  }
  const FuzzyQuery other{.features = 0b01, .elements = {Exactly(1)}};
  EXPECT_THAT(message([&] { (void)Search(other, {Words({1})}); }), HasSubstr("the index does not"));
}

}  // namespace
}  // namespace kinebase::test
