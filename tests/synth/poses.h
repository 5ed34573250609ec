// What tests ask of made-up motion: places seen from the performer, angles, turns.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kinebase/motion/kinematics.h"
#include "kinebase/synth/synthetic_motion.h"

namespace kinebase::test {

inline constexpr int kActors = 6;
inline constexpr int kRepetitions = 2;
inline constexpr std::uint64_t kSeed = 11;

inline Eigen::Vector3d At(const JointTrajectories& t, int frame, StandardJoint joint) {
  return t.at(frame, joint);
}

// The direction to the performer's left in a frame, level.
inline Eigen::Vector3d ToTheLeft(const JointTrajectories& t, int frame) {
  Eigen::Vector3d left = t.at(frame, StandardJoint::kLhip) - t.at(frame, StandardJoint::kRhip);
  left.y() = 0;
  return left.normalized();
}

inline Eigen::Vector3d Ahead(const JointTrajectories& t, int frame) {
  return ToTheLeft(t, frame).cross(Eigen::Vector3d::UnitY());
}

inline double Distance(const JointTrajectories& t, int frame, StandardJoint a, StandardJoint b) {
  return (t.at(frame, a) - t.at(frame, b)).norm();
}

// How far a joint is bent: 0 = the bones before and after it are in line.
inline double BendDegrees(const JointTrajectories& t, int frame, StandardJoint before,
                          StandardJoint joint, StandardJoint after) {
  const Eigen::Vector3d a = t.at(frame, joint) - t.at(frame, before);
  const Eigen::Vector3d b = t.at(frame, after) - t.at(frame, joint);
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

// The frame in which `value(frame)` is largest.
template <typename Value>
int FrameOfLargest(const JointTrajectories& t, Value value) {
  int best = 0;
  for (int frame = 1; frame < t.frame_count(); ++frame) {
    if (value(frame) > value(best)) best = frame;
  }
  return best;
}

template <typename Value>
double Largest(const JointTrajectories& t, Value value) {
  return value(FrameOfLargest(t, value));
}

template <typename Value>
double Smallest(const JointTrajectories& t, Value value) {
  return -Largest(t, [&](int frame) { return -value(frame); });
}

// Whole turns of the arm about the shoulder, seen from the side; hanging → ahead → up is positive.
inline double ArmTurns(const JointTrajectories& t, StandardJoint shoulder, StandardJoint wrist) {
  double total = 0;
  double before = 0;
  for (int frame = 0; frame < t.frame_count(); ++frame) {
    const Eigen::Vector3d arm = t.at(frame, wrist) - t.at(frame, shoulder);
    const double angle = std::atan2(arm.dot(Ahead(t, frame)), -arm.y()) / (2 * std::numbers::pi);
    if (frame > 0) total += angle - before - std::round(angle - before);
    before = angle;
  }
  return total;
}

// Every repetition of a class by several actors, with a line that says which one it is.
template <typename Check>
void ForEachClip(const std::string& class_name, Check check) {
  for (int number = 0; number < kActors; ++number) {
    const SyntheticActor actor = MakeSyntheticActor(number, kSeed);
    for (int repetition = 0; repetition < kRepetitions; ++repetition) {
      SCOPED_TRACE(class_name + " by " + actor.name + ", " + std::to_string(repetition));
      check(MakeSyntheticClip(class_name, actor, repetition, kSeed));
    }
  }
}

template <typename Check>
void ForEachPerformance(const std::string& class_name, Check check) {
  ForEachClip(class_name, [&](const Motion& clip) { check(StandardJoints(clip)); });
}

}  // namespace kinebase::test
