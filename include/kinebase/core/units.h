// Conversions into the units that are used inside: centimetres and radians.
#pragma once

#include <numbers>

namespace kinebase {

inline constexpr double kCentimetresPerInch = 2.54;
inline constexpr double kRadiansPerDegree = std::numbers::pi / 180;

}  // namespace kinebase
