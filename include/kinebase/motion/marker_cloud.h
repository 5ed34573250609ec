// Points on a body that were followed through time, before anything is known about bones.
//
// Built from a file's record by motion/c3d_motion.h, motion/csm_motion.h and motion/trc_motion.h;
// motion/marker_joints.h makes the standard joints of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/motion/kinematics.h"

namespace kinebase {

enum class MarkerState : std::uint8_t {
  kMissing,   // Not seen; its position is NaN.
  kFilled,    // Interpolated, filtered or computed from others, as the file says.
  kMeasured,  // Seen by cameras.
};

// World space is right-handed with Y up.
struct MarkerCloud {
  std::vector<std::string> labels;  // As in the file; may repeat: "LFHD", "Subject:LFHD", "".
  double rate_hz = 0;
  int frame_count = 0;
  std::int64_t first_frame = 1;               // The number that the file gives its first frame.
  std::vector<Eigen::Vector3d> positions_cm;  // [frame × marker]; NaN where missing.
  std::vector<MarkerState> states;            // [frame × marker].

  [[nodiscard]] int marker_count() const { return static_cast<int>(labels.size()); }
  [[nodiscard]] double duration_s() const { return rate_hz > 0 ? frame_count / rate_hz : 0; }
  [[nodiscard]] std::size_t Index(int frame, int marker) const {
    return static_cast<std::size_t>(frame) * labels.size() + static_cast<std::size_t>(marker);
  }
  [[nodiscard]] const Eigen::Vector3d& at(int frame, int marker) const {
    return positions_cm[Index(frame, marker)];
  }
  [[nodiscard]] bool is_missing(int frame, int marker) const {
    return states[Index(frame, marker)] == MarkerState::kMissing;
  }

  // The first marker of that name in any case, with or without its subject's prefix.
  [[nodiscard]] std::optional<int> FindMarker(std::string_view name) const;
};

// The label without the subject's prefix: "LFHD" of "Subject:LFHD".
[[nodiscard]] std::string_view BareLabel(std::string_view label);

[[nodiscard]] inline Eigen::Vector3d MissingPosition() {
  return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

// Frames first … last (0-based, inclusive). Frame numbers go on counting as in the take.
// Errors  InvalidArgument if the range is empty or leaves the cloud.
[[nodiscard]] MarkerCloud CutMarkers(const MarkerCloud& markers, int first, int last);

// Another rate, linear between neighbours that are both there; else missing. Sample times as
// ResampleMotion.
// Errors  InvalidArgument as ResampleMotion.
[[nodiscard]] MarkerCloud ResampleMarkers(const MarkerCloud& markers, double rate_hz);

// Smallest box along the world axes that holds all markers that are there; zero if none is.
[[nodiscard]] BoundingBox ComputeBoundingBox(const MarkerCloud& markers);

}  // namespace kinebase
