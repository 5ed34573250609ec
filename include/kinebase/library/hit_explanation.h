// Why a template matches a stretch of a take, in the terms of the take's file.
//
// Read search/explanation.h and library/take_search.h first.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kinebase/library/take_search.h"
#include "kinebase/search/explanation.h"

namespace kinebase {

struct HitExplanation {
  TakeHit hit;                       // Its take is 0.
  std::vector<ExplainedCell> cells;  // The path, from its first column to its last.
};

// last_frame  Of the take's file, 1-based: the stretch that ends with it is explained, wherever it
//             starts. Without: the best hit, whatever it costs.
// Errors      InvalidArgument for a frame that the take does not have; NotFound where no path ends,
//             as too near to the take's beginning.
// Cost        That of a search of the take.
[[nodiscard]] HitExplanation ExplainHit(const QuantizedTemplate& motion_template,
                                        const TakeFeatures& take,
                                        std::optional<std::int64_t> last_frame = {});

}  // namespace kinebase
