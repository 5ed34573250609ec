// Velocities as the features use them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kinebase {

// Mean over a box of `width` samples: out(t) = mean of x(t+1−P) … x(t+width−P), P = ⌈width/2⌉, the
// signal continued by reflection that repeats the border sample (x(−1) = x(0)).
[[nodiscard]] std::vector<double> BoxFilter(std::span<const double> signal, int width);

// The same where the signal goes on on both sides: P − 1 samples before the first of `out`, and
// width − P after the last.
//
// padded  out.size() + width − 1 samples.
void BoxFilterPadded(std::span<const double> padded, int width, std::span<double> out);

// The sample that stands for one before the first or after the last: 0 for −1.
[[nodiscard]] std::ptrdiff_t ReflectedSample(std::ptrdiff_t index, std::ptrdiff_t count);

// Samples in a window: max(1, ⌈ms · rate / 1000⌉).
[[nodiscard]] int BoxWidth(double window_ms, double rate_hz);

}  // namespace kinebase
