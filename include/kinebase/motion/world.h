// Units and axes of files, and the way from them to the one world inside: centimetres, Y up,
// right-handed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

namespace kinebase {

// Units to write in.
inline constexpr std::array<std::string_view, 5> kLengthUnits = {"mm", "cm", "m", "inch", "ft"};

// The unit of CMU's and HDM05's skeletons; conversions of them to other formats kept the numbers.
inline constexpr std::string_view kAcclaimUnit = "inch / 0.45";

// Units that files come in.
inline constexpr std::array<std::string_view, 6> kSourceUnits = {"mm",   "cm", "m",
                                                                 "inch", "ft", kAcclaimUnit};

enum class UpAxis { kX, kY, kZ };

[[nodiscard]] std::optional<UpAxis> ParseUpAxis(std::string_view text);  // "y", "Z" …
[[nodiscard]] std::string_view ToString(UpAxis up);                      // "X", "Y", "Z".

// The rotation that takes a vector of a world with this axis up to Y up. Axes are exchanged in
// turn: with Z up, (x, y, z) becomes (y, z, x), with X up (z, x, y). So the C3D and the AMC of one
// HDM05 or CMU take lie in the same place. The transpose leads back.
[[nodiscard]] Eigen::Matrix3d ToYUp(UpAxis up);

// Centimetres in a unit of length: "mm", "cm", "m", "inch" ("in"), "ft", in any case; a plural or
// the long name too ("millimeters", "metres"); or in a part of one, as kAcclaimUnit. Empty for
// others.
[[nodiscard]] std::optional<double> CentimetresIn(std::string_view unit);

// The same. Errors  InvalidArgument, naming `file` and the known ones, for others.
[[nodiscard]] double CentimetresInOrFail(std::string_view unit,
                                         const std::filesystem::path& file = {});

}  // namespace kinebase
