// AMC, the motion half of Acclaim's format, as it stands in the file: a table of numbers.
//
// Read formats/asf.h first; motion/asf_amc_motion.h brings the two together.
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 4.1; docs/formats/asf-amc.md.
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

enum class AmcAngleUnit { kUnstated, kDegrees, kRadians };

// The values of one bone in every frame: columns [first_column, first_column + column_count).
struct AmcBone {
  std::string name;
  std::size_t first_column = 0;
  std::size_t column_count = 0;
  std::int64_t line = 0;  // Of its first occurrence, for messages; not part of equality.

  friend bool operator==(const AmcBone& a, const AmcBone& b) {
    return a.name == b.name && a.first_column == b.first_column && a.column_count == b.column_count;
  }
};

struct AmcMotion {
  std::vector<std::string> header;  // Lines before the first frame, comments too, without ends.
  AmcAngleUnit angle_unit = AmcAngleUnit::kUnstated;  // From `:DEGREES` or `:RADIANS`.
  bool all_bones_have_three_dofs = false;             // `:FORCE-ALL-JOINTS-BE-3DOF`.
  std::vector<AmcBone> bones;                         // In the order of the first frame.
  std::size_t column_count = 0;                       // Sum over `bones`.
  std::vector<std::int64_t> frame_numbers;            // As in the file, strictly increasing.
  std::vector<double> values;                         // [frame × column]; NaN = missing or "nan".

  // A comment or unknown line (it starts with '#' or ':') after the first frame began.
  struct Remark {
    std::size_t frame = 0;  // 0-based; stands after that frame's values.
    std::string text;

    friend bool operator==(const Remark&, const Remark&) = default;
  };
  std::vector<Remark> remarks;

  Diagnostics diagnostics;  // What was odd; not part of equality.

  [[nodiscard]] std::size_t frame_count() const { return frame_numbers.size(); }
  [[nodiscard]] std::span<const double> Frame(std::size_t frame) const {
    return std::span(values).subspan(frame * column_count, column_count);
  }
  // NaN equals NaN here, as a missing value is the same as a missing value.
  friend bool operator==(const AmcMotion& a, const AmcMotion& b);
};

struct AmcReadOptions {
  bool strict = false;  // Refuse what may be cut off: part of a frame, a last line without end.
};

// Reads the text of an AMC file. `file` is for messages only.
//
// The first frame says which bones there are; later frames may order them differently. A last
// frame that is cut off is dropped with a diagnostic. One that is complete but whose last line has
// no end is kept, with a diagnostic: nothing tells whether its last value lost digits.
// Errors  MalformedFile with the line: not text, no frames, a value that is no number, a bone
//         missing from or twice in a frame, another number of values, a frame number that repeats.
// Cost    Linear in the text; memory 8 bytes a value. No allocation depends on a number in the
// file.
[[nodiscard]] AmcMotion ParseAmc(std::string_view text, const std::filesystem::path& file,
                                 const AmcReadOptions& options = {});
[[nodiscard]] AmcMotion ReadAmc(const std::filesystem::path& path,
                                const AmcReadOptions& options = {});

// The text of an AMC file with LF line ends, every number so short that it reads back the same.
// ParseAmc(FormatAmc(m)) == m.
[[nodiscard]] std::string FormatAmc(const AmcMotion& motion);

// Frames first … last (0-based, inclusive) with the header, values as they are; those that the
// first frame lacks are what readers of the whole fill in there, the last ones before, or else the
// first ones after. Frame numbers begin at 1 and keep their jumps, as in the clips that come with
// HDM05. Remarks go with their frames; diagnostics stay with the whole.
// Errors  InvalidArgument if the range is empty or leaves the motion.
[[nodiscard]] AmcMotion CutAmc(const AmcMotion& motion, std::int64_t first, std::int64_t last);

}  // namespace kinebase
