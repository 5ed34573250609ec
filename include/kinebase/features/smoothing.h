// Velocities as the features use them.
#pragma once

#include <span>
#include <vector>

namespace kinebase {

// Mean over a box of `width` samples: out(t) = mean of x(t+1−P) … x(t+width−P), P = ⌈width/2⌉, the
// signal continued by reflection that repeats the border sample (x(−1) = x(0)).
[[nodiscard]] std::vector<double> BoxFilter(std::span<const double> signal, int width);

// Samples in a window: max(1, ⌈ms · rate / 1000⌉).
[[nodiscard]] int BoxWidth(double window_ms, double rate_hz);

}  // namespace kinebase
