// Stick-figure poses in a row: the quickest way to see what a recording holds.
//
// Read motion/kinematics.h first: it makes the standard joints. docs/pictures.md shows how to read
// the picture.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/output_file.h"
#include "kinebase/motion/motion.h"

namespace kinebase {

// Where the camera stands, without perspective. All but the height turns with the performer's
// heading in the first pose (square to the line from right to left hip), so that "front" shows the
// face wherever the recording space points.
enum class PoseView {
  kFront,         // Before the performer.
  kSide,          // At the right side; the performer faces right.
  kTop,           // Above; the performer faces up.
  kThreeQuarter,  // Before and slightly above; the performer faces us and right.
};

[[nodiscard]] std::string_view ToString(PoseView view);  // "front", "side", "top", "three-quarter".
[[nodiscard]] std::optional<PoseView> ParsePoseView(std::string_view text);

// One recording of the picture. Joints with a coordinate that is not finite are left out, and the
// bones at them.
struct PoseStripRow {
  std::string title;
  JointTrajectories standard_joints;  // A rate of 0 leaves the times out.
  std::int64_t first_frame = 1;       // Number to print for the first frame.
};

struct PoseStripOptions {
  PoseView view = PoseView::kThreeQuarter;
  int poses = 10;     // In a row, at least 1; fewer if the recording has fewer frames.
  bool floor = true;  // At the height of the row's lowest joint; squares of 50 cm.

  // Joints whose way is drawn: with each pose the way since the pose before, as seen from the body
  // (a way through the room would run across the neighbours), fading towards the past. With a
  // single pose the way through the whole recording.
  std::vector<StandardJoint> trails;
};

// Rows below each other, all poses in one scale. Poses are spread evenly over the frames, the first
// and the last included, and stand next to each other: each root in the middle of its own floor,
// heights as they were. The right side of the body has another colour; far limbs are lighter.
//
// Errors  InvalidArgument: no rows, not standard joints, no frames, no poses, or more than a
//         picture can hold; those of WritePicture.
void DrawPoseStrip(std::span<const PoseStripRow> rows, const std::filesystem::path& path,
                   Overwrite overwrite, const PoseStripOptions& options = {});

}  // namespace kinebase
