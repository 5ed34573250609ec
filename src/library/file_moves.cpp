// Applies moves, and what both plans check.

#include "kinebase/library/file_moves.h"

#include <fcntl.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <system_error>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/motion_file.h"
#include "library/file_move_checks.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

// 0, or the system's error number. EEXIST if something has that name.
int MoveWithoutReplacing(const fs::path& from, const fs::path& to) {
#ifdef RENAME_NOREPLACE
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
#endif
  // A system or file system that cannot: the check and the rename are two steps there.
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(to, ignored))) return EEXIST;
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

void Move(const FileMove& move) {
  std::error_code error;
  fs::create_directories(move.to.parent_path(), error);
  if (error) {
    throw Error(ErrorCode::kIoFailure, "cannot be made: " + error.message(),
                {.file = move.to.parent_path()});
  }
  switch (const int number = MoveWithoutReplacing(move.from, move.to)) {
    case 0:
      return;
    case EEXIST:
      throw Error(ErrorCode::kAlreadyExists,
                  fmt::format("exists already; {} stays where it is", move.from.string()),
                  {.file = move.to});
    case ENOENT:
      throw Error(ErrorCode::kNotFound, "is gone", {.file = move.from});
    default:
      throw Error(ErrorCode::kIoFailure,
                  fmt::format("cannot be moved to {}: {}", move.to.string(), std::strerror(number)),
                  {.file = move.from});
  }
}

// The skeleton of a motion that has one, else empty.
fs::path SkeletonOf(const fs::path& motion) {
  try {
    return FindSkeleton(motion);
  } catch (const Error&) {
    return {};
  }
}

fs::path Normal(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return (error ? path : absolute).lexically_normal();
}

bool IsNamedFor(const fs::path& skeleton, const fs::path& motion) {
  const std::string stem = skeleton.stem().string();
  const std::string name = motion.stem().string();
  return name == stem || name.starts_with(stem + '_');
}

}  // namespace

std::vector<MoveFailure> ApplyMoves(std::span<const FileMove> moves,
                                    const ProgressCallback& progress) {
  std::vector<MoveFailure> failures;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    try {
      Move(moves[i]);
    } catch (const Error& error) {
      failures.push_back({moves[i], error});
    }
    if (progress && !progress("moving", i + 1, moves.size())) {
      throw Error(ErrorCode::kCancelled, "cancelled");
    }
  }
  return failures;
}

namespace internal {

void CheckIsFolder(const fs::path& folder) {
  std::error_code ignored;
  if (fs::is_directory(folder, ignored)) return;
  throw Error(ErrorCode::kNotFound, fs::exists(folder, ignored) ? "is no folder" : "does not exist",
              {.file = folder});
}

bool IsMotionFile(const fs::path& file) {
  const MotionFormat* const format = FindMotionFormat(file);
  return format != nullptr && format->load != nullptr;
}

bool IsThere(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

void WarnOfLostSkeletons(MovePlan& plan) {
  std::map<fs::path, fs::path> places_then;
  for (const FileMove& move : plan.moves) places_then.emplace(Normal(move.from), move.to);
  for (const FileMove& move : plan.moves) {
    if (ToLower(move.from.extension().string()) != ".amc") continue;
    const fs::path skeleton = SkeletonOf(move.from);
    if (skeleton.empty()) continue;
    const auto moved = places_then.find(skeleton);
    // One that moves too cannot be looked for yet: its new name has to fit.
    const bool is_found = moved == places_then.end() ? SkeletonOf(move.to) == skeleton
                                                     : IsNamedFor(moved->second, move.to);
    if (is_found) continue;
    plan.warnings.push_back(fmt::format(
        "{}: its skeleton {} will not be found by this name; rename that too, or name it with "
        "--skeleton",
        move.to.string(), skeleton.filename().string()));
  }
}

}  // namespace internal
}  // namespace kinebase
