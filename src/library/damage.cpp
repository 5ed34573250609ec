#include "library/damage.h"

#include "fmt/format.h"
#include "library/library_layout.h"

namespace kinebase::internal {

void CheckTakeRow(const StoredTake& take, const std::filesystem::path& library) {
  if (take.is_intact) return;
  throw Error(
      ErrorCode::kMalformedFile,
      fmt::format("is damaged in what it says of {}; {}", take.path.string(), kDamageRemedy),
      {.file = CatalogueFile(library)});
}

}  // namespace kinebase::internal
