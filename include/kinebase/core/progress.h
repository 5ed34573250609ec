// How long work reports where it is, and how it is told to stop.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

namespace kinebase {

// Called with what is being done, how many items are done and how many there are in all, never
// from two threads at once. Returns false to cancel: the work then throws Error(kCancelled).
// An empty function is fine: nobody listens.
using ProgressCallback =
    std::function<bool(std::string_view what, std::size_t done, std::size_t total)>;

}  // namespace kinebase
