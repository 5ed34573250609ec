// Reads and writes MOT and STO.
//
//   name
//   version=1
//   nRows=2
//   nColumns=3
//   inDegrees=yes
//   endheader
//   time  a    b
//   0     1.5  2
//   0.01  1.6  2
//
// with tabs for the gaps. Cells of quaternions and vectors hold their numbers with commas between.

#include "kinebase/formats/sto.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "text_lines.h"

namespace kinebase {
namespace {

struct DataType {
  std::string_view name;
  std::size_t component_count;
};

// OpenSim's names of types.
constexpr std::array kDataTypes = {DataType{"double", 1}, DataType{"Vec3", 3},
                                   DataType{"Quaternion", 4}, DataType{"SpatialVec", 6}};

class StoParser {
 public:
  StoParser(std::string_view text, const std::filesystem::path& file) : lines_(text), file_(file) {}

  StoTable Parse() {
    ReadHeader();
    ReadLabels();
    while (NextLine()) ReadRow();
    CheckCount(declared_rows_, table_.row_count(), "rows");
    CheckCount(declared_columns_, table_.column_count() + 1, "columns");
    return std::move(table_);
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, lines_.line_number()});
  }

  // The next line that is not blank; false at the end.
  bool NextLine() {
    while (lines_.Next()) {
      if (!Trim(lines_.line()).empty()) return true;
    }
    return false;
  }

  void ReadHeader() {
    for (bool is_first = true; NextLine(); is_first = false) {
      if (internal::HoldsBinaryData(lines_.line())) {
        Fail("holds binary data; expected the text of a MOT or STO file");
      }
      const std::string_view line = Trim(lines_.line());
      if (EqualsIgnoringCase(line, "endheader")) return;
      const std::size_t equals = line.find('=');
      if (is_first && equals == std::string_view::npos) {
        table_.name = line;
      } else if (equals == std::string_view::npos || Trim(line.substr(0, equals)).empty()) {
        table_.header.push_back({"", std::string(line)});
      } else {
        TakeHeaderLine(Trim(line.substr(0, equals)), Trim(line.substr(equals + 1)));
      }
    }
    Fail("has no line 'endheader'");
  }

  void TakeHeaderLine(std::string_view key, std::string_view value) {
    const auto is = [&](std::string_view each) { return EqualsIgnoringCase(key, each); };
    if (is("nRows") || is("datarows")) {
      declared_rows_ = ParseInteger(value);
    } else if (is("nColumns") || is("datacolumns")) {
      declared_columns_ = ParseInteger(value);
    } else if (is("inDegrees")) {
      if (!EqualsIgnoringCase(value, "yes") && !EqualsIgnoringCase(value, "no")) {
        Fail("expected inDegrees=yes or inDegrees=no, found " + Quoted(value));
      }
      table_.in_degrees = EqualsIgnoringCase(value, "yes");
    } else if (is("DataType")) {
      TakeDataType(value);
    } else {
      table_.header.push_back({std::string(key), std::string(value)});
    }
  }

  void TakeDataType(std::string_view value) {
    const auto found = std::ranges::find_if(
        kDataTypes, [&](const DataType& type) { return EqualsIgnoringCase(type.name, value); });
    if (found == kDataTypes.end()) {
      Fail(fmt::format("unknown DataType {}; known: double, Vec3, Quaternion, SpatialVec",
                       Quoted(value)));
    }
    table_.data_type = value;
    table_.component_count = found->component_count;
  }

  void ReadLabels() {
    if (!NextLine()) Fail("ends before the names of the columns");
    const auto names = SplitTokens(lines_.line());
    if (internal::HoldsBinaryData(lines_.line()) || !EqualsIgnoringCase(names.front(), "time")) {
      Fail("expected the names of the columns, 'time' first, found " + Quoted(names.front()));
    }
    table_.labels.assign(names.begin() + 1, names.end());
  }

