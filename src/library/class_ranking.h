// What the evaluation ranks: hits of one class in one stream, by whatever method. Internal.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinebase/library/evaluation.h"
#include "library/threshold_rule.h"

namespace kinebase::internal {

struct ClassRanking {
  std::string class_name;
  std::string example;          // The file that was looked for; empty where the class was learned.
  std::vector<RankedHit> hits;  // Best first.
  double usual_delta = 0;       // Median of Δ over all columns where a path ends; 0 = not known.
  std::optional<double> tau;    // The class's own.
  std::optional<Calibration> calibration;
};

// Median over the columns where a path ends; 0 if none does anywhere.
// curves  Δ curves of all recordings.
[[nodiscard]] double UsualDelta(std::span<const DeltaCurve> curves);

struct BaselineInput {
  std::span<const LabelledClip* const> train;
  std::span<const MotionTemplate> learned;  // From these, one a class.
  std::span<const TakeFeatures* const> stream;
  const FeatureSet& features;
  Profile matching = Profile::kBonn;
  int threads = 0;
};

// For each class one ranking, or one for each of its examples.
// Errors  Mismatch: clips or takes without the joint streams that the baseline compares.
[[nodiscard]] std::vector<ClassRanking> RankByBaseline(const Baseline& baseline,
                                                       const BaselineInput& input);

}  // namespace kinebase::internal
