// The 24 joints that every recording is brought to before features are computed.
//
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Fig. 2, Sect. 3.1 (`nameMap`) and
// Table 6. Which bone stands for which joint is data: data/skeletons/*.csv.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace kinebase {

enum class StandardJoint {
  kRoot,
  kLhip,
  kLknee,
  kLankle,
  kLtoes,
  kRhip,
  kRknee,
  kRankle,
  kRtoes,
  kBelly,
  kChest,
  kNeck,
  kHead,
  kHeadtop,
  kLclavicle,
  kLshoulder,
  kLelbow,
  kLwrist,
  kLfingers,
  kRclavicle,
  kRshoulder,
  kRelbow,
  kRwrist,
  kRfingers,
};

inline constexpr int kStandardJointCount = 24;

[[nodiscard]] std::string_view ToString(StandardJoint joint);  // "root", "lhip", …
[[nodiscard]] std::optional<StandardJoint> ParseStandardJoint(std::string_view name);

// The joint on the other side of the body; itself for those in the middle.
[[nodiscard]] StandardJoint Mirrored(StandardJoint joint);

// The neighbour towards the root, as drawn in Fig. 2; nothing for the root. lclavicle and
// rclavicle hang on the neck and lie in the same place.
[[nodiscard]] std::optional<StandardJoint> StandardParent(StandardJoint joint);

// Joints of a file's skeleton that stand for one standard joint; -1 = none.
struct NameMapEntry {
  int rotation_joint = -1;    // Whose local rotation it has: the bone after it.
  int trajectory_joint = -1;  // Whose trajectory it has: the end of the bone before it.
};

}  // namespace kinebase
