// What `explain` found, as JSON and as text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "kinebase/library/hit_explanation.h"
#include "kinebase/motion/standard_skeleton.h"

namespace kinebase::cli {

// How one feature fared along the path.
struct FeatureTally {
  int feature = 0;
  int agreed = 0;  // Cells.
  int disagreed = 0;
  double cost = 0;  // Of the hit's.
};

// Where a joint was off most along one axis in one cell: what cost most.
struct JointOffset {
  StandardJoint joint = StandardJoint::kRoot;
  int axis = 0;  // 0 to 2: x, y, z of the pose stream.
  int column = 0;
  double off = 0;
  double cost = 0;
};

// How one joint fared along the path.
struct JointTally {
  StandardJoint joint = StandardJoint::kRoot;
  double cost = 0;  // Of the hit's.
  JointOffset most;
};

// All that is shown, in one place.
struct Explained {
  std::vector<std::string> template_names;  // The first is explained, the others are rivals.
  std::string file;
  FeatureSet features;
  QuantizedTemplate quantized;
  TakeFeatures take;
  HitExplanation explanation;
  std::vector<FeatureTally> tallies;  // Those that cost most first; none of free features.
  std::vector<JointTally> joints;     // The same of joints; empty where poses do not count.

  [[nodiscard]] bool has_poses() const { return !explanation.places.empty(); }
};

[[nodiscard]] std::vector<FeatureTally> TallyFeatures(const std::vector<ExplainedCell>& cells,
                                                      const QuantizedTemplate& motion_template);
// Those that cost anything.
[[nodiscard]] std::vector<JointTally> TallyJoints(const HitExplanation& explanation);

// What joints cost in one cell of the path, each along the axis that costs most; dearest first,
// none that cost nothing.
[[nodiscard]] std::vector<JointOffset> OffsetsOfCell(const HitExplanation& explanation,
                                                     std::size_t cell);

[[nodiscard]] Json ToJson(const Explained& explained);
[[nodiscard]] std::string ToText(const Explained& explained);

}  // namespace kinebase::cli
