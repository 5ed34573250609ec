#include "kinebase/motion/joint_source.h"

#include <array>

namespace kinebase {

std::string_view ToString(JointMatch match) {
  constexpr std::array<std::string_view, 4> kNames = {"table", "topology", "nearest", "missing"};
  return kNames[static_cast<std::size_t>(match)];
}

}  // namespace kinebase
