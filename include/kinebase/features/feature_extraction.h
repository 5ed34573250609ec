// From the 24 standard joints to the feature matrix.
//
// Read features/feature_set.h first; templates/ and search/ consume the result.
// Method: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 3 and Appendix A.
// Departures: docs/design/features.md.
#pragma once

#include <cstdint>
#include <vector>

#include "kinebase/features/feature_matrix.h"
#include "kinebase/features/feature_set.h"
#include "kinebase/motion/motion.h"

namespace kinebase {

// Asked before long work: ExtractFeatures makes the same demand.
// Errors  InvalidArgument unless `rate_hz` divides the set's rate.
void CheckColumnRate(const FeatureSet& features, double rate_hz);

// Features of a recording, computed at the set's rate and thinned to `rate_hz`.
//
// standard_joints  24 joints, at least one frame; another rate than the set's is resampled first.
// rate_hz          A divisor of the set's rate: column c is the set's sample c · (set rate / rate).
// Errors           InvalidArgument.
// Cost             O(frames · features).
[[nodiscard]] FeatureMatrix ExtractFeatures(const JointTrajectories& standard_joints,
                                            const FeatureSet& features, double rate_hz = 30);

// The value behind a feature before any threshold, one for each sample at the set's rate; in cm,
// cm/s or degrees. For inspection and tests.
[[nodiscard]] std::vector<double> FeatureValues(const JointTrajectories& standard_joints,
                                                const FeatureSet& features, int feature);

// Frames of a recording (0-based, inclusive) that a column of its matrix stands for: those in the
// column's span of time. Never empty, never past the end.
struct FrameRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
};
[[nodiscard]] FrameRange FramesOfColumns(int first_column, int last_column, double column_rate_hz,
                                         double recording_rate_hz, std::int64_t frame_count);

}  // namespace kinebase
