// Cuts frames out of rows of values.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase::internal {

// Errors  InvalidArgument if the range is empty or leaves the frames.
inline void CheckCut(std::int64_t first, std::int64_t last, std::int64_t frames) {
  if (first >= 0 && last >= first && last < frames) return;
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("frames {} to {} of {} cannot be cut out", first, last, frames));
}

// The rows first … last. What is missing (no finite number) stays so, but not in the first row:
// readers fill a gap from the frame before, at the start from the first that has the value, and
// those frames may not be in the cut. So it gets that value here.
inline std::vector<double> CutRows(const std::vector<double>& values, std::size_t columns,
                                   std::int64_t first, std::int64_t last) {
  const auto step = static_cast<std::ptrdiff_t>(columns);
  std::vector<double> cut(values.begin() + first * step, values.begin() + (last + 1) * step);
  for (std::size_t column = 0; column < columns; ++column) {
    std::size_t known = static_cast<std::size_t>(first) * columns + column;
    while (!std::isfinite(values[known]) && known >= columns) known -= columns;
    while (!std::isfinite(values[known]) && known + columns < values.size()) known += columns;
    cut[column] = values[known];
  }
  return cut;
}

}  // namespace kinebase::internal
