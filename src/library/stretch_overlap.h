// How much two stretches of one take have in common. Internal.
#pragma once

#include <algorithm>
#include <cstdint>

#include "kinebase/features/feature_extraction.h"

namespace kinebase::internal {

inline std::int64_t LengthOf(const FrameRange& frames) { return frames.last - frames.first + 1; }

inline std::int64_t SharedFrames(const FrameRange& a, const FrameRange& b) {
  return std::max<std::int64_t>(std::min(a.last, b.last) - std::max(a.first, b.first) + 1, 0);
}

// What they share is at least half of both together.
inline bool AreSameStretch(const FrameRange& a, const FrameRange& b) {
  const std::int64_t shared = SharedFrames(a, b);
  return 2 * shared >= LengthOf(a) + LengthOf(b) - shared;
}

// At least half of `part` lies in `whole`.
inline bool LiesIn(const FrameRange& part, const FrameRange& whole) {
  return 2 * SharedFrames(part, whole) >= LengthOf(part);
}

}  // namespace kinebase::internal
