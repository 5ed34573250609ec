// Plans which folder each clip goes into.

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/library/file_moves.h"
#include "kinebase/library/takes.h"
#include "kinebase/motion/motion_file.h"
#include "library/file_move_checks.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> MotionFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  // Not a range-based loop: its ++ throws where a folder cannot be read on.
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (internal::IsMotionFile(entry->path()) && entry->is_regular_file(ignored)) {
      files.push_back(entry->path());
    }
  }
  if (error) {
    throw Error(ErrorCode::kIoFailure, "cannot be read: " + error.message(), {.file = folder});
  }
  std::ranges::sort(files);
  return files;
}

// Where the character at a position from 1 begins in UTF-8; the end if there are not so many.
std::size_t ByteOf(std::string_view text, std::int64_t position) {
  std::size_t byte = 0;
  const auto is_continuation = [&] {
    return byte < text.size() && (static_cast<unsigned char>(text[byte]) & 0xC0U) == 0x80U;
  };
  for (std::int64_t i = 1; i < position && byte < text.size(); ++i) {
    ++byte;
    while (is_continuation()) ++byte;
  }
  return byte;
}

// Empty if the name gives no folder.
std::string FolderFor(const fs::path& file, const SortOptions& options) {
  const std::string stem = file.stem().string();
  if (options.start_position == 0 && options.start_text.empty()) {
    return ParseTakeName(file).class_name;
  }
  std::size_t begin = ByteOf(stem, options.start_position);
  if (!options.start_text.empty()) {
    const std::size_t found = stem.find(options.start_text);
    if (found == std::string::npos) return {};
    begin = found + options.start_text.size();
  }
  const std::string rest = stem.substr(begin);
  return options.delimiter.empty() ? rest : rest.substr(0, rest.find(options.delimiter));
}

}  // namespace

MovePlan PlanSort(const fs::path& folder, const SortOptions& options) {
  internal::CheckIsFolder(folder);
  const std::vector<fs::path> files = MotionFilesIn(folder);
  MovePlan plan;
  if (files.empty()) {
    (void)FindMotionFiles(std::vector{folder});  // All sorted already, or nothing to sort at all?
    return plan;
  }
  for (const fs::path& file : files) {
    const std::string name = FolderFor(file, options);
    if (name.empty() || name == "." || name == "..") {
      plan.left.push_back(file);
      continue;
    }
    const fs::path target_folder = folder / name;
    const fs::path target = target_folder / file.filename();
    std::error_code ignored;
    if (internal::IsThere(target_folder) && !fs::is_directory(target_folder, ignored)) {
      plan.obstacles.emplace_back(ErrorCode::kAlreadyExists,
                                  fmt::format("is a file; a folder of that name is needed for {}",
                                              file.filename().string()),
                                  Place{.file = target_folder});
    } else if (internal::IsThere(target)) {
      plan.obstacles.emplace_back(ErrorCode::kAlreadyExists,
                                  fmt::format("exists already; {} cannot go there", file.string()),
                                  Place{.file = target});
    } else {
      plan.moves.push_back({file, target});
    }
  }
  internal::WarnOfLostSkeletons(plan);
  return plan;
}

}  // namespace kinebase
