// Cost curves over time: for every moment of a recording what the best match that ends there costs,
// with the threshold and the hits.
//
// Read search/subsequence_dtw.h for what the curve is; docs/pictures.md shows how to read the
// picture.
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Figs. 7 and 8.
// Departures: threshold and hits are drawn, and true stretches beneath where they are known.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinebase/core/output_file.h"
#include "kinebase/pictures/canvas.h"
#include "kinebase/pictures/timeline_picture.h"

namespace kinebase {

// One template.
struct DeltaRow {
  std::string name;
  std::vector<double> cost;  // [column] +inf where no match ends.
  double rate_hz = 0;        // Columns a second.
  double tau = 0;
  std::vector<TimelineBar> hits;
};

// One recording.
struct DeltaPanel {
  std::string title;
  double duration_s = 0;
  double frame_rate_hz = 0;  // Of the recording: an axis in its frames stands below.
  std::vector<DeltaRow> rows;
  std::vector<TimelineRow> labels;  // What is true, in `truth`; each has a line beneath the curves.
};

inline constexpr Color kDeltaCurve = {0, 114, 178};
inline constexpr Color kDeltaHit = {255, 226, 178};
inline constexpr Color kDeltaThreshold = {213, 94, 0};

// Recordings below each other, in each a curve for every template, each with an axis of its own.
// A cost stands at the end of the match, so that a hit is a dip at the right end of its shaded
// stretch. Where columns are narrower than a pixel the least and the greatest of some are drawn.
//
// Errors  InvalidArgument: no recording, one without rows, duration or rates; a cost or threshold
//         below 0 or not a number; a bar that ends before it begins.
[[nodiscard]] Picture DeltaCurvesPicture(std::vector<DeltaPanel> panels);

// The same into a file.
// Errors  Also those of WritePicture.
void DrawDeltaCurves(std::span<const DeltaPanel> panels, const std::filesystem::path& path,
                     Overwrite overwrite);

}  // namespace kinebase
