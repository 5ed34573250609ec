#include "search/kernels/filter_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace kinebase::internal {
namespace {

// With more, hits are no rarity: what is not ruled out costs more than the rest saves.
constexpr double kMostTau = 0.3;
// Of a path of cost τ. The largest number leaves as much again for paths beyond.
constexpr double kUnitsOfTau = 32768;
constexpr double kMostUnits = std::numeric_limits<std::uint16_t>::max();
// Exact costs are sums of doubles: they may lie below what they stand for by far less than this.
constexpr double kSlack = 1e-9;

// What the four features of a nibble that disagree cost.
std::array<double, 16> NibbleCosts(const QuantizedTemplate& motion_template, std::size_t column,
                                   std::size_t nibble) {
  const QuantizedColumn& asked = motion_template.columns[column];
  const std::uint64_t consistent = (asked.consistent >> (4 * nibble)) & 0xF;
  const std::uint64_t ones = (asked.ones >> (4 * nibble)) & 0xF;
  const auto features = static_cast<std::size_t>(motion_template.feature_count);
  std::array<double, 16> costs = {};
  for (std::uint64_t value = 0; value < costs.size(); ++value) {
    const std::uint64_t disagreeing = (value ^ ones) & consistent;
    if (motion_template.costs.empty()) {
      costs[value] = std::popcount(disagreeing);
      continue;
    }
    for (std::size_t bit = 0; bit < 4; ++bit) {
      if (((disagreeing >> bit) & 1U) == 0) continue;
      costs[value] += motion_template.costs[column * features + 4 * nibble + bit];
    }
  }
  return costs;
}

// A template column before units are chosen.
struct RowCosts {
  std::vector<std::pair<std::size_t, std::array<double, 16>>> nibbles;
  double unit = 0;  // Cost of one unit of the tables.
  double most = 0;  // Of the whole column, in costs.
};

RowCosts CostsOfRow(const QuantizedTemplate& motion_template, std::size_t column) {
  const QuantizedColumn& asked = motion_template.columns[column];
  RowCosts row;
  double most = 0;
  for (std::size_t nibble = 0; nibble < kNibblesOfAWord; ++nibble) {
    if (((asked.consistent >> (4 * nibble)) & 0xF) == 0) continue;
    row.nibbles.emplace_back(nibble, NibbleCosts(motion_template, column, nibble));
    most += std::ranges::max(row.nibbles.back().second);
  }
  constexpr double kMostOfATable = std::numeric_limits<std::uint8_t>::max();
  // Mismatches are whole already; weights become so, the unit being as small as all together allow.
  const bool is_counted = motion_template.costs.empty();
  row.unit = is_counted ? asked.scale : most / kMostOfATable;
  row.most = is_counted ? most * asked.scale : most;
  if (is_counted || !std::isnormal(row.unit)) return row;
  for (auto& [nibble, costs] : row.nibbles) {
    for (double& cost : costs) cost = std::floor(cost / row.unit * (1 - kSlack));
  }
  return row;
}

}  // namespace

FilterPlan::FilterPlan(const QuantizedTemplate& motion_template, double tau)
    : doubles_two_one_(motion_template.matching == Profile::kBonn) {
  const std::size_t columns = motion_template.columns.size();
  if (columns == 0 || !(tau > 0) || tau > kMostTau) return;
  std::vector<RowCosts> rows;
  rows.reserve(columns);
  double most = 0;
  for (std::size_t column = 0; column < columns; ++column) {
    rows.push_back(CostsOfRow(motion_template, column));
    most = std::max(most, rows.back().most);
  }
  if (most == 0) return;  // Everything matches.
  const double path = tau * static_cast<double>(columns);
  const double units_of_a_cost = std::min(kUnitsOfTau / path, kMostUnits / most);
  // Numbers so small, or so large, that their quotients are no numbers any more bound nothing.
  const bool has_units =
      std::ranges::all_of(
          rows, [](const RowCosts& row) { return row.most == 0 || std::isnormal(row.unit); }) &&
      std::isnormal(units_of_a_cost);
  if (!has_units) return;
  limit_ = static_cast<std::uint16_t>(std::floor(path * units_of_a_cost * (1 + kSlack)) + 1);
  tables_.reserve(columns * kNibblesOfAWord);  // The spans below stay valid.
  for (const RowCosts& row : rows) {
    const std::size_t first = tables_.size();
    for (const auto& [nibble, costs] : row.nibbles) {
      NibbleTable& table = tables_.emplace_back(NibbleTable{.sums = {}, .nibble = nibble});
      std::ranges::transform(costs, table.sums.begin(),
                             [](double cost) { return static_cast<std::uint8_t>(cost); });
    }
    const double factor = std::floor(row.unit * units_of_a_cost * (1 - kSlack));
    rows_.push_back({static_cast<std::uint16_t>(factor), std::span(tables_).subspan(first)});
  }
}

}  // namespace kinebase::internal
