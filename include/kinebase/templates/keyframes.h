// Choosing keyframes: columns of a template that tell most about the motion.
//
// Read templates/motion_template.h first; search/keyframe_index.h looks for them.
// Method: the authors' toolbox. Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.4, only
// say that columns with many ones and few free entries are picked. docs/design/keyframes.md.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinebase/features/feature_set.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

struct KeyframeOptions {
  int most = 2;    // At least 1.
  int misses = 0;  // Of each keyframe; 0 or more, and always fewer than it tests.
};

// The best columns of a template, each for one group of features, by column.
//
// An entry counts if it is quantised to the same 0 or 1 in its column and in both neighbours. A
// column's score within a group is (2 · ones + 1.2 · zeros) / features of the group, faded by half
// a Hann window over the first and the last fifth of the template. Columns with a score of at least
// 0.9 are taken, best first (of equals the first column, then the first group); each rules out 5
// columns before and after it in all groups, and in its own those on as long as scores fall.
//
// Returns  May be fewer than asked for, or none: then there is nothing to preselect by.
// Errors   Mismatch if `features` is not the template's set; InvalidArgument.
[[nodiscard]] std::vector<Keyframe> ChooseKeyframes(const MotionTemplate& motion_template,
                                                    const FeatureSet& features,
                                                    const KeyframeOptions& options = {});

// One chosen by hand: those of `tested` (bit i: feature i) that are consistent in a column.
// Errors  InvalidArgument: no such column, none of them is consistent there, or as many misses as
//         features that are.
[[nodiscard]] Keyframe MakeKeyframe(const MotionTemplate& motion_template, int column,
                                    std::uint64_t tested, int misses = 0);

// Empty if these can be the keyframes of a template of this size; else what is wrong with them.
[[nodiscard]] std::string ProblemOfKeyframes(std::span<const Keyframe> keyframes, int column_count,
                                             int feature_count);

}  // namespace kinebase
