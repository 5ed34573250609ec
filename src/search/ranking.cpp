#include "kinebase/search/ranking.h"

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "kinebase/search/subsequence_dtw.h"

namespace kinebase {
namespace {

// Chosen on actors left out among the training actors (docs/design/contrast.md); within a factor of
// two of each the result is the same but for noise.
constexpr double kPlacesWeight = 0.1;
constexpr double kRivalWeight = 0.5;
// Two spreads off is wrong; more says nothing more.
constexpr double kMostOff = 4;
// A template with half of its entries wrong is no rival.
constexpr double kNoRival = 0.5;

double Distance(const PoseModel& model, int column, std::span<const float> pose) {
  const std::size_t first = static_cast<std::size_t>(column) * kPoseValues;
  double distance = 0;
  for (std::size_t i = 0; i < pose.size(); ++i) {
    const double weight = model.weight[first + i];
    if (weight == 0) continue;
    const double off = pose[i] - model.mean[first + i];
    distance += weight * std::min(off * off / model.spread[i], kMostOff);
  }
  return distance;
}

// A template that is ready, and its curve over one recording.
struct Searched {
  const MotionTemplate* motion_template = nullptr;
  QuantizedTemplate quantized;
};

std::vector<Searched> Prepare(std::span<const MotionTemplate> templates,
                              std::span<const RecordingStreams> recordings) {
  std::vector<Searched> searched;
  for (const MotionTemplate& each : templates) {
    searched.push_back({&each, Quantize(each)});
    for (const RecordingStreams& recording : recordings) {
      if (recording.features->feature_count == each.matrix.feature_count &&
          recording.features->rate_hz == each.matrix.rate_hz) {
        continue;
      }
      throw Error(ErrorCode::kMismatch,
                  fmt::format("a recording has {} features at {} Hz, template '{}' {} at {} Hz",
                              recording.features->feature_count, recording.features->rate_hz,
                              each.name, each.matrix.feature_count, each.matrix.rate_hz));
    }
  }
  return searched;
}

// How near the best of other classes comes that ends within half a hit's length of its end.
double Rivalry(const Hit& hit, std::size_t own, std::span<const Searched> searched,
               std::span<const DeltaCurve> curves) {
  double best = kNoRival;
  const int reach = (hit.last - hit.first + 1) / 2;
  for (std::size_t other = 0; other < searched.size(); ++other) {
    if (searched[other].motion_template->name == searched[own].motion_template->name) continue;
    const std::vector<double>& delta = curves[other].delta;
    const int end = std::min(hit.last + reach + 1, static_cast<int>(delta.size()));
    for (int column = std::max(hit.last - reach, 0); column < end; ++column) {
      best = std::min(best, delta[static_cast<std::size_t>(column)]);
    }
  }
  return kNoRival - best;
}

class Ranker {
 public:
  Ranker(std::span<const Searched> searched, const RankOptions& options)
      : searched_(searched), options_(options) {}

  // [template] of one recording.
  [[nodiscard]] std::vector<std::vector<RankedHit>> Rank(const RecordingStreams& recording,
                                                         int index) const {
    std::vector<DeltaCurve> curves;
    for (const Searched& each : searched_) {
      curves.push_back(ComputeDelta(each.quantized, recording.features->columns));
    }
    std::vector<std::vector<RankedHit>> hits(searched_.size());
    for (std::size_t t = 0; t < searched_.size(); ++t) {
      const double tau =
          options_.tau.value_or(searched_[t].motion_template->tau.value_or(kUnlimited));
      // What is added to Δ is never below 0.
      for (const Hit& hit : options_.every_end ? EveryEnd(curves[t], tau, index)
                                               : ExtractHits(curves[t], kUnlimited, index)) {
        if (hit.cost > tau) continue;
        const RankedHit ranked = Score(hit, t, recording, curves);
        if (ranked.hit.cost <= tau) hits[t].push_back(ranked);
      }
    }
    return hits;
  }

 private:
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  static std::vector<Hit> EveryEnd(const DeltaCurve& curve, double tau, int index) {
    std::vector<Hit> hits;
    for (std::size_t column = 0; column < curve.delta.size(); ++column) {
      if (curve.start[column] < 0 || curve.delta[column] > tau) continue;
      hits.push_back({.recording = index,
                      .first = curve.start[column],
                      .last = static_cast<int>(column),
                      .cost = curve.delta[column]});
    }
    return hits;
  }

  [[nodiscard]] RankedHit Score(const Hit& hit, std::size_t t, const RecordingStreams& recording,
                                std::span<const DeltaCurve> curves) const {
    RankedHit ranked{.hit = hit, .matching = hit.cost};
    const std::optional<Contrast>& contrast = searched_[t].motion_template->contrast;
    if (contrast && options_.places) {
      ComparePoses(*contrast, searched_[t].quantized, recording, ranked);
    }
    ranked.hit.cost += kPlacesWeight * ranked.places;
    if (options_.rivals) ranked.rival = Rivalry(hit, t, searched_, curves);
    ranked.score = ranked.hit.cost + kRivalWeight * ranked.rival;
    return ranked;
  }

  static void ComparePoses(const Contrast& contrast, const QuantizedTemplate& quantized,
                           const RecordingStreams& recording, RankedHit& ranked) {
    const std::vector<PathCell> path =
        TracePath(quantized, recording.features->columns, ranked.hit.last);
    for (const PathCell& cell : path) {
      ranked.places += Distance(contrast.places, cell.template_column,
                                recording.poses->Column(cell.recording_column));
    }
    ranked.places /= static_cast<double>(path.size());
  }

  std::span<const Searched> searched_;
  const RankOptions& options_;
};

}  // namespace

std::vector<std::vector<RankedHit>> RankHits(std::span<const MotionTemplate> templates,
                                             std::span<const RecordingStreams> recordings,
                                             const RankOptions& options) {
  const std::vector<Searched> searched = Prepare(templates, recordings);
  const Ranker ranker(searched, options);
  std::vector<std::vector<std::vector<RankedHit>>> found(recordings.size());
  ParallelFor(recordings.size(), options.threads, "searching", options.progress,
              [&](std::size_t i) { found[i] = ranker.Rank(recordings[i], static_cast<int>(i)); });
  std::vector<std::vector<RankedHit>> hits(templates.size());
  for (const auto& of_recording : found) {
    for (std::size_t t = 0; t < hits.size(); ++t) {
      hits[t].insert(hits[t].end(), of_recording[t].begin(), of_recording[t].end());
    }
  }
  for (std::vector<RankedHit>& of_template : hits) {
    std::ranges::stable_sort(of_template, {}, &RankedHit::score);
    if (of_template.size() > options.most_hits) of_template.resize(options.most_hits);
  }
  return hits;
}

}  // namespace kinebase
