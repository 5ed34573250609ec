#include "kinebase/library/source_search.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "library/feature_groups.h"

namespace kinebase {
namespace {

// Queries that share takes' features, by index; among them those with keyframes of their own, and
// those that know what sets their class off: rivals are searched together.
struct QueryGroup {
  std::vector<std::size_t> queries;
  std::vector<std::size_t> preselected;
  std::vector<std::size_t> rivals;
};

std::vector<QueryGroup> GroupQueries(std::span<const SearchQuery> queries) {
  std::vector<QueryGroup> groups;
  for (std::vector<std::size_t>& members : internal::GroupByFeatures(queries)) {
    QueryGroup& group = groups.emplace_back();
    group.queries = std::move(members);
    for (const std::size_t i : group.queries) {
      if (queries[i].motion_template.contrast) {
        group.rivals.push_back(i);
      } else if (!queries[i].motion_template.keyframes.empty() && !queries[i].fuzzy) {
        group.preselected.push_back(i);
      }
    }
  }
  return groups;
}

// Of queries that are searched for otherwise nothing.
std::vector<QuantizedTemplate> Quantized(std::span<const SearchQuery> queries) {
  std::vector<QuantizedTemplate> quantized(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (queries[i].fuzzy || queries[i].motion_template.contrast) continue;
    quantized[i] = Quantize(queries[i].motion_template);
  }
  return quantized;
}

class Search {
 public:
  Search(std::span<const SearchQuery> queries, const SourceSearchOptions& options)
      : queries_(queries),
        options_(options),
        groups_(GroupQueries(queries)),
        quantized_(Quantized(queries)),
        best_(queries.size()) {}

  SourceHits Run(const TakeSource& source) {
    if (source.comes_at_once()) progress_ = options_.progress;  // Others are counted as they come.
    std::vector<TakeRequest> requests;
    requests.reserve(groups_.size());
    for (const QueryGroup& group : groups_) requests.push_back(RequestOf(group));
    found_.failures =
        source.VisitTogether(requests, [&](std::size_t group, const TakesAtHand& at_hand) {
          Count(at_hand);
          SearchGroup(groups_[group], at_hand);
        });
    found_.hits = Best();
    return std::move(found_);
  }

 private:
  [[nodiscard]] TakeRequest RequestOf(const QueryGroup& group) const {
    const SearchQuery& any = queries_[group.queries.front()];
    TakeRequest request{.features = &any.features,
                        .rate_hz = any.motion_template.matrix.rate_hz,
                        .with_poses = !group.rivals.empty(),
                        .threads = options_.threads,
                        .progress = options_.progress};
    request.keyframes.reserve(group.preselected.size());
    for (const std::size_t i : group.preselected) {
      const MotionTemplate& each = queries_[i].motion_template;
      request.keyframes.push_back({each.keyframes, each.matrix.column_count()});
    }
    request.only_preselected =
        group.preselected.size() == group.queries.size() && !options_.on_takes;
    return request;
  }

  // Each take once, for whatever group it could be read.
  void Count(const TakesAtHand& at_hand) {
    for (std::size_t i = 0; i < at_hand.takes.size(); ++i) {
      const std::size_t place = at_hand.places[i];
      if (place >= is_counted_.size()) is_counted_.resize(place + 1);
      if (is_counted_[place]) continue;
      is_counted_[place] = true;
      const TakeView& take = at_hand.takes[i];
      ++found_.takes;
      found_.frames += take.frame_count;
      if (take.diagnostics != nullptr && !take.diagnostics->empty()) {
        found_.diagnostics.emplace_back(*take.path, *take.diagnostics);
      }
    }
  }

