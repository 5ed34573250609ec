// Where the samples of a new rate lie among the frames of an old one.
#pragma once

#include <cstdint>

namespace kinebase::internal {

struct SamplePlace {
  int before = 0;
  int after = 0;
  double share = 0;  // Of `after`.
};

// Sample times are i / new rate; a product that rounding leaves a hair off a frame is that frame,
// so that going to half the rate picks every other frame exactly.
SamplePlace PlaceOfSample(int sample, double old_rate_hz, double new_rate_hz, int frames);

// Errors  InvalidArgument if a rate is not positive, or there would be too many samples.
int SampleCount(int frames, double old_rate_hz, double new_rate_hz);

// The number of the first sample, so that it keeps its time: (number - 1) / rate.
std::int64_t FirstSample(std::int64_t first_frame, double old_rate_hz, double new_rate_hz);

}  // namespace kinebase::internal
