#include "kinebase/library/annotation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <ranges>
#include <tuple>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "kinebase/search/ranking.h"
#include "kinebase/templates/calibration.h"
#include "library/take_frames.h"

namespace kinebase {
namespace {

constexpr double kShareOfFalseCost = 0.7;  // See ThresholdFromBackground.
constexpr std::int64_t kMarginDivisor = 20;

using Candidates = std::vector<AnnotationCandidate>;

void CheckFeatures(const QuantizedTemplate& motion_template, const FeatureView& features) {
  if (motion_template.feature_count == features.feature_count &&
      motion_template.rate_hz == features.rate_hz) {
    return;
  }
  throw Error(ErrorCode::kMismatch,
              fmt::format("a recording has {} features at {} Hz, the template {} at {} Hz; extract "
                          "its features with the template's set and rate",
                          features.feature_count, features.rate_hz, motion_template.feature_count,
                          motion_template.rate_hz));
}

std::int64_t Length(const AnnotationCandidate& candidate) {
  return candidate.last - candidate.first + 1;
}

// What a segment may lose at each end.
std::int64_t Margin(const AnnotationCandidate& candidate) {
  return Length(candidate) / kMarginDivisor;
}

double Worth(const AnnotationCandidate& candidate) {
  const double share = candidate.tau > 0 ? candidate.cost / candidate.tau : 0;
  return static_cast<double>(Length(candidate)) * (1 - share);
}

int TrackOf(const AnnotationCandidate& candidate, std::span<const int> tracks) {
  if (tracks.empty()) return 0;
  if (candidate.motion_class < 0 || candidate.motion_class >= std::ssize(tracks)) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("class {} has no track; there are tracks for {} classes",
                            candidate.motion_class, tracks.size()));
  }
  return tracks[static_cast<std::size_t>(candidate.motion_class)];
}

void CheckCandidate(const AnnotationCandidate& candidate) {
  if (candidate.first <= candidate.last && candidate.cost >= 0 && candidate.cost <= candidate.tau) {
    return;
  }
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("a candidate from {} to {} of cost {} with threshold {}; expected first "
                          "≤ last and 0 ≤ cost ≤ threshold",
                          candidate.first, candidate.last, candidate.cost, candidate.tau));
}

// Weighted interval scheduling: the best choice among the candidates up to each one, by their ends.
Candidates BestChoice(Candidates candidates) {
  const auto end = [](const AnnotationCandidate& c) { return c.last - Margin(c); };
  const auto order = [&](const AnnotationCandidate& c) {
    return std::tuple(end(c), c.first, c.motion_class, c.cost);
  };
  std::ranges::sort(candidates, {}, order);
  // [i] of the first i candidates: what they are worth, and the choice before the last one taken.
  std::vector<double> worth(candidates.size() + 1, 0);
  std::vector<std::size_t> before(candidates.size() + 1, 0);
  std::vector<char> taken(candidates.size() + 1, 0);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const AnnotationCandidate& candidate = candidates[i];
    const auto earlier = std::ranges::lower_bound(
        candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(i),
        candidate.first + Margin(candidate), {}, end);
    const auto compatible = static_cast<std::size_t>(earlier - candidates.begin());
    const double with = worth[compatible] + Worth(candidate);
    taken[i + 1] = with > worth[i] ? 1 : 0;
    worth[i + 1] = std::max(with, worth[i]);
    before[i + 1] = compatible;
  }
  Candidates chosen;
  for (std::size_t i = candidates.size(); i > 0;) {
    if (taken[i] == 0) {
      --i;
      continue;
    }
    chosen.push_back(candidates[i - 1]);
    i = before[i];
  }
  std::ranges::reverse(chosen);
  return chosen;
}

// Neighbours overlap by no more than the sum of their margins; each gives in proportion to its own.
void SettleBorders(Candidates& segments) {
  Candidates settled = segments;
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const std::int64_t overlap = segments[i - 1].last - segments[i].first + 1;
    if (overlap <= 0) continue;
    const std::int64_t left = Margin(segments[i - 1]);
    const std::int64_t right = Margin(segments[i]);
    settled[i - 1].last -= overlap * left / (left + right);
    settled[i].first = settled[i - 1].last + 1;
  }
  segments = std::move(settled);
}

