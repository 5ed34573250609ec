// A motion in another world than ours: another axis up, another unit of length.
#pragma once

#include <Eigen/Core>

#include "kinebase/motion/motion.h"
#include "kinebase/motion/world.h"

namespace kinebase::internal {

// The same motion seen in a world that is turned: places, bones, their axes and rotations.
[[nodiscard]] Motion TurnMotion(const Motion& motion, const Eigen::Matrix3d& turn);

}  // namespace kinebase::internal
