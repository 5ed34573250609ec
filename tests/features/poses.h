// Recordings of the 24 joints put together by hand, and feature sets of one feature.
#pragma once

#include <map>
#include <string>

#include "kinebase/features/feature_extraction.h"

namespace kinebase::test {

using Pose = std::map<StandardJoint, Eigen::Vector3d>;

// `frames` times the same pose; joints that it does not name lie in the origin.
inline JointTrajectories Still(const Pose& pose, int frames = 1, double rate_hz = 120) {
  JointTrajectories joints{.rate_hz = rate_hz, .joint_count = kStandardJointCount};
  joints.positions_cm.assign(static_cast<std::size_t>(frames) * kStandardJointCount,
                             Eigen::Vector3d::Zero());
  for (int frame = 0; frame < frames; ++frame) {
    for (const auto& [joint, position] : pose) {
      joints.positions_cm[frame * kStandardJointCount + static_cast<int>(joint)] = position;
    }
  }
  return joints;
}

inline Eigen::Vector3d& At(JointTrajectories& joints, int frame, StandardJoint joint) {
  return joints.positions_cm[frame * kStandardJointCount + static_cast<int>(joint)];
}

// A set of one feature with these terms, absolute units and any further keys.
inline FeatureSet SetOf(const std::string& terms, const std::string& unit,
                        const std::string& keys = "strong = 1\nweak = 1\n") {
  return ParseFeatureSet(
      "format = \"kinebase-feature-set\"\nversion = 1\nname = \"one\"\n[[feature]]\nid = \"F1\"\n"
      "name = \"one\"\n" +
          keys + "unit = \"" + unit + "\"\nterms = [\n" + terms + "\n]\n",
      "one.toml");
}

}  // namespace kinebase::test
