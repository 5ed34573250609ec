// Cutting clips out of takes, as cut files say.
//
// Read library/cut_list.h first.
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 3.3. Departures: docs/cutting.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "kinebase/core/diagnostic.h"
#include "kinebase/core/error.h"
#include "kinebase/core/output_file.h"
#include "kinebase/core/progress.h"
#include "kinebase/library/cut_list.h"

namespace kinebase {

enum class ClipType { kAmc, kC3d };

struct CutOptions {
  std::filesystem::path in;   // The folder that the takes' names begin in.
  std::filesystem::path out;  // The folder for the clips; made if need be.
  // Only clips of this type; a take that has no such file is then a failure. By default each file
  // that a take has is cut, and a take that has none is a failure.
  std::optional<ClipType> type;
  std::filesystem::path skeleton;  // Of all takes; empty: FindSkeleton.
  bool strict = false;             // Refuse takes that would be repaired.
  Overwrite overwrite = Overwrite::kNo;
  bool dry_run = false;  // Do everything but write.
  int threads = 0;
  ProgressCallback progress;
};

enum class ClipState {
  kNew,        // Was not there; now it is.
  kUnchanged,  // Was there already with the same bytes; left alone.
  kReplaced,   // Was there with other contents.
};

struct CutClip {
  std::filesystem::path file;
  std::filesystem::path source;
  std::int64_t first_frame = 0;  // Of the source, 1-based from its first stored frame.
  std::int64_t last_frame = 0;   // Inclusive.
  ClipState state = ClipState::kNew;
};

struct CutFailure {
  std::filesystem::path file;  // The clip, or the cut file if the line is no cut.
  Error error;                 // Its place is the line in the cut file, or what could not be read.
};

struct CutReport {
  std::vector<CutClip> clips;                    // In the order of the list.
  std::vector<std::filesystem::path> skeletons;  // That went along; new or there already.
  std::vector<CutFailure> failures;              // Also of the list's refused lines.

  // What was odd about a source.
  struct Note {
    std::filesystem::path file;
    Diagnostic diagnostic;
  };
  std::vector<Note> notes;
};

// Cuts all clips of a list.
//
// The take `HDM05/HDM05_amc/bd/X` is looked for as X.amc there, and as X.c3d in HDM05/HDM05_c3d/bd
// and there; also without the first folders of its name, so `in` may be HDM05 or HDM05_amc itself.
// Values of a clip are those of its source; where an AMC's begins in a gap, its first frame has
// what readers of the source fill in there, which is a note. A clip says where it comes from: an
// AMC in a comment, a C3D in its parameters KINEBASE:SOURCE, FIRST_FRAME and LAST_FRAME. An AMC's
// skeleton is copied beside it, under its own name where it is found by that and the name is free,
// else under the clip's.
//
// A clip that cannot be made stops no other: whatever is wrong with it is a failure in the report.
// A clip that is there already is left alone if it would be the same, and a failure if not and
// overwriting was not asked for. Nothing is written outside `out`, no source is written over.
//
// Errors   NotFound if `in` is no folder; IoFailure if `out` is there and none; Cancelled: clips
//          that were finished by then stay.
// Cost     Each source is read once. Memory: a source a thread.
// Threads  The result does not depend on their number.
[[nodiscard]] CutReport CutClips(const CutList& list, const CutOptions& options);

}  // namespace kinebase
