// Why a template matches a stretch of a take, in the terms of the take's file.
//
// Read search/explanation.h and library/take_search.h first.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kinebase/library/take_search.h"
#include "kinebase/search/explanation.h"

namespace kinebase {

// Another class's template that fits nearly the same stretch.
struct ExplainedRival {
  std::size_t motion_template = 0;  // Index of it.
  TakeHit hit;                      // Its cost is what its features alone cost.
};

struct HitExplanation {
  TakeHit hit;                       // Its take is 0.
  std::vector<ExplainedCell> cells;  // The path, from its first column to its last.
  // Of a template with a contrast only.
  double matching = 0;                 // What features add to the hit's cost,
  double places_cost = 0;              // what poses add that are not the class's,
  double lookalikes_cost = 0;          // and those of look-alikes; together they are the cost.
  std::vector<ExplainedPlace> places;  // [cell × kPoseValues]
  std::optional<ExplainedRival> rival;
};

// last_frame  Of the take's file, 1-based: the stretch that ends with it is explained, wherever it
//             starts. Without: the best hit, whatever it costs.
// Errors      InvalidArgument for a frame that the take does not have; NotFound where no path ends,
//             as too near to the take's beginning.
// Cost        That of a search of the take.
[[nodiscard]] HitExplanation ExplainHit(const QuantizedTemplate& motion_template,
                                        const TakeFeatures& take,
                                        std::optional<std::int64_t> last_frame = {});

// The same for a template with a contrast, as RankTakes finds it: poses, rivals and confidence too.
//
// templates   The first is explained, the others are its rivals.
// take        With poses.
// last_frame  Without: the hit that RankTakes puts first; where none costs as little as it asks,
//             the one that it would put first whatever it costs.
// Errors      As above; InvalidArgument for a template without a contrast; Mismatch for a template
//             of another rate or feature set than the first.
// Cost        That of a search of the take with all templates.
[[nodiscard]] HitExplanation ExplainRankedHit(std::span<const MotionTemplate> templates,
                                              const TakeFeatures& take,
                                              std::optional<std::int64_t> last_frame = {});

}  // namespace kinebase
