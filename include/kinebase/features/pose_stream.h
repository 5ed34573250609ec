// Poses beside the feature matrix, comparable between people and places: what features leave out.
//
// templates/contrast.h learns from them, search/ranking.h compares with them.
#pragma once

#include <span>
#include <vector>

#include "kinebase/features/feature_matrix.h"
#include "kinebase/motion/motion.h"
#include "kinebase/motion/standard_skeleton.h"

namespace kinebase {

inline constexpr int kPoseValues = 3 * kStandardJointCount;

struct PoseStream {
  double rate_hz = 0;
  std::vector<float> values;  // [column × kPoseValues]: x, y, z of the standard joints in order.

  [[nodiscard]] int column_count() const { return static_cast<int>(values.size()) / kPoseValues; }
  [[nodiscard]] std::span<const float> Column(int column) const {
    return std::span(values).subspan(static_cast<std::size_t>(column) * kPoseValues, kPoseValues);
  }
};

// The joints relative to the root, turned about the vertical so that the hips point to +x, in units
// of the body's size: root to neck along the spine, and a leg, both as in the first frame.
//
// standard_joints  24 joints, at least one frame.
// rate_hz          Column c is the same moment as column c of ExtractFeatures at that rate.
// Errors           InvalidArgument.
// Cost             O(frames).
[[nodiscard]] PoseStream ExtractPoses(const JointTrajectories& standard_joints,
                                      double rate_hz = 30);

// A recording as it is learned from and searched: two streams of the same columns. poses may be
// null where only features are asked for.
struct RecordingStreams {
  FeatureView features;
  const PoseStream* poses = nullptr;
};

}  // namespace kinebase
