// Why a stretch of a recording matches a template: the warping path, and along it which features
// were as the template asks and which were not.
//
// Read search/subsequence_dtw.h first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinebase/search/subsequence_dtw.h"

namespace kinebase {

// One cell of the path. Bit i stands for feature i; free ones are in neither word.
struct ExplainedCell {
  PathCell cell;
  std::uint64_t agreed = 0;
  std::uint64_t disagreed = 0;
  // What one of the features that disagree adds to the cost of the hit. So Δ is the sum of
  // popcount(disagreed) · cost_of_one over the path, but for rounding.
  double cost_of_one = 0;

  friend bool operator==(const ExplainedCell&, const ExplainedCell&) = default;
};

// The path behind delta[last], as TracePath; empty if none ends there.
// Cost  That of TracePath.
[[nodiscard]] std::vector<ExplainedCell> ExplainPath(const QuantizedTemplate& motion_template,
                                                     std::span<const std::uint64_t> columns,
                                                     int last);

}  // namespace kinebase
