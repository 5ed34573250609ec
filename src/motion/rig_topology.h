// Finds the standard joints by the shape of a tree of joints alone.
#pragma once

#include <array>
#include <span>

#include "kinebase/motion/skeleton.h"

namespace kinebase::internal {

// The joint that lies where each standard joint does, in their order; -1 where there is none.
[[nodiscard]] std::array<int, kStandardJointCount> MapByTopology(std::span<const Joint> joints);

// The farthest tip below a joint, along the bones, in the neutral pose; -1 if none lies elsewhere
// than the joint itself.
[[nodiscard]] int FarthestTip(std::span<const Joint> joints, int joint);

}  // namespace kinebase::internal
