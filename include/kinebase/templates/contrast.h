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

// labelled  Clips of motion classes: how often features are one is measured on these alone, as
//           weights from there tell classes apart better.
// others    Any other recordings, such as the library to be searched: their poses count too.
// Errors    InvalidArgument: no columns in `labelled`, feature counts that differ, recordings
// without
//           a pose for each column.
[[nodiscard]] Background MeasureBackground(std::span<const RecordingStreams> labelled,
                                           std::span<const RecordingStreams> others = {});

// Entry (i, k) of the template x, seen in N performances, weighs |2x − 1|⁴ · (0.3 + KL(p ‖ b)): how
// consistent it is, and how surprising, p = (N x + ½) / (N + 1) against the background's share b.
// The weights of a column sum to 1. Each pose value weighs KL of its distribution over the
// performances, matched to the column, against the background's, both taken for Gaussian.
//
// What nothing is known of has no weight: a column whose entries are all ½ costs nothing anywhere.
//
// Counterexamples look like the class and are not. They are matched to the columns too, and the
// background of each column is theirs and the general one, which counts as much as one of them: so
// what tells the class from them weighs most (docs/design/feedback.md).
//
// performances     Those that the template was learned from, with poses.
// counterexamples  Stretches about as long as the class, with poses; may be empty.
// Errors           InvalidArgument: no performances, or one without a pose for each column;
//                  Mismatch: other features than the template's.
[[nodiscard]] Contrast MeasureContrast(const MotionTemplate& motion_template,
                                       std::span<const RecordingStreams> performances,
                                       const Background& background,
                                       std::span<const RecordingStreams> counterexamples = {});

// The entries' weights alone, where the performances are no longer at hand.
// performances  How many there were.
// Errors        Mismatch, as above.
[[nodiscard]] std::vector<double> MeasureEntryWeights(
    const MotionTemplate& motion_template, std::size_t performances, const Background& background,
    std::span<const RecordingStreams> counterexamples = {});

}  // namespace kinebase
