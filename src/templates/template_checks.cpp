#include "templates/template_checks.h"

#include <algorithm>
#include <cmath>

#include "kinebase/features/pose_stream.h"

namespace kinebase::internal {
namespace {

template <typename T>
bool AreWeights(const std::vector<T>& weights) {
  return std::ranges::all_of(weights, [](T each) { return std::isfinite(each) && each >= 0; });
}

// What is wrong with it, as "a place without a mean"; empty if nothing is.
std::string ProblemOf(const PoseModel& model, int columns) {
  const std::size_t values = static_cast<std::size_t>(columns) * kPoseValues;
  if (model.mean.size() != values || model.weight.size() != values ||
      model.spread.size() != kPoseValues ||
      (!model.lookalikes.empty() && model.lookalikes.size() != values)) {
    return "poses of another size than the matrix";
  }
  const auto are_finite = [](const std::vector<float>& numbers) {
    return std::ranges::all_of(numbers, [](float each) { return std::isfinite(each); });
  };
  if (!are_finite(model.mean) || !are_finite(model.lookalikes) || !AreWeights(model.weight) ||
      !AreWeights(model.spread)) {
    return "poses with a number that is not finite, or a weight or spread below 0";
  }
  for (std::size_t i = 0; i < values; ++i) {
    if (model.weight[i] > 0 && model.spread[i % kPoseValues] == 0) {
      return "poses with a weight where the spread is 0";
    }
  }
  return {};
}

std::string ProblemOf(const Background& background, int features) {
  const PoseStatistics& places = background.places;
  if (std::ssize(background.ones) != features || places.mean.size() != kPoseValues ||
      places.variance.size() != kPoseValues) {
    return "a background of another size than the matrix";
  }
  const bool are_shares =
      std::ranges::all_of(background.ones, [](double each) { return each > 0 && each < 1; });
  if (!are_shares) return "a background whose ones are not between 0 and 1";
  const bool is_finite =
      std::ranges::all_of(places.mean, [](double each) { return std::isfinite(each); });
  const bool is_fine = is_finite && AreWeights(places.variance);
  return is_fine ? "" : "a background with a pose that is not finite, or a variance below 0";
}

}  // namespace

bool IsThreshold(double tau) { return std::isfinite(tau) && tau >= 0; }

std::string ProblemOf(const Contrast& contrast, const TemplateMatrix& matrix) {
  if (contrast.entry_weights.size() != matrix.values.size()) {
    return "entry weights of another size than the matrix";
  }
  if (!AreWeights(contrast.entry_weights)) return "an entry weight that is not finite or below 0";
  std::string problem = ProblemOf(contrast.places, matrix.column_count());
  if (!problem.empty() || !contrast.background) return problem;
  return ProblemOf(*contrast.background, matrix.feature_count);
}

std::string ProblemOf(const Calibration& calibration) {
  const bool is_fine = std::isfinite(calibration.slope) && std::isfinite(calibration.offset);
  return is_fine ? "" : "a calibration that is not finite";
}

}  // namespace kinebase::internal
