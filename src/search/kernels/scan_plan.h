// A quantised template prepared for the vector kernel, and the kernel's entry.
//
// Mismatches are counted four features at a time: for every template column and every nibble of a
// feature word, a table of 16 bytes says how many of the four features disagree. Byte shuffles look
// up 16 to 64 columns of the recording at once; a nibble that a column leaves free costs nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kinebase/templates/quantized_template.h"
#include "search/local_costs.h"

namespace kinebase::internal {

inline constexpr std::size_t kNibblesOfAWord = 16;

struct NibbleTable {
  alignas(16) std::array<std::uint8_t, 16> sums;  // [value of the nibble]
  std::size_t nibble = 0;                         // Which: 0 = features 1 to 4.
};

struct ScanRow {
  double scale = 0;  // Cost of one mismatch.
  std::span<const NibbleTable> tables;
};

// Immutable; one plan serves all threads.
class ScanPlan {
 public:
  explicit ScanPlan(const QuantizedTemplate& motion_template);
  ScanPlan(const ScanPlan&) = delete;
  ScanPlan& operator=(const ScanPlan&) = delete;

  [[nodiscard]] const std::vector<ScanRow>& rows() const { return rows_; }
  [[nodiscard]] bool doubles_two_one() const { return doubles_two_one_; }
  [[nodiscard]] const LocalCosts& costs() const { return costs_; }

 private:
  std::vector<NibbleTable> tables_;
  std::vector<ScanRow> rows_;  // One for each template column.
  bool doubles_two_one_;       // Profile bonn.
  LocalCosts costs_;           // For templates with entry weights, which are not counted.
};

// Δ and starts of the columns [begin, end) of a recording; the same whatever the cut.
//
// columns  The whole recording.
// delta    [end − begin], out.
// start    [end − begin], out: columns of the recording.
void ScanRange(const ScanPlan& plan, std::span<const std::uint64_t> columns, std::size_t begin,
               std::size_t end, double* delta, std::int32_t* start);

}  // namespace kinebase::internal
