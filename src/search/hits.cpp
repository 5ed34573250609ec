#include "kinebase/search/hits.h"

#include <algorithm>
#include <tuple>

#include "search/hit_extraction.h"

namespace kinebase {
namespace {

int CeilOfPart(int length, int divisor) { return (length + divisor - 1) / divisor; }

// Calls f(element) for the columns [first, last] that exist.
template <typename T, typename F>
void ForRange(std::vector<T>& columns, int first, int last, const F& f) {
  const int end = std::min(last + 1, static_cast<int>(columns.size()));
  for (int i = std::max(first, 0); i < end; ++i) f(columns[i]);
}

}  // namespace

namespace internal {

void AppendCandidates(std::span<const double> delta, std::span<const std::int32_t> start,
                      double tau, std::size_t first_column, std::vector<Candidate>& candidates) {
  for (std::size_t i = 0; i < delta.size(); ++i) {
    if (start[i] < 0 || !(delta[i] <= tau)) continue;
    candidates.push_back({static_cast<std::int32_t>(first_column + i), start[i], delta[i]});
  }
}

std::vector<Hit> ExtractHits(std::vector<Candidate> candidates, std::size_t columns,
                             int recording) {
  if (candidates.empty()) return {};
  std::ranges::stable_sort(candidates, {}, &Candidate::cost);
  std::vector<Hit> hits;
  std::vector<int> reserved(columns);  // [start] length of the hit that reserved it; 0 = free.
  std::vector<char> blank(columns);    // [end]
  for (const Candidate& candidate : candidates) {
    const int end = candidate.column;
    if (blank[end] != 0) continue;
    const int start = candidate.start;
    if (reserved[start] == 0) {
      const int length = end - start + 1;
      hits.push_back({.recording = recording, .first = start, .last = end, .cost = candidate.cost});
      // Where reservations overlap, the better hit's stays.
      ForRange(reserved, start - CeilOfPart(length, 10), start + CeilOfPart(length, 2),
               [length](int& owner) {
                 if (owner == 0) owner = length;
               });
    }
    const int length = reserved[start];
    ForRange(blank, end - CeilOfPart(length, 2), end + CeilOfPart(length, 10),
             [](char& is_blank) { is_blank = 1; });
  }
  return hits;
}

}  // namespace internal

std::vector<Hit> ExtractHits(const DeltaCurve& curve, double tau, int recording) {
  std::vector<internal::Candidate> candidates;
  internal::AppendCandidates(curve.delta, curve.start, tau, 0, candidates);
  return internal::ExtractHits(std::move(candidates), curve.delta.size(), recording);
}

std::vector<Hit> BestHits(std::vector<Hit> hits, std::size_t most) {
  const auto order = [](const Hit& hit) {
    return std::tuple(hit.cost, hit.recording, hit.first, hit.last);
  };
  std::ranges::sort(hits, {}, order);
  if (hits.size() > most) hits.resize(most);
  return hits;
}

}  // namespace kinebase
