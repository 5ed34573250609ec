// C3D records made in memory.
#pragma once

#include <string>
#include <vector>

#include "kinebase/formats/c3d.h"

namespace kinebase::test {

// Each point measured, of residual 2 · scale, seen by camera 1.
inline C3dRecording C3dOf(const std::vector<std::string>& labels,
                          const std::vector<std::vector<std::array<float, 3>>>& frames) {
  C3dRecording c3d;
  c3d.rate_hz = 100;
  c3d.frame_count = frames.size();
  c3d.point_count = labels.size();
  for (const auto& frame : frames) {
    for (const auto& [x, y, z] : frame) {
      c3d.points.push_back({.x = x, .y = y, .z = z, .quality = 256 + 2});
    }
  }
  SetTextList(c3d, "POINT", "LABELS", labels);
  return c3d;
}

inline void SetText(C3dRecording& c3d, std::string_view name, std::string_view text) {
  SetParameter(c3d, "POINT", TextParameter(name, text));
}

}  // namespace kinebase::test
