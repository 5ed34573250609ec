// Labels of takes, and of stretches of them, in a library on disk: key words to find them by.
//
// Read library/take_library.h first. A take may have any number of them; TakeFilter finds them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinebase/library/annotation_file.h"
#include "kinebase/library/take_choice.h"

namespace kinebase {

struct LabelChange {
  std::vector<std::string> add;
  // From the takes as wholes and from all their stretches; where a stretch is named, from those
  // that lie within it.
  std::vector<std::string> remove;
  // The stretch that is meant: frames from 1, inclusive; 0: the take as a whole.
  std::int64_t first_frame = 0;
  std::int64_t last_frame = 0;
};

struct LabelReport {
  std::int64_t takes = 0;  // That were changed.
  std::int64_t added = 0;  // Labels that were not there before.
  std::int64_t removed = 0;
  std::int64_t passed_over = 0;  // Rows of a table whose recording is not among the takes.
};

// Changes the labels of the chosen takes. All or none, whatever happens.
//
// Errors  Those of TakeLibrary and ChooseTakes; InvalidArgument for a label that is empty, a
//         stretch that leaves a take; MalformedFile for a take whose row is damaged; IoFailure if
//         somebody else is writing.
LabelReport ChangeLabels(const std::filesystem::path& library, const TakeChoice& choice,
                         const LabelChange& change);

// Adds labels of stretches from a table (ReadSegmentLabels) to those of the chosen takes whose
// paths, or else names, the table has. A stretch of all frames is the take as a whole. What a
// stretch has behind its take's end is left out.
//
// table   For messages.
// Errors  As ChangeLabels; NotFound if no row is of any of the takes; InvalidArgument with the line
//         for a name that several takes have, and for a stretch that begins behind its take's end.
LabelReport AddSegmentLabels(const std::filesystem::path& library, const TakeChoice& choice,
                             std::span<const SegmentLabel> labels,
                             const std::filesystem::path& table);

// The labels as such a table, files by their full paths, with the columns file, class, first_frame,
// last_frame. A label of a take as a whole has all of its frames.
[[nodiscard]] std::string FormatLabelTable(std::span<const StoredTake* const> takes);

}  // namespace kinebase
