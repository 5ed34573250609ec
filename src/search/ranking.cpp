#include "kinebase/search/ranking.h"

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "kinebase/search/subsequence_dtw.h"
#include "search/pose_distance.h"

namespace kinebase {
namespace {

// Chosen as the weight of poses.
constexpr double kRivalWeight = 0.5;
// A template with half of its entries wrong is no rival.
constexpr double kNoRival = 0.5;

double Distance(const PoseModel& model, int column, std::span<const float> pose) {
  const std::size_t first = static_cast<std::size_t>(column) * kPoseValues;
  double distance = 0;
  for (std::size_t i = 0; i < pose.size(); ++i) {
    distance += internal::OffOfValue(model, model.mean, first + i, i, pose[i]);
  }
  return distance;
}

// How much nearer a pose is to look-alikes than other motion is; below 0 if it is not.
double NearnessToLookalikes(const PoseModel& model, int column, std::span<const float> pose) {
  const std::size_t first = static_cast<std::size_t>(column) * kPoseValues;
  double nearness = 0;
  for (std::size_t i = 0; i < pose.size(); ++i) {
    nearness += internal::kNoLookalike * model.weight[first + i] -
                internal::OffOfValue(model, model.lookalikes, first + i, i, pose[i]);
  }
  return nearness;
}

// A template that is ready, and its curve over one recording.
struct Searched {
  const MotionTemplate* motion_template = nullptr;
  QuantizedTemplate quantized;
};

void CheckFeatures(const MotionTemplate& motion_template, const FeatureView& features) {
  if (features.feature_count == motion_template.matrix.feature_count &&
      features.rate_hz == motion_template.matrix.rate_hz) {
    return;
  }
  throw Error(ErrorCode::kMismatch,
              fmt::format("a recording has {} features at {} Hz, template '{}' {} at {} Hz",
                          features.feature_count, features.rate_hz, motion_template.name,
                          motion_template.matrix.feature_count, motion_template.matrix.rate_hz));
}

void CheckPoses(const MotionTemplate& motion_template, const RecordingStreams& recording) {
  const int poses = recording.poses == nullptr ? 0 : recording.poses->column_count();
  if (poses == recording.features.column_count()) return;
  throw Error(
      ErrorCode::kMismatch,
      fmt::format("a recording has {} columns of features and {} poses; template '{}' needs "
                  "a pose for each: extract them too",
                  recording.features.column_count(), poses, motion_template.name));
}

std::vector<Searched> Prepare(std::span<const MotionTemplate> templates,
                              std::span<const RecordingStreams> recordings, bool with_places) {
  std::vector<Searched> searched;
  for (const MotionTemplate& each : templates) {
    searched.push_back({&each, Quantize(each)});
    for (const RecordingStreams& recording : recordings) {
      CheckFeatures(each, recording.features);
      if (each.contrast && with_places) CheckPoses(each, recording);
    }
  }
  return searched;
}

// The best of other classes that ends within half a hit's length of its end, if it is a rival.
std::optional<Rival> FindRival(const Hit& hit, std::size_t own, std::span<const Searched> searched,
                               std::span<const DeltaCurve> curves) {
  std::optional<Rival> best;
  const int reach = (hit.last - hit.first + 1) / 2;
  for (std::size_t other = 0; other < searched.size(); ++other) {
    if (searched[other].motion_template->name == searched[own].motion_template->name) continue;
    const DeltaCurve& curve = curves[other];
    const int end = std::min(hit.last + reach + 1, static_cast<int>(curve.delta.size()));
    for (int column = std::max(hit.last - reach, 0); column < end; ++column) {
      const double delta = curve.delta[static_cast<std::size_t>(column)];
      if (delta >= (best ? best->matching : kNoRival)) continue;
      best = Rival{.motion_template = other,
                   .first = curve.start[static_cast<std::size_t>(column)],
                   .last = column,
                   .matching = delta};
    }
  }
  return best;
}

// Whether two hits of one recording are of the same performance.
bool ShareMost(const Hit& a, const Hit& b) {
  const int shared = std::min(a.last, b.last) - std::max(a.first, b.first) + 1;
  const int shorter = std::min(a.last - a.first, b.last - b.first) + 1;
  return 2 * shared > shorter;
}

// Leaves of each performance the best hit, where templates of one name found it more than once.
// hits  [template] of one recording, in any order.
void SettleSiblings(std::span<const Searched> searched, std::vector<std::vector<RankedHit>>& hits) {
  const auto is_sibling = [&](std::size_t a, std::size_t b) {
    return a != b && searched[a].motion_template->name == searched[b].motion_template->name;
  };
  const std::vector<std::vector<RankedHit>> all = hits;
  for (std::size_t t = 0; t < hits.size(); ++t) {
    std::erase_if(hits[t], [&](const RankedHit& own) {
      for (std::size_t other = 0; other < all.size(); ++other) {
        if (!is_sibling(t, other)) continue;
        const bool is_beaten = std::ranges::any_of(all[other], [&](const RankedHit& hit) {
          const bool is_better = hit.score < own.score || (hit.score == own.score && other < t);
          return is_better && ShareMost(hit.hit, own.hit);
        });
        if (is_beaten) return true;
      }
      return false;
    });
  }
}

class Ranker {
 public:
  Ranker(std::span<const Searched> searched, const RankOptions& options)
      : searched_(searched), options_(options) {}

