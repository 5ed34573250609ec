// Where a threshold lies between right and wrong hits, and how sure a hit is. Internal.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "kinebase/templates/calibration.h"

namespace kinebase::internal {

// From right to wrong marks: a library has much more motion to go wrong in than what is known, and
// those who mark do not reach all that costs little.
inline constexpr double kThresholdShare = 1.0 / 3;
// Of the confidence between them: it falls from .99 to .01 where it is ½ half way, and from .97 to
// .001 where it is ½ after a third.
inline constexpr double kSteepness = 10;

inline double ThresholdBetween(double right, double wrong) {
  return right + kThresholdShare * (wrong - right);
}

// ½ at τ.
inline Calibration CalibrationAt(double tau, double slope) {
  return {.slope = slope, .offset = -slope * tau};
}

inline std::optional<double> Median(std::vector<double> costs) {
  if (costs.empty()) return std::nullopt;
  std::ranges::sort(costs);
  return (costs[(costs.size() - 1) / 2] + costs[costs.size() / 2]) / 2;
}

}  // namespace kinebase::internal
