#include "kinebase/core/csv.h"

#include <algorithm>
#include <utility>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

// Walks over the fields of a table, counting lines.
class CsvParser {
 public:
  CsvParser(std::string_view text, const std::filesystem::path& file) : rest_(text), file_(file) {
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  }

  // The next line that is not empty; false at the end.
  bool NextRow(std::vector<std::string>& fields, std::int64_t& line) {
    fields.clear();
    while (!rest_.empty() && TakeLineEnd()) {
    }
    if (rest_.empty()) return false;
    line = line_;
    do {
      fields.push_back(rest_.starts_with('"') ? QuotedField() : PlainField());
    } while (TakeComma());
    if (!rest_.empty() && !TakeLineEnd()) {
      throw Error(ErrorCode::kMalformedFile, "text after a closing quote", {file_, line_});
    }
    return true;
  }

 private:
  bool TakeComma() {
    if (!rest_.starts_with(',')) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool TakeLineEnd() {
    const std::size_t length = rest_.starts_with("\r\n")                            ? 2
                               : rest_.starts_with('\n') || rest_.starts_with('\r') ? 1
                                                                                    : 0;
    rest_.remove_prefix(length);
    line_ += length > 0 ? 1 : 0;
    return length > 0;
  }

  std::string PlainField() {
    const std::size_t end = std::min(rest_.find_first_of(",\r\n"), rest_.size());
    std::string field(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return field;
  }

  std::string QuotedField() {
    const std::int64_t opened = line_;
    rest_.remove_prefix(1);
    std::string field;
    while (!rest_.empty()) {
      const char c = rest_.front();
      rest_.remove_prefix(1);
      if (c != '"') {
        line_ += c == '\n' ? 1 : 0;
        field += c;
      } else if (rest_.starts_with('"')) {
        rest_.remove_prefix(1);
        field += '"';
      } else {
        return field;
      }
    }
    throw Error(ErrorCode::kMalformedFile, "a quote that opens here is never closed",
                {file_, opened});
  }

  std::string_view rest_;
  const std::filesystem::path& file_;
  std::int64_t line_ = 1;
};

}  // namespace

std::optional<std::size_t> CsvTable::FindColumn(std::string_view name) const {
  const auto found = std::ranges::find(columns, name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

std::size_t CsvTable::Column(std::string_view name) const {
  if (const auto column = FindColumn(name)) return *column;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("no column '{}'; there are: {}", name, fmt::join(columns, ", ")),
              {file, 1});
}

CsvTable ParseCsv(std::string_view text, const std::filesystem::path& file) {
  CsvParser parser(text, file);
  CsvTable table{.file = file};
  std::int64_t line = 0;
  if (!parser.NextRow(table.columns, line)) {
    throw Error(ErrorCode::kMalformedFile, "is empty; expected a line of column names", {file});
  }
  std::vector<std::string> fields;
  while (parser.NextRow(fields, line)) {
    if (fields.size() != table.columns.size()) {
      throw Error(ErrorCode::kMalformedFile,
                  fmt::format("{} fields; the header has {}", fields.size(), table.columns.size()),
                  {file, line});
    }
    table.rows.push_back(std::move(fields));
    table.lines.push_back(line);
    fields = {};
  }
  return table;
}

std::string CsvField(std::string_view field) {
  if (field.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(field);
  std::string quoted = "\"";
  for (const char c : field) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace kinebase
