// Where recordings show what: for each pattern that some of the features take, the stretches that
// have it, as inverted lists of runs.
//
// search/keyframe_index.h and search/fuzzy_search.h look things up here.
// Method: Müller, Röder & Clausen, "Efficient Content-Based Retrieval of Motion Capture Data",
// SIGGRAPH 2005; Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "kinebase/features/feature_matrix.h"

namespace kinebase {

// Columns of a recording, 0-based, inclusive.
struct Stretch {
  int recording = 0;
  int first = 0;
  int last = 0;

  friend bool operator==(const Stretch&, const Stretch&) = default;
};

// What feature words are asked for: those that differ from `ones` in at most `misses` of the
// `tested` bits.
struct FeaturePattern {
  std::uint64_t tested = 0;
  std::uint64_t ones = 0;
  int misses = 0;

  [[nodiscard]] bool Admits(std::uint64_t features) const;

  friend bool operator==(const FeaturePattern&, const FeaturePattern&) = default;
};

class FeatureIndex {
 public:
  // features  Bit i: feature i is indexed; others are not looked at.
  // Cost      O(columns) time; memory for each run of equal columns.
  FeatureIndex(std::span<const FeatureView> recordings, std::uint64_t features);
  FeatureIndex(std::span<const FeatureMatrix> recordings, std::uint64_t features)
      : FeatureIndex(ViewsOf(recordings), features) {}

  [[nodiscard]] std::uint64_t features() const { return features_; }
  [[nodiscard]] std::size_t pattern_count() const { return lists_.size(); }

  // All runs of equal columns, by recording and place.
  [[nodiscard]] std::vector<Stretch> Runs() const;

  // By recording and place; stretches are as long as can be.
  // Errors  InvalidArgument if the pattern tests features that are not indexed.
  // Cost    O(patterns + stretches · log stretches).
  [[nodiscard]] std::vector<Stretch> Find(const FeaturePattern& pattern) const;

 private:
  std::uint64_t features_;
  std::unordered_map<std::uint64_t, std::vector<Stretch>> lists_;
};

}  // namespace kinebase
