// BVH, Biovision's motion format: a tree of joints and a table of their channels, as they stand in
// the file.
//
// motion/bvh_motion.h turns it into a Skeleton and a Motion.
// Source: docs/formats/bvh.md; there is no standard, files are what their writers made.
#pragma once

#include <array>
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

enum class BvhChannel { kXPosition, kYPosition, kZPosition, kXRotation, kYRotation, kZRotation };

[[nodiscard]] std::string_view ToString(BvhChannel channel);  // "Xposition" … "Zrotation".

[[nodiscard]] constexpr bool IsRotationChannel(BvhChannel channel) {
  return channel >= BvhChannel::kXRotation;
}
// 0 = x, 1 = y, 2 = z.
[[nodiscard]] constexpr int AxisOfChannel(BvhChannel channel) {
  return static_cast<int>(channel) % 3;
}

// A joint; its channels move all that hangs on it. Its values in a frame are the columns
// [first_column, first_column + channels.size()).
struct BvhJoint {
  std::string name;                  // The rest of its line: blanks and colons too; may be empty.
  int parent = -1;                   // Index, smaller than the joint's own; -1 for a root.
  std::array<double, 3> offset{};    // From the parent; file units.
  std::vector<BvhChannel> channels;  // In the order of the columns; any number, any mix.
  std::size_t first_column = 0;

  // Where a tip ends.
  struct EndSite {
    std::string name;                  // What stands behind `End`: "Site".
    std::array<double, 3> offset{};    // File units.
    std::vector<std::string> unknown;  // Other lines of its block.

    friend bool operator==(const EndSite&, const EndSite&) = default;
  };
  std::vector<EndSite> end_sites;  // Most often one for a leaf, none for others.

  std::vector<std::string> unknown;  // Other lines of its block.
  std::int64_t line = 0;             // Where it begins; not part of equality.

  friend bool operator==(const BvhJoint& a, const BvhJoint& b);
};

struct BvhMotion {
  std::string file_name;         // For messages; not part of equality.
  std::vector<BvhJoint> joints;  // Depth first, as in the file; those without parent are roots.
  std::size_t column_count = 0;  // Sum of the joints' channels.

  std::optional<std::int64_t> declared_frame_count;  // What `Frames:` says; the rows count.
  std::string frame_time_text;                       // "0.0083333"; empty if it is not there.
  double frame_time_s = 0;           // The number that the text is; 0 if it is no time.
  std::vector<std::string> unknown;  // Other lines between `MOTION` and the values.
  std::vector<double> values;        // [frame × column]; NaN = "nan" in the file.

  Diagnostics diagnostics;  // What was odd; not part of equality.

  [[nodiscard]] std::size_t frame_count() const {
    return column_count == 0 ? 0 : values.size() / column_count;
  }
  [[nodiscard]] std::span<const double> Frame(std::size_t frame) const {
    return std::span(values).subspan(frame * column_count, column_count);
  }
  // NaN equals NaN here, as a missing value is the same as a missing value.
  friend bool operator==(const BvhMotion& a, const BvhMotion& b);
};

// The rate that a frame time stands for, Hz. Writers round the time: where a rate of video
// (24, 30, 60 or 120 · 1000 / 1001) lies within 0.002 %, else a whole or half rate within 0.1 %,
// that is taken; else 1 / frame_time_s.
[[nodiscard]] double SnapRate(double frame_time_s);

struct BvhReadOptions {
  bool strict = false;  // Refuse what may be cut off, and a row count other than declared.
};

// Reads the text of a BVH file. `file` is for messages only.
//
// Keywords may stand in any case, braces and what follows them on any line. A row of values is a
// line, or several lines. A last row that is cut off is dropped with a diagnostic.
// Errors  MalformedFile with the line: no `HIERARCHY` or `MOTION`, a joint without offset, an
//         unknown channel or another number of them than said, braces that do not match, a value
//         that is no number, a row with another number of values, no frames.
// Cost    Linear in the text; memory 8 bytes a value. No allocation depends on a number in the
//         file.
[[nodiscard]] BvhMotion ParseBvh(std::string_view text, const std::filesystem::path& file,
                                 const BvhReadOptions& options = {});
[[nodiscard]] BvhMotion ReadBvh(const std::filesystem::path& path,
                                const BvhReadOptions& options = {});

// The text of a BVH file with LF line ends, every number so short that it reads back the same.
// ParseBvh(FormatBvh(m)) == m for every m that was read.
// Errors  InvalidArgument if the joints are not depth first.
[[nodiscard]] std::string FormatBvh(const BvhMotion& motion);

// Frames first … last (0-based, inclusive), gaps as in CutAmc; diagnostics stay with the whole.
// Errors  InvalidArgument if the range is empty or leaves the motion.
[[nodiscard]] BvhMotion CutBvh(const BvhMotion& motion, std::int64_t first, std::int64_t last);

}  // namespace kinebase
