// Where the samples of a new rate lie among the frames of an old one.
#pragma once

#include <cstdint>

namespace kinebase::internal {

struct SamplePlace {
  int before = 0;
  int after = 0;
  double share = 0;  // Of `after`.
};

// Frame n is at (n - 1) / rate, in the old rate and in the new, so that samples keep their times:
// the first one is that at or after the first frame. Of frames too few to hold a time of the new
// rate the first is taken, numbered by the time that is nearest.
class SampleGrid {
 public:
  // Errors  InvalidArgument if a rate is not positive, or there would be too many samples.
  SampleGrid(std::int64_t first_frame, int frames, double old_rate_hz, double new_rate_hz);

  [[nodiscard]] std::int64_t first_number() const { return first_number_; }
  [[nodiscard]] int count() const { return count_; }

  // A product that rounding leaves a hair off a frame is that frame, so that going to half the rate
  // picks every other frame exactly.
  [[nodiscard]] SamplePlace Place(int sample) const;

 private:
  int frames_ = 0;
  double old_rate_hz_ = 0;
  double new_rate_hz_ = 0;
  double start_ = 0;  // Where the first sample is, in frames from the first.
  std::int64_t first_number_ = 1;
  int count_ = 0;
};

}  // namespace kinebase::internal
