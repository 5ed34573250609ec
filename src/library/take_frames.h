// Columns of a take's features as frames of its file. Internal.
#pragma once

#include <cstddef>

#include "kinebase/library/take_search.h"

namespace kinebase::internal {

inline FrameRange FramesOfHit(const TakeView& take, int first_column, int last_column) {
  return FramesOfColumns(first_column, last_column, take.features.rate_hz, take.rate_hz,
                         take.frame_count);
}

inline TakeHit ToTakeHit(const Hit& hit, const TakeView& take, std::size_t index) {
  const FrameRange frames = FramesOfHit(take, hit.first, hit.last);
  return {.take = index,
          .first_frame = frames.first + 1,
          .last_frame = frames.last + 1,
          .start_s = static_cast<double>(frames.first) / take.rate_hz,
          .end_s = static_cast<double>(frames.last + 1) / take.rate_hz,
          .cost = hit.cost,
          .score = hit.cost};
}

}  // namespace kinebase::internal
