// Any bytes as a TRC: a recording or one kinebase::Error. What was read is written and read again,
// understood as markers, and those are written as TRC; what the strict reader takes, the other
// reads the same.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/formats/trc.h"
#include "kinebase/motion/trc_motion.h"

namespace {

// Another exception than kinebase::Error leaves through here and is a finding.
std::optional<kinebase::TrcRecording> Parse(std::string_view text, bool strict) {
  try {
    return kinebase::ParseTrc(text, "fuzz.trc", {.strict = strict});
  } catch (const kinebase::Error&) {
    return std::nullopt;
  }
}

void TryMarkers(const kinebase::TrcRecording& trc) {
  try {
    kinebase::Diagnostics diagnostics;
    const double rate_hz = kinebase::FindRate(trc, diagnostics);
    const kinebase::MarkerCloud markers =
        kinebase::BuildMarkers(trc, {.rate_hz = rate_hz > 0 ? rate_hz : 120}, diagnostics);
    const kinebase::TrcRecording written = kinebase::ToTrc(markers, {}, diagnostics);
    if (kinebase::ParseTrc(kinebase::FormatTrc(written), "markers.trc") != written) std::abort();
  } catch (const kinebase::Error&) {
    return;
  }
}

void TryTrc(std::string_view text) {
  const auto trc = Parse(text, false);
  const auto strict = Parse(text, true);
  if (strict && strict != trc) std::abort();
  if (!trc) return;
  if (trc->values.size() != trc->frame_count() * trc->marker_count() * 3) std::abort();
  if (kinebase::ParseTrc(kinebase::FormatTrc(*trc), "written.trc") != *trc) std::abort();
  TryMarkers(*trc);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryTrc({reinterpret_cast<const char*>(data), size});
  return 0;
}
