// Where a threshold lies between right and wrong hits, and how sure a hit is. Internal.
#pragma once

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

namespace kinebase::internal {

// Of the confidence between them: it falls from .99 to .01.
inline constexpr double kSteepness = 10;

// Half way from right to wrong hits.
inline double ThresholdBetween(double right, double wrong) { return std::midpoint(right, wrong); }

inline std::optional<double> Median(std::vector<double> costs) {
  if (costs.empty()) return std::nullopt;
  std::ranges::sort(costs);
  return (costs[(costs.size() - 1) / 2] + costs[costs.size() / 2]) / 2;
}

}  // namespace kinebase::internal
