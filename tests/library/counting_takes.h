// Made-up takes in which every value tells its frame, so that a clip shows what it was cut from.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "kinebase/formats/amc.h"
#include "kinebase/formats/c3d.h"
#include "support/files.h"

namespace kinebase::test {

// Two bones; the root's height is the frame's number from 1, and awkward digits stay as they are.
inline std::string CountingAmc(int frames) {
  std::string text = "#!made up\r\n:FULLY-SPECIFIED\r\n:DEGREES\r\n";
  for (int frame = 1; frame <= frames; ++frame) {
    text += fmt::format("{0}\r\nroot 0 {0} -1.27222e-014 10 20.25 30\r\nupper {0}.125 -0 .5\r\n",
                        frame);
  }
  return text;
}

inline constexpr std::string_view kUpperAsf = R"(:version 1.10
:name upper
:units
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    name upper
    direction 0 1 0
    length 2
    axis 0 0 0 XYZ
    dof rx ry rz
  end
:hierarchy
  begin
    root upper
  end
)";

// Two markers; the first one's x is the frame's number from 1, whatever the first stored frame is.
inline C3dRecording CountingC3d(int frames, std::int64_t first_frame = 1) {
  C3dRecording c3d{.rate_hz = 120,
                   .first_frame = first_frame,
                   .frame_count = static_cast<std::size_t>(frames),
                   .point_count = 2,
                   .channel_count = 1,
                   .subframe_count = 2};
  for (int frame = 1; frame <= frames; ++frame) {
    const auto x = static_cast<float>(frame);
    c3d.points.push_back({.x = x, .y = 1.5F, .z = -2, .quality = 0});
    c3d.points.push_back({.x = -x, .y = .25F, .z = 3, .quality = 1});
    c3d.analog.insert(c3d.analog.end(), {x, x + .5F});
  }
  SetTextList(c3d, "POINT", "LABELS", std::vector<std::string>{"LFHD", "RFHD"});
  SetParameter(c3d, "POINT", TextParameter("UNITS", "mm"));
  SetTextList(c3d, "SUBJECTS", "NAMES", std::vector<std::string>{"made up"});
  return c3d;
}

inline void WriteCountingAmc(const std::filesystem::path& path, int frames) {
  WriteText(path, CountingAmc(frames));
}

inline void WriteCountingC3d(const std::filesystem::path& path, int frames,
                             std::int64_t first_frame = 1) {
  WriteText(path, FormatC3d(CountingC3d(frames, first_frame)));
}

}  // namespace kinebase::test
