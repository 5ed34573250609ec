#include "kinebase/search/keyframe_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>

#include "kinebase/core/error.h"
#include "kinebase/search/template_search.h"
#include "search/scans.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::vector<FeatureGroup> kGroups = {{"arms", 0b0011}, {"legs", 0b1100}};

FeatureMatrix Columns(int count, const std::vector<std::pair<int, std::uint64_t>>& words) {
  FeatureMatrix recording{.rate_hz = 30, .feature_count = 4, .columns = {}};
  recording.columns.resize(static_cast<std::size_t>(count));
  for (const auto& [column, word] : words) {
    recording.columns[static_cast<std::size_t>(column)] |= word;
  }
  return recording;
}

// What the index selects; run lists select the same.
std::vector<Stretch> Select(const std::vector<FeatureMatrix>& recordings,
                            const std::vector<Keyframe>& keyframes, int template_columns) {
  std::vector<Stretch> selected =
      KeyframeIndex(recordings, kGroups).Preselect(keyframes, template_columns);
  std::vector<Stretch> by_lists;
  for (int i = 0; i < std::ssize(recordings); ++i) {
    const FeatureMatrix& recording = recordings[static_cast<std::size_t>(i)];
    const std::string bytes = FormatRunLists(recording);
    const RunLists lists(bytes, recording.feature_count, recording.column_count());
    for (const Stretch& each : Preselect(keyframes, template_columns, kGroups, lists, i)) {
      by_lists.push_back(each);
    }
  }
  EXPECT_EQ(by_lists, selected);
  return selected;
}

// Column 2 is the third: nine columns before it; seven follow: 21 after it.
TEST(KeyframeIndex, LooksAroundOneKeyframeAsFarAsTheTemplateAsks) {
  const Keyframe keyframe{.column = 2, .tested = 0b0001, .ones = 0b0001};
  EXPECT_THAT(Select({Columns(100, {{50, 1}})}, {keyframe}, 10), ElementsAre(Stretch{0, 41, 71}));
  EXPECT_THAT(Select({Columns(60, {{3, 1}, {50, 1}})}, {keyframe}, 10),
              ElementsAre(Stretch{0, 0, 24}, Stretch{0, 41, 59}));
  EXPECT_THAT(Select({Columns(99, {{30, 1}, {50, 1}}), Columns(9, {}), Columns(9, {{1, 1}})},
                     {keyframe}, 10),
              ElementsAre(Stretch{0, 21, 71}, Stretch{2, 0, 8}));
}

// In the template the keyframes are 4 apart, 5 columns with both; in a recording 10 at most.
TEST(KeyframeIndex, WantsKeyframesInOrderAndNotTooFarApart) {
  const std::vector<Keyframe> keyframes = {{.column = 0, .tested = 0b0001, .ones = 0b0001},
                                           {.column = 4, .tested = 0b0100, .ones = 0b0100}};
  EXPECT_THAT(Select({Columns(60, {{20, 0b0001}, {29, 0b0100}})}, keyframes, 5),
              ElementsAre(Stretch{0, 17, 29}));
  EXPECT_THAT(Select({Columns(60, {{20, 0b0001}, {30, 0b0100}})}, keyframes, 5), IsEmpty());
  EXPECT_THAT(Select({Columns(60, {{20, 0b0100}, {24, 0b0001}})}, keyframes, 5), IsEmpty());
  EXPECT_THAT(Select({Columns(60, {{20, 0b0101}})}, keyframes, 5), IsEmpty());
}

// A gap of 8: stiffness 0 is 4 to 16 columns, 0.5 is 6 to 11, 1 is 8.
TEST(KeyframeIndex, BoundsTheTimeBetweenKeyframesByTheirStiffness) {
  std::vector<Keyframe> keyframes = {{.column = 0, .tested = 0b0001, .ones = 0b0001},
                                     {.column = 8, .tested = 0b0100, .ones = 0b0100},
                                     {.column = 20, .tested = 0b0010, .ones = 0b0010}};
  const auto gaps_found = [&] {
    std::vector<int> gaps;
    for (int gap = 1; gap < 30; ++gap) {
      const FeatureMatrix recording =
          Columns(90, {{20, 0b0001}, {20 + gap, 0b0100}, {20 + 35, 0b0010}});
      if (!Select({recording}, keyframes, 21).empty()) gaps.push_back(gap);
    }
    return std::pair(gaps.front(), gaps.back());
  };
  EXPECT_EQ(gaps_found(), std::pair(1, 29));
  keyframes[1].stiffness = 0;
  EXPECT_EQ(gaps_found(), std::pair(4, 16));
  keyframes[1].stiffness = 0.5;
  EXPECT_EQ(gaps_found(), std::pair(6, 11));
  keyframes[1].stiffness = 1;
  EXPECT_EQ(gaps_found(), std::pair(8, 8));
}

