// MOT and STO, OpenSim's tables of values over time, as they stand in the file.
//
// Written from recordings by motion/sto_motion.h. Source: docs/formats/opensim.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/diagnostic.h"

namespace kinebase {

// A line of the header but those that the table itself has: `key=value`, or text without a key.
struct StoHeaderLine {
  std::string key;
  std::string value;

  friend bool operator==(const StoHeaderLine&, const StoHeaderLine&) = default;
};

struct StoTable {
  std::string name;                   // First line; may be empty.
  std::vector<StoHeaderLine> header;  // "version" and others, in order.
  std::optional<bool> in_degrees;     // `inDegrees`.
  std::string data_type;              // `DataType`: "Quaternion", "Vec3"; empty: plain numbers.
  std::size_t component_count = 1;    // Numbers in a cell, by the type: 4 for quaternions.

  std::vector<std::string> labels;  // Of the columns but `time`.
  std::vector<double> times_s;      // [row]
  std::vector<double> values;       // [row × column × component]

  Diagnostics diagnostics;  // What was odd; not part of equality.

  [[nodiscard]] std::size_t row_count() const { return times_s.size(); }
  [[nodiscard]] std::size_t column_count() const { return labels.size(); }
  [[nodiscard]] std::span<const double> Cell(std::size_t row, std::size_t column) const {
    return std::span(values).subspan((row * labels.size() + column) * component_count,
                                     component_count);
  }
  // NaN equals NaN here.
  friend bool operator==(const StoTable& a, const StoTable& b);
};

// Reads the text of a MOT or STO file. `file` is for messages only.
//
// Errors       MalformedFile with the line: not text, no `endheader`, no column `time`, a row with
//              another number of cells, a cell that is no number or has another number of
//              components.
// diagnostics  Counts in the header that differ from what is there.
// Cost         Linear in the text; memory 8 bytes a value. No allocation depends on a number in
//              the file.
[[nodiscard]] StoTable ParseSto(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] StoTable ReadSto(const std::filesystem::path& path);

// The text of a MOT or STO file with LF line ends, every number so short that it reads back the
// same. ParseSto(FormatSto(t)) == t for every table that was read, and for others whose labels are
// words and whose header's lines are trimmed.
[[nodiscard]] std::string FormatSto(const StoTable& table);

}  // namespace kinebase
