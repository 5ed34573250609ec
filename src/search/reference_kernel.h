// The subsequence DTW in plain C++, for any local costs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kinebase/search/subsequence_dtw.h"
#include "search/local_costs.h"

namespace kinebase::internal {

[[nodiscard]] DeltaCurve ComputeDelta(const LocalCosts& costs, std::size_t rows, Profile matching,
                                      std::span<const std::uint64_t> columns);

}  // namespace kinebase::internal
