// One template against takes: hits in the terms of their files.
//
// Read library/takes.h and search/template_search.h first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kinebase/library/takes.h"
#include "kinebase/search/template_search.h"

namespace kinebase {

struct TakeHit {
  std::size_t take = 0;          // Index of the take.
  std::int64_t first_frame = 0;  // Of the take's file, 1-based, inclusive.
  std::int64_t last_frame = 0;
  double start_s = 0;  // From the start of the take to the start of the first frame,
  double end_s = 0;    // and to the end of the last.
  double cost = 0;

  friend bool operator==(const TakeHit&, const TakeHit&) = default;
};

// SearchTemplate, its columns turned into frames and seconds.
// Errors, cost, threads  As SearchTemplate.
[[nodiscard]] std::vector<TakeHit> SearchTakes(const QuantizedTemplate& motion_template,
                                               std::span<const TakeFeatures> takes,
                                               const SearchOptions& options = {});

}  // namespace kinebase
