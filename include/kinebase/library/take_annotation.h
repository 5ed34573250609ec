// Annotating all takes of a source, some of them at a time: files, or a library of any size.
//
// Read library/annotation.h and library/take_source.h first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinebase/library/annotation.h"
#include "kinebase/library/take_source.h"

namespace kinebase {

// A template that is ready to be looked for. Those that agree in the hash of their feature set and
// in the rate share the takes' features.
struct AnnotationQuery {
  MotionTemplate motion_template;  // Its threshold is that of `search`.
  FeatureSet features;
  std::string class_name;
  AnnotationTemplate search;
};

struct AnnotateTakesOptions {
  std::vector<int> tracks;        // As ChooseSegments takes them.
  std::optional<double> merge_s;  // Repetitions with at most this pause are one segment.
  int threads = 0;
  ProgressCallback progress;
};

struct TakeSegments {
  std::filesystem::path path;
  double rate_hz = 0;
  std::int64_t frame_count = 0;
  std::vector<AnnotationCandidate> segments;  // Frames of the file, from 1.
  Diagnostics diagnostics;
};

struct AnnotatedTakes {
  // Those that could be read for some template, in the order of the source.
  std::vector<TakeSegments> takes;
  std::vector<TakeFailure> failures;  // Of all templates: a take may be among both.
};

// Errors   Those of TakeSource::Visit, FindCandidates and ChooseSegments.
// Cost     Of FindCandidates. Memory: candidates of the takes at hand, and all segments.
// Threads  The result does not depend on the thread count.
[[nodiscard]] AnnotatedTakes AnnotateTakes(const TakeSource& source,
                                           std::span<const AnnotationQuery> queries,
                                           const AnnotateTakesOptions& options = {});

struct BackgroundThresholds {
  std::vector<std::optional<double>> tau;  // [query] as ThresholdFromBackground.
  std::vector<TakeFailure> failures;
};

// Thresholds from sources that show other motion. A take that is known to show a query's class is
// no background for that. Errors, cost  As ThresholdFromBackground, and those of TakeSource::Visit.
[[nodiscard]] BackgroundThresholds FindThresholds(std::span<const TakeSource> background,
                                                  std::span<const AnnotationQuery> queries,
                                                  int threads = 0,
                                                  const ProgressCallback& progress = {});

}  // namespace kinebase
