#include "kinebase/search/explanation.h"

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

std::vector<ExplainedCell> ExplainPath(const QuantizedTemplate& motion_template,
                                       std::span<const std::uint64_t> columns, int last) {
  std::vector<ExplainedCell> explained;
  internal::Step step = internal::Step::kNone;
  for (const PathCell& cell : TracePath(motion_template, columns, last)) {
    if (!explained.empty()) step = StepBetween(explained.back().cell, cell);
    const QuantizedColumn& column =
        motion_template.columns[static_cast<std::size_t>(cell.template_column)];
    const std::uint64_t differs =
        columns[static_cast<std::size_t>(cell.recording_column)] ^ column.ones;
    explained.push_back(
        {.cell = cell,
         .agreed = column.consistent & ~differs,
         .disagreed = column.consistent & differs,
         .cost_of_one = internal::StepCost(motion_template.matching, step, column.scale) /
                        motion_template.column_count()});
  }
  return explained;
}

}  // namespace kinebase
