#include "library/memory_gate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "kinebase/core/parallel.h"

namespace kinebase::internal {
namespace {

TEST(MemoryGate, LetsNoMoreInThanFitAndAllInTheEnd) {
  MemoryGate gate(100);
  std::atomic<std::int64_t> used = 0;
  std::atomic<int> done = 0;
  ParallelFor(200, 8, [&](std::size_t i) {
    const auto bytes = static_cast<std::int64_t>(i % 70);
    const MemoryGate::Pass pass(gate, bytes);
    EXPECT_LE(used += bytes, 100);
    used -= bytes;
    ++done;
  });
  EXPECT_EQ(done, 200);
}

TEST(MemoryGate, LetsInWhatNeverFitsAlone) {
  MemoryGate gate(100);
  std::atomic<int> inside = 0;
  ParallelFor(20, 8, [&](std::size_t) {
    const MemoryGate::Pass pass(gate, 1000);
    EXPECT_EQ(++inside, 1);
    --inside;
  });
  EXPECT_EQ(inside, 0);
}

}  // namespace
}  // namespace kinebase::internal
