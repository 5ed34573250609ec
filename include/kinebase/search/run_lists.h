// Where a recording shows each of its features, in a few bytes: run-length inverted lists, as a
// library keeps them beside the words.
//
// search/feature_index.h makes lists for whole patterns, in memory; here there is one for each
// feature, and patterns are put together when somebody asks. So the lists are good for any pattern
// and take a fifth of what the words do, or less. search/keyframe_index.h preselects by them.
// Method: Müller, Röder & Clausen, "Efficient Content-Based Retrieval of Motion Capture Data",
// SIGGRAPH 2005; Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.4.
//
//   for each feature
//     the number of bytes that follow for it
//     lengths of stretches that are by turns 0 and 1, beginning with 0: the first may be empty, and
//     the last is left out, as it reaches to the end of the recording
//
// Numbers are written seven bits a byte, the lowest first; all bytes of a number but its last have
// the highest bit set.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/features/feature_matrix.h"
#include "kinebase/search/feature_index.h"

namespace kinebase {

// Cost  O(columns + changes of features); the result is about a byte or two for each change, and
//       one for each feature.
[[nodiscard]] std::string FormatRunLists(const FeatureView& recording);

// Lists of one recording, where they lie.
class RunLists {
 public:
  // bytes    Valid as long as the object lives.
  // Errors   MalformedFile: lists that are cut off, or followed by other bytes. What is in them is
  //          only looked at when it is asked for.
  // Cost     O(features).
  RunLists(std::string_view bytes, int feature_count, int column_count);

  [[nodiscard]] int column_count() const { return column_count_; }

  // By place; stretches are as long as can be. The same as a FeatureIndex finds.
  //
  // pattern    Tests no others than these features.
  // recording  What the stretches say.
  // Errors     MalformedFile for lists of tested features that are of no such recording.
  // Cost       O(changes of the tested features); where misses are allowed, times their logarithm.
  [[nodiscard]] std::vector<Stretch> Find(const FeaturePattern& pattern, int recording) const;

 private:
  [[nodiscard]] std::vector<Stretch> FindExactly(const FeaturePattern& pattern,
                                                 int recording) const;
  [[nodiscard]] std::vector<Stretch> FindNearly(const FeaturePattern& pattern, int recording) const;

  std::vector<std::string_view> lists_;  // [feature]
  int column_count_;
};

}  // namespace kinebase
