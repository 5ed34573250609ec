// Small tables in text: comma separated, quotes as in RFC 4180, any line ending.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinebase {

struct CsvTable {
  std::filesystem::path file;                  // For messages.
  std::vector<std::string> columns;            // The header line.
  std::vector<std::vector<std::string>> rows;  // Each as long as `columns`.
  std::vector<std::int64_t> lines;             // 1-based line of each row.

  // Index of a column. Errors: MalformedFile, naming the file and the columns that there are.
  [[nodiscard]] std::size_t Column(std::string_view name) const;
  [[nodiscard]] std::optional<std::size_t> FindColumn(std::string_view name) const;
};

// Errors  MalformedFile: no header, an open quote, a row of another length (with its line).
[[nodiscard]] CsvTable ParseCsv(std::string_view text, const std::filesystem::path& file);

// A field as it stands in a file: quoted where it holds a comma, quote or line break.
[[nodiscard]] std::string CsvField(std::string_view field);

}  // namespace kinebase
