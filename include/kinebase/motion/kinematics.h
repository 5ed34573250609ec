// From rotations to places, and the angles behind a rotation.
//
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 3.1, 4.1, 4.2.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "kinebase/motion/motion.h"

namespace kinebase {

// The place of every joint of the skeleton in every frame.
//
// With G the product of the local rotations from the root down to a joint (the root's own preceded
// by the skeleton's orientation), joint = parent + G · (offset + extra offset).
// Cost  O(frames · joints).
[[nodiscard]] JointTrajectories ForwardKinematics(const Motion& motion);

// The same for one frame, into joint_count() places.
void ForwardKinematics(const Motion& motion, int frame, Eigen::Vector3d* positions_cm);

// The neutral pose: all rotations the identity, the root at the origin. [joint]
[[nodiscard]] std::vector<Eigen::Vector3d> NeutralPose(const Skeleton& skeleton);

// Errors  Mismatch, naming the bones of the standard skeleton that this one lacks.
void CheckStandardJoints(const Skeleton& skeleton);

// The 24 standard joints in every frame.
//
// Errors  Mismatch, naming the bones that the skeleton lacks.
[[nodiscard]] JointTrajectories StandardJoints(const Motion& motion);

// Picks the standard joints out of all joints.
[[nodiscard]] JointTrajectories StandardJoints(const Skeleton& skeleton,
                                               const JointTrajectories& all_joints);

// Angles in rad about the joint's own x, y, z axes for every frame, in its Euler order: what an AMC
// holds. Of the many triples that mean one rotation, one that the joint's DOFs can hold is taken,
// and of these the one nearest to the frame before.
[[nodiscard]] std::vector<Eigen::Vector3d> EulerAngles(const Motion& motion, int joint);

struct BoundingBox {
  Eigen::Vector3d low_cm = Eigen::Vector3d::Zero();
  Eigen::Vector3d high_cm = Eigen::Vector3d::Zero();
};

// Smallest box along the world axes that holds all joints in all frames.
[[nodiscard]] BoundingBox ComputeBoundingBox(const JointTrajectories& trajectories);

}  // namespace kinebase
