// CSM, Character Studio's marker format, as it stands in the file: names and a table of places.
//
// formats/mnm.h says which of a file's own names is which marker; motion/csm_motion.h makes a
// MarkerCloud of it.
// Source: "Character Studio CSM Motion Capture File format"; docs/formats/csm.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/diagnostic.h"

namespace kinebase {

// Sizes of the performer, `$talent`.
struct CsmTalent {
  enum class Unit { kUnstated, kMillimetres, kInches };

  struct Measure {
    std::string name;  // "head", "pelvlength"; also names that the format does not know.
    double value = 0;  // In `unit`, whatever the unit of the points.

    friend bool operator==(const Measure&, const Measure&) = default;
  };

  Unit unit = Unit::kUnstated;
  std::vector<Measure> measures;  // In the order of the file; no name twice.

  // The value of a name in any case, in centimetres; empty if it, or the unit, is not there.
  [[nodiscard]] std::optional<double> LengthCm(std::string_view name) const;

  friend bool operator==(const CsmTalent&, const CsmTalent&) = default;
};

// The twelve names of `$talent`, from "head" to "footlength".
[[nodiscard]] std::span<const std::string_view> CsmTalentNames();

// A section that the format does not know, kept for writing.
struct CsmUnknownSection {
  std::string title;               // Without its '$'.
  std::vector<std::string> lines;  // The first is what follows the title on its line; may be empty.

  friend bool operator==(const CsmUnknownSection&, const CsmUnknownSection&) = default;
};

// Text is as in the file, trimmed; empty where the section is missing.
struct CsmRecording {
  std::string file_name;
  std::string capture_date;  // "1998/01/31", from `$capturedate` or `$date`.
  std::string capture_time;  // "23:31:59", from `$capturetime` or `$time`.
  std::string actor;
  std::vector<std::string> comments;  // Lines.

  // What the file says, for reports. The rows rule: they are what is written, and these are not
  // part of equality.
  std::optional<std::int64_t> declared_first_frame;
  std::optional<std::int64_t> declared_last_frame;

  std::optional<double> rate_hz;
  std::optional<std::int64_t> spine_links;  // The format knows 2 and 3, and means 3 without.
  std::optional<CsmTalent> talent;
  std::vector<CsmUnknownSection> unknown_sections;

  std::vector<std::string> labels;          // `$order`; may repeat.
  std::vector<std::int64_t> frame_numbers;  // As in the file, strictly increasing.
  std::vector<double> values;               // [frame × marker × xyz], mm, Z up; NaN = DROPOUT.

  Diagnostics diagnostics;  // What was odd; not part of equality.

  [[nodiscard]] std::size_t frame_count() const { return frame_numbers.size(); }
  [[nodiscard]] std::size_t marker_count() const { return labels.size(); }
  [[nodiscard]] std::span<const double> Point(std::size_t frame, std::size_t marker) const {
    return std::span(values).subspan((frame * labels.size() + marker) * 3, 3);
  }
  // NaN equals NaN here, as a missing value is the same as a missing value.
  friend bool operator==(const CsmRecording& a, const CsmRecording& b);
};

struct CsmReadOptions {
  bool strict = false;  // Refuse what is otherwise repaired.
};

// Reads the text of a CSM file. `file` is for messages only.
//
// A frame is its number and as many values as `$order` has markers, on one line or several. One
// DROPOUT stands for a marker, or, in frames that only fit so, for a single value. A last frame
// that is cut off is dropped with a diagnostic.
// Errors  MalformedFile with the line: not text, no `$order` before `$points`, no frames, a frame
//         with more or fewer values than `$order` has markers, a value that is no number, frame
//         numbers that do not grow.
// Cost    Linear in the text; memory 8 bytes a value. No allocation depends on a number in the
//         file.
[[nodiscard]] CsmRecording ParseCsm(std::string_view text, const std::filesystem::path& file,
                                    const CsmReadOptions& options = {});
[[nodiscard]] CsmRecording ReadCsm(const std::filesystem::path& path,
                                   const CsmReadOptions& options = {});

// The text of a CSM file with LF line ends, a frame a line, every number so short that it reads
// back the same. ParseCsm(FormatCsm(r)) == r for every record that was read, and for others whose
// labels are words without '$', commas or blanks.
[[nodiscard]] std::string FormatCsm(const CsmRecording& recording);

}  // namespace kinebase
