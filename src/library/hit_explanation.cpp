#include "kinebase/library/hit_explanation.h"

#include <algorithm>
#include <ranges>

#include "fmt/format.h"
#include "library/take_frames.h"

namespace kinebase {
namespace {

// The first column that reaches up to the frame.
int ColumnThatEndsWith(std::int64_t last_frame, const TakeFeatures& take) {
  if (last_frame < 1 || last_frame > take.frame_count) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("has frames 1 to {}, not {}", take.frame_count, last_frame),
                {take.path});
  }
  const auto columns = std::views::iota(0, take.features.column_count());
  const auto found = std::ranges::partition_point(columns, [&](int column) {
    return internal::FramesOfHit(take, column, column).last < last_frame - 1;
  });
  return std::min(*found, take.features.column_count() - 1);
}

}  // namespace

HitExplanation ExplainHit(const QuantizedTemplate& motion_template, const TakeFeatures& take,
                          std::optional<std::int64_t> last_frame) {
  const DeltaCurve curve = ComputeDelta(motion_template, take.features.columns);
  const auto best = std::ranges::min_element(curve.delta) - curve.delta.begin();
  const int last = last_frame ? ColumnThatEndsWith(*last_frame, take) : static_cast<int>(best);
  HitExplanation explanation{.cells = ExplainPath(motion_template, take.features.columns, last)};
  if (explanation.cells.empty()) {
    throw Error(ErrorCode::kNotFound,
                last_frame
                    ? fmt::format("nothing that ends at frame {} is long enough for the template",
                                  *last_frame)
                    : "is too short for the template",
                {take.path});
  }
  const Hit hit{.first = explanation.cells.front().cell.recording_column,
                .last = last,
                .cost = curve.delta[static_cast<std::size_t>(last)]};
  explanation.hit = internal::ToTakeHit(hit, take, 0);
  return explanation;
}

}  // namespace kinebase