  void SearchGroup(const QueryGroup& group, const TakesAtHand& at_hand) {
    for (const std::size_t i : group.queries) {
      if (options_.on_takes) options_.on_takes(i, at_hand.takes);
      if (queries_[i].motion_template.contrast) continue;
      found_.all_columns += at_hand.columns;
      const auto place = std::ranges::find(group.preselected, i);
      if (place == group.preselected.end()) {
        Keep(i, at_hand, SearchAll(i, at_hand));
      } else {
        const auto which = static_cast<std::size_t>(place - group.preselected.begin());
        Keep(i, at_hand, SearchStretches(i, at_hand, at_hand.stretches[which]));
      }
    }
    if (!group.rivals.empty()) SearchRivals(group.rivals, at_hand);
  }

  std::vector<TakeHit> SearchAll(std::size_t i, const TakesAtHand& at_hand) {
    found_.searched_columns += at_hand.columns;
    if (queries_[i].fuzzy) {
      return SearchTakes(*queries_[i].fuzzy, at_hand.takes,
                         {.faults = options_.faults, .most_hits = options_.most_hits});
    }
    return SearchTakes(quantized_[i], at_hand.takes, OptionsOf(i));
  }

  std::vector<TakeHit> SearchStretches(std::size_t i, const TakesAtHand& at_hand,
                                       std::span<const Stretch> stretches) {
    found_.searched_columns += CountColumns(stretches);
    return SearchTakes(quantized_[i], at_hand.takes, stretches, OptionsOf(i));
  }

  void SearchRivals(const std::vector<std::size_t>& rivals, const TakesAtHand& at_hand) {
    std::vector<MotionTemplate> templates;
    templates.reserve(rivals.size());
    for (const std::size_t i : rivals) templates.push_back(queries_[i].motion_template);
    const auto found = RankTakes(templates, at_hand.takes,
                                 {.tau = options_.tau,
                                  .most_hits = options_.most_hits,
                                  .threads = options_.threads,
                                  .progress = progress_});
    for (std::size_t t = 0; t < found.size(); ++t) Keep(rivals[t], at_hand, found[t]);
  }

  [[nodiscard]] SearchOptions OptionsOf(std::size_t i) const {
    const double own = queries_[i].motion_template.tau.value_or(kDefaultTau);
    return {.tau = options_.tau.value_or(own),
            .most_hits = options_.most_hits,
            .threads = options_.threads,
            .progress = progress_};
  }

  void Keep(std::size_t i, const TakesAtHand& at_hand, const std::vector<TakeHit>& found) {
    best_[i].reserve(best_[i].size() + found.size());
    for (const TakeHit& hit : found) best_[i].push_back({i, *at_hand.takes[hit.take].path, hit});
    KeepBest(best_[i]);
  }

  // By score; of equals those that came first.
  void KeepBest(std::vector<SourceHit>& hits) const {
    std::ranges::stable_sort(hits, {}, [](const SourceHit& each) { return each.hit.score; });
    if (hits.size() > options_.most_hits) hits.resize(options_.most_hits);
  }

  // The best of all, those of rivals behind the others where they score the same.
  [[nodiscard]] std::vector<SourceHit> Best() {
    std::vector<std::size_t> order(queries_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) {
      const SearchQuery& query = queries_[i];
      return query.motion_template.contrast ? std::optional(internal::FeatureKeyOf(query))
                                            : std::nullopt;
    });
    std::vector<SourceHit> hits;
    for (const std::size_t i : order) std::ranges::move(best_[i], std::back_inserter(hits));
    KeepBest(hits);
    return hits;
  }

  std::span<const SearchQuery> queries_;
  const SourceSearchOptions& options_;
  std::vector<QueryGroup> groups_;
  std::vector<QuantizedTemplate> quantized_;  // [query]
  std::vector<std::vector<SourceHit>> best_;  // [query]
  std::vector<bool> is_counted_;              // [place in the source]
  ProgressCallback progress_;                 // Of each search.
  SourceHits found_;
};

}  // namespace

SourceHits SearchSource(const TakeSource& source, std::span<const SearchQuery> queries,
                        const SourceSearchOptions& options) {
  return Search(queries, options).Run(source);
}

}  // namespace kinebase
