// Putting takes into a library on disk.
//
// Read library/take_library.h first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kinebase/library/memory_limits.h"
#include "kinebase/library/takes.h"

namespace kinebase {

// A file to import, and what lists say of it; empty: what its name says.
struct ImportSource {
  std::filesystem::path file;
  std::string class_name;
  std::string actor;
  std::string description;  // In words; empty: what is known of HDM05 (library/descriptions.h).

  // For a take that no file holds: gives it when the library lacks it. `file` is then the name that
  // it is known by, and `origin` stands for its contents: all that they follow from.
  std::function<Recording()> make = {};  // Called from any thread.
  std::string origin = {};
};

enum class ImportState {
  kAdded,      // New in the library.
  kUpdated,    // Was there; contents, class, actor, description, features or poses are others.
  kUnchanged,  // Was there; nothing was read but the bytes of the file.
};

struct ImportedTake {
  std::filesystem::path path;  // As the library has it.
  ImportState state = ImportState::kAdded;
  std::int64_t frame_count = 0;
  Diagnostics diagnostics;  // Empty for what was not read.
};

struct ImportOptions {
  FeatureSet features;
  double rate_hz = 30;
  bool with_poses = false;
  LoadOptions load;
  int threads = 0;
  int takes_per_batch = 64;  // What becomes durable, or is lost in a crash, together.
  // Roughly what reading and a batch may use: fewer files are then read at a time, and batches are
  // smaller. A file that needs more is read alone.
  std::int64_t memory_bytes = kDefaultMemoryBytes;
  ProgressCallback progress;
  // Hears of each take once it will be there whatever happens.
  std::function<void(const ImportedTake& take)> on_durable;
};

struct ImportReport {
  std::int64_t added = 0;
  std::int64_t updated = 0;
  std::int64_t unchanged = 0;
  std::int64_t frames = 0;            // Of takes that were read.
  std::vector<TakeFailure> failures;  // Files that could not be read; the others are in.
};

// Adds the files to a library, which is made where there is none. A take is known by the path of
// its file, resolved, and stays as it is while the bytes of the file and its skeleton and the
// options of reading are the same; features of the same bytes are never computed twice.
//
// Errors   IoFailure: another import is running, a full disk; InvalidArgument: a folder that holds
//          other things; Mismatch, MalformedFile: the library is newer or damaged; Cancelled. What
//          on_durable heard of stays.
// Cost     Of reading the files, batch by batch; memory for the recordings of `threads` files and
//          the features of a batch.
// Threads  One import a library at a time; readers may go on meanwhile.
ImportReport ImportTakes(const std::filesystem::path& library,
                         std::span<const ImportSource> sources, const ImportOptions& options);

// The clips of a list (columns file, class, actor, …), looked up as ReadClipList does; an
// empty class is none. Those that are nowhere go into `failures`.
// Errors  As ReadClipList.
[[nodiscard]] std::vector<ImportSource> ListedSources(
    const std::filesystem::path& list, std::span<const std::filesystem::path> folders,
    std::vector<TakeFailure>& failures);

}  // namespace kinebase
