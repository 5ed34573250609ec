#include "motion/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase::internal {
namespace {

// 120 / 30 · 40 must not become 159.99…
constexpr double kSameFrame = 1e-9;

}  // namespace

SampleGrid::SampleGrid(std::int64_t first_frame, int frames, double old_rate_hz, double new_rate_hz)
    : frames_(frames),
      old_rate_hz_(old_rate_hz),
      new_rate_hz_(new_rate_hz),
      first_number_(first_frame) {
  if (!(new_rate_hz > 0)) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("cannot resample to {} Hz: the rate must be positive", new_rate_hz));
  }
  if (!(old_rate_hz > 0)) {
    throw Error(ErrorCode::kInvalidArgument, "cannot resample a motion without a rate");
  }
  if (frames == 0) return;
  const double last = frames - 1;
  constexpr double kLargest = 1e15;  // Whole numbers beyond are not exact, and no file needs them.
  const auto before = static_cast<double>(first_frame - 1);
  const double position = before * new_rate_hz / old_rate_hz;
  if (std::abs(before) < kLargest && std::abs(position) < kLargest) {
    double number = std::ceil(position - kSameFrame);
    start_ = std::max(number * old_rate_hz / new_rate_hz - before, 0.0);
    if (start_ > last + kSameFrame) {
      number = std::round(position);
      start_ = 0;
    }
    first_number_ = static_cast<std::int64_t>(number) + 1;
  }
  const double samples = std::floor((last - start_) * new_rate_hz / old_rate_hz + kSameFrame) + 1;
  if (!(samples <= std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("cannot resample {} frames from {} to {} Hz: too many frames", frames,
                            old_rate_hz, new_rate_hz));
  }
  count_ = std::max(static_cast<int>(samples), 1);
}

SamplePlace SampleGrid::Place(int sample) const {
  const double position = start_ + sample * old_rate_hz_ / new_rate_hz_;
  const double nearest = std::round(position);
  const double exact = std::abs(position - nearest) < kSameFrame ? nearest : position;
  const int before = std::min(static_cast<int>(exact), frames_ - 1);
  return {before, std::min(before + 1, frames_ - 1), exact - before};
}

}  // namespace kinebase::internal
