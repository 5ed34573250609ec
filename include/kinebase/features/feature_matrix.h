// The 0/1 matrix that stands for a recording from here on: one word a frame.
#pragma once

#include <cstdint>
#include <vector>

namespace kinebase {

struct FeatureMatrix {
  double rate_hz = 0;
  int feature_count = 0;
  std::vector<std::uint64_t> columns;  // [column]; bit i = feature i. Bits ≥ feature_count are 0.

  [[nodiscard]] int column_count() const { return static_cast<int>(columns.size()); }
  [[nodiscard]] bool at(int column, int feature) const {
    return ((columns[column] >> feature) & 1U) != 0;
  }
};

}  // namespace kinebase
