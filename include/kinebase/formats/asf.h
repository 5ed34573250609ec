// ASF, the skeleton half of Acclaim's motion format, as it stands in the file.
//
// motion/asf_amc_motion.h turns it into a Skeleton; formats/amc.h is the other half.
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 4.1; docs/formats/asf-amc.md.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/diagnostic.h"

namespace kinebase {

// One degree of freedom. Translations and lengths are in the file's length unit.
enum class AsfDof { kTx, kTy, kTz, kRx, kRy, kRz, kLength };

[[nodiscard]] std::string_view ToString(AsfDof dof);  // "TX" … "RZ", "L".

// Smallest and largest value of a DOF, in the file's angle or length unit; may be infinite.
struct AsfLimits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  friend bool operator==(const AsfLimits&, const AsfLimits&) = default;
};

// A line (or lines) that the reader does not know, kept for writing.
struct AsfUnknown {
  std::string text;

  friend bool operator==(const AsfUnknown&, const AsfUnknown&) = default;
};

struct AsfBone {
  std::optional<std::int64_t> id;
  std::string name;
  std::array<double, 3> direction{};  // World space of the neutral pose; any length.
  double length = 0;                  // File units.
  std::array<double, 3> axis{};       // Angles about x, y, z; file's angle unit.
  std::string axis_order = "XYZ";     // Euler order of the DOFs (not of `axis`).
  std::vector<AsfDof> dofs;           // In the order of the AMC's columns. Empty: no AMC line.
  std::vector<AsfLimits> limits;      // As many as the file has; may differ from `dofs`.
  std::vector<AsfUnknown> unknown;    // Other lines of the bone.
  std::int64_t line = 0;              // Of its `begin`.

  friend bool operator==(const AsfBone& a, const AsfBone& b);  // `line` does not count.
};

struct AsfSkeleton {
  std::string file_name;              // For messages; not part of equality.
  std::vector<std::string> comments;  // Before the first section, with their '#'.
  std::string version;                // Text as in the file; empty if it is not there.
  std::string name;
  std::optional<double> mass_unit;
  std::optional<double> length_unit;
  bool angle_is_degrees = true;  // `:units angle`; degrees where the file is silent.
  std::vector<AsfUnknown> unknown_units;
  std::vector<std::string> documentation;  // Its lines, as in the file.

  std::vector<AsfDof> root_order;            // Columns of the AMC's root line.
  std::string root_axis = "XYZ";             // Euler order of the root's rotation.
  std::array<double, 3> root_position{};     // File units; added to the AMC's translation.
  std::array<double, 3> root_orientation{};  // Angles about x, y, z; applied from the left.
  std::vector<AsfUnknown> unknown_root;

  std::vector<AsfBone> bones;  // In the order of `:bonedata`.

  // One line of `:hierarchy`: parent first.
  struct Family {
    std::string parent;
    std::vector<std::string> children;
    std::int64_t line = 0;

    friend bool operator==(const Family& a, const Family& b) {
      return a.parent == b.parent && a.children == b.children;
    }
  };
  std::vector<Family> hierarchy;

  // Whole sections that are not part of the format as documented (`:skin`, …), with their header.
  std::vector<AsfUnknown> unknown_sections;

  Diagnostics diagnostics;  // What was odd; not part of equality.

  friend bool operator==(const AsfSkeleton& a, const AsfSkeleton& b);
};

// Reads the text of an ASF file. `file` is for messages only.
//
// Sections may come in any order, keywords in any case, comments (`#`) anywhere.
// Errors  MalformedFile with the line: no bones, a bone without name, direction or length, a number
//         that is none, a name used twice, a bone of the hierarchy that `:bonedata` lacks, a cycle.
// Cost    Linear in the text.
[[nodiscard]] AsfSkeleton ParseAsf(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] AsfSkeleton ReadAsf(const std::filesystem::path& path);

// The text of an ASF file with LF line ends. ParseAsf(FormatAsf(s)) == s.
[[nodiscard]] std::string FormatAsf(const AsfSkeleton& skeleton);

}  // namespace kinebase
