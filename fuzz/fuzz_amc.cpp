// Any bytes as an AMC: a motion or one kinebase::Error. What was read is written and read again;
// what the strict reader takes, the other reads the same.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/formats/amc.h"

namespace {

// Another exception than kinebase::Error leaves through here and is a finding.
std::optional<kinebase::AmcMotion> Parse(std::string_view text, bool strict) {
  try {
    return kinebase::ParseAmc(text, "fuzz.amc", {.strict = strict});
  } catch (const kinebase::Error&) {
    return std::nullopt;
  }
}

void TryAmc(std::string_view text) {
  const auto amc = Parse(text, false);
  const auto strict = Parse(text, true);
  if (strict && strict != amc) std::abort();
  if (!amc) return;
  if (amc->values.size() != amc->frame_count() * amc->column_count) std::abort();
  if (kinebase::ParseAmc(kinebase::FormatAmc(*amc), "written.amc", {.strict = true}) != *amc) {
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryAmc({reinterpret_cast<const char*>(data), size});
  return 0;
}
