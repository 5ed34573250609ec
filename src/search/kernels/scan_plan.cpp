#include "search/kernels/scan_plan.h"

#include <bit>

namespace kinebase::internal {
namespace {

NibbleTable MakeTable(const QuantizedColumn& column, std::size_t nibble) {
  const std::uint64_t consistent = (column.consistent >> (4 * nibble)) & 0xF;
  const std::uint64_t ones = (column.ones >> (4 * nibble)) & 0xF;
  NibbleTable table{.sums = {}, .nibble = nibble};
  for (std::uint64_t value = 0; value < 16; ++value) {
    table.sums[value] = static_cast<std::uint8_t>(std::popcount((value ^ ones) & consistent));
  }
  return table;
}

}  // namespace

ScanPlan::ScanPlan(const QuantizedTemplate& motion_template)
    : doubles_two_one_(motion_template.matching == Profile::kBonn), costs_(motion_template) {
  const auto looks_at = [](const QuantizedColumn& column, std::size_t nibble) {
    return ((column.consistent >> (4 * nibble)) & 0xF) != 0;
  };
  tables_.reserve(motion_template.columns.size() * kNibblesOfAWord);  // The spans below stay valid.
  for (const QuantizedColumn& column : motion_template.columns) {
    const std::size_t first = tables_.size();
    for (std::size_t nibble = 0; nibble < kNibblesOfAWord; ++nibble) {
      if (looks_at(column, nibble)) tables_.push_back(MakeTable(column, nibble));
    }
    rows_.push_back({column.scale, std::span(tables_).subspan(first)});
  }
}

}  // namespace kinebase::internal
