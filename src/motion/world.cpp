#include "kinebase/motion/world.h"

#include <algorithm>
#include <array>
#include <initializer_list>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/core/units.h"

namespace kinebase {
namespace {

struct LengthUnit {
  double centimetres;
  std::initializer_list<std::string_view> names;
};

std::optional<double> CentimetresInWhole(std::string_view unit) {
  static const std::array<LengthUnit, 5> kUnits = {{
      {0.1, {"mm", "millimeter", "millimetre", "millimeters", "millimetres"}},
      {1, {"cm", "centimeter", "centimetre", "centimeters", "centimetres"}},
      {100, {"m", "meter", "metre", "meters", "metres"}},
      {kCentimetresPerInch, {"in", "inch", "inches"}},
      {12 * kCentimetresPerInch, {"ft", "foot", "feet"}},
  }};
  const std::string_view wanted = Trim(unit);
  for (const LengthUnit& known : kUnits) {
    if (std::ranges::any_of(
            known.names, [&](std::string_view name) { return EqualsIgnoringCase(wanted, name); })) {
      return known.centimetres;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<UpAxis> ParseUpAxis(std::string_view text) {
  if (EqualsIgnoringCase(text, "x")) return UpAxis::kX;
  if (EqualsIgnoringCase(text, "y")) return UpAxis::kY;
  if (EqualsIgnoringCase(text, "z")) return UpAxis::kZ;
  return std::nullopt;
}

std::string_view ToString(UpAxis up) {
  constexpr std::array<std::string_view, 3> kNames = {"X", "Y", "Z"};
  return kNames[static_cast<std::size_t>(up)];
}

Eigen::Matrix3d ToYUp(UpAxis up) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (up == UpAxis::kX) rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  if (up == UpAxis::kZ) rotation << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return rotation;
}

std::optional<double> CentimetresIn(std::string_view unit) {
  constexpr double kLargestDivisor = 1e9;
  const std::size_t slash = unit.find('/');
  const auto whole_cm = CentimetresInWhole(unit.substr(0, slash));
  if (slash == std::string_view::npos || !whole_cm) return whole_cm;
  const double divisor = ParseDouble(Trim(unit.substr(slash + 1))).value_or(0);
  if (!(divisor > 0 && divisor < kLargestDivisor)) return std::nullopt;
  return *whole_cm / divisor;
}

double CentimetresInOrFail(std::string_view unit, const std::filesystem::path& file) {
  if (const auto centimetres = CentimetresIn(unit)) return *centimetres;
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("unknown unit of length {}; known: {}, and parts of them such as '{}'",
                          Quoted(unit), fmt::join(kLengthUnits, ", "), kAcclaimUnit),
              {file});
}

}  // namespace kinebase
