#include "kinebase/search/keyframe_index.h"

#include <algorithm>
#include <cmath>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/templates/keyframes.h"

namespace kinebase {
namespace {

constexpr int kLongestSpan = 2;  // Times that of the template.
constexpr int kExtent = 3;       // Times the template columns before and after.

// Columns from one keyframe to the next, inclusive.
struct GapRange {
  int least = 0;
  int most = 0;
};

GapRange GapBefore(const Keyframe& keyframe, const Keyframe& before, int longest) {
  const int gap = keyframe.column - before.column;
  if (!keyframe.stiffness) return {.least = gap > 0 ? 1 : 0, .most = longest};
  const double factor = std::exp2(1 - *keyframe.stiffness);
  return {.least = static_cast<int>(std::ceil(gap / factor)),
          .most = std::min(static_cast<int>(std::floor(gap * factor)), longest)};
}

// Where the next keyframe can be: in `runs`, within the gap after one of `places`, up to `last`.
// Both by place; so is the result, without overlaps.
std::vector<Stretch> Advance(std::span<const Stretch> places, const GapRange& gap,
                             std::span<const Stretch> runs, int last) {
  std::vector<Stretch> reached;
  for (const Stretch& place : places) {
    const int from = place.first + gap.least;
    const int to = std::min(place.last + gap.most, last);
    auto run = std::ranges::lower_bound(runs, from, {}, &Stretch::last);
    for (; run != runs.end() && run->first <= to; ++run) {
      int first = std::max(run->first, from);
      if (!reached.empty()) first = std::max(first, reached.back().last + 1);
      const int end = std::min(run->last, to);
      if (first <= end) reached.push_back({run->recording, first, end});
    }
  }
  return reached;
}

// The keyframes of one template, and where each is in one recording.
class Preselection {
 public:
  Preselection(std::span<const Keyframe> keyframes, int template_columns, int recording,
               int columns)
      : longest_(kLongestSpan * (keyframes.back().column - keyframes.front().column + 1) - 1),
        before_(kExtent * (keyframes.front().column + 1)),
        after_(kExtent * (template_columns - 1 - keyframes.back().column)),
        recording_(recording),
        columns_(columns) {
    for (std::size_t i = 1; i < keyframes.size(); ++i) {
      gaps_.push_back(GapBefore(keyframes[i], keyframes[i - 1], longest_));
    }
  }

  // found     Of each keyframe, the stretches of this recording.
  // selected  Out: grows by what is to be looked at.
  void Select(std::span<const std::vector<Stretch>> found, std::vector<Stretch>& selected) const {
    if (std::ranges::any_of(found, &std::vector<Stretch>::empty)) return;
    for (const Stretch& run : found.front()) {
      for (int column = run.first; column <= run.last; ++column) {
        const int last = LastKeyframe(column, found);
        if (last >= 0) Add(column, last, selected);
      }
    }
  }

 private:
  // The latest column that the last keyframe can have if the first is in `column`; -1 if there is
  // none.
  [[nodiscard]] int LastKeyframe(int column, std::span<const std::vector<Stretch>> found) const {
    std::vector<Stretch> places = {{recording_, column, column}};
    for (std::size_t i = 1; i < found.size() && !places.empty(); ++i) {
      places = Advance(places, gaps_[i - 1], found[i], column + longest_);
    }
    return places.empty() ? -1 : places.back().last;
  }

  void Add(int first, int last, std::vector<Stretch>& selected) const {
    first = std::max(first - before_, 0);
    last = std::min(last + after_, columns_ - 1);
    if (!selected.empty() && selected.back().recording == recording_ &&
        first <= selected.back().last + 1) {
      selected.back().last = std::max(selected.back().last, last);
    } else {
      selected.push_back({recording_, first, last});
    }
  }

