// What a pose strip shows and where. Internal to pictures/pose_strip.cpp.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinebase/pictures/canvas.h"
#include "kinebase/pictures/pose_strip.h"
#include "pictures/pose_camera.h"

namespace kinebase::internal {

inline constexpr double kStripMargin = 24;
inline constexpr double kStripHeader = 30;  // Height of the legend's line.
inline constexpr double kRowTitle = 24;     // Height of a row's title,
inline constexpr double kRowLabels = 34;    // and of its frame numbers and times.

// One way of a joint, as seen; missing places are NaN.
struct SeenTrail {
  StandardJoint joint;
  std::vector<Eigen::Vector3d> places;  // Oldest first.
};

struct StripPose {
  int frame = 0;  // 0-based.
  SeenPose joints;
  std::vector<SeenTrail> trails;
};

struct StripRow {
  const PoseStripRow* source = nullptr;
  std::vector<StripPose> poses;
  double top = 0;         // Pixels: upper edge of the title,
  double floor_y = 0;     // the floor's middle,
  double labels_top = 0;  // and where the space for poses ends.
  PictureBox floor;       // What the floor covers.
};

struct StripLayout {
  double pixels_per_cm = 1;
  double slot_width = 0;   // Pixels that each pose has to itself.
  double slot_origin = 0;  // Of the body's point on the floor, from the slot's left edge.
  double poses_width = 0;  // All slots of the longest row.
  std::vector<StripRow> rows;
  PictureSize size;
};

[[nodiscard]] StripLayout LayOutStrip(std::span<const PoseStripRow> rows,
                                      const PoseStripOptions& options);

}  // namespace kinebase::internal
