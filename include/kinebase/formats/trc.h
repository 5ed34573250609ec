// TRC, Motion Analysis' table of marker places that OpenSim reads, as it stands in the file.
//
// motion/trc_motion.h makes a MarkerCloud of it. Source: docs/formats/opensim.md.
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

// A field of the header that the format does not know, kept for writing.
struct TrcField {
  std::string name;
  std::string value;

  friend bool operator==(const TrcField&, const TrcField&) = default;
};

struct TrcRecording {
  std::string path_file_type = "4";  // What follows `PathFileType`.
  std::string axes = "(X/Y/Z)";
  std::string file_name;

  std::optional<double> data_rate_hz;
  std::optional<double> camera_rate_hz;
  std::string units;  // "mm"; empty if the file does not tell.
  std::optional<double> original_rate_hz;
  std::optional<std::int64_t> original_first_frame;
  std::optional<std::int64_t> original_frame_count;
  std::vector<TrcField> other_fields;

  // What the file says, for reports. What is there rules: it is what is written, and these are not
  // part of equality.
  std::optional<std::int64_t> declared_frame_count;
  std::optional<std::int64_t> declared_marker_count;

  std::vector<std::string> labels;          // May hold blanks, be empty or repeat.
  std::vector<std::int64_t> frame_numbers;  // As in the file, strictly increasing.
  std::vector<double> times_s;              // [frame]
  std::vector<double> values;               // [frame × marker × xyz], `units`; NaN = empty field.

  Diagnostics diagnostics;  // What was odd; not part of equality.

  [[nodiscard]] std::size_t frame_count() const { return frame_numbers.size(); }
  [[nodiscard]] std::size_t marker_count() const { return labels.size(); }
  [[nodiscard]] std::span<const double> Point(std::size_t frame, std::size_t marker) const {
    return std::span(values).subspan((frame * labels.size() + marker) * 3, 3);
  }
  // NaN equals NaN here, as a missing value is the same as a missing value.
  friend bool operator==(const TrcRecording& a, const TrcRecording& b);
};

struct TrcReadOptions {
  bool strict = false;  // Refuse what is otherwise repaired.
};

// Reads the text of a TRC file. `file` is for messages only.
//
// Fields are separated by tabs, in lines without any by blanks. A last row that is cut off is
// dropped with a diagnostic.
// Errors  MalformedFile with the line: not text, another header, no markers, no frames, a row that
//         does not fit the markers, a value that is no number, frame numbers that do not grow.
// Cost    Linear in the text; memory 8 bytes a value. No allocation depends on a number in the
//         file.
[[nodiscard]] TrcRecording ParseTrc(std::string_view text, const std::filesystem::path& file,
                                    const TrcReadOptions& options = {});
[[nodiscard]] TrcRecording ReadTrc(const std::filesystem::path& path,
                                   const TrcReadOptions& options = {});

// The text of a TRC file with LF line ends, every number so short that it reads back the same.
// ParseTrc(FormatTrc(r)) == r for every record that was read, and for others whose texts hold no
// tabs, line ends or blanks around them.
[[nodiscard]] std::string FormatTrc(const TrcRecording& recording);

}  // namespace kinebase
