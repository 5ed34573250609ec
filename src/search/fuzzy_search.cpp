#include "kinebase/search/fuzzy_search.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase {
namespace {

void CheckSelection(std::uint64_t features) {
  if (features != 0) return;
  throw Error(ErrorCode::kInvalidArgument, "a fuzzy query needs at least one feature");
}

void CheckQuery(const FuzzyQuery& query, const FuzzyOptions& options) {
  CheckSelection(query.features);
  if (options.faults < 0 || options.faults >= std::ssize(query.elements)) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} faults in a query of {} elements; expected 0 or more, and fewer "
                            "than there are",
                            options.faults, query.elements.size()));
  }
}

void AppendUnlessRepeated(const FuzzyElement& element, std::vector<FuzzyElement>& elements) {
  if (elements.empty() || elements.back() != element) elements.push_back(element);
}

// How a part of the query was found, from its first element to the one at hand.
struct Match {
  int faults = std::numeric_limits<int>::max();
  std::size_t first = 0;  // Segment.

  // Fewer faults first; of as many, the shorter match.
  friend bool operator<(const Match& a, const Match& b) {
    return std::tuple(a.faults, b.first) < std::tuple(b.faults, a.first);
  }
};

// The query against the segments of one recording.
class Matcher {
 public:
  // admits  [element][segment]
  Matcher(const std::vector<std::vector<char>>& admits, std::size_t segments, int faults)
      : admits_(admits),
        elements_(admits.size()),
        faults_(static_cast<std::size_t>(faults)),
        best_(elements_ * segments) {
    for (std::size_t segment = 0; segment < segments; ++segment) {
      for (std::size_t element = 0; element < elements_; ++element) {
        if (admits_[element][segment] != 0) At(element, segment) = BestAt(element, segment);
      }
    }
  }

  // The best match of the whole query that ends in a segment; nothing if it takes too many faults.
  [[nodiscard]] std::optional<Match> EndingIn(std::size_t segment) const {
    Match best;
    for (std::size_t element = 0; element < elements_; ++element) {
      const std::size_t left_out = elements_ - 1 - element;
      best = std::min(best, WithFaults(At(element, segment), left_out));
    }
    if (best.faults > static_cast<int>(faults_)) return std::nullopt;
    return best;
  }

 private:
  [[nodiscard]] const Match& At(std::size_t element, std::size_t segment) const {
    return best_[segment * elements_ + element];
  }
  Match& At(std::size_t element, std::size_t segment) {
    return best_[segment * elements_ + element];
  }

  // No match if that makes too many.
  [[nodiscard]] Match WithFaults(const Match& match, std::size_t more) const {
    if (match.faults > static_cast<int>(faults_) || more > faults_) return {};
    return {.faults = match.faults + static_cast<int>(more), .first = match.first};
  }

  // Begins here with the elements before left out; shares the segment with an earlier element; or
  // goes on from an earlier segment, those between belonging to no element.
  [[nodiscard]] Match BestAt(std::size_t element, std::size_t segment) const {
    Match best = WithFaults({.faults = 0, .first = segment}, element);
    best = std::min(best, FromEarlierElement(element, segment, 0));
    for (std::size_t skipped = 0; skipped <= faults_ && skipped < segment; ++skipped) {
      const std::size_t before = segment - 1 - skipped;
      best = std::min(best, WithFaults(At(element, before), skipped));
      best = std::min(best, FromEarlierElement(element, before, skipped));
    }
    return best;
  }

  // The elements between are left out.
  [[nodiscard]] Match FromEarlierElement(std::size_t element, std::size_t segment,
                                         std::size_t skipped) const {
    Match best;
    for (std::size_t left_out = 0; left_out <= faults_ && left_out < element; ++left_out) {
      best = std::min(best, WithFaults(At(element - 1 - left_out, segment), skipped + left_out));
    }
    return best;
  }

  const std::vector<std::vector<char>>& admits_;
  std::size_t elements_;
  std::size_t faults_;
  std::vector<Match> best_;  // [segment × element]
};

// Keeps of hits of one recording that overlap the best.
void KeepDistinct(std::vector<Hit>& hits) {
  std::ranges::sort(hits, {}, [](const Hit& hit) {
    return std::tuple(hit.cost, hit.last - hit.first, hit.first);
  });
  std::vector<Hit> kept;
  for (const Hit& hit : hits) {
    const bool overlaps = std::ranges::any_of(kept, [&](const Hit& better) {
      return hit.first <= better.last && better.first <= hit.last;
    });
    if (!overlaps) kept.push_back(hit);
  }
  hits = std::move(kept);
}

