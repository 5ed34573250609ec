// Loops over independent items on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace kinebase {

// The number of hardware threads, at least 1.
[[nodiscard]] int HardwareThreads();

// Calls body(i) for every i in [0, count), each once, in any order, on up to `threads` threads
// (0 = as many as the hardware has). Returns when all are done.
//
// Errors   If bodies throw, the exception of the smallest index that threw is thrown here, after
//          the running ones ended; items not yet begun may be left out.
void ParallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

}  // namespace kinebase
