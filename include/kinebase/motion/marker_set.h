// Tables of what markers tell about joints, as data: data/marker_sets/*.toml, or a file of yours.
//
// motion/marker_joints.h applies them. docs/design/marker-joints.md explains the file.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/motion/standard_skeleton.h"

namespace kinebase {

struct MarkerSet {
  using Names = std::vector<std::string>;  // Markers whose middle is meant.

  enum class Direction { kLeft, kUp, kForward };
  struct Axis {
    Direction direction = Direction::kUp;
    Names from;
    Names to;
  };
  // Axes of a body part: the first is exact, the second made perpendicular to it.
  struct Axes {
    Axis first;
    Axis second;
  };
  struct JointRow {
    StandardJoint joint = StandardJoint::kRoot;
    Names markers;
    std::string axes;                                   // Empty: not moved.
    Eigen::Vector3d move_cm = Eigen::Vector3d::Zero();  // To the left, up, forward.
    double confidence = 1;
  };

  std::string name;
  // The distance that stands for a person's size; others are scaled by theirs. Empty: no scaling.
  Names size_from;
  Names size_to;
  double size_cm = 0;
  std::map<std::string, Names, std::less<>> labels;  // Of a marker; itself if it has no entry.
  std::map<std::string, Axes, std::less<>> axes;
  std::vector<JointRow> joints;  // Of several for one joint the first counts whose markers exist.
  std::map<std::string, Names, std::less<>> rigid;  // Markers of a bone: they keep their distances.

  [[nodiscard]] Names LabelsOf(const std::string& marker) const;
};

// Errors  MalformedFile with the line: no marker set, a newer version, unknown keys, joints or
// axes.
[[nodiscard]] MarkerSet ParseMarkerSet(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] MarkerSet ReadMarkerSet(const std::filesystem::path& path);

[[nodiscard]] std::span<const MarkerSet> BuiltInMarkerSets();

}  // namespace kinebase
