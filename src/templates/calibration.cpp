#include "kinebase/templates/calibration.h"

#include <cmath>

namespace kinebase {

double Confidence(const Calibration& calibration, double cost) {
  const double x = calibration.slope * cost + calibration.offset;
  return x > 0 ? std::exp(-x) / (1 + std::exp(-x)) : 1 / (1 + std::exp(x));
}

double CostAt(const Calibration& calibration, double confidence) {
  return (std::log((1 - confidence) / confidence) - calibration.offset) / calibration.slope;
}

Calibration HalfAt(double cost, double slope) { return {.slope = slope, .offset = -slope * cost}; }

}  // namespace kinebase
