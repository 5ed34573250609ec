#include "motion/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase::internal {

SamplePlace PlaceOfSample(int sample, double old_rate_hz, double new_rate_hz, int frames) {
  const double position = sample * old_rate_hz / new_rate_hz;
  const double nearest = std::round(position);
  constexpr double kSameFrame = 1e-9;
  const double exact = std::abs(position - nearest) < kSameFrame ? nearest : position;
  const int before = std::min(static_cast<int>(exact), frames - 1);
  return {before, std::min(before + 1, frames - 1), exact - before};
}

int SampleCount(int frames, double old_rate_hz, double new_rate_hz) {
  if (!(new_rate_hz > 0)) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("cannot resample to {} Hz: the rate must be positive", new_rate_hz));
  }
  if (!(old_rate_hz > 0)) {
    throw Error(ErrorCode::kInvalidArgument, "cannot resample a motion without a rate");
  }
  if (frames == 0) return 0;
  // The same care as in PlaceOfSample: 120 / 30 · 40 must not become 159.99…
  const double samples = std::floor((frames - 1) * new_rate_hz / old_rate_hz + 1e-9) + 1;
  if (!(samples <= std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("cannot resample {} frames from {} to {} Hz: too many frames", frames,
                            old_rate_hz, new_rate_hz));
  }
  return static_cast<int>(samples);
}

std::int64_t FirstSample(std::int64_t first_frame, double old_rate_hz, double new_rate_hz) {
  constexpr double kLargest = 1e15;  // Whole numbers beyond are not exact, and no file needs them.
  const double before = static_cast<double>(first_frame - 1) * new_rate_hz / old_rate_hz;
  return std::abs(before) < kLargest ? std::llround(before) + 1 : first_frame;
}

}  // namespace kinebase::internal
