// Which motion class happens when, over long takes.
//
// Read search/hits.h and library/takes.h first. library/annotation_accuracy.h measures the result,
// library/annotation_file.h writes it, docs/annotation.md says why it is done so.
//
// Places are frames or columns, counted from anything and inclusive: a caller keeps to one of them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kinebase/library/take_search.h"

namespace kinebase {

// A stretch of a take that may be an instance of a class.
struct AnnotationCandidate {
  int motion_class = 0;  // Index of the class; several templates may belong to one.
  std::int64_t first = 0;
  std::int64_t last = 0;
  double cost = 0;
  double tau = 0;                    // The most that a hit of this template may cost.
  std::optional<double> confidence;  // Share of such hits that are right, where it is known.

  friend bool operator==(const AnnotationCandidate&, const AnnotationCandidate&) = default;
};

// A template and what its hits stand for.
struct AnnotationTemplate {
  int motion_class = 0;
  QuantizedTemplate quantized;
  double tau = kDefaultTau;
};

// The best match that ends at each column, where it costs no more than τ. All of them, not the hits
// alone that search gives: which end is best depends on the neighbours.
//
// Errors   Mismatch if the features have another rate or feature count than the template.
// Cost     O(template columns · columns).
// Threads  May be called concurrently.
[[nodiscard]] std::vector<AnnotationCandidate> FindCandidates(
    const AnnotationTemplate& motion_template, const FeatureView& features);

// The same in frames of the take's file, from 1.
[[nodiscard]] std::vector<AnnotationCandidate> FindCandidates(
    const AnnotationTemplate& motion_template, const TakeView& take);

// The same of templates that know what sets their class off (templates/contrast.h): the costs of
// RankHits, below the templates' own thresholds, with confidences.
//
// classes      [template]
// ingredients  Which of a template's are used; the rest of the options is not.
// Errors       As RankHits.
[[nodiscard]] std::vector<AnnotationCandidate> FindCandidates(
    std::span<const MotionTemplate> templates, std::span<const int> classes,
    const RecordingStreams& recording, const RankOptions& ingredients = {});
[[nodiscard]] std::vector<AnnotationCandidate> FindCandidates(
    std::span<const MotionTemplate> templates, std::span<const int> classes, const TakeView& take);

// The choice of candidates that explains most of a take: the largest sum of length · (1 − cost /
// τ), where no two of one track overlap. So what costs as much as its τ counts nothing, and one
// long match wins over two short ones that fit no better.
//
// Neighbours may overlap by a twentieth of the one's length and a twentieth of the other's; the
// border is then set within that stretch, so that none loses more than its twentieth.
//
// tracks   [class] classes of one track exclude each other, whatever their numbers; those of
//          different tracks may overlap. Empty: all are of one.
// Returns  By their first place, then track. Instances of a class stay apart.
// Errors   InvalidArgument: a class without a track, a candidate that ends before it begins, a cost
//          above τ.
// Cost     O(candidates · log candidates).
[[nodiscard]] std::vector<AnnotationCandidate> ChooseSegments(
    const std::vector<AnnotationCandidate>& candidates, std::span<const int> tracks = {});

// Neighbours of one class with at most `largest_gap` places between them become one segment; cost
// and τ are means by length, the confidence too if all have one.
//
// segments  As ChooseSegments returns them.
[[nodiscard]] std::vector<AnnotationCandidate> MergeSegments(
    const std::vector<AnnotationCandidate>& segments, std::int64_t largest_gap);

// Places from `first` to `last` that no segment covers, as stretches.
struct PlaceRange {
  std::int64_t first = 0;
  std::int64_t last = 0;

  friend bool operator==(const PlaceRange&, const PlaceRange&) = default;
};
[[nodiscard]] std::vector<PlaceRange> UncoveredStretches(
    std::span<const AnnotationCandidate> segments, const PlaceRange& whole);

// Tracks by the features that templates ask for (kConsistent bits): classes that ask for features
// of one group exclude each other, directly or through a third; arms and legs alone do not.
//
// templates  Of all classes 0 … class_count − 1, all with the features of `features`.
// Errors     InvalidArgument: a class out of range; Mismatch: another number of features.
[[nodiscard]] std::vector<int> TracksByBodyPart(std::span<const AnnotationTemplate> templates,
                                                int class_count, const FeatureSet& features);

// A threshold from recordings that do not show the class: 0.7 of what the second-best of them costs
// at its best. The best is passed over, as one may show the class after all. Where there is one
// only, that decides.
//
// Why 0.7: between 0.6 and 0.8 it made little difference on actors of HDM05 that were left out;
// docs/annotation.md says how far that choice can be trusted.
// Costs are those of RankHits: of templates that know what sets their class off, and of plain ones.
//
// ingredients  Which of a template's are used, and threads; the rest of the options is not.
// Returns      Empty if no recording is long enough for the template.
// Errors       As RankHits.
[[nodiscard]] std::optional<double> ThresholdFromBackground(
    const MotionTemplate& motion_template, std::span<const RecordingStreams> background,
    const RankOptions& ingredients = {});

// The two steps of that, for a background that comes some recordings at a time: what the best hit
// costs in each recording that has one, in any order; and the threshold by all of them.
// Errors  As RankHits.
[[nodiscard]] std::vector<double> LeastCosts(const MotionTemplate& motion_template,
                                             std::span<const RecordingStreams> background,
                                             const RankOptions& ingredients = {});
[[nodiscard]] std::optional<double> ThresholdBelow(std::vector<double> least_costs);

}  // namespace kinebase
