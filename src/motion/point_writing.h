// What the readers and writers of markers share.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/formats/mnm.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase::internal {

// To 1e-6 of a unit: a nanometre where the unit is a millimetre. Beyond any measurement, and the
// shortest text stays short after a change of units.
inline double RoundedPlace(double value, double digits = 1e6) {
  constexpr double kExactIntegers = 9007199254740992;  // 2^53
  const double scaled = value * digits;
  return std::abs(scaled) < kExactIntegers ? std::round(scaled) / digits : value;
}

// Labels as a format can hold them: those bytes become '_' or, where blanks are fine, a blank;
// empty ones are numbered, repeated ones too.
// diagnostics  How many changed, and an example.
std::vector<std::string> WritableLabels(std::span<const std::string> labels,
                                        std::string_view forbidden, char replacement,
                                        Diagnostics& diagnostics);

// The names of an MNM file. What is odd about it goes to `diagnostics` under the file's name.
MarkerNames ReadMarkerNames(const std::filesystem::path& path, bool strict,
                            Diagnostics& diagnostics);

// diagnostics  How many samples a format without such marks writes as if they were measured.
void ReportFilledSamples(const MarkerCloud& markers, std::string_view format,
                         Diagnostics& diagnostics);

// Errors  Mismatch for more frames than a MarkerCloud counts.
int FrameCountOrFail(std::size_t count);

}  // namespace kinebase::internal
