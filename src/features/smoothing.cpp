#include "kinebase/features/smoothing.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace kinebase {

std::ptrdiff_t ReflectedSample(std::ptrdiff_t index, std::ptrdiff_t count) {
  const std::ptrdiff_t period = 2 * count;
  const std::ptrdiff_t wrapped = ((index % period) + period) % period;
  return wrapped < count ? wrapped : period - 1 - wrapped;
}

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
        signal[static_cast<std::size_t>(ReflectedSample(i - before, count))];
  }
  std::vector<double> out(signal.size());
  BoxFilterPadded(padded, width, out);
  return out;
}

void BoxFilterPadded(std::span<const double> padded, int width, std::span<double> out) {
  // A sum for each sample anew, not a running one: no error builds up along a long take. Several
  // samples side by side keep their sums in registers.
  constexpr std::size_t kSideBySide = 8;
  using Some = Eigen::Array<double, kSideBySide, 1>;
  const auto count = static_cast<std::size_t>(width);
  std::size_t t = 0;
  for (; t + kSideBySide <= out.size(); t += kSideBySide) {
    Some sums = Some::Zero();
    for (std::size_t k = 0; k < count; ++k) sums += Eigen::Map<const Some>(&padded[t + k]);
    Eigen::Map<Some> means(&out[t]);
    means = sums / width;
  }
  for (; t < out.size(); ++t) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += padded[t + k];
    out[t] = sum / width;
  }
}

}  // namespace kinebase
