#include "search/reference_kernel.h"

#include <utility>

#include "kinebase/search/subsequence_dtw.h"
#include "search/recurrence.h"

namespace kinebase {
namespace {

// One row of the cost table: [column of the recording].
struct Row {
  explicit Row(std::size_t columns) : cost(columns, internal::kUnreachable), start(columns, -1) {}

  // The cell `back` columns before `column`.
  [[nodiscard]] double CostBefore(std::size_t column, std::size_t back) const {
    return column >= back ? cost[column - back] : internal::kUnreachable;
  }

  std::vector<double> cost;
  std::vector<std::int32_t> start;
};

std::int32_t StartBehind(internal::Step step, const Row& one_up, const Row& two_up,
                         std::size_t column) {
  switch (step) {
    case internal::Step::kOneOne:
      return one_up.start[column - 1];
    case internal::Step::kOneTwo:
      return one_up.start[column - 2];
    case internal::Step::kTwoOne:
      return two_up.start[column - 1];
    case internal::Step::kNone:
      break;
  }
  return -1;
}

}  // namespace

namespace internal {

DeltaCurve ComputeDelta(const LocalCosts& costs, std::size_t rows, Profile matching,
                        std::span<const std::uint64_t> columns) {
  Row two_up(columns.size());
  Row one_up(columns.size());
  Row row(columns.size());
  for (std::size_t k = 0; k < rows; ++k) {
    std::swap(two_up, one_up);
    std::swap(one_up, row);
    for (std::size_t l = 0; l < columns.size(); ++l) {
      const double local_cost = costs.At(k, columns[l]);
      if (k == 0) {
        row.cost[l] = local_cost;
        row.start[l] = static_cast<std::int32_t>(l);
        continue;
      }
      double cost = 0;
      const Step step = ChooseStep({.one_one = one_up.CostBefore(l, 1),
                                    .one_two = one_up.CostBefore(l, 2),
                                    .two_one = two_up.CostBefore(l, 1)},
                                   cost);
      row.cost[l] = cost + StepCost(matching, step, local_cost);
      row.start[l] = StartBehind(step, one_up, two_up, l);
    }
  }
  DeltaCurve curve{std::move(row.cost), std::move(row.start)};
  for (double& delta : curve.delta) delta /= static_cast<double>(rows);
  return curve;
}

}  // namespace internal

DeltaCurve ComputeDeltaReference(const QuantizedTemplate& motion_template,
                                 std::span<const std::uint64_t> columns) {
  return internal::ComputeDelta(internal::LocalCosts(motion_template),
                                motion_template.columns.size(), motion_template.matching, columns);
}

}  // namespace kinebase
