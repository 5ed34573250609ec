// What sets a motion class off from other motion: the part of a template that plain templates lack.
//
// A motion template says what is consistent within the class. That knees are straight is consistent
// in waving, and in nearly everything else; it should count for less than the hand above the head.
// How often features are one, and how joints lie, where the class does not happen, is measured on
// any other recordings, without labels. docs/design/contrast.md has the method and its gain.
//
// Read templates/motion_template.h and features/pose_stream.h first; search/ranking.h uses this.
#pragma once

#include <span>
#include <vector>

#include "kinebase/features/pose_stream.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

// Mean and variance of each value of a pose.
struct PoseStatistics {
  std::vector<double> mean;      // [kPoseValues]
  std::vector<double> variance;  // [kPoseValues]

  friend bool operator==(const PoseStatistics&, const PoseStatistics&) = default;
};

// Motion in general.
struct Background {
  std::vector<double> ones;  // [feature] how often it is one, in (0, 1).
  PoseStatistics places;

  friend bool operator==(const Background&, const Background&) = default;
};

// labelled  Clips of motion classes: how often features are one is measured on these alone, as
//           weights from there tell classes apart better.
// others    Any other recordings, such as the library to be searched: their poses count too.
// Errors    InvalidArgument: no columns in `labelled`, feature counts that differ.
[[nodiscard]] Background MeasureBackground(std::span<const RecordingStreams> labelled,
                                           std::span<const RecordingStreams> others = {});

// Entry (i, k) of the template x, seen in N performances, weighs |2x − 1|⁴ · (0.3 + KL(p ‖ b)): how
// consistent it is, and how surprising, p = (N x + ½) / (N + 1) against the background's share b.
// The weights of a column sum to 1. Each pose value weighs KL of its distribution over the
// performances, matched to the column, against the background's, both taken for Gaussian.
//
// performances  Those that the template was learned from, with poses.
// Errors        InvalidArgument: no performances; Mismatch: other features than the template's.
[[nodiscard]] Contrast MeasureContrast(const MotionTemplate& motion_template,
                                       std::span<const RecordingStreams> performances,
                                       const Background& background);

}  // namespace kinebase
