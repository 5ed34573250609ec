#include "library/feedback_threshold.h"

#include <algorithm>
#include <limits>

#include "fmt/format.h"
#include "kinebase/search/template_search.h"
#include "kinebase/templates/calibration.h"
#include "library/threshold_rule.h"

namespace kinebase::internal {
namespace {

// Between which marks the threshold lies: all right ones up to `right` cost less than it, all wrong
// ones from `wrong` on cost more.
struct Split {
  std::optional<double> right;  // Empty: it is below all right marks.
  double wrong = std::numeric_limits<double>::infinity();
  std::ptrdiff_t mistakes = 0;
};

Split SplitAt(std::optional<double> right, const MarkedCosts& costs) {
  Split split{.right = right};
  for (const double cost : costs.right) split.mistakes += !right || cost > *right ? 1 : 0;
  for (const double cost : costs.wrong) {
    if (right && cost <= *right) {
      ++split.mistakes;
    } else {
      split.wrong = std::min(split.wrong, cost);
    }
  }
  return split;
}

// With the fewest mistakes; of as many the highest, as a hit too many is seen and one that is
// missing is not.
Split BestSplit(const MarkedCosts& costs) {
  Split best = SplitAt(std::nullopt, costs);
  std::vector<double> right = costs.right;
  std::ranges::sort(right);
  for (const double cost : right) {
    const Split split = SplitAt(cost, costs);
    if (split.mistakes <= best.mistakes) best = split;
  }
  return best;
}

// Half way from hits that were learned from to those that were not, as Calibrate has it.
std::optional<double> UsualRightCost(const MarkedCosts& costs) {
  const std::optional<double> seen = Median(costs.right.empty() ? costs.clips : costs.right);
  const std::optional<double> unseen = Median(costs.unseen);
  if (seen && unseen) return (*seen + *unseen) / 2;
  return seen;
}

struct Limits {
  double tau = 0;
  std::optional<double> width;  // From right to wrong hits, where both are known.
};

Limits LimitsOf(const Split& split, const MarkedCosts& costs) {
  if (split.wrong == std::numeric_limits<double>::infinity()) return {.tau = *split.right};
  const double lowest = split.right.value_or(0);
  const double usual = UsualRightCost(costs).value_or(0);
  if (!split.right || usual >= split.wrong) {
    return {.tau = ThresholdBetween(lowest, split.wrong)};
  }
  return {.tau = std::max(ThresholdBetween(usual, split.wrong), lowest),
          .width = split.wrong - usual};
}

std::string CountsOf(const MarkedCosts& costs) {
  return fmt::format("{} right and {} wrong marks", costs.right.size(), costs.wrong.size());
}

void MoveThreshold(double tau, const std::string& origin, const std::optional<double>& width,
                   MotionTemplate& motion_template) {
  motion_template.tau = tau;
  motion_template.tau_origin = origin;
  if (!motion_template.calibration) return;
  const double slope =
      width && *width > 0 ? kSteepness / *width : motion_template.calibration->slope;
  motion_template.calibration = HalfAt(tau, slope);
}

// Right marks alone: what they cost is allowed.
void Raise(const MarkedCosts& costs, MotionTemplate& motion_template) {
  const double worst = std::ranges::max(costs.right);
  if (worst <= motion_template.tau.value_or(kDefaultTau)) return;
  MoveThreshold(worst, fmt::format("the costliest of {} right marks", costs.right.size()), {},
                motion_template);
}

// Wrong marks alone: they are left out. True if they cost no more than the clips do.
bool Lower(const MarkedCosts& costs, MotionTemplate& motion_template) {
  const double best = std::ranges::min(costs.wrong);
  const double usual = UsualRightCost(costs).value_or(0);
  if (usual >= best) return true;
  const double tau = ThresholdBetween(usual, best);
  if (tau >= motion_template.tau.value_or(kDefaultTau)) return false;
  MoveThreshold(tau, fmt::format("half way from the clips to {} wrong marks", costs.wrong.size()),
                best - usual, motion_template);
  return false;
}

}  // namespace

bool SetThreshold(const MarkedCosts& costs, MotionTemplate& motion_template) {
  if (costs.right.empty() && costs.wrong.empty()) return false;
  if (costs.wrong.empty()) {
    Raise(costs, motion_template);
    return false;
  }
  if (costs.right.empty()) return Lower(costs, motion_template);
  const Split split = BestSplit(costs);
  const Limits limits = LimitsOf(split, costs);
  const bool contradictory = split.mistakes > 0;
  MoveThreshold(limits.tau,
                contradictory
                    ? fmt::format("fewest mistakes among {}", CountsOf(costs))
                    : fmt::format("half way from right to wrong hits, by {}", CountsOf(costs)),
                limits.width, motion_template);
  return contradictory;
}

}  // namespace kinebase::internal
