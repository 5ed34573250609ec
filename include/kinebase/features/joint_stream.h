// Poses as numbers, column by column: what retrieval without relational features compares.
//
// search/example_search.h compares them.
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.5 (Q and 3D).
#pragma once

#include <span>
#include <vector>

#include "kinebase/motion/motion.h"

namespace kinebase {

enum class JointStreamKind {
  kRotations,  // 4 numbers a joint: the local rotation as a unit quaternion w, x, y, z.
  kPositions,  // 3 numbers a joint: its place seen from the root, in humerus lengths.
};

struct JointStream {
  JointStreamKind kind = JointStreamKind::kRotations;
  double rate_hz = 0;
  int joint_count = 0;
  std::vector<float> values;  // [column × joint × numbers]

  [[nodiscard]] int numbers_per_joint() const {
    return kind == JointStreamKind::kRotations ? 4 : 3;
  }
  [[nodiscard]] int numbers_per_column() const { return joint_count * numbers_per_joint(); }
  [[nodiscard]] int column_count() const {
    return joint_count == 0 ? 0 : static_cast<int>(values.size()) / numbers_per_column();
  }
  [[nodiscard]] std::span<const float> Column(int column) const {
    const auto size = static_cast<std::size_t>(numbers_per_column());
    return std::span(values).subspan(static_cast<std::size_t>(column) * size, size);
  }
};

// The same columns as ExtractFeatures has at 120 Hz and `rate_hz`: resampled to 120 Hz, then
// thinned.
//
// Rotations are those of the 18 standard joints that turn a bone, without the root: where somebody
// faces says nothing of what they do. One that this skeleton lacks stays in its neutral pose.
// Positions are those of the standard joints without the root, turned back by the root's rotation
// and divided by the length of the right humerus in the first frame.
//
// rate_hz  Divides 120.
// Errors   InvalidArgument: no frames, another rate; Mismatch: no standard joints.
// Cost     O(frames · joints).
[[nodiscard]] JointStream ExtractJointStream(const Motion& motion, JointStreamKind kind,
                                             double rate_hz = 30);

}  // namespace kinebase