  int longest_;  // Columns from the first keyframe to the last.
  int before_;
  int after_;
  int recording_;
  int columns_;
  std::vector<GapRange> gaps_;
};

bool IsOfGroup(const Keyframe& keyframe, std::uint64_t features) {
  return (keyframe.tested & ~features) == 0;
}

[[noreturn]] void ThrowSeveralGroups(const Keyframe& keyframe) {
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("the keyframe in column {} tests features of several groups; make one "
                          "for each group",
                          keyframe.column));
}

void CheckKeyframes(std::span<const Keyframe> keyframes, int template_columns) {
  std::string problem = ProblemOfKeyframes(keyframes, template_columns, kMaxFeatures);
  if (keyframes.empty()) problem = "no keyframes; choose some, or search without";
  if (!problem.empty()) throw Error(ErrorCode::kInvalidArgument, problem);
}

FeaturePattern PatternOf(const Keyframe& keyframe) {
  return {.tested = keyframe.tested, .ones = keyframe.ones, .misses = keyframe.misses};
}

}  // namespace

KeyframeIndex::KeyframeIndex(std::span<const FeatureView> recordings,
                             std::span<const FeatureGroup> groups) {
  column_counts_.reserve(recordings.size());
  indices_.reserve(groups.size());
  for (const FeatureView& recording : recordings) {
    column_counts_.push_back(recording.column_count());
  }
  for (const FeatureGroup& group : groups) indices_.emplace_back(recordings, group.features);
}

std::vector<std::vector<Stretch>> KeyframeIndex::Find(const Keyframe& keyframe) const {
  const auto index = std::ranges::find_if(
      indices_, [&](const FeatureIndex& group) { return IsOfGroup(keyframe, group.features()); });
  if (index == indices_.end()) ThrowSeveralGroups(keyframe);
  std::vector<std::vector<Stretch>> by_recording(column_counts_.size());
  for (const Stretch& run : index->Find(PatternOf(keyframe))) {
    by_recording[static_cast<std::size_t>(run.recording)].push_back(run);
  }
  return by_recording;
}

std::vector<Stretch> KeyframeIndex::Preselect(std::span<const Keyframe> keyframes,
                                              int template_columns) const {
  CheckKeyframes(keyframes, template_columns);
  std::vector<std::vector<std::vector<Stretch>>> found;  // [keyframe][recording]
  found.reserve(keyframes.size());
  for (const Keyframe& keyframe : keyframes) found.push_back(Find(keyframe));
  std::vector<Stretch> selected;
  for (std::size_t i = 0; i < column_counts_.size(); ++i) {
    std::vector<std::vector<Stretch>> here;
    here.reserve(found.size());
    for (auto& recordings : found) here.push_back(std::move(recordings[i]));
    Preselection(keyframes, template_columns, static_cast<int>(i), column_counts_[i])
        .Select(here, selected);
  }
  return selected;
}

std::vector<Stretch> Preselect(std::span<const Keyframe> keyframes, int template_columns,
                               std::span<const FeatureGroup> groups, const RunLists& lists,
                               int recording) {
  CheckKeyframes(keyframes, template_columns);
  std::vector<std::vector<Stretch>> found;  // [keyframe]
  found.reserve(keyframes.size());
  for (const Keyframe& keyframe : keyframes) {
    const bool is_of_one = std::ranges::any_of(
        groups, [&](const FeatureGroup& group) { return IsOfGroup(keyframe, group.features); });
    if (!is_of_one) ThrowSeveralGroups(keyframe);
  }
  for (const Keyframe& keyframe : keyframes) {
    found.push_back(lists.Find(PatternOf(keyframe), recording));
    if (found.back().empty()) return {};
  }
  std::vector<Stretch> selected;
  Preselection(keyframes, template_columns, recording, lists.column_count())
      .Select(found, selected);
  return selected;
}

std::int64_t CountColumns(std::span<const Stretch> stretches) {
  std::int64_t columns = 0;
  for (const Stretch& stretch : stretches) columns += stretch.last - stretch.first + 1;
  return columns;
}

}  // namespace kinebase
