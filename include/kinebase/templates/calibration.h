// From costs to probabilities: how often a hit of this cost is right. library/class_learning.h says
// where the numbers come from.
#pragma once

#include "kinebase/templates/motion_template.h"

namespace kinebase {

// A hit of which it is known whether it is right.
struct KnownHit {
  double cost = 0;
  bool right = false;

  friend bool operator==(const KnownHit&, const KnownHit&) = default;
};

// 1 / (1 + exp(slope · cost + offset)), in [0, 1].
[[nodiscard]] double Confidence(const Calibration& calibration, double cost);

// The cost of which Confidence is `confidence`: the threshold of who wants to be that sure. Below 0
// where no hit is as sure as that.
// confidence  Above 0 and below 1.
[[nodiscard]] double CostAt(const Calibration& calibration, double confidence);

// ½ at a cost, such as a threshold.
[[nodiscard]] Calibration HalfAt(double cost, double slope);

}  // namespace kinebase
