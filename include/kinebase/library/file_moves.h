// Sorting and renaming files: first a plan as data, then the moves.
//
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 3.3. Departures: docs/cutting.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/core/progress.h"

namespace kinebase {

struct FileMove {
  std::filesystem::path from;
  std::filesystem::path to;

  friend bool operator==(const FileMove&, const FileMove&) = default;
};

// What is to be done, and what stands in its way. Nothing has been touched yet.
struct MovePlan {
  std::vector<FileMove> moves;
  std::vector<std::filesystem::path> left;  // Motion files that stay where they are.
  std::vector<Error> obstacles;             // With any of these, apply nothing.
  std::vector<std::string> warnings;        // Skeletons that would not be found any more.
};

struct SortOptions {
  // Where in a file's name that of its folder begins. Neither: at the motion class, by the
  // convention of HDM05, where files that have none (full takes) are left.
  std::int64_t start_position = 0;  // From 1, in characters; 0 = not used.
  std::string start_text;           // After its first occurrence; empty = not used.
  std::string delimiter = "_";      // The name ends before it, or with the file's name.
};

// Sorts the motion files right in `folder` into folders below it. A file whose name gives no
// folder is left.
//
// Skeletons stay: they are found from the folders below.
// Errors     NotFound: no such folder, or no motion file in it and below.
// obstacles  A file of that name is there already; the folder's name is a file's.
[[nodiscard]] MovePlan PlanSort(const std::filesystem::path& folder,
                                const SortOptions& options = {});

// Renames files in `folder` by a table: columns `old` and `new`; or two columns without titles, in
// that order. Names are relative to the folder and stay below it.
//
// An old name without the extension of a motion file stands for all motion files of that name, each
// of which keeps its own; so does a new name without one. A row whose old file is gone and whose
// new one is there is done already: a run that was interrupted can be run again.
// Errors     NotFound, MalformedFile: the folder, the table.
// obstacles  Each with its line: a name that is absolute or has '..', a file that is missing, a new
//            name that exists or stands twice, another extension, a name that is old in one row and
//            new in another (which could not be run again).
[[nodiscard]] MovePlan PlanRename(const std::filesystem::path& folder,
                                  const std::filesystem::path& table);

struct MoveFailure {
  FileMove move;
  Error error;
};

// Moves files within a file system, making folders where they are missing. What has come up since
// the plan was made is never overwritten: such a move fails, the others are made.
// Errors  Cancelled: files stay where they are by then.
[[nodiscard]] std::vector<MoveFailure> ApplyMoves(std::span<const FileMove> moves,
                                                  const ProgressCallback& progress = {});

}  // namespace kinebase
