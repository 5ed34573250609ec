#include "templates/alignment.h"

#include <algorithm>
#include <limits>

#include "templates/distance_kernel.h"

namespace kinebase::internal {
namespace {

constexpr double kUnreachable = std::numeric_limits<double>::infinity();

// Walks back from the last columns. `cost(reference, other)` gives accumulated costs.
template <typename Cost>
Alignment TraceBack(int reference_columns, int other_columns, const Cost& cost) {
  int reference = reference_columns - 1;
  int other = other_columns - 1;
  Alignment alignment;
  alignment.cost = cost(reference, other);
  alignment.path.reserve(static_cast<std::size_t>(reference_columns) + other_columns);
  alignment.path.push_back({reference, other});
  while (reference > 0 || other > 0) {
    const double diagonal =
        reference > 0 && other > 0 ? cost(reference - 1, other - 1) : kUnreachable;
    const double along_other = other > 0 ? cost(reference, other - 1) : kUnreachable;
    const double along_reference = reference > 0 ? cost(reference - 1, other) : kUnreachable;
    if (diagonal <= along_other && diagonal <= along_reference) {
      --reference;
      --other;
    } else if (along_other <= along_reference) {
      --other;
    } else {
      --reference;
    }
    alignment.path.push_back({reference, other});
  }
  std::ranges::reverse(alignment.path);
  return alignment;
}

}  // namespace

FeatureRows::FeatureRows(const TemplateMatrix& matrix)
    : stride_((matrix.weights.size() + kBlock - 1) / kBlock * kBlock),
      values_(stride_ * matrix.feature_count),
      constants_(matrix.feature_count, std::numeric_limits<double>::quiet_NaN()),
      weights_(matrix.weights) {
  weights_.resize(stride_);
  for (int feature = 0; feature < matrix.feature_count; ++feature) {
    double* row = values_.data() + stride_ * feature;
    for (int c = 0; c < matrix.column_count(); ++c) row[c] = matrix.Column(c)[feature];
    const std::span<const double> columns(row, matrix.weights.size());
    if (std::ranges::count(columns, row[0]) == std::ssize(columns)) constants_[feature] = row[0];
  }
}

void PairAlignment::FillLocalCosts(std::span<const double> column, double weight,
                                   const FeatureRows& second, Profile profile, double* row) {
  // A feature that has this column's value everywhere in the other matrix adds +0 to every sum,
  // which changes no bit.
  features_.resize(column.size());
  std::size_t count = 0;
  for (int feature = 0; feature < std::ssize(column); ++feature) {
    // Without a branch: which features differ is hard to predict.
    features_[count] = feature;
    count += second.Constant(feature) != column[feature] ? 1 : 0;
  }
  SumDistances(column, std::span(features_).first(count), second.Row(0), stride_, row);
  if (profile == Profile::kPaper) return;
  WeighDistances(static_cast<double>(column.size()), weight, second.weights(), stride_, row);
}

void PairAlignment::Compute(const TemplateMatrix& first, const TemplateMatrix& second,
                            const FeatureRows& second_rows, Profile profile) {
  first_columns_ = first.column_count();
  second_columns_ = second.column_count();
  stride_ = second_rows.stride();
  costs_.resize(stride_ * first.weights.size());
  nearest_.resize(stride_);
  for (int i = 0; i < first_columns_; ++i) {
    double* row = costs_.data() + stride_ * i;
    FillLocalCosts(first.Column(i), first.weights[i], second_rows, profile, row);
    if (i == 0) {
      for (int j = 1; j < second_columns_; ++j) row[j] += row[j - 1];
      continue;
    }
    // Only the minimum with the left neighbour has to wait for it.
    const double* above = row - stride_;
    for (int j = 1; j < second_columns_; ++j) nearest_[j] = std::min(above[j - 1], above[j]);
    double left = row[0] += above[0];
    for (int j = 1; j < second_columns_; ++j) row[j] = left = std::min(nearest_[j], left) + row[j];
  }
}

Alignment PairAlignment::WithFirstAsReference() const {
  return TraceBack(first_columns_, second_columns_,
                   [this](int reference, int other) { return At(reference, other); });
}

Alignment PairAlignment::WithSecondAsReference() const {
  return TraceBack(second_columns_, first_columns_,
                   [this](int reference, int other) { return At(other, reference); });
}

}  // namespace kinebase::internal