// Groups of features that a template asks for, as bits by `group_of`.
std::uint64_t GroupsAskedFor(const QuantizedTemplate& motion_template,
                             std::span<const int> group_of) {
  std::uint64_t features = 0;
  for (const QuantizedColumn& column : motion_template.columns) features |= column.consistent;
  std::uint64_t groups = 0;
  for (std::size_t i = 0; i < group_of.size(); ++i) {
    if (((features >> i) & 1U) != 0) groups |= std::uint64_t{1} << group_of[i];
  }
  return groups;
}

std::vector<int> GroupNumbers(const FeatureSet& features) {
  std::map<std::string, int> numbers;
  std::vector<int> group_of;
  for (const Feature& feature : features.features) {
    const int next = static_cast<int>(numbers.size());
    group_of.push_back(numbers.try_emplace(feature.group, next).first->second);
  }
  return group_of;
}

// Columns become frames of the take's file, from 1.
Candidates InFrames(Candidates candidates, const TakeView& take) {
  for (AnnotationCandidate& candidate : candidates) {
    const FrameRange frames = internal::FramesOfHit(take, static_cast<int>(candidate.first),
                                                    static_cast<int>(candidate.last));
    candidate.first = frames.first + 1;
    candidate.last = frames.last + 1;
  }
  return candidates;
}

}  // namespace

std::vector<AnnotationCandidate> FindCandidates(const AnnotationTemplate& motion_template,
                                                const FeatureView& features) {
  CheckFeatures(motion_template.quantized, features);
  const DeltaCurve curve = ComputeDelta(motion_template.quantized, features.columns);
  Candidates candidates;
  for (std::size_t i = 0; i < curve.delta.size(); ++i) {
    if (curve.start[i] < 0 || !(curve.delta[i] <= motion_template.tau)) continue;
    candidates.push_back({.motion_class = motion_template.motion_class,
                          .first = curve.start[i],
                          .last = static_cast<std::int64_t>(i),
                          .cost = curve.delta[i],
                          .tau = motion_template.tau,
                          .confidence = {}});
  }
  return candidates;
}

std::vector<AnnotationCandidate> FindCandidates(const AnnotationTemplate& motion_template,
                                                const TakeView& take) {
  return InFrames(FindCandidates(motion_template, take.features), take);
}

std::vector<AnnotationCandidate> FindCandidates(std::span<const MotionTemplate> templates,
                                                std::span<const int> classes,
                                                const RecordingStreams& recording,
                                                const RankOptions& ingredients) {
  RankOptions options = ingredients;
  options.tau.reset();
  options.rivals = false;  // ChooseSegments lets classes compete.
  options.every_end = true;
  options.most_hits = std::numeric_limits<std::size_t>::max();
  options.threads = 1;
  const auto hits = RankHits(templates, std::span(&recording, 1), options);
  Candidates candidates;
  for (std::size_t t = 0; t < templates.size(); ++t) {
    const double tau = templates[t].tau.value_or(std::numeric_limits<double>::infinity());
    const std::optional<Calibration>& calibration = templates[t].calibration;
    for (const RankedHit& ranked : hits[t]) {
      AnnotationCandidate& candidate =
          candidates.emplace_back(AnnotationCandidate{.motion_class = classes[t],
                                                      .first = ranked.hit.first,
                                                      .last = ranked.hit.last,
                                                      .cost = ranked.hit.cost,
                                                      .tau = tau,
                                                      .confidence = {}});
      if (calibration) candidate.confidence = Confidence(*calibration, candidate.cost);
    }
  }
  return candidates;
}

std::vector<AnnotationCandidate> FindCandidates(std::span<const MotionTemplate> templates,
                                                std::span<const int> classes,
                                                const TakeView& take) {
  return InFrames(FindCandidates(templates, classes, {take.features, take.poses}), take);
}

std::vector<AnnotationCandidate> ChooseSegments(const std::vector<AnnotationCandidate>& candidates,
                                                std::span<const int> tracks) {
  std::map<int, Candidates> by_track;
  for (const AnnotationCandidate& candidate : candidates) {
    CheckCandidate(candidate);
    by_track[TrackOf(candidate, tracks)].push_back(candidate);
  }
  Candidates segments;
  for (auto& [track, of_track] : by_track) {
    Candidates chosen = BestChoice(std::move(of_track));
    SettleBorders(chosen);
    segments.insert(segments.end(), chosen.begin(), chosen.end());
  }
  std::ranges::stable_sort(segments, {}, &AnnotationCandidate::first);
  return segments;
}

