// Long takes put together from clips, whose truth is therefore known to the column.
//
// Read features/feature_matrix.h first; library/annotation.h is measured with them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinebase/features/feature_matrix.h"
#include "kinebase/features/pose_stream.h"

namespace kinebase {

struct ClipOfClass {
  FeatureMatrix features;
  int motion_class = 0;
};

struct LongTake {
  FeatureMatrix features;

  // Where each clip is: columns, 0-based, inclusive.
  struct Segment {
    int motion_class = 0;
    int first = 0;
    int last = 0;
  };
  std::vector<Segment> truth;  // In their order.

  // What it is joined from: columns of a clip or of a filler, by their numbers.
  struct Part {
    bool is_clip = false;
    std::size_t source = 0;
    int first = 0;
    int count = 0;
  };
  std::vector<Part> parts;
};

// All clips in random order, with 2 to 10 seconds of fillers before, between and after them: a
// random stretch of a random filler, and if that is too short another one behind it. Everything is
// joined as columns, so features at the seams are those of their recordings.
//
// clips, fillers  One rate and feature count, none empty; at least one of each.
// seed            The same gives the same take on every machine.
// Errors          InvalidArgument, Mismatch.
// Cost            Linear in the result.
[[nodiscard]] LongTake MakeLongTake(std::span<const ClipOfClass> clips,
                                    std::span<const FeatureMatrix> fillers, std::uint64_t seed);

// The poses of the same columns.
// clips, fillers  [as in MakeLongTake]
// Errors          Mismatch if a stream has not the columns that its part needs.
[[nodiscard]] PoseStream JoinPoses(const LongTake& take, std::span<const PoseStream* const> clips,
                                   std::span<const PoseStream* const> fillers);

}  // namespace kinebase
