// Classical DTW for learning, both ways of a pair at once.
//
// Read templates/learning.h first.
// Method: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 4.1 and 5.1.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kinebase/templates/learning.h"

namespace kinebase::internal {

// A matrix laid out for comparing one column with many: one run of columns for each feature, padded
// with zeros so that whole blocks can be read.
class FeatureRows {
 public:
  static constexpr std::size_t kBlock = 8;  // Columns.

  explicit FeatureRows(const TemplateMatrix& matrix);

  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] const double* Row(int feature) const { return values_.data() + stride_ * feature; }
  // The value that a feature has in all columns; NaN if they differ.
  [[nodiscard]] double Constant(int feature) const { return constants_[feature]; }
  [[nodiscard]] const double* weights() const { return weights_.data(); }  // [stride]

 private:
  std::size_t stride_;
  std::vector<double> values_;  // [feature × stride]
  std::vector<double> constants_;
  std::vector<double> weights_;
};

// Costs of the best alignments of all beginnings of two matrices.
//
// The accumulated costs do not depend on which of the two is the reference, bit for bit: |a − b|,
// the mean of two weights and the least of three are all symmetric. Only ties are settled
// differently on the way back; so one table serves both directions.
// Reuse one object for many pairs: it keeps its memory.
class PairAlignment {
 public:
  void Compute(const TemplateMatrix& first, const TemplateMatrix& second,
               const FeatureRows& second_rows, Profile profile);

  [[nodiscard]] Alignment WithFirstAsReference() const;
  [[nodiscard]] Alignment WithSecondAsReference() const;

 private:
  void FillLocalCosts(std::span<const double> column, double weight, const FeatureRows& second,
                      Profile profile, double* row);
  [[nodiscard]] double At(int first, int second) const { return costs_[stride_ * first + second]; }

  int first_columns_ = 0;
  int second_columns_ = 0;
  std::size_t stride_ = 0;
  std::vector<int> features_;    // Those that can differ from the column at hand.
  std::vector<double> costs_;    // [first column × stride] accumulated.
  std::vector<double> nearest_;  // [second column] lesser of the two predecessors in the row above.
};

}  // namespace kinebase::internal
