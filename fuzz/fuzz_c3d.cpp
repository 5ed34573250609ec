// Any bytes as a C3D: a recording or one kinebase::Error. What was read is written and read again,
// looked at, cut, stored otherwise, and understood as markers that are written as C3D; what the
// strict reader takes, the other reads the same.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/formats/c3d.h"
#include "kinebase/motion/c3d_motion.h"

namespace {

// Another exception than kinebase::Error leaves through here and is a finding.
std::optional<kinebase::C3dRecording> Parse(std::string_view bytes, bool strict) {
  try {
    return kinebase::ParseC3d(bytes, "fuzz.c3d", {.strict = strict});
  } catch (const kinebase::Error&) {
    return std::nullopt;
  }
}

void Look(const kinebase::C3dRecording& c3d) {
  if (kinebase::PointLabels(c3d).size() != c3d.point_count) std::abort();
  if (kinebase::ChannelLabels(c3d).size() != c3d.channel_count) std::abort();
  if (kinebase::ScaledAnalog(c3d).size() != c3d.analog.size()) std::abort();
  (void)kinebase::ForcePlates(c3d);
}

// Editing refuses what does not fit the format with a kinebase::Error.
template <typename Edit>
void Try(Edit edit) {
  try {
    edit();
  } catch (const kinebase::Error&) {
    return;
  }
}

void CheckSize(const kinebase::C3dRecording& c3d) {
  if (c3d.points.size() != c3d.frame_count * c3d.point_count) std::abort();
  if (c3d.analog.size() != c3d.frame_count * c3d.analog_per_frame()) std::abort();
}

void TryEdits(const kinebase::C3dRecording& c3d) {
  Try([&] {
    const auto frames = static_cast<std::int64_t>(c3d.frame_count);
    if (frames == 0) return;
    const kinebase::C3dRecording cut = kinebase::CutC3d(c3d, frames / 3, frames - 1 - frames / 3);
    CheckSize(cut);
    (void)kinebase::ParseC3d(kinebase::FormatC3d(cut), "cut.c3d");
  });
  Try([&] {
    kinebase::C3dRecording other = c3d;
    kinebase::ChangeStorage(other, c3d.storage == kinebase::C3dStorage::kFloat
                                       ? kinebase::C3dStorage::kInteger
                                       : kinebase::C3dStorage::kFloat);
    CheckSize(other);
    (void)kinebase::ParseC3d(kinebase::FormatC3d(other), "other.c3d");
  });
  Try([&] {
    kinebase::C3dRecording other = c3d;
    kinebase::SetEvents(other, kinebase::Events(c3d));
    (void)kinebase::ParseC3d(kinebase::FormatC3d(other), "events.c3d");
  });
}

void TryMarkers(const kinebase::C3dRecording& c3d) {
  Try([&] {
    kinebase::Diagnostics diagnostics;
    (void)kinebase::FindUnits(c3d, diagnostics);
    const kinebase::UpAxis up = kinebase::FindUpAxis(c3d, diagnostics);
    const kinebase::MarkerCloud markers =
        kinebase::BuildMarkers(c3d, {.rate_hz = c3d.rate_hz, .up = up}, diagnostics);
    const kinebase::C3dRecording written =
        kinebase::ToC3d(markers, {.base = {.recording = &c3d, .up = up}}, diagnostics);
    CheckSize(written);
    (void)kinebase::ParseC3d(kinebase::FormatC3d(written), "markers.c3d");
  });
}

void TryC3d(std::string_view bytes) {
  const auto c3d = Parse(bytes, false);
  const auto strict = Parse(bytes, true);
  if (strict && strict != c3d) std::abort();
  if (!c3d) return;
  CheckSize(*c3d);
  if (kinebase::ParseC3d(kinebase::FormatC3d(*c3d), "written.c3d") != *c3d) std::abort();
  Look(*c3d);
  TryEdits(*c3d);
  TryMarkers(*c3d);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryC3d({reinterpret_cast<const char*>(data), size});
  return 0;
}
