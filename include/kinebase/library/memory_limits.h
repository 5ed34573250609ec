// How much memory work on a library may use, where nobody says otherwise, and at least.
#pragma once

#include <cstdint>

namespace kinebase {

inline constexpr std::int64_t kDefaultMemoryBytes = std::int64_t{1} << 30;
inline constexpr std::int64_t kLeastMemoryBytes = std::int64_t{64} << 20;

}  // namespace kinebase
