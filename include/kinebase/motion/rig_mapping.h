// Which of a file's joints stand for the 24 standard joints, where it does not name them as ASF
// does.
//
// Read motion/standard_skeleton.h first; motion/bvh_motion.h uses it. Names of known rigs are data:
// data/rigs/rigs.csv, a column a rig. What no table knows is found by the shape of the tree.
// docs/formats/bvh.md shows both at work.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/motion/joint_source.h"
#include "kinebase/motion/skeleton.h"

namespace kinebase {

struct RigMapping {
  std::string rig;  // The table's column: "cmu", "mixamo" …; empty if no table fits.
  std::array<NameMapEntry, kStandardJointCount> name_map{};
  std::vector<JointSource> sources;  // One for each standard joint, in order.
};

// A joint's name without the name space of its figure: "Hips" of "mixamorig:Hips".
[[nodiscard]] std::string_view BareJointName(std::string_view name);

// joints  A tree with parents before children; names are those of the places where bones end, in
//         any case, with or without blanks, underscores and a prefix that all share ("Bip01 ").
//
// The table most of whose names are there wins, if hips and knees are among them. Standard joints
// that it lacks are found by topology: two pairs of like limbs hang on the trunk, the one nearer to
// the root are legs; thigh and shin, upper arm and forearm are the longest two bones in a row. Left
// is told by the names, else by where the toes point. Then the nearest joint is taken.
// Confidence  1 = named; .75 = named, about there; .7 = by topology; .5 = the nearest.
// Cost        O(joints · standard joints).
[[nodiscard]] RigMapping MapRig(std::span<const Joint> joints);

// The same by topology alone, where names do not tell whether they are those of the places where
// bones begin or end.
[[nodiscard]] RigMapping MapRigByTopology(std::span<const Joint> joints);

}  // namespace kinebase
