#include "motion/sto_columns.h"

#include <algorithm>

namespace kinebase::internal {

std::string StoLabel(std::string_view name) {
  std::string label(name);
  std::ranges::replace_if(
      label, [](char c) { return static_cast<unsigned char>(c) <= ' '; }, '_');
  return label;
}

void SetColumns(StoTable& table, std::span<const StoColumn> columns) {
  table.labels.clear();
  for (const auto& column : columns) table.labels.push_back(StoLabel(column.label));
  table.values.clear();
  table.values.reserve(table.row_count() * columns.size());
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    for (const auto& column : columns) table.values.push_back(column.values[row]);
  }
}

std::vector<double> AnalogTimes(const C3dRecording& c3d) {
  const auto per_frame = static_cast<double>(c3d.subframe_count);
  const double samples_before = static_cast<double>(c3d.first_frame - 1) * per_frame;
  std::vector<double> times_s;
  for (std::size_t i = 0; i < c3d.frame_count * c3d.subframe_count; ++i) {
    const double sample = samples_before + static_cast<double>(i);
    times_s.push_back(sample / (per_frame * static_cast<double>(c3d.rate_hz)));
  }
  return times_s;
}

}  // namespace kinebase::internal
