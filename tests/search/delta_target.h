// One instruction set for as long as a test runs.
#pragma once

#include <cstdint>

#include "kinebase/search/subsequence_dtw.h"

namespace kinebase::test {

// Puts the choice of instructions back when a test is over.
class DeltaTarget {
 public:
  explicit DeltaTarget(std::int64_t target) { UseDeltaTarget(target); }
  ~DeltaTarget() { UseDeltaTarget(0); }
  DeltaTarget(const DeltaTarget&) = delete;
  DeltaTarget& operator=(const DeltaTarget&) = delete;
};

}  // namespace kinebase::test
