// Finds the standard joints among a skeleton's bones by the table data/skeletons/asf.csv.
#pragma once

#include <array>
#include <span>
#include <string>

#include "kinebase/motion/skeleton.h"

namespace kinebase::internal {

[[nodiscard]] std::array<NameMapEntry, kStandardJointCount> BuildNameMap(
    std::span<const Joint> joints);

// Whether the bones have the names of that table: at least half of them.
[[nodiscard]] bool NamesStandardJoints(std::span<const Joint> joints);

// The bone whose end is a standard joint, for messages about one that is missing.
[[nodiscard]] std::string TrajectoryBoneName(StandardJoint joint);

}  // namespace kinebase::internal
