#include "pictures/strip_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace kinebase::internal {
namespace {

constexpr double kSquare_cm = 50;
constexpr Color kFloorColor = {246, 246, 246};
constexpr Color kLineColor = {218, 218, 218};

// The part within the box of the endless line through `point`; nothing if it misses the box.
// Method: Liang and Barsky, "A New Concept and Method for Line Clipping", ACM TOG 3 (1984).
std::optional<std::array<PicturePoint, 2>> ClipLine(const PicturePoint& point,
                                                    const Eigen::Vector2d& direction,
                                                    const PictureBox& box) {
  double begin = -1e9;
  double end = 1e9;
  const std::array<double, 2> start = {point.x, point.y};
  const std::array<double, 2> low = {box.left, box.top};
  const std::array<double, 2> high = {box.left + box.width, box.top + box.height};
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(direction[axis]) < 1e-9) {
      if (start[axis] < low[axis] || start[axis] > high[axis]) return std::nullopt;
      continue;
    }
    const double to_low = (low[axis] - start[axis]) / direction[axis];
    const double to_high = (high[axis] - start[axis]) / direction[axis];
    begin = std::max(begin, std::min(to_low, to_high));
    end = std::min(end, std::max(to_low, to_high));
  }
  if (begin >= end) return std::nullopt;
  const auto at = [&](double distance) {
    return PicturePoint{point.x + distance * direction.x(), point.y + distance * direction.y()};
  };
  return std::array<PicturePoint, 2>{at(begin), at(end)};
}

Eigen::Vector2d ToPixels(const Eigen::Vector3d& seen, double pixels_per_cm) {
  return {seen.x() * pixels_per_cm, -seen.y() * pixels_per_cm};
}

// Lines along `direction`, one `step` from the next, as many as can reach the box; none where they
// would lie so close that they fill it, as when one frame throws the figure kilometres away.
void DrawLines(Canvas& canvas, const PicturePoint& origin, const Eigen::Vector2d& direction,
               const Eigen::Vector2d& step, const PictureBox& box) {
  const double distance =
      std::abs(direction.x() * step.y() - direction.y() * step.x()) / direction.norm();
  constexpr double kLeastDistance = 2;  // Pixels.
  if (!(distance >= kLeastDistance)) return;
  const int reach = static_cast<int>(std::hypot(box.width, box.height) / distance) + 1;
  for (int i = -reach; i <= reach; ++i) {
    const PicturePoint point = {origin.x + i * step.x(), origin.y + i * step.y()};
    if (const auto line = ClipLine(point, direction, box)) {
      canvas.Line(*line, {.width = 0.75, .color = kLineColor, .round_ends = false});
    }
  }
}

}  // namespace

void DrawFloor(Canvas& canvas, PoseView view, const FigurePlace& place, const PictureBox& box) {
  const PoseCamera camera = MakeCamera(view, Eigen::Vector3d::UnitZ());
  const Eigen::Vector2d along =
      ToPixels(Seen(camera, kSquare_cm * Eigen::Vector3d::UnitZ()), place.pixels_per_cm);
  const Eigen::Vector2d across =
      ToPixels(Seen(camera, kSquare_cm * Eigen::Vector3d::UnitX()), place.pixels_per_cm);
  canvas.BeginGroup("floor");
  if (std::abs(camera.up.y()) > 1 - 1e-9) {
    const std::array<PicturePoint, 2> line = {PicturePoint{box.left, place.origin.y},
                                              PicturePoint{box.left + box.width, place.origin.y}};
    canvas.Line(line, {.width = 1, .color = kLineColor, .round_ends = false});
  } else {
    canvas.Rectangle(box, kFloorColor);
    DrawLines(canvas, place.origin, along, across, box);
    DrawLines(canvas, place.origin, across, along, box);
  }
  canvas.EndGroup();
}

}  // namespace kinebase::internal
