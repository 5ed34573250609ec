// Any bytes as a CSM: a recording or one kinebase::Error. What was read is written and read again,
// understood as markers, and those are written as CSM; what the strict reader takes, the other
// reads the same.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/formats/csm.h"
#include "kinebase/motion/csm_motion.h"

namespace {

// Another exception than kinebase::Error leaves through here and is a finding.
std::optional<kinebase::CsmRecording> Parse(std::string_view text, bool strict) {
  try {
    return kinebase::ParseCsm(text, "fuzz.csm", {.strict = strict});
  } catch (const kinebase::Error&) {
    return std::nullopt;
  }
}

void TryMarkers(const kinebase::CsmRecording& csm) {
  kinebase::Diagnostics diagnostics;
  const kinebase::MarkerCloud markers = kinebase::BuildMarkers(csm, {.rate_hz = 120}, diagnostics);
  const kinebase::CsmRecording written = kinebase::ToCsm(markers, diagnostics);
  if (kinebase::ParseCsm(kinebase::FormatCsm(written), "markers.csm") != written) std::abort();
  (void)kinebase::CheckPreset(markers.labels);
  (void)kinebase::HasBandAndStick(markers.labels);
}

void TryCsm(std::string_view text) {
  const auto csm = Parse(text, false);
  const auto strict = Parse(text, true);
  if (strict && strict != csm) std::abort();
  if (!csm) return;
  if (csm->frame_count() == 0) std::abort();
  if (csm->values.size() != csm->frame_count() * csm->marker_count() * 3) std::abort();
  if (kinebase::ParseCsm(kinebase::FormatCsm(*csm), "written.csm") != *csm) std::abort();
  TryMarkers(*csm);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryCsm({reinterpret_cast<const char*>(data), size});
  return 0;
}
