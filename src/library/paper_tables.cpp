// The tables of data/paper as types.

#include "kinebase/library/paper_tables.h"

#include <algorithm>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {

namespace internal {
std::string_view EmbeddedData_paper_classes();
std::string_view EmbeddedData_paper_table1();
std::string_view EmbeddedData_paper_table2();
std::string_view EmbeddedData_paper_table3();
std::string_view EmbeddedData_paper_table4();
std::string_view EmbeddedData_paper_table5();
std::string_view EmbeddedData_paper_figure7();
std::string_view EmbeddedData_paper_figure8();
}  // namespace internal

namespace {

constexpr std::array<std::string_view, 7> kNames = {"table1", "table2",  "table3", "table4",
                                                    "table5", "figure7", "figure8"};

std::string_view TextOf(PaperPreset preset) {
  switch (preset) {
    case PaperPreset::kTable1:
      return internal::EmbeddedData_paper_table1();
    case PaperPreset::kTable2:
      return internal::EmbeddedData_paper_table2();
    case PaperPreset::kTable3:
      return internal::EmbeddedData_paper_table3();
    case PaperPreset::kTable4:
      return internal::EmbeddedData_paper_table4();
    case PaperPreset::kTable5:
      return internal::EmbeddedData_paper_table5();
    case PaperPreset::kFigure7:
      return internal::EmbeddedData_paper_figure7();
    case PaperPreset::kFigure8:
      return internal::EmbeddedData_paper_figure8();
  }
  return {};
}

// Columns that say which row it is; all others are figures.
bool IsFigure(std::string_view column) {
  return column != "class" && column != "variant" && column != "note";
}

// All that a table or figure is about.
std::set<std::string> ClassesOfPaper() {
  std::set<std::string> names;
  for (const std::string_view preset : kNames) {
    for (PaperRow& row : ReadPaperTable(*ParsePaperPreset(preset)).rows) {
      names.insert(std::move(row.paper_class));
    }
  }
  return names;
}

}  // namespace

std::span<const std::string_view> PaperPresetNames() { return kNames; }

std::string_view ToString(PaperPreset preset) { return kNames[static_cast<std::size_t>(preset)]; }

std::optional<PaperPreset> ParsePaperPreset(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<PaperPreset>(found - kNames.begin());
}

PaperClasses PaperClasses::BuiltIn() {
  return Parse(internal::EmbeddedData_paper_classes(), "paper_classes.csv");
}

PaperClasses PaperClasses::Read(const std::filesystem::path& file) {
  return Parse(MappedFile(file).text(), file);
}

PaperClasses PaperClasses::Parse(std::string_view text, const std::filesystem::path& file) {
  const CsvTable table = ParseCsv(text, file);
  const std::size_t paper_class = table.Column("class");
  const std::size_t hdm05 = table.Column("hdm05");
  const std::optional<std::size_t> note = table.FindColumn("note");
  const std::set<std::string> known = ClassesOfPaper();
  PaperClasses classes;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<std::string>& fields = table.rows[i];
    const auto names = SplitTokens(fields[hdm05]);
    const Place place{file, table.lines[i]};
    if (!known.contains(fields[paper_class])) {
      throw Error(ErrorCode::kMalformedFile,
                  fmt::format("the paper has no class {}; there are {}",
                              Quoted(fields[paper_class]), fmt::join(known, ", ")),
                  place);
    }
    if (names.empty()) {
      throw Error(ErrorCode::kMalformedFile,
                  "column hdm05 needs the name of a class in the list of clips, or several", place);
    }
    Row& row = classes.rows_.emplace_back();
    row.paper_class = fields[paper_class];
    row.found.names = {names.begin(), names.end()};
    if (note) row.found.note = fields[*note];
  }
  return classes;
}

PaperClasses::Found PaperClasses::Find(std::string_view paper_class,
                                       const std::set<std::string>& here) const {
  for (const Row& row : rows_) {
    if (row.paper_class == paper_class && std::ranges::includes(here, row.found.names)) {
      return row.found;
    }
  }
  return {};
}

PaperTable ReadPaperTable(PaperPreset preset) {
  const std::string file = fmt::format("paper_{}.csv", ToString(preset));
  const CsvTable csv = ParseCsv(TextOf(preset), file);
  const std::size_t class_column = csv.Column("class");
  const std::optional<std::size_t> variant = csv.FindColumn("variant");
  const std::optional<std::size_t> note = csv.FindColumn("note");
  PaperTable table;
  std::ranges::copy_if(csv.columns, std::back_inserter(table.columns), &IsFigure);
  for (const std::vector<std::string>& fields : csv.rows) {
    PaperRow& row = table.rows.emplace_back();
    row.paper_class = fields[class_column];
    if (variant) row.variant = fields[*variant];
    if (note) row.note = fields[*note];
    for (std::size_t i = 0; i < fields.size(); ++i) {
      // What the paper leaves out, or our copy of it, is an empty field.
      if (IsFigure(csv.columns[i])) row.paper.push_back(ParseDouble(fields[i]));
    }
  }
  return table;
}

}  // namespace kinebase