// Hits in the segments of one recording.
// admits  [element][segment]
std::vector<Hit> HitsIn(std::span<const Stretch> segments,
                        const std::vector<std::vector<char>>& admits, int faults) {
  const auto missing = std::ranges::count_if(admits, [](const std::vector<char>& segments_of) {
    return std::ranges::find(segments_of, 1) == segments_of.end();
  });
  if (missing > faults) return {};
  const Matcher matcher(admits, segments.size(), faults);
  std::vector<Hit> hits;
  for (std::size_t segment = 0; segment < segments.size(); ++segment) {
    const std::optional<Match> match = matcher.EndingIn(segment);
    if (!match) continue;
    hits.push_back(
        {.recording = segments[segment].recording,
         .first = segments[match->first].first,
         .last = segments[segment].last,
         .cost = static_cast<double>(match->faults) / static_cast<double>(admits.size())});
  }
  KeepDistinct(hits);
  return hits;
}

// Which segments an element admits.
std::vector<char> Admitted(const FuzzyElement& element, const FeatureIndex& index,
                           std::span<const Stretch> segments) {
  std::vector<char> admitted(segments.size());
  for (const FeaturePattern& pattern : element.patterns) {
    auto segment = segments.begin();
    for (const Stretch& found : index.Find(pattern)) {
      const auto place = [](const Stretch& run) { return std::tuple(run.recording, run.first); };
      segment = std::ranges::lower_bound(segment, segments.end(), place(found), {}, place);
      for (; segment != segments.end() && segment->recording == found.recording &&
             segment->last <= found.last;
           ++segment) {
        admitted[static_cast<std::size_t>(segment - segments.begin())] = 1;
      }
    }
  }
  return admitted;
}

}  // namespace

FuzzyQuery MakeFuzzyQuery(const FeatureMatrix& example, std::uint64_t features) {
  CheckSelection(features);
  if (example.columns.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "an example needs at least one column");
  }
  FuzzyQuery query{.features = features};
  for (const std::uint64_t column : example.columns) {
    AppendUnlessRepeated({{{.tested = features, .ones = column & features}}}, query.elements);
  }
  return query;
}

FuzzyQuery MakeFuzzyQuery(const QuantizedTemplate& motion_template, std::uint64_t features) {
  CheckSelection(features);
  FuzzyQuery query{.features = features};
  for (const QuantizedColumn& column : motion_template.columns) {
    const std::uint64_t tested = column.consistent & features;
    AppendUnlessRepeated({{{.tested = tested, .ones = column.ones & tested}}}, query.elements);
  }
  const auto is_free = [](const FuzzyElement& element) {
    return element.patterns.front().tested == 0;
  };
  while (!query.elements.empty() && is_free(query.elements.back())) query.elements.pop_back();
  if (!query.elements.empty() && is_free(query.elements.front())) {
    query.elements.erase(query.elements.begin());
  }
  if (query.elements.empty()) {
    throw Error(ErrorCode::kInvalidArgument,
                "the template leaves all of the selected features free; select others");
  }
  return query;
}

std::vector<Hit> SearchFuzzy(const FuzzyQuery& query, std::span<const FeatureView> recordings,
                             const FuzzyOptions& options) {
  CheckQuery(query, options);
  const FeatureIndex index(recordings, query.features);
  const std::vector<Stretch> segments = index.Runs();
  std::vector<std::vector<char>> admits;  // [element][segment]
  admits.reserve(query.elements.size());
  for (const FuzzyElement& element : query.elements) {
    admits.push_back(Admitted(element, index, segments));
  }
  std::vector<Hit> hits;
  for (std::size_t begin = 0; begin < segments.size();) {
    std::size_t end = begin;
    while (end < segments.size() && segments[end].recording == segments[begin].recording) ++end;
    std::vector<std::vector<char>> here;
    here.reserve(admits.size());
    for (const std::vector<char>& all : admits) {
      here.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(begin),
                        all.begin() + static_cast<std::ptrdiff_t>(end));
    }
    const std::vector<Hit> found =
        HitsIn(std::span(segments).subspan(begin, end - begin), here, options.faults);
    hits.insert(hits.end(), found.begin(), found.end());
    begin = end;
  }
  return BestHits(std::move(hits), options.most_hits);
}

std::vector<Hit> SearchFuzzy(const FuzzyQuery& query, std::span<const FeatureMatrix> recordings,
                             const FuzzyOptions& options) {
  return SearchFuzzy(query, ViewsOf(recordings), options);
}

}  // namespace kinebase
