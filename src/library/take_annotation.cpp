#include "kinebase/library/take_annotation.h"

#include <cmath>
#include <map>
#include <utility>

#include "kinebase/core/parallel.h"

namespace kinebase {
namespace {

using Candidates = std::vector<AnnotationCandidate>;

// Queries that need the features of one set at one rate, by index.
using QueryGroups = std::map<std::pair<std::uint64_t, double>, std::vector<std::size_t>>;

QueryGroups GroupQueries(std::span<const AnnotationQuery> queries) {
  QueryGroups groups;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    groups[{queries[i].features.hash, queries[i].motion_template.matrix.rate_hz}].push_back(i);
  }
  return groups;
}

TakeRequest RequestOf(const std::vector<std::size_t>& group,
                      std::span<const AnnotationQuery> queries, int threads,
                      const ProgressCallback& progress) {
  const AnnotationQuery& any = queries[group.front()];
  TakeRequest request{.features = &any.features,
                      .rate_hz = any.motion_template.matrix.rate_hz,
                      .threads = threads,
                      .progress = progress};
  for (const std::size_t i : group) {
    request.with_poses = request.with_poses || queries[i].motion_template.contrast.has_value();
  }
  return request;
}

Candidates CandidatesOf(const AnnotationQuery& query, const TakeView& take) {
  if (!query.motion_template.contrast) return FindCandidates(query.search, take);
  return FindCandidates(std::span(&query.motion_template, 1),
                        std::span(&query.search.motion_class, 1), take);
}

class Annotator {
 public:
  Annotator(std::span<const AnnotationQuery> queries, const AnnotateTakesOptions& options)
      : queries_(queries), options_(options), groups_(GroupQueries(queries)) {}

  AnnotatedTakes Run(const TakeSource& source) {
    for (const auto& [key, group] : groups_) {
      const bool is_first = &group == &groups_.begin()->second;
      const bool is_last = &group == &groups_.rbegin()->second;
      auto failures = source.Visit(RequestOf(group, queries_, options_.threads, options_.progress),
                                   [&](const TakesAtHand& at_hand) {
                                     if (is_first) Remember(at_hand);
                                     Find(group, at_hand);
                                     if (is_last) Choose(at_hand.takes);
                                   });
      if (is_first) annotated_.failures = std::move(failures);  // All read the same takes.
    }
    return std::move(annotated_);
  }

 private:
  void Remember(const TakesAtHand& at_hand) {
    for (const TakeView& take : at_hand.takes) {
      places_.emplace(*take.path, annotated_.takes.size());
      TakeSegments& each = annotated_.takes.emplace_back();
      each.path = *take.path;
      each.rate_hz = take.rate_hz;
      each.frame_count = take.frame_count;
      if (take.diagnostics != nullptr) each.diagnostics = *take.diagnostics;
      found_.emplace_back(queries_.size());
    }
  }

  // Nothing for a take that could be read with other features alone.
  [[nodiscard]] std::optional<std::size_t> PlaceOf(const TakeView& take) const {
    const auto place = places_.find(*take.path);
    return place == places_.end() ? std::nullopt : std::optional(place->second);
  }

  void Find(const std::vector<std::size_t>& group, const TakesAtHand& at_hand) {
    ParallelFor(at_hand.takes.size(), options_.threads, [&](std::size_t i) {
      const auto place = PlaceOf(at_hand.takes[i]);
      if (!place) return;
      for (const std::size_t query : group) {
        found_[*place][query] = CandidatesOf(queries_[query], at_hand.takes[i]);
      }
    });
  }

  void Choose(std::span<const TakeView> takes) {
    ParallelFor(takes.size(), options_.threads, [&](std::size_t i) {
      const auto place = PlaceOf(takes[i]);
      if (!place) return;
      Candidates candidates;
      for (const Candidates& of_query : std::exchange(found_[*place], {})) {
        candidates.insert(candidates.end(), of_query.begin(), of_query.end());
      }
      TakeSegments& take = annotated_.takes[*place];
      take.segments = ChooseSegments(candidates, options_.tracks);
      if (!options_.merge_s) return;
      take.segments = MergeSegments(take.segments, std::llround(*options_.merge_s * take.rate_hz));
    });
  }

  std::span<const AnnotationQuery> queries_;
  const AnnotateTakesOptions& options_;
  QueryGroups groups_;
  AnnotatedTakes annotated_;
  std::map<std::filesystem::path, std::size_t> places_;  // Of a take among them.
  std::vector<std::vector<Candidates>> found_;           // [take][query] not yet chosen among.
};

}  // namespace

AnnotatedTakes AnnotateTakes(const TakeSource& source, std::span<const AnnotationQuery> queries,
                             const AnnotateTakesOptions& options) {
  return Annotator(queries, options).Run(source);
}

BackgroundThresholds FindThresholds(std::span<const TakeSource> background,
                                    std::span<const AnnotationQuery> queries, int threads,
                                    const ProgressCallback& progress) {
  BackgroundThresholds thresholds;
  std::vector<std::vector<double>> least(queries.size());
  bool is_first = true;
  for (const auto& [key, group] : GroupQueries(queries)) {
    const TakeRequest request = RequestOf(group, queries, threads, progress);
    for (const TakeSource& source : background) {
      const auto failures = source.Visit(request, [&](const TakesAtHand& at_hand) {
        for (const std::size_t i : group) {
          std::vector<RecordingStreams> recordings;
          recordings.reserve(at_hand.takes.size());
          for (const TakeView& take : at_hand.takes) {
            if (take.name->class_name == queries[i].class_name) continue;
            recordings.push_back({.features = take.features, .poses = take.poses});
          }
          const auto costs =
              LeastCosts(queries[i].motion_template, recordings, {.threads = threads});
          least[i].insert(least[i].end(), costs.begin(), costs.end());
        }
      });
      if (!is_first) continue;
      thresholds.failures.insert(thresholds.failures.end(), failures.begin(), failures.end());
    }
    is_first = false;
  }
  for (std::vector<double>& of_query : least) {
    thresholds.tau.push_back(ThresholdBelow(std::move(of_query)));
  }
  return thresholds;
}

}  // namespace kinebase
