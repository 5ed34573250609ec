#include "kinebase/library/take_annotation.h"

#include <cmath>
#include <map>
#include <utility>

#include "kinebase/core/parallel.h"
#include "library/feature_groups.h"

namespace kinebase {
namespace {

using Candidates = std::vector<AnnotationCandidate>;

using internal::FeatureGroups;

// One for each group, in its order.
std::vector<TakeRequest> RequestsOf(const FeatureGroups& groups,
                                    std::span<const AnnotationQuery> queries, int threads,
                                    const ProgressCallback& progress) {
  std::vector<TakeRequest> requests;
  requests.reserve(groups.size());
  for (const auto& group : groups) {
    const AnnotationQuery& any = queries[group.front()];
    TakeRequest& request = requests.emplace_back();
    request.features = &any.features;
    request.rate_hz = any.motion_template.matrix.rate_hz;
    request.threads = threads;
    request.progress = progress;
    for (const std::size_t i : group) {
      request.with_poses = request.with_poses || queries[i].motion_template.contrast.has_value();
    }
  }
  return requests;
}

Candidates CandidatesOf(const AnnotationQuery& query, const TakeView& take) {
  if (!query.motion_template.contrast) return FindCandidates(query.search, take);
  return FindCandidates(std::span(&query.motion_template, 1),
                        std::span(&query.search.motion_class, 1), take);
}

// All templates look at some takes at a time: what they find is chosen among before the next.
class Annotator {
 public:
  Annotator(std::span<const AnnotationQuery> queries, const AnnotateTakesOptions& options)
      : queries_(queries), options_(options), groups_(internal::GroupByFeatures(queries)) {}

  AnnotatedTakes Run(const TakeSource& source) {
    const auto requests = RequestsOf(groups_, queries_, options_.threads, options_.progress);
    annotated_.failures =
        source.VisitTogether(requests, [&](std::size_t group, const TakesAtHand& at_hand) {
          Find(groups_[group], at_hand);
          if (group + 1 == groups_.size()) Choose();
        });
    return std::move(annotated_);
  }

 private:
  struct Take {
    TakeSegments annotated;
    std::vector<Candidates> found;  // [query] not yet chosen among.
  };

  void Find(const std::vector<std::size_t>& group, const TakesAtHand& at_hand) {
    std::vector<Take*> takes;
    takes.reserve(at_hand.takes.size());
    for (std::size_t i = 0; i < at_hand.takes.size(); ++i) {
      const auto [place, is_new] = at_hand_.try_emplace(at_hand.places[i]);
      takes.push_back(&place->second);
      if (is_new) Remember(at_hand.takes[i], place->second);
    }
    ParallelFor(takes.size(), options_.threads, [&](std::size_t i) {
      for (const std::size_t query : group) {
        takes[i]->found[query] = CandidatesOf(queries_[query], at_hand.takes[i]);
      }
    });
  }

  void Remember(const TakeView& view, Take& take) const {
    take.annotated.path = *view.path;
    take.annotated.rate_hz = view.rate_hz;
    take.annotated.frame_count = view.frame_count;
    if (view.diagnostics != nullptr) take.annotated.diagnostics = *view.diagnostics;
    take.found.resize(queries_.size());
  }

  void Choose() {
    std::vector<Take*> takes;
    takes.reserve(at_hand_.size());
    for (auto& [place, take] : at_hand_) takes.push_back(&take);
    ParallelFor(takes.size(), options_.threads, [&](std::size_t i) {
      Candidates candidates;
      for (const Candidates& of_query : std::exchange(takes[i]->found, {})) {
        candidates.insert(candidates.end(), of_query.begin(), of_query.end());
      }
      TakeSegments& take = takes[i]->annotated;
      take.segments = ChooseSegments(candidates, options_.tracks);
      if (!options_.merge_s) return;
      take.segments = MergeSegments(take.segments, std::llround(*options_.merge_s * take.rate_hz));
    });
    for (Take* take : takes) annotated_.takes.push_back(std::move(take->annotated));
    at_hand_.clear();
  }

  std::span<const AnnotationQuery> queries_;
  const AnnotateTakesOptions& options_;
  FeatureGroups groups_;
  AnnotatedTakes annotated_;
  std::map<std::size_t, Take> at_hand_;  // By place in the source, so in its order.
};

// What the best hit of a query costs in each take that is not known to show its class.
std::vector<double> CostsElsewhere(const AnnotationQuery& query, const TakesAtHand& at_hand,
                                   int threads) {
  std::vector<RecordingStreams> recordings;
  recordings.reserve(at_hand.takes.size());
  for (const TakeView& take : at_hand.takes) {
    if (take.name->class_name == query.class_name) continue;
    recordings.push_back({.features = take.features, .poses = take.poses});
  }
  return LeastCosts(query.motion_template, recordings, {.threads = threads});
}

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
  const FeatureGroups groups = internal::GroupByFeatures(queries);
  const auto requests = RequestsOf(groups, queries, threads, progress);
  for (const TakeSource& source : background) {
    const auto failures =
        source.VisitTogether(requests, [&](std::size_t group, const TakesAtHand& at_hand) {
          for (const std::size_t i : groups[group]) {
            const auto costs = CostsElsewhere(queries[i], at_hand, threads);
            least[i].insert(least[i].end(), costs.begin(), costs.end());
          }
        });
    thresholds.failures.insert(thresholds.failures.end(), failures.begin(), failures.end());
  }
  thresholds.tau.reserve(queries.size());
  for (std::vector<double>& of_query : least) {
    thresholds.tau.push_back(ThresholdBelow(std::move(of_query)));
  }
  return thresholds;
}

}  // namespace kinebase
