// One template against many recordings.
//
// Read search/hits.h first. library/ says where recordings come from.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kinebase/core/progress.h"
#include "kinebase/features/feature_matrix.h"
#include "kinebase/search/feature_index.h"
#include "kinebase/search/hits.h"

namespace kinebase {

// The threshold for templates without one of their own: Müller & Röder, SCA 2006, Sect. 5.4.
inline constexpr double kDefaultTau = 0.06;

struct SearchOptions {
  double tau = kDefaultTau;
  std::size_t most_hits = 500;
  int threads = 0;  // 0 = as many as the hardware has.
  ProgressCallback progress;
};

// No path and no suppression crosses from one recording to another. Short recordings are taken
// together, so that many of them cost as much as one long one.
//
// Errors   Mismatch if a recording has another rate or feature count than the template; Cancelled.
// Cost     O(template columns · columns of all recordings); memory for one curve a thread.
// Threads  The result does not depend on the thread count.
[[nodiscard]] std::vector<Hit> SearchTemplate(const QuantizedTemplate& motion_template,
                                              std::span<const FeatureView> recordings,
                                              const SearchOptions& options = {});
[[nodiscard]] std::vector<Hit> SearchTemplate(const QuantizedTemplate& motion_template,
                                              std::span<const FeatureMatrix> recordings,
                                              const SearchOptions& options = {});

// The same within stretches only, as search/keyframe_index.h selects them. No path leaves its
// stretch; hits of one recording suppress each other as ever.
//
// stretches  By recording and place, without overlaps.
// Errors     Also InvalidArgument for stretches that are otherwise or leave their recording.
[[nodiscard]] std::vector<Hit> SearchTemplate(const QuantizedTemplate& motion_template,
                                              std::span<const FeatureView> recordings,
                                              std::span<const Stretch> stretches,
                                              const SearchOptions& options = {});
[[nodiscard]] std::vector<Hit> SearchTemplate(const QuantizedTemplate& motion_template,
                                              std::span<const FeatureMatrix> recordings,
                                              std::span<const Stretch> stretches,
                                              const SearchOptions& options = {});

}  // namespace kinebase
