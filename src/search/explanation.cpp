#include "kinebase/search/explanation.h"

#include <cmath>

#include "search/local_costs.h"
#include "search/pose_distance.h"
#include "search/recurrence.h"

namespace kinebase {
namespace {

// How the path came to a cell from the one before.
internal::Step StepBetween(const PathCell& before, const PathCell& cell) {
  if (cell.template_column - before.template_column == 2) return internal::Step::kTwoOne;
  return cell.recording_column - before.recording_column == 2 ? internal::Step::kOneTwo
                                                              : internal::Step::kOneOne;
}

}  // namespace

double CostOfFeature(const QuantizedTemplate& motion_template, const ExplainedCell& cell,
                     int feature) {
  const auto column = static_cast<std::size_t>(cell.cell.template_column);
  const double cost =
      motion_template.costs.empty()
          ? motion_template.columns[column].scale
          : motion_template.costs[column * static_cast<std::size_t>(motion_template.feature_count) +
                                  static_cast<std::size_t>(feature)];
  return cost * cell.share;
}

std::vector<ExplainedCell> ExplainPath(const QuantizedTemplate& motion_template,
                                       std::span<const std::uint64_t> columns, int last) {
  std::vector<ExplainedCell> explained;
  const internal::LocalCosts costs(motion_template);
  internal::Step step = internal::Step::kNone;
  for (const PathCell& cell : TracePath(motion_template, columns, last)) {
    if (!explained.empty()) step = StepBetween(explained.back().cell, cell);
    const auto column = static_cast<std::size_t>(cell.template_column);
    const std::uint64_t disagreed =
        costs.Disagreeing(column, columns[static_cast<std::size_t>(cell.recording_column)]);
    const double share =
        internal::StepCost(motion_template.matching, step, 1.0) / motion_template.column_count();
    explained.push_back({.cell = cell,
                         .agreed = motion_template.columns[column].consistent & ~disagreed,
                         .disagreed = disagreed,
                         .cost = costs.Of(column, disagreed) * share,
                         .share = share});
  }
  return explained;
}

std::vector<ExplainedPlace> ExplainPlaces(const PoseModel& model,
                                          std::span<const ExplainedCell> path,
                                          const PoseStream& poses) {
  std::vector<ExplainedPlace> places;
  places.reserve(path.size() * kPoseValues);
  const double share = internal::kPlacesWeight / static_cast<double>(path.size());
  for (const ExplainedCell& cell : path) {
    const std::span<const float> pose = poses.Column(cell.cell.recording_column);
    const std::size_t first = static_cast<std::size_t>(cell.cell.template_column) * kPoseValues;
    for (std::size_t i = 0; i < pose.size(); ++i) {
      const double spread = std::sqrt(model.spread[i]);
      // What never moves in other motion says nothing: the root is always in its own place.
      places.push_back(
          {.off = spread > 0 ? (pose[i] - model.mean[first + i]) / spread : 0,
           .cost = share * internal::OffOfValue(model, model.mean, first + i, i, pose[i])});
    }
  }
  return places;
}

}  // namespace kinebase
