// The floor below a row of poses. Internal.
#pragma once

#include "kinebase/pictures/canvas.h"
#include "kinebase/pictures/pose_strip.h"
#include "pictures/stick_figure.h"

namespace kinebase::internal {

// Squares of 50 cm along and across the heading, one corner below `place`; seen from the edge, a
// line. `box` is what the floor may cover.
void DrawFloor(Canvas& canvas, PoseView view, const FigurePlace& place, const PictureBox& box);

}  // namespace kinebase::internal
