// Getting the room back that removed takes took, and joining small segment files.
//
// Read library/take_library.h first; docs/design/library.md says why a crash does no harm.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "kinebase/core/progress.h"
#include "kinebase/library/takes.h"

namespace kinebase {

struct CompactOptions {
  // What a segment file grows to; those of less than half are joined. Also the memory that this
  // needs, three times over.
  std::int64_t segment_bytes = std::int64_t{32} << 20;
  int threads = 0;
  ProgressCallback progress;
};

struct CompactReport {
  std::int64_t segments_before = 0;
  std::int64_t segments_after = 0;
  std::int64_t bytes_before = 0;  // Of segments, catalogue and what an import left.
  std::int64_t bytes_after = 0;
  // Segment files that were left as they are, as something in them cannot be read; or takes whose
  // rows of the catalogue are damaged: then all of them were left.
  std::vector<TakeFailure> failures;
};

// Writes the takes of segment files that hold removed ones, or are small, into new files, and
// removes the old ones and what an import that was cut short has left; makes the catalogue smaller
// and its words anew where they are damaged. Readers that are at work go on. Whatever happens, each
// take stays where it was or is where it came to.
//
// Errors  Those of TakeLibrary; IoFailure if somebody else is writing, or the disk is full;
//         MalformedFile for a damaged catalogue; Cancelled. What was done so far stays.
// Cost    O(bytes of the files that are written anew, twice, and of the catalogue).
CompactReport CompactLibrary(const std::filesystem::path& library,
                             const CompactOptions& options = {});

}  // namespace kinebase
