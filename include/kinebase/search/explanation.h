// Why a stretch of a recording matches a template: the warping path, and along it which features
// were as the template asks and which were not, and how far poses were from the class's.
//
// Read search/subsequence_dtw.h first, and search/ranking.h for poses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinebase/features/pose_stream.h"
#include "kinebase/search/subsequence_dtw.h"

namespace kinebase {

// One cell of the path. Bit i stands for feature i; free ones are in neither word.
struct ExplainedCell {
  PathCell cell;
  std::uint64_t agreed = 0;
  std::uint64_t disagreed = 0;
  double cost = 0;   // What the cell adds to the hit's: Δ is their sum, but for rounding.
  double share = 0;  // Of a feature's cost in that: of the step, and of the template's length.

  friend bool operator==(const ExplainedCell&, const ExplainedCell&) = default;
};

// What a feature (from 0) that disagrees in a cell of the template adds to the hit's cost.
[[nodiscard]] double CostOfFeature(const QuantizedTemplate& motion_template,
                                   const ExplainedCell& cell, int feature);

// The path behind delta[last], as TracePath; empty if none ends there.
// Cost  That of TracePath.
[[nodiscard]] std::vector<ExplainedCell> ExplainPath(const QuantizedTemplate& motion_template,
                                                     std::span<const std::uint64_t> columns,
                                                     int last);

// One of the values of a pose in a cell of the path, where a joint lies along one axis.
struct ExplainedPlace {
  double off = 0;   // From the class's mean, in standard deviations of other motion; above 0 is to
                    // the body's left (x), upwards (y) or to the front (z).
  double cost = 0;  // What it adds to the hit's: a tenth of the hit's `places` is their sum, but
                    // for rounding.

  friend bool operator==(const ExplainedPlace&, const ExplainedPlace&) = default;
};

// [cell of the path × kPoseValues]
// Cost  O(cells).
[[nodiscard]] std::vector<ExplainedPlace> ExplainPlaces(const PoseModel& model,
                                                        std::span<const ExplainedCell> path,
                                                        const PoseStream& poses);

}  // namespace kinebase
