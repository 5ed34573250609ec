// The hit rule on the few columns that can be hits, for those who have no whole curve.
#pragma once

#include <cstdint>
#include <vector>

#include "kinebase/search/hits.h"

namespace kinebase::internal {

// A column where a path of cost ≤ τ ends.
struct Candidate {
  std::int32_t column = 0;
  std::int32_t start = 0;
  double cost = 0;
};

// Adds those of `delta` to `candidates`; `first_column` is the column of delta[0].
void AppendCandidates(std::span<const double> delta, std::span<const std::int32_t> start,
                      double tau, std::size_t first_column, std::vector<Candidate>& candidates);

// candidates  By column, all of one recording.
// Cost        O(candidates · log candidates), and what each hit reserves and blanks of them.
[[nodiscard]] std::vector<Hit> ExtractHits(std::vector<Candidate> candidates, int recording);

}  // namespace kinebase::internal
