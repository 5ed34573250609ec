#include "pictures/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinebase::internal {
namespace {

constexpr double kLeastGap = 10;  // Pixels between two labels.

std::vector<Tick> TicksEvery(int mantissa, int exponent, double last,
                             const std::function<double(double)>& place) {
  const double unit = std::pow(10.0, exponent);
  std::vector<Tick> ticks;
  for (int i = 0;; i += mantissa) {
    const double value = i * unit;
    // The last tick must not get lost by rounding.
    if (value > last * (1 + 1e-9)) return ticks;
    ticks.push_back({place(value), fmt::format("{:.{}f}", value, std::max(0, -exponent))});
  }
}

bool FitAcross(const std::vector<Tick>& ticks, const TextStyle& style) {
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const double half_widths =
        (TextWidth(ticks[i - 1].label, style) + TextWidth(ticks[i].label, style)) / 2;
    if (ticks[i].at - ticks[i - 1].at < half_widths + kLeastGap) return false;
  }
  return true;
}

bool FitUp(const std::vector<Tick>& ticks, const TextStyle& style) {
  return ticks.size() < 2 || ticks[0].at - ticks[1].at >= style.size + kLeastGap;
}

template <typename Fit>
std::vector<Tick> DensestTicks(double last, double least_step,
                               const std::function<double(double)>& place, Fit fit) {
  // More than some 400 labels never fit, so finer steps need no try.
  const double finest = std::max(least_step, last / 400);
  int exponent = static_cast<int>(std::floor(std::log10(finest)));
  for (;; ++exponent) {
    for (const int mantissa : {1, 2, 5}) {
      if (mantissa * std::pow(10.0, exponent) < finest * (1 - 1e-9)) continue;
      std::vector<Tick> ticks = TicksEvery(mantissa, exponent, last, place);
      if (fit(ticks)) return ticks;
    }
  }
}

}  // namespace

std::vector<Tick> RoundTicks(double last, double least_step, const TextStyle& style,
                             const std::function<double(double)>& place) {
  return DensestTicks(last, least_step, place,
                      [&](const std::vector<Tick>& ticks) { return FitAcross(ticks, style); });
}

std::vector<Tick> RoundTicksUp(double last, double least_step, const TextStyle& style,
                               const std::function<double(double)>& place) {
  return DensestTicks(last, least_step, place,
                      [&](const std::vector<Tick>& ticks) { return FitUp(ticks, style); });
}

}  // namespace kinebase::internal