  void ReadRow() {
    std::string_view rest = lines_.line();
    const auto time = ParseDouble(TakeToken(rest));
    if (!time || !std::isfinite(*time)) Fail("expected a time, found " + Quoted(lines_.line()));
    std::size_t count = 0;
    for (auto cell = TakeToken(rest); !cell.empty(); cell = TakeToken(rest)) {
      if (++count <= table_.column_count()) ReadCell(cell);
    }
    if (count != table_.column_count()) {
      Fail(fmt::format("{} cells after the time; expected {}", count, table_.column_count()));
    }
    table_.times_s.push_back(*time);
  }

  void ReadCell(std::string_view cell) {
    for (std::size_t i = 0; i < table_.component_count; ++i) {
      const std::size_t comma = cell.find(',');
      const bool is_last = i + 1 == table_.component_count;
      const auto value = ParseDouble(cell.substr(0, comma));
      if (!value || is_last != (comma == std::string_view::npos)) {
        Fail(fmt::format("a cell is not {}: {}",
                         table_.component_count == 1 ? "a number"
                                                     : fmt::format("{} numbers with commas between",
                                                                   table_.component_count),
                         Quoted(cell)));
      }
      table_.values.push_back(*value);
      if (!is_last) cell.remove_prefix(comma + 1);
    }
  }

  void CheckCount(std::optional<std::int64_t> declared, std::size_t there, std::string_view what) {
    if (!declared || *declared == static_cast<std::int64_t>(there)) return;
    table_.diagnostics.push_back(
        {Severity::kWarning,
         fmt::format("{} {} are declared, {} are there", *declared, what, there), 0});
  }

  LineScanner lines_;
  const std::filesystem::path& file_;
  StoTable table_;
  std::optional<std::int64_t> declared_rows_;
  std::optional<std::int64_t> declared_columns_;
};

bool SameValue(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

StoTable ParseSto(std::string_view text, const std::filesystem::path& file) {
  if (text.empty()) {
    throw Error(ErrorCode::kMalformedFile, "is empty; expected a MOT or STO table", {file});
  }
  return StoParser(text, file).Parse();
}

StoTable ReadSto(const std::filesystem::path& path) {
  const MappedFile file(path);
  return ParseSto(file.text(), path);
}

std::string FormatSto(const StoTable& table) {
  std::string out;
  out.reserve(table.values.size() * 12);
  const std::string counts =
      fmt::format("nRows={}\nnColumns={}\n", table.row_count(), table.column_count() + 1);
  if (table.name.starts_with(kByteOrderMark)) out += kByteOrderMark;
  // A first line without '=' would be a name.
  out += table.name.empty() ? counts : table.name + '\n';
  if (!table.data_type.empty()) out += "DataType=" + table.data_type + '\n';
  for (const auto& line : table.header) {
    out += (line.key.empty() ? "" : line.key + '=') + line.value + '\n';
  }
  if (!table.name.empty()) out += counts;
  if (table.in_degrees) out += *table.in_degrees ? "inDegrees=yes\n" : "inDegrees=no\n";
  out += "endheader\ntime";
  for (const auto& label : table.labels) out += '\t' + label;
  out += '\n';
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    AppendShortestText(out, table.times_s[row]);
    for (std::size_t column = 0; column < table.column_count(); ++column) {
      char separator = '\t';
      for (const double value : table.Cell(row, column)) {
        out += std::exchange(separator, ',');
        AppendShortestText(out, value);
      }
    }
    out += '\n';
  }
  return out;
}

bool operator==(const StoTable& a, const StoTable& b) {
  return a.name == b.name && a.header == b.header && a.in_degrees == b.in_degrees &&
         a.data_type == b.data_type && a.component_count == b.component_count &&
         a.labels == b.labels && a.times_s == b.times_s &&
         std::ranges::equal(a.values, b.values, SameValue);
}

}  // namespace kinebase
