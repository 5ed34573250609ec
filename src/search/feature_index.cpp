#include "kinebase/search/feature_index.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "kinebase/core/error.h"

namespace kinebase {
namespace {

void SortByPlace(std::vector<Stretch>& stretches) {
  std::ranges::sort(stretches, {},
                    [](const Stretch& run) { return std::tuple(run.recording, run.first); });
}

}  // namespace

bool FeaturePattern::Admits(std::uint64_t features) const {
  return std::popcount((features ^ ones) & tested) <= misses;
}

FeatureIndex::FeatureIndex(std::span<const FeatureView> recordings, std::uint64_t features)
    : features_(features) {
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const std::span<const std::uint64_t> columns = recordings[i].columns;
    for (std::size_t first = 0; first < columns.size();) {
      const std::uint64_t word = columns[first] & features;
      std::size_t end = first + 1;
      while (end < columns.size() && (columns[end] & features) == word) ++end;
      lists_[word].push_back({.recording = static_cast<int>(i),
                              .first = static_cast<int>(first),
                              .last = static_cast<int>(end) - 1});
      first = end;
    }
  }
}

std::vector<Stretch> FeatureIndex::Runs() const {
  std::vector<Stretch> runs;
  for (const auto& [word, stretches] : lists_) {
    runs.insert(runs.end(), stretches.begin(), stretches.end());
  }
  SortByPlace(runs);
  return runs;
}

std::vector<Stretch> FeatureIndex::Find(const FeaturePattern& pattern) const {
  if ((pattern.tested & ~features_) != 0) {
    throw Error(ErrorCode::kInvalidArgument,
                "features are asked for that the index does not hold; make one of all that are");
  }
  std::vector<Stretch> found;
  for (const auto& [word, stretches] : lists_) {
    if (pattern.Admits(word)) found.insert(found.end(), stretches.begin(), stretches.end());
  }
  SortByPlace(found);
  // Neighbours may have come from different lists.
  std::size_t kept = 0;
  for (const Stretch& run : found) {
    if (kept > 0 && found[kept - 1].recording == run.recording &&
        found[kept - 1].last + 1 == run.first) {
      found[kept - 1].last = run.last;
    } else {
      found[kept++] = run;
    }
  }
  found.resize(kept);
  return found;
}

}  // namespace kinebase
