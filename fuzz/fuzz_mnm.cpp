// Any bytes as an MNM: marker names or one kinebase::Error. What was read is written and read again
// and looked up in both directions; what the strict reader takes, the other reads the same.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/formats/mnm.h"
#include "kinebase/motion/csm_motion.h"

namespace {

// Another exception than kinebase::Error leaves through here and is a finding.
std::optional<kinebase::MarkerNames> Parse(std::string_view text, bool strict) {
  try {
    return kinebase::ParseMnm(text, "fuzz.mnm", {.strict = strict});
  } catch (const kinebase::Error&) {
    return std::nullopt;
  }
}

void TryLabels(const kinebase::MarkerNames& names) {
  std::vector<std::string> labels;
  for (const auto& row : names.rows) labels.push_back(row.custom);
  kinebase::Diagnostics diagnostics;
  const auto preset = kinebase::PresetLabels(labels, names, diagnostics);
  if (preset.size() != labels.size()) std::abort();
  if (kinebase::CustomLabels(preset, names, diagnostics).size() != labels.size()) std::abort();
}

void TryMnm(std::string_view text) {
  const auto names = Parse(text, false);
  const auto strict = Parse(text, true);
  if (strict && strict != names) std::abort();
  if (!names) return;
  if (kinebase::ParseMnm(kinebase::FormatMnm(*names), "written.mnm") != *names) std::abort();
  TryLabels(*names);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryMnm({reinterpret_cast<const char*>(data), size});
  return 0;
}
