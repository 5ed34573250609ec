// Cut files: which frames of which take become which clip.
//
// library/cutting.h does what they say.
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 3.3. Departures: docs/cutting.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/error.h"

namespace kinebase {

// One line: `"HDM05\HDM05_amc\bd\HDM_bd_01-06_01_120.amc" 781 1085 HDM_bd_staircase_005_120`.
//
// Both names are relative, with '/' between folders, and lead nowhere but down. They have no
// extension: .amc or .c3d is taken off, as one line stands for both files of a take.
struct Cut {
  std::string take;
  std::int64_t first_frame = 0;  // As people count: the first stored frame is 1.
  std::int64_t last_frame = 0;   // Inclusive; not below first_frame.
  std::string clip;
  Place place;  // The line in the cut file.
};

struct CutList {
  std::vector<Cut> cuts;
  std::vector<Error> refused;  // Lines that begin with a quote and are no cut, or an unsafe one.
  // Lines that were passed over and would be cuts with CutListOptions::unquoted.
  std::int64_t unquoted_lines = 0;
  Place first_unquoted_line;
};

struct CutListOptions {
  // Also take lines that do not begin with a quote: `take first last clip`, neither name with
  // blanks in it unless it is quoted. A public copy of HDM05's full list has no quotes.
  bool unquoted = false;
};

// Reads the text of a cut file. Any text is one: lines that do not begin with a quote say nothing.
// Cost  Linear in the text.
[[nodiscard]] CutList ParseCutList(std::string_view text, const std::filesystem::path& file,
                                   const CutListOptions& options = {});

// Reads cut files and, of folders, all *.txt right in them, in the order of their names.
// Errors  NotFound, IoFailure; MalformedFile if there is not one cut in all of them, saying whether
//         there would be without quotes.
[[nodiscard]] CutList ReadCutLists(std::span<const std::filesystem::path> paths,
                                   const CutListOptions& options = {});

}  // namespace kinebase
