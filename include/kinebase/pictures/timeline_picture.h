// Which class happens when, as bars over time: what was found, and above it what is true.
//
// docs/pictures.md shows how to read the picture.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinebase/core/output_file.h"
#include "kinebase/pictures/canvas.h"

namespace kinebase {

struct TimelineBar {
  double start_s = 0;
  double end_s = 0;
};

// One class.
struct TimelineRow {
  std::string name;
  std::vector<TimelineBar> truth;
  std::vector<TimelineBar> found;
};

// One recording.
struct Timeline {
  std::string title;
  double duration_s = 0;
  std::vector<TimelineRow> rows;
  bool has_truth = false;  // Without, rows have no place for it and all that was found is right.
};

inline constexpr Color kTimelineTruth = {120, 120, 120};
inline constexpr Color kTimelineRight = {31, 119,
                                         180};          // Found, and true or not known to be wrong.
inline constexpr Color kTimelineWrong = {214, 39, 40};  // Found where the truth has it not.

// Recordings below each other, each over the whole width with an axis of its own. What is shorter
// than a pixel is drawn a pixel wide.
//
// Errors  InvalidArgument: no recording, one without rows or of no duration, a bar that ends before
//         it begins; those of WritePicture.
void DrawTimelines(std::span<const Timeline> timelines, const std::filesystem::path& path,
                   Overwrite overwrite);

}  // namespace kinebase
