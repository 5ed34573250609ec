#include <algorithm>

#include "kinebase/search/subsequence_dtw.h"
#include "search/local_costs.h"
#include "search/recurrence.h"

namespace kinebase {

std::vector<PathCell> TracePath(const QuantizedTemplate& motion_template,
                                std::span<const std::uint64_t> columns, int last) {
  using internal::Step;
  const int rows = motion_template.column_count();
  if (rows == 0 || last < 0 || last >= std::ssize(columns)) return {};
  // A path goes at most two columns back for each row. Cells further left may come out differently
  // in this window, but none of them lies on a path that ends in its last column.
  const int first = std::max(0, last - 2 * (rows - 1));
  const internal::LocalCosts costs_of(motion_template);
  const int width = last - first + 1;
  std::vector<double> costs(static_cast<std::size_t>(rows) * width, internal::kUnreachable);
  std::vector<Step> steps(costs.size(), Step::kNone);
  const auto index = [width](int k, int l) { return static_cast<std::size_t>(k) * width + l; };
  const auto cost_at = [&](int k, int l) {
    return k >= 0 && l >= 0 ? costs[index(k, l)] : internal::kUnreachable;
  };
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < width; ++l) {
      const double local_cost = costs_of.At(static_cast<std::size_t>(k), columns[first + l]);
      double cost = 0;
      Step step = Step::kNone;
      if (k > 0) {
        step = internal::ChooseStep({.one_one = cost_at(k - 1, l - 1),
                                     .one_two = cost_at(k - 1, l - 2),
                                     .two_one = cost_at(k - 2, l - 1)},
                                    cost);
      }
      steps[index(k, l)] = step;
      costs[index(k, l)] = cost + internal::StepCost(motion_template.matching, step, local_cost);
    }
  }
  int k = rows - 1;
  int l = width - 1;
  if (costs[index(k, l)] == internal::kUnreachable) return {};
  std::vector<PathCell> path;
  while (true) {
    path.push_back({k, first + l});
    const Step step = steps[index(k, l)];
    if (step == Step::kNone) break;
    k -= step == Step::kTwoOne ? 2 : 1;
    l -= step == Step::kOneTwo ? 2 : 1;
  }
  std::ranges::reverse(path);
  return path;
}

}  // namespace kinebase