std::vector<AnnotationCandidate> MergeSegments(const std::vector<AnnotationCandidate>& segments,
                                               std::int64_t largest_gap) {
  Candidates merged;
  std::map<int, std::size_t> latest;  // [class] place in `merged`.
  for (const AnnotationCandidate& segment : segments) {
    const auto [entry, is_new] = latest.try_emplace(segment.motion_class, merged.size());
    if (is_new || segment.first - merged[entry->second].last - 1 > largest_gap) {
      entry->second = merged.size();
      merged.push_back(segment);
      continue;
    }
    AnnotationCandidate& whole = merged[entry->second];
    const double share =
        static_cast<double>(Length(segment)) / static_cast<double>(Length(whole) + Length(segment));
    whole.cost = std::lerp(whole.cost, segment.cost, share);
    whole.tau = std::lerp(whole.tau, segment.tau, share);
    if (whole.confidence && segment.confidence) {
      whole.confidence = std::lerp(*whole.confidence, *segment.confidence, share);
    } else {
      whole.confidence.reset();
    }
    whole.last = segment.last;
  }
  return merged;
}

std::vector<PlaceRange> UncoveredStretches(std::span<const AnnotationCandidate> segments,
                                           const PlaceRange& whole) {
  std::vector<PlaceRange> stretches;
  std::int64_t next = whole.first;
  for (const AnnotationCandidate& segment : segments) {  // By their first place.
    if (segment.first > next) {
      stretches.push_back({next, std::min(segment.first - 1, whole.last)});
    }
    next = std::max(next, segment.last + 1);
    if (next > whole.last) break;
  }
  if (next <= whole.last) stretches.push_back({next, whole.last});
  return stretches;
}

std::vector<int> TracksByBodyPart(std::span<const AnnotationTemplate> templates, int class_count,
                                  const FeatureSet& features) {
  const std::vector<int> group_of = GroupNumbers(features);
  std::vector<std::uint64_t> groups(static_cast<std::size_t>(class_count), 0);
  for (const AnnotationTemplate& one : templates) {
    if (one.quantized.feature_count != features.feature_count()) {
      throw Error(
          ErrorCode::kMismatch,
          fmt::format("a template has {} features, the set '{}' {}; body parts need "
                      "templates of one feature set",
                      one.quantized.feature_count, features.name, features.feature_count()));
    }
    if (one.motion_class < 0 || one.motion_class >= class_count) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("class {} of {}", one.motion_class, class_count));
    }
    groups[static_cast<std::size_t>(one.motion_class)] |= GroupsAskedFor(one.quantized, group_of);
  }
  std::vector<int> tracks(groups.size());
  std::iota(tracks.begin(), tracks.end(), 0);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((groups[i] & groups[j]) == 0 || tracks[i] == tracks[j]) continue;
      std::ranges::replace(tracks, std::max(tracks[i], tracks[j]), std::min(tracks[i], tracks[j]));
    }
  }
  return tracks;
}

std::vector<double> LeastCosts(const MotionTemplate& motion_template,
                               std::span<const RecordingStreams> background,
                               const RankOptions& ingredients) {
  RankOptions options = ingredients;
  options.tau = std::numeric_limits<double>::infinity();
  options.rivals = false;
  options.every_end = false;
  options.most_hits = std::numeric_limits<std::size_t>::max();
  std::map<int, double> least;  // By recording; those without a hit are too short.
  const auto hits = RankHits(std::span(&motion_template, 1), background, options);
  for (const RankedHit& ranked : hits.front()) {
    const auto [entry, is_new] = least.try_emplace(ranked.hit.recording, ranked.hit.cost);
    entry->second = std::min(entry->second, ranked.hit.cost);
  }
  const auto costs = std::views::values(least);
  return {costs.begin(), costs.end()};
}

std::optional<double> ThresholdBelow(std::vector<double> least_costs) {
  if (least_costs.empty()) return std::nullopt;
  std::ranges::sort(least_costs);
  return kShareOfFalseCost * least_costs[std::min<std::size_t>(1, least_costs.size() - 1)];
}

std::optional<double> ThresholdFromBackground(const MotionTemplate& motion_template,
                                              std::span<const RecordingStreams> background,
                                              const RankOptions& ingredients) {
  return ThresholdBelow(LeastCosts(motion_template, background, ingredients));
}

}  // namespace kinebase
