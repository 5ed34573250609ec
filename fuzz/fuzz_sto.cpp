// Any bytes as a MOT or STO: a table or one kinebase::Error. What was read is written and read
// again.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/formats/sto.h"

namespace {

// Another exception than kinebase::Error leaves through here and is a finding.
void TrySto(std::string_view text) {
  kinebase::StoTable table;
  try {
    table = kinebase::ParseSto(text, "fuzz.sto");
  } catch (const kinebase::Error&) {
    return;
  }
  if (table.values.size() != table.row_count() * table.column_count() * table.component_count) {
    std::abort();
  }
  if (kinebase::ParseSto(kinebase::FormatSto(table), "written.sto") != table) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TrySto({reinterpret_cast<const char*>(data), size});
  return 0;
}
