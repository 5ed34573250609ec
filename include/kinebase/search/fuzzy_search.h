// Fuzzy retrieval: what a recording shows in order, by features that somebody selects, however long
// each of it lasts.
//
// Reduced to the selected features, a recording is a sequence of segments: runs of equal columns. A
// query is a sequence of elements, each a set of admissible feature vectors. A hit is a row of
// segments that the elements admit in order. An element may have several segments, and neighbours
// that both admit a segment may share it.
// Read search/feature_index.h first.
// Method: Müller, Röder & Clausen, "Efficient Content-Based Retrieval of Motion Capture Data",
// SIGGRAPH 2005, which Müller & Röder, SCA 2006, Sect. 5.5, compare with.
// How overlapping elements and faults are treated: docs/design/fuzzy.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kinebase/features/feature_matrix.h"
#include "kinebase/search/feature_index.h"
#include "kinebase/search/hits.h"
#include "kinebase/templates/quantized_template.h"

namespace kinebase {

struct FuzzyElement {
  std::vector<FeaturePattern> patterns;  // Admitted is what one of them admits.

  friend bool operator==(const FuzzyElement&, const FuzzyElement&) = default;
};

struct FuzzyQuery {
  std::uint64_t features = 0;  // Bit i: feature i is selected; patterns test no others.
  std::vector<FuzzyElement> elements;
};

// The segments of an example, each an element that admits itself only.
// Errors  InvalidArgument if nothing is selected or the example has no columns.
[[nodiscard]] FuzzyQuery MakeFuzzyQuery(const FeatureMatrix& example, std::uint64_t features);

// The segments of a template: an element admits what agrees with its consistent entries. Columns
// that leave all selected features free are dropped at both ends, and admit anything between.
// Errors  InvalidArgument if nothing is selected, or all of it is free everywhere.
[[nodiscard]] FuzzyQuery MakeFuzzyQuery(const QuantizedTemplate& motion_template,
                                        std::uint64_t features);

struct FuzzyOptions {
  // How much may be amiss: elements that are left out, and segments between the first and the last
  // of a hit that belong to no element. Fewer than there are elements.
  int faults = 0;
  std::size_t most_hits = 500;
};

// Hits, best first: their cost is faults / elements. A hit begins as late and ends as early as it
// can with as few faults; of hits that overlap in a recording the one with the fewest faults stays,
// then the shortest, then the first.
//
// Errors  InvalidArgument: no elements, as many faults as elements, patterns that test features
//         that are not selected.
// Cost    O(segments · elements · faults²) for recordings that show enough of the elements; others
//         are passed over by the inverted lists.
[[nodiscard]] std::vector<Hit> SearchFuzzy(const FuzzyQuery& query,
                                           std::span<const FeatureView> recordings,
                                           const FuzzyOptions& options = {});
[[nodiscard]] std::vector<Hit> SearchFuzzy(const FuzzyQuery& query,
                                           std::span<const FeatureMatrix> recordings,
                                           const FuzzyOptions& options = {});

}  // namespace kinebase