  // [template] of one recording.
  [[nodiscard]] std::vector<std::vector<RankedHit>> Rank(const RecordingStreams& recording,
                                                         int index) const {
    const std::vector<DeltaCurve> curves = CurvesOf(recording);
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
    if (!options_.every_end) SettleSiblings(searched_, hits);
    return hits;
  }

  // The path of a template that ends with a column.
  [[nodiscard]] std::optional<RankedHit> RankEnd(const RecordingStreams& recording, std::size_t t,
                                                 int last) const {
    const std::vector<DeltaCurve> curves = CurvesOf(recording);
    const auto column = static_cast<std::size_t>(last);
    if (curves[t].start[column] < 0) return std::nullopt;
    return Score({.first = curves[t].start[column], .last = last, .cost = curves[t].delta[column]},
                 t, recording, curves);
  }

 private:
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  [[nodiscard]] std::vector<DeltaCurve> CurvesOf(const RecordingStreams& recording) const {
    std::vector<DeltaCurve> curves;
    curves.reserve(searched_.size());
    for (const Searched& each : searched_) {
      curves.push_back(ComputeDelta(each.quantized, recording.features.columns));
    }
    return curves;
  }

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
      ComparePoses(contrast->places, searched_[t].quantized, recording, ranked);
    }
    ranked.hit.cost += internal::kPlacesWeight * (ranked.places + ranked.lookalikes);
    if (options_.rivals) ranked.nearest = FindRival(hit, t, searched_, curves);
    if (ranked.nearest) ranked.rival = kNoRival - ranked.nearest->matching;
    ranked.score = ranked.hit.cost + kRivalWeight * ranked.rival;
    return ranked;
  }

  void ComparePoses(const PoseModel& model, const QuantizedTemplate& quantized,
                    const RecordingStreams& recording, RankedHit& ranked) const {
    const bool has_lookalikes = options_.lookalikes && !model.lookalikes.empty();
    const std::vector<PathCell> path =
        TracePath(quantized, recording.features.columns, ranked.hit.last);
    double nearness = 0;
    for (const PathCell& cell : path) {
      const std::span<const float> pose = recording.poses->Column(cell.recording_column);
      ranked.places += Distance(model, cell.template_column, pose);
      if (has_lookalikes) nearness += NearnessToLookalikes(model, cell.template_column, pose);
    }
    const auto cells = static_cast<double>(path.size());
    ranked.places /= cells;
    ranked.lookalikes = std::max(nearness / cells, 0.0);
  }

  std::span<const Searched> searched_;
  const RankOptions& options_;
};

}  // namespace

std::vector<std::vector<RankedHit>> RankHits(std::span<const MotionTemplate> templates,
                                             std::span<const RecordingStreams> recordings,
                                             const RankOptions& options) {
  const std::vector<Searched> searched = Prepare(templates, recordings, options.places);
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

std::vector<RankedHit> HitsOfClass(std::string_view name, std::span<const MotionTemplate> templates,
                                   std::span<const std::vector<RankedHit>> hits) {
  std::vector<RankedHit> of_class;
  for (std::size_t t = 0; t < templates.size(); ++t) {
    if (templates[t].name != name) continue;
    of_class.insert(of_class.end(), hits[t].begin(), hits[t].end());
  }
  std::ranges::stable_sort(of_class, {}, &RankedHit::score);
  return of_class;
}

std::optional<RankedHit> RankEnd(std::span<const MotionTemplate> templates, std::size_t which,
                                 const RecordingStreams& recording, int last,
                                 const RankOptions& options) {
  const std::vector<Searched> searched =
      Prepare(templates, std::span(&recording, 1), options.places);
  return Ranker(searched, options).RankEnd(recording, which, last);
}

}  // namespace kinebase
