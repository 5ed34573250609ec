// Any bytes as an ASF: a skeleton or one kinebase::Error. What was read is written and read again,
// and built into a Skeleton.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/formats/asf.h"
#include "kinebase/motion/asf_amc_motion.h"
#include "kinebase/motion/kinematics.h"

namespace {

// Another exception than kinebase::Error leaves through here and is a finding.
void TryAsf(std::string_view text) {
  kinebase::AsfSkeleton asf;
  try {
    asf = kinebase::ParseAsf(text, "fuzz.asf");
  } catch (const kinebase::Error&) {
    return;
  }
  if (kinebase::ParseAsf(kinebase::FormatAsf(asf), "written.asf") != asf) std::abort();
  try {
    kinebase::Diagnostics diagnostics;
    const auto skeleton = kinebase::BuildSkeleton(asf, {}, diagnostics);
    if (kinebase::NeutralPose(*skeleton).size() != skeleton->joints().size()) std::abort();
  } catch (const kinebase::Error&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryAsf({reinterpret_cast<const char*>(data), size});
  return 0;
}
