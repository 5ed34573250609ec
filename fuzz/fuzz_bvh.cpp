// Any bytes as a BVH: a motion or one kinebase::Error. What was read is written and read again,
// understood as a figure, and that is written as BVH; what the strict reader takes, the other
// reads the same.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/formats/bvh.h"
#include "kinebase/motion/bvh_motion.h"

namespace {

// Another exception than kinebase::Error leaves through here and is a finding.
std::optional<kinebase::BvhMotion> Parse(std::string_view text, bool strict) {
  try {
    return kinebase::ParseBvh(text, "fuzz.bvh", {.strict = strict});
  } catch (const kinebase::Error&) {
    return std::nullopt;
  }
}

void TryFigure(const kinebase::BvhMotion& bvh) {
  try {
    kinebase::Diagnostics diagnostics;
    const kinebase::BvhFigure figure = kinebase::BuildFigure(bvh, {}, diagnostics);
    const kinebase::BvhMotion written = kinebase::ToBvh(figure.motion, {}, diagnostics);
    if (written.frame_count() != bvh.frame_count()) std::abort();
    (void)kinebase::FormatBvh(written);
  } catch (const kinebase::Error&) {
    return;
  }
}

void TryBvh(std::string_view text) {
  const auto bvh = Parse(text, false);
  const auto strict = Parse(text, true);
  if (strict && strict != bvh) std::abort();
  if (!bvh) return;
  if (bvh->values.size() != bvh->frame_count() * bvh->column_count) std::abort();
  if (kinebase::ParseBvh(kinebase::FormatBvh(*bvh), "written.bvh") != *bvh) std::abort();
  TryFigure(*bvh);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryBvh({reinterpret_cast<const char*>(data), size});
  return 0;
}
