#include "kinebase/search/hits.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "search/scans.h"

namespace kinebase::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The rule word by word.
std::vector<Hit> ExtractPlainly(DeltaCurve curve, double tau) {
  std::vector<Hit> hits;
  std::map<int, int> reserved;  // Start → length of the hit that reserved it.
  while (true) {
    const auto smallest = std::ranges::min_element(curve.delta);
    if (smallest == curve.delta.end() || !(*smallest <= tau) || *smallest == kInfinity) return hits;
    const int end = static_cast<int>(smallest - curve.delta.begin());
    const int start = curve.start[end];
    if (!reserved.contains(start)) {
      hits.push_back({.recording = 0, .first = start, .last = end, .cost = *smallest});
      const int length = end - start + 1;
      const int before = static_cast<int>(std::ceil(length / 10.0));
      const int after = static_cast<int>(std::ceil(length / 2.0));
      for (int s = start - before; s <= start + after; ++s) reserved.emplace(s, length);
    }
    const int length = reserved.at(start);
    const int from = end - static_cast<int>(std::ceil(length / 2.0));
    const int to = end + static_cast<int>(std::ceil(length / 10.0));
    for (int e = std::max(from, 0); e <= std::min(to, static_cast<int>(curve.delta.size()) - 1);
         ++e) {
      curve.delta[e] = kInfinity;
    }
  }
}

RC_GTEST_PROP(HitExtraction, FollowsTheRuleWordByWord, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  DeltaCurve curve;
  const int columns = 1 + random.Below(300);
  for (int l = 0; l < columns; ++l) {
    const int length = 1 + random.Below(random.Below(2) == 0 ? 60 : 12);
    const bool reachable = length <= l + 1 && random.Below(10) != 0;
    // Few different costs, so that many are equal.
    curve.delta.push_back(reachable ? random.Below(12) / 100.0 : kInfinity);
    curve.start.push_back(reachable ? l - length + 1 : -1);
  }
  const double tau = random.Below(14) / 100.0;
  RC_ASSERT(ExtractHits(curve, tau) == ExtractPlainly(curve, tau));
}

RC_GTEST_PROP(HitExtraction, FollowsTheRuleOnRealCurves, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const QuantizedTemplate motion_template =
      RandomQuantized(random, 2 + random.Below(12), 10, Profile::kBonn);
  const DeltaCurve curve = ComputeDelta(motion_template, RandomRecording(random, 400, 10));
  RC_ASSERT(ExtractHits(curve, 0.2) == ExtractPlainly(curve, 0.2));
}

DeltaCurve Curve(int columns, const std::vector<Hit>& ends) {
  DeltaCurve curve{std::vector<double>(columns, kInfinity), std::vector<std::int32_t>(columns, -1)};
  for (const Hit& end : ends) {
    curve.delta[end.last] = end.cost;
    curve.start[end.last] = end.first;
  }
  return curve;
}

TEST(HitExtraction, TakesCostsUpToTauItself) {
  const Hit at_tau{.first = 0, .last = 9, .cost = 0.06};
  const Hit above{.first = 40, .last = 49, .cost = std::nextafter(0.06, 1)};
  EXPECT_EQ(ExtractHits(Curve(60, {at_tau, above}), 0.06), std::vector<Hit>{at_tau});
}

TEST(HitExtraction, TakesTheFirstOfEqualCosts) {
  const Hit first{.first = 0, .last = 9, .cost = 0.01};
  const Hit second{.first = 30, .last = 39, .cost = 0.01};
  EXPECT_EQ(ExtractHits(Curve(60, {second, first}), 0.06), (std::vector<Hit>{first, second}));
}

// A hit of length 10 from column 100: starts 99 to 105 are taken, ends 104 to 110 are blank.
TEST(HitExtraction, ReservesStartsAndBlanksEndsByTheLengthOfTheHit) {
  const Hit hit{.first = 100, .last = 109, .cost = 0.01};
  const auto survives = [&](int first, int last) {
    const Hit other{.first = first, .last = last, .cost = 0.02};
    return ExtractHits(Curve(200, {hit, other}), 0.06).size() == 2;
  };
  EXPECT_TRUE(survives(98, 120));
  EXPECT_FALSE(survives(99, 120));
  EXPECT_FALSE(survives(105, 120));
  EXPECT_TRUE(survives(106, 120));
  EXPECT_TRUE(survives(90, 103));
  EXPECT_FALSE(survives(90, 104));
  EXPECT_FALSE(survives(90, 110));
  EXPECT_TRUE(survives(90, 111));
}

// An end whose start is reserved blanks too, by the length of the hit that reserved it.
TEST(HitExtraction, BlanksAroundEndsThatAreNoHits) {
  const Hit hit{.first = 100, .last = 109, .cost = 0.01};
  const Hit shadowed{.first = 105, .last = 129, .cost = 0.02};
  const auto survives = [&](int last) {
    const Hit other{.first = 115, .last = last, .cost = 0.03};
    return ExtractHits(Curve(200, {hit, shadowed, other}), 0.06).size() == 2;
  };
  EXPECT_TRUE(survives(123));
  EXPECT_FALSE(survives(124));
  EXPECT_FALSE(survives(130));
  EXPECT_TRUE(survives(131));
}

TEST(HitExtraction, FindsNothingInUnreachableColumns) {
  EXPECT_TRUE(ExtractHits(Curve(50, {}), kInfinity).empty());
  EXPECT_TRUE(ExtractHits({}, 0.06).empty());
}

TEST(HitExtraction, NamesTheRecording) {
  const std::vector<Hit> hits =
      ExtractHits(Curve(20, {{.first = 0, .last = 9, .cost = 0.01}}), 0.06, 7);
  ASSERT_EQ(hits.size(), 1U);
  EXPECT_EQ(hits[0].recording, 7);
}

TEST(BestHits, OrdersByCostThenRecordingThenPlace) {
  const Hit a{.recording = 1, .first = 5, .last = 9, .cost = 0.01};
  const Hit b{.recording = 0, .first = 7, .last = 9, .cost = 0.02};
  const Hit c{.recording = 1, .first = 2, .last = 9, .cost = 0.02};
  const Hit d{.recording = 1, .first = 3, .last = 8, .cost = 0.02};
  const Hit e{.recording = 1, .first = 3, .last = 9, .cost = 0.02};
  EXPECT_EQ(BestHits({e, c, b, d, a}, 10), (std::vector<Hit>{a, b, c, d, e}));
  EXPECT_EQ(BestHits({e, c, b, d, a}, 2), (std::vector<Hit>{a, b}));
  EXPECT_TRUE(BestHits({a, b}, 0).empty());
}

}  // namespace
}  // namespace kinebase::test
