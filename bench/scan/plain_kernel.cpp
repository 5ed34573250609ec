#include "plain_kernel.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace kinebase {

std::vector<double> PlainDelta(std::span<const std::uint64_t> template_columns,
                               std::span<const std::uint64_t> columns, int features) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::size_t kPad = 2;  // Columns before the first, which no path reaches.
  const double scale = 1.0 / features;
  const std::size_t count = columns.size();
  std::vector<double> row(count + kPad, kInfinity);
  std::vector<double> before = row;
  std::vector<double> before_that = row;
  for (std::size_t k = 0; k < template_columns.size(); ++k) {
    const std::uint64_t word = template_columns[k];
    const double* one = before.data();  // Column l − 2, as is the next.
    const double* two = before_that.data();
    double* out = row.data() + kPad;
    if (k == 0) {
      for (std::size_t l = 0; l < count; ++l) out[l] = scale * std::popcount(word ^ columns[l]);
    } else {
      for (std::size_t l = 0; l < count; ++l) {
        const double nearest = std::min(std::min(one[l + 1], one[l]), two[l + 1]);
        out[l] = nearest + scale * std::popcount(word ^ columns[l]);
      }
    }
    std::swap(before_that, before);
    std::swap(before, row);
  }
  std::vector<double> delta(before.begin() + kPad, before.end());
  for (double& value : delta) value /= static_cast<double>(template_columns.size());
  return delta;
}

}  // namespace kinebase
