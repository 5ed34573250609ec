// What a cell of the cost table costs, for templates with and without entry weights.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kinebase/templates/quantized_template.h"

namespace kinebase::internal {

// Weights are looked up eight features at a time: a table says what each set of eight that disagree
// costs together. So the sum has one order everywhere.
class LocalCosts {
 public:
  explicit LocalCosts(const QuantizedTemplate& motion_template)
      : columns_(motion_template.columns),
        bytes_((static_cast<std::size_t>(motion_template.feature_count) + 7) / 8) {
    if (!motion_template.costs.empty()) FillTables(motion_template);
  }

  [[nodiscard]] bool has_weights() const { return !tables_.empty(); }

  [[nodiscard]] std::uint64_t Disagreeing(std::size_t column, std::uint64_t features) const {
    return (features ^ columns_[column].ones) & columns_[column].consistent;
  }

  // column  Of the template.
  [[nodiscard]] double Of(std::size_t column, std::uint64_t disagreeing) const {
    if (!has_weights()) return std::popcount(disagreeing) * columns_[column].scale;
    double cost = 0;
    const double* table = tables_.data() + column * bytes_ * kSets;
    for (std::size_t byte = 0; byte < bytes_; ++byte, table += kSets) {
      cost += table[(disagreeing >> (8 * byte)) & 0xFF];
    }
    return cost;
  }

  [[nodiscard]] double At(std::size_t column, std::uint64_t features) const {
    return Of(column, Disagreeing(column, features));
  }

 private:
  static constexpr std::size_t kSets = 256;

  void FillTables(const QuantizedTemplate& motion_template) {
    tables_.resize(columns_.size() * bytes_ * kSets);
    const auto features = static_cast<std::size_t>(motion_template.feature_count);
    for (std::size_t column = 0; column < columns_.size(); ++column) {
      for (std::size_t byte = 0; byte < bytes_; ++byte) {
        double* table = tables_.data() + (column * bytes_ + byte) * kSets;
        for (std::size_t set = 1; set < kSets; ++set) {
          // That of the set without its first feature, and the first feature's.
          const auto first = static_cast<std::size_t>(std::countr_zero(set));
          const std::size_t feature = 8 * byte + first;
          const double cost =
              feature < features ? motion_template.costs[column * features + feature] : 0;
          table[set] = table[set & (set - 1)] + cost;
        }
      }
    }
  }

  std::vector<QuantizedColumn> columns_;
  std::size_t bytes_;           // Of a feature word that are used.
  std::vector<double> tables_;  // [column × byte × set of disagreeing features]
};

}  // namespace kinebase::internal
