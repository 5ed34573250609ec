// Units and axes of files, and the way from them to the one world inside: centimetres, Y up,
// right-handed.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

namespace kinebase {

enum class UpAxis { kX, kY, kZ };

[[nodiscard]] std::optional<UpAxis> ParseUpAxis(std::string_view text);  // "y", "Z" …
[[nodiscard]] std::string_view ToString(UpAxis up);                      // "X", "Y", "Z".

// The rotation that takes a vector of a world with this axis up to Y up. Axes are exchanged in
// turn: with Z up, (x, y, z) becomes (y, z, x), with X up (z, x, y). So the C3D and the AMC of one
// HDM05 or CMU take lie in the same place. The transpose leads back.
[[nodiscard]] Eigen::Matrix3d ToYUp(UpAxis up);

// Centimetres in a unit of length: "mm", "cm", "m", "inch" ("in"), "ft", in any case; a plural or
// the long name too ("millimeters", "metres"). Empty for others.
[[nodiscard]] std::optional<double> CentimetresIn(std::string_view unit);

}  // namespace kinebase
