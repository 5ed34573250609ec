// How far a pose is from what a template's class does, value by value. Internal: hits are ranked
// and explained by it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "kinebase/templates/motion_template.h"

namespace kinebase::internal {

// Of the poses in a hit's cost. Chosen on actors left out among the training actors
// (docs/design/contrast.md); within a factor of two the result is the same but for noise.
inline constexpr double kPlacesWeight = 0.1;
// Two spreads off is wrong; more says nothing more.
inline constexpr double kMostOff = 4;
// For each unit of weight: as far from what looks like the class as other motion is by and large,
// which is one spread. Farther away is no better.
inline constexpr double kNoLookalike = 1;

// What one value adds to the distance of a pose.
// mean   The class's or that of its look-alikes, both of the model.
// entry  Of the model: its column and the value.
// value  0 to kPoseValues − 1.
[[nodiscard]] inline double OffOfValue(const PoseModel& model, const std::vector<float>& mean,
                                       std::size_t entry, std::size_t value, float found) {
  const double weight = model.weight[entry];
  if (weight == 0) return 0;
  const double off = found - mean[entry];
  return weight * std::min(off * off / model.spread[value], kMostOff);
}

}  // namespace kinebase::internal