TEST(KeyframeIndex, RefusesWhatItCannotLookUp) {
  const std::vector<FeatureMatrix> recordings = {Columns(9, {})};
  const auto message = [&](const std::vector<Keyframe>& keyframes) {
    const Error error = ErrorOf([&] { (void)Select(recordings, keyframes, 5); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    return std::string(error.what());
  };
  EXPECT_THAT(message({}), HasSubstr("no keyframes"));
  EXPECT_THAT(message({{.column = 2, .tested = 0b0110}}), HasSubstr("features of several groups"));
  EXPECT_THAT(message({{.column = 5, .tested = 0b0010}}), HasSubstr("column 5; expected 0 to 4"));
}

// All that is said of preselection, tried out column by column.
class PlainPreselection {
 public:
  PlainPreselection(std::vector<Keyframe> keyframes, int template_columns)
      : keyframes_(std::move(keyframes)), template_columns_(template_columns) {}

  // [column] is it to be looked at?
  std::vector<bool> Select(const FeatureMatrix& recording) const {
    std::vector<bool> selected(recording.columns.size());
    for (int column = 0; column < recording.column_count(); ++column) {
      if (Shows(recording, column, 0)) Follow(recording, column, column, 0, selected);
    }
    return selected;
  }

 private:
  bool Shows(const FeatureMatrix& recording, int column, std::size_t i) const {
    const Keyframe& keyframe = keyframes_[i];
    const std::uint64_t word = recording.columns[static_cast<std::size_t>(column)];
    return std::popcount((word ^ keyframe.ones) & keyframe.tested) <= keyframe.misses;
  }

  // Keyframe i is in `column`: goes on to all places of the next.
  void Follow(const FeatureMatrix& recording, int first, int column, std::size_t i,
              std::vector<bool>& selected) const {
    if (i + 1 == keyframes_.size()) {
      const int from = first - 3 * (keyframes_.front().column + 1);
      const int to = column + 3 * (template_columns_ - 1 - keyframes_.back().column);
      for (int l = std::max(from, 0); l <= to && l < recording.column_count(); ++l) {
        selected[static_cast<std::size_t>(l)] = true;
      }
      return;
    }
    const int span = keyframes_.back().column - keyframes_.front().column + 1;
    const int gap = keyframes_[i + 1].column - keyframes_[i].column;
    for (int next = column; next < recording.column_count(); ++next) {
      if (next - first + 1 > 2 * span) break;
      if (gap > 0 && next == column) continue;
      if (const auto stiffness = keyframes_[i + 1].stiffness) {
        const double factor = std::exp2(1 - *stiffness);
        if (next - column > gap * factor || next - column < gap / factor) continue;
      }
      if (Shows(recording, next, i + 1)) Follow(recording, first, next, i + 1, selected);
    }
  }

  std::vector<Keyframe> keyframes_;
  int template_columns_;
};

RC_GTEST_PROP(KeyframeIndex, SelectsWhatTryingEverythingSelects, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  std::vector<FeatureMatrix> recordings;
  for (int i = random.Below(3); i >= 0; --i) {
    recordings.push_back({.rate_hz = 30,
                          .feature_count = 4,
                          .columns = RandomRecording(random, random.Below(150), 4)});
  }
  const int template_columns = 3 + random.Below(12);
  std::vector<Keyframe> keyframes;
  for (int column = 0; column < template_columns && keyframes.size() < 4; ++column) {
    if (random.Below(3) != 0) continue;
    Keyframe& keyframe = keyframes.emplace_back();
    keyframe.column = column;
    keyframe.tested = random.Below(2) == 0 ? 0b0011 : 0b1000;
    keyframe.ones = random.Word() & keyframe.tested;
    keyframe.misses = keyframe.tested == 0b0011 && random.Below(4) == 0 ? 1 : 0;
    if (random.Below(3) == 0) keyframe.stiffness = random.Below(3) / 2.0;
  }
  RC_PRE(!keyframes.empty());
  std::vector<Stretch> expected;
  const PlainPreselection plain(keyframes, template_columns);
  for (int i = 0; i < std::ssize(recordings); ++i) {
    const std::vector<bool> selected = plain.Select(recordings[i]);
    for (int column = 0; column < std::ssize(selected); ++column) {
      if (!selected[column]) continue;
      const bool goes_on = column > 0 && selected[column - 1];
      if (goes_on) expected.back().last = column;
      if (!goes_on) expected.push_back({i, column, column});
    }
  }
  const std::vector<Stretch> actual = Select(recordings, keyframes, template_columns);
  RC_ASSERT(actual == expected);
  std::int64_t columns = 0;
  for (const Stretch& stretch : expected) columns += stretch.last - stretch.first + 1;
  RC_ASSERT(CountColumns(actual) == columns);
}

// As if each stretch were a recording of its own, but for the hits that suppress each other.
TEST(SearchOfStretches, LooksAtNothingElse) {
  Random random(71);
  const std::vector<FeatureMatrix> recordings = {
      {.rate_hz = 30, .feature_count = 39, .columns = RandomRecording(random, 400, 39)},
      {.rate_hz = 30, .feature_count = 39, .columns = RandomRecording(random, 300, 39)}};
  const QuantizedTemplate motion_template = RandomQuantized(random, 12, 39, Profile::kBonn);
  const std::vector<Stretch> stretches = {{0, 10, 120}, {0, 200, 399}, {1, 40, 260}};
  std::vector<Hit> expected;
  for (int i = 0; i < std::ssize(recordings); ++i) {
    DeltaCurve curve;
    curve.delta.assign(recordings[i].columns.size(), std::numeric_limits<double>::infinity());
    curve.start.assign(recordings[i].columns.size(), -1);
    for (const Stretch& stretch : stretches) {
      if (stretch.recording != i) continue;
      const auto columns =
          std::span(recordings[i].columns).subspan(stretch.first, stretch.last - stretch.first + 1);
      const DeltaCurve part = ComputeDeltaReference(motion_template, columns);
      for (std::size_t l = 0; l < columns.size(); ++l) {
        curve.delta[stretch.first + l] = part.delta[l];
        if (part.start[l] >= 0) curve.start[stretch.first + l] = stretch.first + part.start[l];
      }
    }
    for (const Hit& hit : ExtractHits(curve, 0.4, i)) expected.push_back(hit);
  }
  expected = BestHits(expected, expected.size());
  ASSERT_GT(expected.size(), 10U);
  EXPECT_EQ(SearchTemplate(motion_template, recordings, stretches, {.tau = 0.4}), expected);
}

TEST(SearchOfStretches, OfEverythingIsTheSearchOfEverything) {
  Random random(72);
  const std::vector<FeatureMatrix> recordings = {
      {.rate_hz = 30, .feature_count = 39, .columns = RandomRecording(random, 90'000, 39)}};
  const QuantizedTemplate motion_template = RandomQuantized(random, 12, 39, Profile::kBonn);
  const std::vector<Stretch> all = {{0, 0, 89'999}};
  EXPECT_EQ(SearchTemplate(motion_template, recordings, all, {.tau = 0.3}),
            SearchTemplate(motion_template, recordings, {.tau = 0.3}));
}

TEST(SearchOfStretches, RefusesStretchesThatAreNone) {
  Random random(73);
  const std::vector<FeatureMatrix> recordings = {
      {.rate_hz = 30, .feature_count = 39, .columns = RandomRecording(random, 50, 39)}};
  const QuantizedTemplate motion_template = RandomQuantized(random, 5, 39, Profile::kBonn);
  const std::vector<std::vector<Stretch>> bad = {
      {{1, 0, 3}}, {{-1, 0, 3}}, {{0, -1, 3}}, {{0, 5, 4}}, {{0, 0, 50}}, {{0, 0, 9}, {0, 9, 20}}};
  for (const std::vector<Stretch>& stretches : bad) {
    const Error error =
        ErrorOf([&] { (void)SearchTemplate(motion_template, recordings, stretches); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr("without overlaps"));
  }
}

}  // namespace
}  // namespace kinebase::test
