// The 0/1 matrix that stands for a recording from here on: one word a frame.
#pragma once

#include <cstdint>
#include <span>
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

// The same where it lies, in a FeatureMatrix or in a mapped file: what searches takes views, so
// that nothing is copied. Valid as long as the words are.
struct FeatureView {
  double rate_hz = 0;
  int feature_count = 0;
  std::span<const std::uint64_t> columns;

  FeatureView() = default;
  FeatureView(double rate, int count, std::span<const std::uint64_t> words)
      : rate_hz(rate), feature_count(count), columns(words) {}
  FeatureView(const FeatureMatrix& matrix)  // NOLINT(google-explicit-constructor)
      : FeatureView(matrix.rate_hz, matrix.feature_count, matrix.columns) {}

  [[nodiscard]] int column_count() const { return static_cast<int>(columns.size()); }
  [[nodiscard]] bool at(int column, int feature) const {
    return ((columns[static_cast<std::size_t>(column)] >> feature) & 1U) != 0;
  }
};

// [recording]
[[nodiscard]] inline std::vector<FeatureView> ViewsOf(std::span<const FeatureMatrix> recordings) {
  return {recordings.begin(), recordings.end()};
}

}  // namespace kinebase
