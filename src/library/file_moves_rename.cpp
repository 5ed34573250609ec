// Plans renaming by a table.

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/file_moves.h"
#include "kinebase/motion/motion_file.h"
#include "library/file_move_checks.h"
#include "library/relative_name.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

struct Row {
  std::string old_name;
  std::string new_name;
  Place place;
};

// Errors  MalformedFile.
std::vector<Row> ReadRows(const fs::path& file) {
  const CsvTable table = ParseCsv(MappedFile(file).text(), file);
  std::vector<Row> rows;
  std::size_t old_column = 0;
  std::size_t new_column = 1;
  if (table.FindColumn("old") || table.FindColumn("new")) {
    old_column = table.Column("old");
    new_column = table.Column("new");
  } else if (table.columns.size() == 2) {
    rows.push_back({table.columns[0], table.columns[1], {file, 1}});
  } else {
    throw Error(ErrorCode::kMalformedFile,
                fmt::format("has the columns {}; expected 'old' and 'new', or two columns without "
                            "titles",
                            fmt::join(table.columns, ", ")),
                {file, 1});
  }
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    rows.push_back({table.rows[i][old_column], table.rows[i][new_column], {file, table.lines[i]}});
  }
  return rows;
}

// The extension if it is one that motion files or their skeletons have, else empty.
std::string KnownExtension(const fs::path& file) {
  std::string extension = file.extension().string();
  const bool is_known = FindMotionFormat(file) != nullptr || EqualsIgnoringCase(extension, ".asf");
  return is_known ? extension : std::string();
}

class RenamePlanner {
 public:
  explicit RenamePlanner(const fs::path& folder) : folder_(folder) {}

  void Add(const Row& row) {
    try {
      AddRow({.old_name = internal::CheckedRelativeName(row.old_name, "old name", row.place),
              .new_name = internal::CheckedRelativeName(row.new_name, "new name", row.place),
              .place = row.place});
    } catch (const Error& error) {
      plan_.obstacles.push_back(error);
    }
  }

  MovePlan Finish() {
    for (const auto& [path, place] : line_of_new_) {
      const auto old = line_of_old_.find(path);
      if (old == line_of_old_.end()) continue;
      plan_.obstacles.emplace_back(
          ErrorCode::kInvalidArgument,
          fmt::format("{} is a new name here and an old one in line {}; such a table could not be "
                      "run again after an interruption: make two",
                      Quoted(path.string()), old->second.line),
          place);
    }
    std::ranges::stable_sort(plan_.obstacles, {},
                             [](const Error& error) { return error.place().line; });
    if (plan_.obstacles.empty()) internal::WarnOfLostSkeletons(plan_);
    return std::move(plan_);
  }

 private:
  void AddRow(const Row& row) {
    if (row.old_name == row.new_name) return;
    if (!KnownExtension(row.old_name).empty() || internal::IsThere(folder_ / row.old_name) ||
        HasBeenRenamed(row)) {
      AddFile(row.old_name, WithExtension(row, KnownExtension(row.old_name)), row);
      return;
    }
    // All files of that name; of a run that was interrupted, also those that have the new one.
    std::map<std::string, std::string> files;
    for (const std::string& extension : ExtensionsOf(row.old_name)) {
      files.emplace(row.old_name + extension, WithExtension(row, extension));
    }
    const std::string own_extension = KnownExtension(row.new_name);
    if (!own_extension.empty() && internal::IsThere(folder_ / row.new_name)) {
      files.emplace(row.old_name + own_extension, row.new_name);
    }
    for (const std::string& extension : ExtensionsOf(row.new_name)) {
      if (own_extension.empty()) {
        files.emplace(row.old_name + extension, row.new_name + extension);
      }
    }
    if (files.empty()) FailMissing(row.old_name, row);
    for (const auto& [old_name, new_name] : files) AddFile(old_name, new_name, row);
  }

  // A file of another kind than motions, by an earlier run.
  [[nodiscard]] bool HasBeenRenamed(const Row& row) const {
    std::error_code ignored;
    return KnownExtension(row.new_name).empty() &&
           fs::is_regular_file(folder_ / row.new_name, ignored);
  }

  // The row's new name for a file with this extension; with none the new name is as it stands.
  static std::string WithExtension(const Row& row, const std::string& extension) {
    if (extension.empty()) return row.new_name;
    const std::string other = KnownExtension(row.new_name);
    if (other.empty()) return row.new_name + extension;
    if (EqualsIgnoringCase(other, extension)) return row.new_name;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a {} file cannot be named {}; renaming does not convert", extension,
                            Quoted(row.new_name)),
                row.place);
  }

  // Those of the motion files with this name and any extension.
  [[nodiscard]] std::vector<std::string> ExtensionsOf(const std::string& name) const {
    const fs::path path = folder_ / name;
    const std::string stem = path.filename().string();
    std::vector<std::string> extensions;
    std::error_code error;
    for (fs::directory_iterator entry(path.parent_path(), error), end; !error && entry != end;
         entry.increment(error)) {
      const fs::path& file = entry->path();
      if (file.stem() != stem || !internal::IsMotionFile(file)) continue;
      extensions.push_back(file.extension().string());
    }
    return extensions;
  }

  [[noreturn]] void FailMissing(const std::string& name, const Row& row) const {
    throw Error(
        ErrorCode::kNotFound,
        fmt::format("no {} in {}, nor {}", Quoted(name), folder_.string(), Quoted(row.new_name)),
        row.place);
  }

  void AddFile(const std::string& old_name, const std::string& new_name, const Row& row) {
    if (old_name == new_name) return;
    Claim(line_of_old_, old_name, "renamed", row.place);
    Claim(line_of_new_, new_name, "a new name", row.place);
    const fs::path from = folder_ / old_name;
    const fs::path to = folder_ / new_name;
    std::error_code ignored;
    if (!internal::IsThere(from)) {
      if (!internal::IsThere(to)) FailMissing(old_name, row);
      return;  // Done by an earlier run.
    }
    if (!fs::is_regular_file(from, ignored)) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("{} is no file; only files are renamed", Quoted(old_name)),
                  row.place);
    }
    if (internal::IsThere(to)) {
      throw Error(ErrorCode::kAlreadyExists,
                  fmt::format("{} exists already; {} cannot be named so", Quoted(new_name),
                              Quoted(old_name)),
                  row.place);
    }
    plan_.moves.push_back({from, to});
  }

  static void Claim(std::map<fs::path, Place>& lines, const std::string& name,
                    std::string_view what, const Place& place) {
    const auto [entry, is_new] = lines.try_emplace(name, place);
    if (is_new) return;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} is {} in line {} already", Quoted(name), what, entry->second.line),
                place);
  }

  fs::path folder_;
  MovePlan plan_;
  std::map<fs::path, Place> line_of_old_;
  std::map<fs::path, Place> line_of_new_;
};

}  // namespace

MovePlan PlanRename(const fs::path& folder, const fs::path& table) {
  internal::CheckIsFolder(folder);
  RenamePlanner planner(folder);
  for (const Row& row : ReadRows(table)) planner.Add(row);
  return planner.Finish();
}

}  // namespace kinebase
