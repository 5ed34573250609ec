#include "kinebase/search/run_lists.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase {
namespace {

constexpr unsigned kBitsOfAByte = 7;
constexpr unsigned kMore = 1U << kBitsOfAByte;
// Of a number of 32 bits.
constexpr std::size_t kMostBytes = 5;

void AppendNumber(std::uint32_t number, std::string& bytes) {
  while (number >= kMore) {
    bytes += static_cast<char>(number | kMore);
    number >>= kBitsOfAByte;
  }
  bytes += static_cast<char>(number);
}

// Takes a number from the front; nothing if there is none, or it could be written shorter.
std::optional<std::uint32_t> TakeNumber(std::string_view& bytes) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < std::min(bytes.size(), kMostBytes); ++i) {
    const auto byte = static_cast<unsigned char>(bytes[i]);
    number |= static_cast<std::uint64_t>(byte & (kMore - 1)) << (kBitsOfAByte * i);
    if ((byte & kMore) != 0) continue;
    if ((byte == 0 && i > 0) || number > UINT32_MAX) return std::nullopt;
    bytes.remove_prefix(i + 1);
    return static_cast<std::uint32_t>(number);
  }
  return std::nullopt;
}

// The stretches of a list, one after the other; the last reaches to the end of the recording.
class ListReader {
 public:
  ListReader(std::string_view list, int column_count) : list_(list), column_count_(column_count) {}

  [[nodiscard]] int first() const { return first_; }
  [[nodiscard]] int end() const { return end_; }
  [[nodiscard]] bool shows() const { return shows_; }

  // Goes on to the next, if there is one.
  // Errors  MalformedFile: a stretch is empty that is not the first, or leaves the recording.
  bool Next() {
    if (end_ == column_count_) return false;
    if (has_begun_) shows_ = !shows_;
    first_ = end_;
    if (list_.empty()) {
      end_ = column_count_;
    } else {
      const auto length = TakeNumber(list_);
      if (!length || (*length == 0 && has_begun_) ||
          *length >= static_cast<std::uint32_t>(column_count_ - first_)) {
        throw Error(ErrorCode::kMalformedFile,
                    fmt::format("a list of a feature is none of {} columns", column_count_));
      }
      end_ += static_cast<int>(*length);
    }
    has_begun_ = true;
    return true;
  }

 private:
  std::string_view list_;  // What follows.
  int column_count_;
  int first_ = 0;
  int end_ = 0;
  bool shows_ = false;
  bool has_begun_ = false;
};

// The parts of `runs` where a feature is as it is wanted. No more of the list is read than matters.
// parts  Out; its memory is used again.
void Intersect(std::span<const Stretch> runs, ListReader list, bool is_wanted,
               std::vector<Stretch>& parts) {
  parts.clear();
  auto run = runs.begin();
  while (run != runs.end() && list.Next()) {
    if (list.shows() != is_wanted) continue;
    while (run != runs.end() && run->last < list.first()) ++run;
    for (; run != runs.end() && run->first < list.end(); ++run) {
      parts.push_back({run->recording, std::max(run->first, list.first()),
                       std::min(run->last, list.end() - 1)});
      if (run->last >= list.end()) break;
    }
  }
}

// A column where a tested feature begins to disagree with the pattern, or ceases to.
struct Change {
  int column = 0;
  int misses = 0;  // 1 or -1.
};

// Adds the changes of a feature; returns whether it disagrees in the first column.
bool AppendChanges(ListReader list, bool is_wanted, std::vector<Change>& changes) {
  bool disagrees_at_first = is_wanted;
  while (list.Next()) {
    const bool agrees = list.shows() == is_wanted;
    if (list.first() == 0) {
      if (list.end() > 0) disagrees_at_first = !agrees;
      continue;
    }
    changes.push_back({list.first(), agrees ? -1 : 1});
  }
  return disagrees_at_first;
}

}  // namespace

