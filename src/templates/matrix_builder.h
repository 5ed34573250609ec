// Makes a template matrix column by column.
#pragma once

#include <span>
#include <vector>

#include "kinebase/templates/motion_template.h"

namespace kinebase::internal {

// Weighted mean of columns that are added one after the other, in plain sums.
class ColumnMean {
 public:
  explicit ColumnMean(int feature_count) : sums_(feature_count) {}

  void Add(std::span<const double> values, double weight) {
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += values[i] * weight;
    weight_ += weight;
  }

  [[nodiscard]] double weight() const { return weight_; }

  // Values stay within 0 and 1: rounding is monotone, so no weighted sum exceeds the sum of weights
  // that is added up in the same order.
  void AppendTo(TemplateMatrix& matrix) const {
    const std::size_t first = matrix.values.size();
    matrix.values.resize(first + sums_.size());
    for (std::size_t i = 0; i < sums_.size(); ++i) matrix.values[first + i] = sums_[i] / weight_;
    matrix.weights.push_back(weight_);
  }

  void Clear() {
    sums_.assign(sums_.size(), 0.0);
    weight_ = 0;
  }

 private:
  std::vector<double> sums_;
  double weight_ = 0;
};

[[nodiscard]] inline TemplateMatrix EmptyLike(const TemplateMatrix& matrix) {
  return {.rate_hz = matrix.rate_hz,
          .feature_count = matrix.feature_count,
          .values = {},
          .weights = {}};
}

inline void AppendColumn(TemplateMatrix& matrix, std::span<const double> values, double weight) {
  matrix.values.insert(matrix.values.end(), values.begin(), values.end());
  matrix.weights.push_back(weight);
}

inline void DropLastColumn(TemplateMatrix& matrix) {
  matrix.weights.pop_back();
  matrix.values.resize(matrix.values.size() - matrix.feature_count);
}

}  // namespace kinebase::internal
