// Any bytes as a cut file: cuts that are safe to follow, and lines that are refused with their
// number. What is read with quotes is read the same where quotes are not asked for.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinebase/library/cut_list.h"

namespace {

void Check(bool holds) {
  if (!holds) std::abort();
}

// A name may not lead out of the folder that it is looked for in.
void CheckName(const std::filesystem::path& name) {
  Check(!name.empty() && name.is_relative() && name.has_filename());
  Check(std::ranges::none_of(name, [](const auto& part) { return part == ".." || part == "."; }));
  Check(name.string().find('\\') == std::string::npos);
}

void TryCutList(std::string_view text) {
  const kinebase::CutList quoted = kinebase::ParseCutList(text, "fuzz.txt");
  const kinebase::CutList all = kinebase::ParseCutList(text, "fuzz.txt", {.unquoted = true});
  for (const kinebase::Cut& cut : all.cuts) {
    CheckName(cut.take);
    CheckName(cut.clip);
    Check(cut.first_frame >= 1 && cut.first_frame <= cut.last_frame && cut.place.line >= 1);
  }
  for (const kinebase::Error& error : all.refused) Check(error.place().line >= 1);
  const auto lines = static_cast<std::int64_t>(all.cuts.size() + all.refused.size());
  const auto with_quotes = static_cast<std::int64_t>(quoted.cuts.size() + quoted.refused.size());
  Check(lines == with_quotes + quoted.unquoted_lines && all.unquoted_lines == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryCutList({reinterpret_cast<const char*>(data), size});
  return 0;
}
