// The inner loop of learning: one column against all columns of another matrix.
#pragma once

#include <cstddef>
#include <span>

namespace kinebase::internal {

// sums[c] = Σ |values[feature] − rows[feature · stride + c]| over `features`, added in their order,
// the same bits on every instruction set.
//
// values   [feature]
// rows     [feature × stride]; aligned like any double.
// stride   A multiple of 8.
// sums     [stride], out.
void SumDistances(std::span<const double> values, std::span<const int> features, const double* rows,
                  std::size_t stride, double* sums);

// costs[c] = costs[c] / feature_count · ((weight + weights[c]) / 2), in this order.
//
// weights, costs  [stride]
void WeighDistances(double feature_count, double weight, const double* weights, std::size_t stride,
                    double* costs);

}  // namespace kinebase::internal
