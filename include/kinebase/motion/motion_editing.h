// Cutting, resampling and mirroring.
#pragma once

#include "kinebase/motion/motion.h"

namespace kinebase {

// Frames first … last (0-based, inclusive). Frame numbers go on counting as in the take.
// Errors  InvalidArgument if the range is empty or leaves the motion.
[[nodiscard]] Motion CutMotion(const Motion& motion, int first, int last);

// Another rate: positions linear, rotations along the shortest arc between neighbours.
//
// Frame n stands for time (n − 1) / rate before and after, so that what is numbered keeps its time:
// the first sample is the one at or after the first frame. Frames that begin with 1 give
// ⌊(frames − 1) · rate_hz / old⌋ + 1 samples. Of frames too few to hold any sample the first is
// taken.
// Errors  InvalidArgument if rate_hz is not positive, the motion has no rate, or the result would
//         have more frames than fit an int.
[[nodiscard]] Motion ResampleMotion(const Motion& motion, double rate_hz);
[[nodiscard]] JointTrajectories ResampleTrajectories(const JointTrajectories& trajectories,
                                                     double rate_hz);

// Left becomes right: reflected in the plane x = 0, bones exchanged by their names (lfemur ↔
// rfemur, LeftArm ↔ RightArm). The skeleton stays, so on one whose sides differ in length the
// joints land where its own bones carry them.
// Errors  Mismatch if a bone has a side in its name and the other side is missing.
[[nodiscard]] Motion MirrorMotion(const Motion& motion);

// The same for the 24 standard joints: exact places, bone lengths exchanged too.
// Errors  InvalidArgument if these are not standard joints.
[[nodiscard]] JointTrajectories MirrorTrajectories(const JointTrajectories& standard_joints);

}  // namespace kinebase
