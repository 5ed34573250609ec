// Where a standard joint came from, when a file's own skeleton or markers do not name it so.
#pragma once

#include <string>
#include <string_view>

#include "kinebase/motion/standard_skeleton.h"

namespace kinebase {

enum class JointMatch {
  kTable,     // A table of known names has it.
  kTopology,  // By its place in the tree.
  kNearest,   // Nothing stands for it; the nearest joint that there is was taken.
  kMissing,   // Not there, and nothing near it.
};

[[nodiscard]] std::string_view ToString(JointMatch match);  // "table", "topology", …

struct JointSource {
  StandardJoint joint = StandardJoint::kRoot;
  std::string source;  // "LeftForeArm"; "LKNE, LKNI".
  JointMatch match = JointMatch::kMissing;
  double confidence = 0;  // 0 … 1: 1 = the very joint, .5 = the nearest that there is.
};

}  // namespace kinebase
