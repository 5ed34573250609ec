// Loops over independent items on several threads.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "kinebase/core/progress.h"

namespace kinebase {

// The number of hardware threads, at least 1.
[[nodiscard]] int HardwareThreads();

// Calls body(i) for every i in [0, count), each once, in any order, on up to `threads` threads
// (0 = as many as the hardware has). Returns when all are done.
//
// Errors   If bodies throw, the exception of the smallest index that threw is thrown here, after
//          the running ones ended; items not yet begun may be left out.
void ParallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

// The same with progress: `progress` hears after each item how many are done.
// Errors   Also Cancelled, once `progress` has returned false.
void ParallelFor(std::size_t count, int threads, std::string_view what,
                 const ProgressCallback& progress, const std::function<void(std::size_t)>& body);

}  // namespace kinebase
