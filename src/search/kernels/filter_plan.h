// Rules out columns where no path of cost ≤ τ ends, before anything is computed exactly.
//
// What a path costs is bounded from below in whole numbers of 16 bits: local costs are rounded
// down, sums that do not fit stay at the largest number, and every cell takes the cheapest way in,
// where the exact rule takes one of the ways. So a bound is never above the exact cost, on any
// machine, and a column with a bound above τ is no hit. docs/design/search.md has the argument in
// full; tests hold it against the reference. The bound's own inexactness only decides how much is
// then computed exactly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "search/kernels/scan_plan.h"

namespace kinebase::internal {

struct FilterRow {
  std::uint16_t factor = 0;             // What one of the tables' units costs.
  std::span<const NibbleTable> tables;  // Mismatches, or their weights in units.
};

// Immutable; one plan serves all threads.
class FilterPlan {
 public:
  // tau  On Δ; above kMostTau nothing is worth ruling out.
  FilterPlan(const QuantizedTemplate& motion_template, double tau);
  FilterPlan(const FilterPlan&) = delete;
  FilterPlan& operator=(const FilterPlan&) = delete;

  // Whether there is anything to gain.
  [[nodiscard]] bool rules_out() const { return !rows_.empty(); }
  [[nodiscard]] const std::vector<FilterRow>& rows() const { return rows_; }
  [[nodiscard]] bool doubles_two_one() const { return doubles_two_one_; }
  [[nodiscard]] std::uint16_t limit() const { return limit_; }  // The bound of τ.

 private:
  std::vector<NibbleTable> tables_;
  std::vector<FilterRow> rows_;  // One for each template column; empty: nothing is ruled out.
  bool doubles_two_one_;
  std::uint16_t limit_ = 0;
};

// Columns [first, last] of a recording.
struct ColumnRun {
  std::size_t first = 0;
  std::size_t last = 0;
};

// What is left of the columns [begin, end) of a recording, by place. Runs that are so close that
// computing them together is cheaper are one.
//
// plan     One that rules out.
// columns  The whole recording.
[[nodiscard]] std::vector<ColumnRun> FilterRange(const FilterPlan& plan,
                                                 std::span<const std::uint64_t> columns,
                                                 std::size_t begin, std::size_t end);

}  // namespace kinebase::internal
