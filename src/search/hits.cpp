#include "kinebase/search/hits.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "search/hit_extraction.h"

namespace kinebase {
namespace {

int CeilOfPart(int length, int divisor) { return (length + divisor - 1) / divisor; }

// A number for each of some columns, 0 at first: few columns of a recording can be hits.
class ColumnNumbers {
 public:
  explicit ColumnNumbers(std::vector<int> columns) : columns_(std::move(columns)) {
    if (!std::ranges::is_sorted(columns_)) std::ranges::sort(columns_);
    const auto repeated = std::ranges::unique(columns_);
    columns_.erase(repeated.begin(), repeated.end());
    numbers_.resize(columns_.size());
  }

  // column  One of them.
  [[nodiscard]] int At(int column) const { return numbers_[IndexFrom(column)]; }

  // Those of columns from first to last that are 0 become `number`.
  void FillFree(int first, int last, int number) {
    for (std::size_t i = IndexFrom(first); i < columns_.size() && columns_[i] <= last; ++i) {
      if (numbers_[i] == 0) numbers_[i] = number;
    }
  }

 private:
  // Of the first column that is not before this one.
  [[nodiscard]] std::size_t IndexFrom(int column) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(columns_, column) - columns_.begin());
  }

  std::vector<int> columns_;  // Ascending.
  std::vector<int> numbers_;
};

// Candidates in the order of their columns are mostly in that of their starts, too, which many
// share.
ColumnNumbers NumbersOf(std::span<const internal::Candidate> candidates,
                        std::int32_t internal::Candidate::*column) {
  std::vector<int> columns;
  columns.reserve(candidates.size());
  for (const internal::Candidate& candidate : candidates) {
    if (columns.empty() || columns.back() != candidate.*column) {
      columns.push_back(candidate.*column);
    }
  }
  return ColumnNumbers(std::move(columns));
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

std::vector<Hit> ExtractHits(std::vector<Candidate> candidates, int recording) {
  // By start, the length of the hit that reserved it; by end, 1 where it is blanked.
  ColumnNumbers reserved = NumbersOf(candidates, &Candidate::start);
  ColumnNumbers blank = NumbersOf(candidates, &Candidate::column);
  std::ranges::stable_sort(candidates, {}, &Candidate::cost);
  std::vector<Hit> hits;
  for (const Candidate& candidate : candidates) {
    const int end = candidate.column;
    if (blank.At(end) != 0) continue;
    const int start = candidate.start;
    if (reserved.At(start) == 0) {
      const int length = end - start + 1;
      hits.push_back({.recording = recording, .first = start, .last = end, .cost = candidate.cost});
      // Where reservations overlap, the better hit's stays.
      reserved.FillFree(start - CeilOfPart(length, 10), start + CeilOfPart(length, 2), length);
    }
    const int length = reserved.At(start);
    blank.FillFree(end - CeilOfPart(length, 2), end + CeilOfPart(length, 10), 1);
  }
  return hits;
}

}  // namespace internal

std::vector<Hit> ExtractHits(const DeltaCurve& curve, double tau, int recording) {
  std::vector<internal::Candidate> candidates;
  internal::AppendCandidates(curve.delta, curve.start, tau, 0, candidates);
  return internal::ExtractHits(std::move(candidates), recording);
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
