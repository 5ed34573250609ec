#include "kinebase/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace kinebase {
namespace {

TEST(ParallelFor, CallsEachIndexOnce) {
  for (const int threads : {0, 1, 2, 4, 33}) {
    for (const std::size_t count : {0U, 1U, 2U, 7U, 1000U}) {
      std::vector<std::atomic<int>> calls(count);
      ParallelFor(count, threads, [&](std::size_t i) { ++calls[i]; });
      for (const auto& each : calls) EXPECT_EQ(each.load(), 1);
    }
  }
}

TEST(ParallelFor, NeverUsesMoreThreadsThanAskedFor) {
  std::atomic<int> running{0};
  std::atomic<int> most{0};
  ParallelFor(64, 2, [&](std::size_t) {
    const int now = ++running;
    int before = most.load();
    while (before < now && !most.compare_exchange_weak(before, now)) {
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    --running;
  });
  EXPECT_LE(most.load(), 2);
}

TEST(ParallelFor, RunsInOrderOnOneThread) {
  std::vector<std::size_t> order;
  ParallelFor(5, 1, [&](std::size_t i) { order.push_back(i); });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(ParallelFor, ThrowsTheExceptionOfTheSmallestIndexThatThrew) {
  for (const int threads : {1, 2, 4}) {
    // Item 3 begins before item 4 throws, and throws after it.
    std::atomic<bool> three_began{false};
    std::atomic<bool> four_threw{false};
    try {
      ParallelFor(100, threads, [&](std::size_t i) {
        if (i == 4) {
          while (!three_began) std::this_thread::yield();
          four_threw = true;
          throw std::runtime_error("4");
        }
        if (i == 3) {
          three_began = true;
          const auto patience = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
          while (!four_threw && std::chrono::steady_clock::now() < patience) {
            std::this_thread::yield();
          }
          throw std::runtime_error("3");
        }
      });
      ADD_FAILURE() << "expected an exception";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "3") << threads;
    }
  }
}

TEST(ParallelFor, EndsRunningItemsBeforeItThrows) {
  std::atomic<int> begun{0};
  std::atomic<int> ended{0};
  EXPECT_THROW(ParallelFor(50, 4,
                           [&](std::size_t i) {
                             ++begun;
                             std::this_thread::sleep_for(std::chrono::milliseconds(1));
                             ++ended;
                             if (i == 2) throw std::runtime_error("2");
                           }),
               std::runtime_error);
  EXPECT_EQ(begun.load(), ended.load());
}

TEST(ParallelFor, MayBeNested) {
  std::atomic<int> calls{0};
  ParallelFor(8, 4, [&](std::size_t) { ParallelFor(8, 4, [&](std::size_t) { ++calls; }); });
  EXPECT_EQ(calls.load(), 64);
}

TEST(HardwareThreads, IsAtLeastOne) { EXPECT_GE(HardwareThreads(), 1); }

}  // namespace
}  // namespace kinebase
