// One pose drawn as a stick figure. Internal.
#pragma once

#include <optional>

#include "kinebase/pictures/canvas.h"
#include "pictures/pose_camera.h"

namespace kinebase::internal {

// Blue and vermilion of Okabe and Ito's palette, which people of every colour vision tell apart
// ("Color Universal Design", 2008), and a neutral gray.
inline constexpr Color kLeftColor = {0, 114, 178};
inline constexpr Color kRightColor = {213, 94, 0};
inline constexpr Color kMiddleColor = {68, 68, 68};

[[nodiscard]] Color SideColor(StandardJoint joint);

// The head as a ball around head and headtop.
struct SeenHead {
  Eigen::Vector3d centre;  // As in SeenPose.
  double radius_cm = 0;
};
[[nodiscard]] std::optional<SeenHead> FindHead(const SeenPose& pose);

// From centimetres of a SeenPose to pixels.
struct FigurePlace {
  PicturePoint origin;  // Of the body's point on the floor.
  double pixels_per_cm = 1;

  [[nodiscard]] PicturePoint operator()(const Eigen::Vector3d& seen) const {
    return {origin.x + seen.x() * pixels_per_cm, origin.y - seen.y() * pixels_per_cm};
  }
};

void DrawStickFigure(Canvas& canvas, const SeenPose& pose, const FigurePlace& place);

}  // namespace kinebase::internal
