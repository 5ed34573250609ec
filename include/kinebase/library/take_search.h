// One template against takes: hits in the terms of their files.
//
// Read library/takes.h and search/template_search.h first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kinebase/library/takes.h"
#include "kinebase/search/fuzzy_search.h"
#include "kinebase/search/keyframe_index.h"
#include "kinebase/search/ranking.h"
#include "kinebase/search/template_search.h"

namespace kinebase {

struct TakeHit {
  std::size_t take = 0;          // Index of the take.
  std::int64_t first_frame = 0;  // Of the take's file, 1-based, inclusive.
  std::int64_t last_frame = 0;
  double start_s = 0;  // From the start of the take to the start of the first frame,
  double end_s = 0;    // and to the end of the last.
  double cost = 0;
  double score = 0;                  // What hits are ordered by: the cost, and rivals if any.
  std::optional<double> confidence;  // How likely it is right, where the template knows.

  friend bool operator==(const TakeHit&, const TakeHit&) = default;
};

// SearchTemplate, its columns turned into frames and seconds.
// Errors, cost, threads  As SearchTemplate.
[[nodiscard]] std::vector<TakeHit> SearchTakes(const QuantizedTemplate& motion_template,
                                               std::span<const TakeView> takes,
                                               const SearchOptions& options = {});
[[nodiscard]] inline std::vector<TakeHit> SearchTakes(const QuantizedTemplate& motion_template,
                                                      std::span<const TakeFeatures> takes,
                                                      const SearchOptions& options = {}) {
  return SearchTakes(motion_template, ViewsOf(takes), options);
}

// RankHits, its columns turned into frames and seconds: for each template its hits in that order,
// below its own threshold where options.tau does not say another.
//
// takes  With poses.
// Errors, cost, threads  As RankHits.
struct RankTakesOptions {
  std::optional<double> tau;
  std::size_t most_hits = 500;
  int threads = 0;
  ProgressCallback progress;
};
[[nodiscard]] std::vector<std::vector<TakeHit>> RankTakes(std::span<const MotionTemplate> templates,
                                                          std::span<const TakeView> takes,
                                                          const RankTakesOptions& options = {});
[[nodiscard]] inline std::vector<std::vector<TakeHit>> RankTakes(
    std::span<const MotionTemplate> templates, std::span<const TakeFeatures> takes,
    const RankTakesOptions& options = {}) {
  return RankTakes(templates, ViewsOf(takes), options);
}

// The same within stretches only; a stretch's recording is the index of its take.
[[nodiscard]] std::vector<TakeHit> SearchTakes(const QuantizedTemplate& motion_template,
                                               std::span<const TakeView> takes,
                                               std::span<const Stretch> stretches,
                                               const SearchOptions& options = {});

// SearchFuzzy, its columns turned into frames and seconds.
// Errors, cost  As SearchFuzzy.
[[nodiscard]] std::vector<TakeHit> SearchTakes(const FuzzyQuery& query,
                                               std::span<const TakeView> takes,
                                               const FuzzyOptions& options = {});
[[nodiscard]] inline std::vector<TakeHit> SearchTakes(const FuzzyQuery& query,
                                                      std::span<const TakeFeatures> takes,
                                                      const FuzzyOptions& options = {}) {
  return SearchTakes(query, ViewsOf(takes), options);
}

// Where all takes show what, for keyframes of templates with this feature set.
[[nodiscard]] KeyframeIndex IndexTakes(std::span<const TakeView> takes, const FeatureSet& features);

// For each column what the best match that ends there costs, +inf where none does: Δ for a plain
// template; where poses count, with them, as for its hits.
//
// take     With poses, if the template has a contrast.
// Errors   As RankTakes.
// Cost     Of ComputeDelta; with poses also the square of the template's columns for each column.
[[nodiscard]] std::vector<double> CostCurve(const MotionTemplate& motion_template,
                                            const TakeView& take);

}  // namespace kinebase
