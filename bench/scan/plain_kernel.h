// What one would write for speed without vector instructions: loops of doubles that the compiler
// turns into them, for the instruction set of this machine.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinebase {

// The Δ curve of profile `paper` without starts, where no feature is free: `features` bits of each
// column count, and a mismatch costs 1 / features.
[[nodiscard]] std::vector<double> PlainDelta(std::span<const std::uint64_t> template_columns,
                                             std::span<const std::uint64_t> columns, int features);

}  // namespace kinebase
