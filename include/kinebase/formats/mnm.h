// MNM, Character Studio's marker-name file: which of a CSM file's own names is which marker.
//
// Source: "Character Studio CSM Motion Capture File format", marker attachment positions and marker
// name file; docs/formats/csm.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/diagnostic.h"

namespace kinebase {

// A marker that Character Studio knows by name.
struct PresetMarker {
  enum class Need {
    kRequired,
    kOptional,
    kStick,  // Of the wrist; one kind is required, the two are not worn together.
    kBand,
    kProp,
  };

  std::string_view name;   // "LKNE".
  std::string_view place;  // "left outer knee".
  Need need = Need::kRequired;
  std::string_view tells;  // What is known less well without it: "the left knee".
};

// All markers of the preset and of props, in the order of the format's table.
[[nodiscard]] std::span<const PresetMarker> PresetMarkers();

// The preset's marker of a name in any case; null if there is none.
[[nodiscard]] const PresetMarker* FindPresetMarker(std::string_view name);

struct MarkerNames {
  struct Row {
    std::string preset;     // Left column: what the marker is.
    std::string custom;     // Right column: what the CSM file calls it.
    std::int64_t line = 0;  // For messages; not part of equality.

    friend bool operator==(const Row& a, const Row& b) {
      return a.preset == b.preset && a.custom == b.custom;
    }
  };

  std::vector<Row> rows;
  std::vector<std::string> comments;  // Lines that begin with '#' or ';', kept for writing.
  Diagnostics diagnostics;            // What was odd; not part of equality.

  // The first row of a name, in any case; empty if there is none.
  [[nodiscard]] std::optional<std::string_view> PresetName(std::string_view custom) const;
  [[nodiscard]] std::optional<std::string_view> CustomName(std::string_view preset) const;

  friend bool operator==(const MarkerNames& a, const MarkerNames& b) {
    return a.rows == b.rows && a.comments == b.comments;
  }
};

struct MnmReadOptions {
  bool strict = false;  // Refuse what is otherwise repaired.
};

// Reads the text of an MNM file. `file` is for messages only.
//
// Names that the preset lacks, and rows too many or too few, are normal.
// Errors  MalformedFile with the line: not text, no rows.
// Cost    Linear in the text, but for the names: O(n · log n).
[[nodiscard]] MarkerNames ParseMnm(std::string_view text, const std::filesystem::path& file,
                                   const MnmReadOptions& options = {});
[[nodiscard]] MarkerNames ReadMnm(const std::filesystem::path& path,
                                  const MnmReadOptions& options = {});

// The text of an MNM file with LF line ends. ParseMnm(FormatMnm(n)) == n for all that was read.
[[nodiscard]] std::string FormatMnm(const MarkerNames& names);

}  // namespace kinebase
