// From Δ curves to hits: distinct stretches of recordings, best first.
//
// Read search/subsequence_dtw.h first.
// Method: the authors' toolbox, which the tables of Müller & Röder (SCA 2006) were made with; the
// paper itself (Sect. 5.4) speaks of every local minimum below τ. docs/design/search.md.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kinebase/search/subsequence_dtw.h"

namespace kinebase {

struct Hit {
  int recording = 0;  // Index of the recording.
  int first = 0;      // Columns, 0-based, inclusive.
  int last = 0;
  double cost = 0;  // Δ at `last`.

  friend bool operator==(const Hit&, const Hit&) = default;
};

// Hits of one recording with cost ≤ tau, in the order in which they were found: best first.
//
// Repeats: take the smallest Δ (the first of equals). Unless its start is reserved it is a hit, and
// starts from ⌈length/10⌉ before to ⌈length/2⌉ after its start become reserved. Either way Δ is
// blanked from ⌈length/2⌉ before to ⌈length/10⌉ after its end, with the length of the hit that
// reserved the start.
// Cost  O(columns · log columns).
[[nodiscard]] std::vector<Hit> ExtractHits(const DeltaCurve& curve, double tau, int recording = 0);

// The best `most` of all, ordered by cost, then recording, then place.
[[nodiscard]] std::vector<Hit> BestHits(std::vector<Hit> hits, std::size_t most);

}  // namespace kinebase
