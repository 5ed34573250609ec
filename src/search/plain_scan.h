// The subsequence DTW in plain C++, for any local cost: templates, examples, whatever is compared.
//
// Read search/subsequence_dtw.h first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "kinebase/search/subsequence_dtw.h"
#include "search/recurrence.h"

namespace kinebase::internal {

// One row of the cost table: [column of the recording].
struct PlainRow {
  explicit PlainRow(std::size_t columns) : cost(columns, kUnreachable), start(columns, -1) {}

  // The cell `back` columns before `column`.
  [[nodiscard]] double CostBefore(std::size_t column, std::size_t back) const {
    return column >= back ? cost[column - back] : kUnreachable;
  }

  std::vector<double> cost;
  std::vector<std::int32_t> start;
};

[[nodiscard]] inline std::int32_t StartBehind(Step step, const PlainRow& one_up,
                                              const PlainRow& two_up, std::size_t column) {
  switch (step) {
    case Step::kOneOne:
      return one_up.start[column - 1];
    case Step::kOneTwo:
      return one_up.start[column - 2];
    case Step::kTwoOne:
      return two_up.start[column - 1];
    case Step::kNone:
      break;
  }
  return -1;
}

// rows        Of the query; at least one.
// columns     Of the recording.
// local_cost  (row, column) → what the cell costs by itself; asked once a cell, row by row.
template <typename LocalCost>
[[nodiscard]] DeltaCurve ScanPlainly(int rows, std::size_t columns, Profile matching,
                                     const LocalCost& local_cost) {
  PlainRow two_up(columns);
  PlainRow one_up(columns);
  PlainRow row(columns);
  for (int k = 0; k < rows; ++k) {
    std::swap(two_up, one_up);
    std::swap(one_up, row);
    for (std::size_t l = 0; l < columns; ++l) {
      const double own_cost = local_cost(k, l);
      if (k == 0) {
        row.cost[l] = own_cost;
        row.start[l] = static_cast<std::int32_t>(l);
        continue;
      }
      double cost = 0;
      const Step step = ChooseStep({.one_one = one_up.CostBefore(l, 1),
                                    .one_two = one_up.CostBefore(l, 2),
                                    .two_one = two_up.CostBefore(l, 1)},
                                   cost);
      row.cost[l] = cost + StepCost(matching, step, own_cost);
      row.start[l] = StartBehind(step, one_up, two_up, l);
    }
  }
  DeltaCurve curve{std::move(row.cost), std::move(row.start)};
  for (double& delta : curve.delta) delta /= rows;
  return curve;
}

}  // namespace kinebase::internal
