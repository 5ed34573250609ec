// Styles of a motion class: groups of performances that are done in the same way.
//
// Who averages cartwheels to the left with those to the right gets a template of neither. Where
// performances fall into clear groups, one template for each says more; library/class_learning.h
// learns them, and search/ranking.h lets them stand for one class.
//
// Read templates/learning.h first. docs/design/contrast.md has what it gains.
// Method: average linkage (Sokal & Michener 1958) on the costs of alignment; the number of groups
// by the mean silhouette (Rousseeuw 1987).
#pragma once

#include <span>
#include <vector>

#include "kinebase/templates/motion_template.h"

namespace kinebase {

// For each performance the number of its style, from 0, in the order of their first performances.
//
// A style has three performances or more: fewer say nothing about what is consistent in it. Those
// left over go to the nearest. There are as many styles as separate best, by the mean silhouette;
// where that is below one half, as in a cloud without structure, there is one.
//
// performances  As LearnTemplate takes them. Fewer than six are one style.
// Cost          O(n² · columns² · features + n³).
[[nodiscard]] std::vector<int> FindStyles(std::span<const TemplateMatrix> performances,
                                          Profile profile);

}  // namespace kinebase
