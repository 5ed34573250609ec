// One cell of the subsequence DTW: the rule that the reference kernel and the path tracing share.
//
// Read search/subsequence_dtw.h first. The vector kernel computes the same in another shape; tests
// hold the two against each other bit for bit.
#pragma once

#include <cstdint>
#include <limits>

#include "kinebase/templates/quantized_template.h"

namespace kinebase::internal {

inline constexpr double kUnreachable = std::numeric_limits<double>::infinity();

// How a path came to a cell: steps (template, recording).
enum class Step : std::uint8_t { kNone, kOneOne, kOneTwo, kTwoOne };

struct Predecessors {
  double one_one = kUnreachable;  // Accumulated costs; unreachable where there is no such cell.
  double one_two = kUnreachable;
  double two_one = kUnreachable;
};

// The least accumulated cost; the first in order (1,1), (1,2), (2,1) where costs tie.
[[nodiscard]] inline Step ChooseStep(const Predecessors& costs, double& cost) {
  Step step = Step::kNone;
  cost = kUnreachable;
  const auto consider = [&](Step candidate, double candidate_cost) {
    if (candidate_cost >= cost) return;
    step = candidate;
    cost = candidate_cost;
  };
  consider(Step::kOneOne, costs.one_one);
  consider(Step::kOneTwo, costs.one_two);
  consider(Step::kTwoOne, costs.two_one);
  return step;
}

// What a cell adds to the path that enters it with this step.
[[nodiscard]] inline double StepCost(Profile matching, Step step, double local_cost) {
  return matching == Profile::kBonn && step == Step::kTwoOne ? local_cost + local_cost : local_cost;
}

}  // namespace kinebase::internal