std::string FormatRunLists(const FeatureView& recording) {
  const auto features = static_cast<std::size_t>(recording.feature_count);
  std::vector<std::string> lists(features);
  std::vector<std::uint32_t> begins(features, 0);  // Of the stretch at hand.
  std::uint64_t before = 0;
  for (std::size_t column = 0; column < recording.columns.size(); ++column) {
    const std::uint64_t word = recording.columns[column];
    for (std::uint64_t changed = word ^ before; changed != 0; changed &= changed - 1) {
      const auto feature = static_cast<std::size_t>(std::countr_zero(changed));
      if (feature >= features) break;
      AppendNumber(static_cast<std::uint32_t>(column) - begins[feature], lists[feature]);
      begins[feature] = static_cast<std::uint32_t>(column);
    }
    before = word;
  }
  std::string bytes;
  for (const std::string& list : lists) {
    AppendNumber(static_cast<std::uint32_t>(list.size()), bytes);
    bytes += list;
  }
  return bytes;
}

RunLists::RunLists(std::string_view bytes, int feature_count, int column_count)
    : column_count_(column_count) {
  lists_.reserve(static_cast<std::size_t>(feature_count));
  for (int feature = 0; feature < feature_count; ++feature) {
    const auto size = TakeNumber(bytes);
    if (!size || *size > bytes.size() || (*size > 0 && column_count == 0)) {
      throw Error(ErrorCode::kMalformedFile,
                  fmt::format("the list of feature {} is cut off", feature + 1));
    }
    lists_.push_back(bytes.substr(0, *size));
    bytes.remove_prefix(*size);
  }
  if (!bytes.empty()) {
    throw Error(ErrorCode::kMalformedFile, fmt::format("{} bytes follow the lists of {} features",
                                                       bytes.size(), feature_count));
  }
}

std::vector<Stretch> RunLists::Find(const FeaturePattern& pattern, int recording) const {
  if (column_count_ == 0) return {};
  return pattern.misses == 0 ? FindExactly(pattern, recording) : FindNearly(pattern, recording);
}

std::vector<Stretch> RunLists::FindExactly(const FeaturePattern& pattern, int recording) const {
  std::vector<Stretch> found = {{recording, 0, column_count_ - 1}};
  std::vector<Stretch> parts;
  for (std::uint64_t tested = pattern.tested; tested != 0 && !found.empty(); tested &= tested - 1) {
    const auto feature = static_cast<std::size_t>(std::countr_zero(tested));
    const bool is_wanted = ((pattern.ones >> feature) & 1U) != 0;
    Intersect(found, {lists_.at(feature), column_count_}, is_wanted, parts);
    found.swap(parts);
  }
  return found;
}

std::vector<Stretch> RunLists::FindNearly(const FeaturePattern& pattern, int recording) const {
  std::vector<Change> changes;
  int misses = 0;
  for (std::uint64_t tested = pattern.tested; tested != 0; tested &= tested - 1) {
    const auto feature = static_cast<std::size_t>(std::countr_zero(tested));
    const bool is_wanted = ((pattern.ones >> feature) & 1U) != 0;
    if (AppendChanges({lists_.at(feature), column_count_}, is_wanted, changes)) ++misses;
  }
  std::ranges::sort(changes, {}, &Change::column);
  std::vector<Stretch> found;
  int first = misses <= pattern.misses ? 0 : -1;  // Of the stretch at hand, if there is one.
  for (std::size_t i = 0; i < changes.size();) {
    const int column = changes[i].column;
    for (; i < changes.size() && changes[i].column == column; ++i) misses += changes[i].misses;
    if (misses <= pattern.misses) {
      if (first < 0) first = column;
    } else if (first >= 0) {
      found.push_back({.recording = recording, .first = first, .last = column - 1});
      first = -1;
    }
  }
  if (first >= 0) {
    found.push_back({.recording = recording, .first = first, .last = column_count_ - 1});
  }
  return found;
}

}  // namespace kinebase
