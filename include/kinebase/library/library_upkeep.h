// Checking a library on disk, and taking takes out of it.
//
// Read library/take_library.h first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinebase/core/progress.h"
#include "kinebase/library/take_library.h"

namespace kinebase {

struct VerifyReport {
  std::int64_t takes = 0;
  std::int64_t segment_bytes = 0;
  // Takes that cannot be read, or whose rows of the catalogue are not what was written; by path.
  std::vector<TakeFailure> damaged;
  // Stored templates and annotations whose rows are not what was written: "template 'squat'".
  std::vector<std::string> damaged_records;
  std::int64_t orphaned_rows = 0;  // Of the catalogue, that belong to no take.
  // Whether the words by which takes are found are not those of the takes; CompactLibrary mends it.
  bool words_are_damaged = false;
  // Files of an import that was cut short, or still goes on; the next import removes them.
  std::vector<std::filesystem::path> leftovers;
};

// Reads everything and compares all checksums, of the catalogue too.
// Errors  Those of TakeLibrary; MalformedFile if the catalogue is damaged; Cancelled.
// Cost    O(bytes of the library).
[[nodiscard]] VerifyReport VerifyLibrary(const std::filesystem::path& library, int threads = 0,
                                         const ProgressCallback& progress = {});

// Which takes to remove: those of the names, of the filter, and damaged ones; each that is given
// has to hold.
struct Removal {
  std::vector<std::filesystem::path> names;  // As in TakeChoice.
  TakeFilter filter;
  bool damaged = false;
};

// Removes takes, and segment files that hold no other; in files that hold others their room stays
// taken. Says which. All or none, whatever happens.
//
// Errors  Those of TakeLibrary and ChooseTakes, without `damaged` of ChooseTakesToChange;
//         InvalidArgument if nothing was asked for; IoFailure if somebody else is writing. With
//         `damaged` also IoFailure and Mismatch for a segment that may be sound, but cannot be read
//         here.
std::vector<std::filesystem::path> RemoveTakes(const std::filesystem::path& library,
                                               const Removal& removal);

// Removes stored templates and annotations that are not what was written, and rows of the catalogue
// that belong to no take. Says which. All or none, whatever happens.
//
// Errors  Those of TakeLibrary; IoFailure if somebody else is writing.
std::vector<std::string> RemoveDamagedRecords(const std::filesystem::path& library);

// The takes as a list of clips: file,class,actor,take,format,frames,rate_hz, a row a take, files by
// their full paths. It can be imported again wherever it lies and, where all takes have a class,
// learned from and evaluated.
[[nodiscard]] std::string FormatTakeList(std::span<const StoredTake> takes);

}  // namespace kinebase
