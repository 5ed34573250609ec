// What an evaluation says beyond single figures: precision over recall, and which class is taken
// for which.
//
// Read library/evaluation.h first; pictures/evaluation_picture.h draws both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinebase/library/evaluation.h"

namespace kinebase {

// Recalls of 0, .01 … 1.
inline constexpr std::size_t kRecallLevels = 101;

// For each recall level the highest precision with that recall or more, 0 where the ranking never
// gets there. Lenient: excused hits do not count.
//
// hits      Best first.
// relevant  Clips of the class in the stream; at least 1.
[[nodiscard]] std::vector<double> InterpolatedPrecision(std::span<const JudgedHit> hits,
                                                        std::size_t relevant);

// Mean over the actors, level by level; empty for a class that nobody was tested on.
[[nodiscard]] std::vector<double> MeanPrecision(const ClassResult& result);
// Mean over actors, then over classes.
[[nodiscard]] std::vector<double> MacroPrecision(const MethodResult& result);

// Which class clips were taken for.
struct Confusion {
  std::vector<std::string> classes;               // Of the method, in its order.
  std::vector<std::vector<std::int64_t>> counts;  // [class][taken for], the last column for none.

  [[nodiscard]] std::int64_t right() const;  // On the diagonal.
  [[nodiscard]] std::int64_t all() const;
};
[[nodiscard]] Confusion CountConfusion(const MethodResult& result);

}  // namespace kinebase
