#include "kinebase/features/smoothing.h"

#include <algorithm>
#include <cmath>

namespace kinebase {
namespace {

// Index of a sample in a signal that is reflected at its ends, border samples repeated.
std::ptrdiff_t Reflected(std::ptrdiff_t index, std::ptrdiff_t count) {
  const std::ptrdiff_t period = 2 * count;
  const std::ptrdiff_t wrapped = ((index % period) + period) % period;
  return wrapped < count ? wrapped : period - 1 - wrapped;
}

}  // namespace

int BoxWidth(double window_ms, double rate_hz) {
  return std::max(1, static_cast<int>(std::ceil(window_ms * rate_hz / 1000)));
}

std::vector<double> BoxFilter(std::span<const double> signal, int width) {
  const auto count = static_cast<std::ptrdiff_t>(signal.size());
  if (width <= 1 || count == 0) return {signal.begin(), signal.end()};
  const std::ptrdiff_t before = (width + 1) / 2 - 1;  // P − 1 samples on the left.
  std::vector<double> padded(signal.size() + static_cast<std::size_t>(width) - 1);
  for (std::ptrdiff_t i = 0; i < std::ssize(padded); ++i) {
    padded[static_cast<std::size_t>(i)] =
        signal[static_cast<std::size_t>(Reflected(i - before, count))];
  }
  // A sum for each sample anew, not a running one: no error builds up along a long take, and the
  // loop over samples is the inner one, which vectorises.
  std::vector<double> out(signal.size(), 0.0);
  for (std::size_t k = 0; k < static_cast<std::size_t>(width); ++k) {
    for (std::size_t t = 0; t < out.size(); ++t) out[t] += padded[t + k];
  }
  for (double& value : out) value /= width;
  return out;
}

}  // namespace kinebase
