// Ticks with round numbers. Internal.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kinebase/pictures/canvas.h"

namespace kinebase::internal {

struct Tick {
  double at = 0;  // Pixels along the axis.
  std::string label;
};

// As many ticks as fit at multiples of 1, 2 or 5 times a power of ten, from 0.
//
// last        Largest value on the axis.
// least_step  No finer steps than this: 1 for things that are counted.
// place       Pixels of a value; grows with it.
[[nodiscard]] std::vector<Tick> RoundTicks(double last, double least_step, const TextStyle& style,
                                           const std::function<double(double)>& place);

// The same for an axis that goes up: `place` shrinks as the value grows, labels stand one above the
// other.
[[nodiscard]] std::vector<Tick> RoundTicksUp(double last, double least_step, const TextStyle& style,
                                             const std::function<double(double)>& place);

}  // namespace kinebase::internal
