#include "library/damage.h"

#include "fmt/format.h"
#include "library/library_layout.h"

namespace kinebase::internal {
namespace {

constexpr std::string_view kAccessRemedy =
    "it may be sound: see to its permissions and its disk, and try again";

}  // namespace

Error WithRemedy(const Error& error) {
  std::string message = error.message();
  if (IsDamage(error)) {
    message += fmt::format("; {}", kDamageRemedy);
  } else if (error.code() == ErrorCode::kIoFailure) {
    message += fmt::format("; {}", kAccessRemedy);
  }
  return {error.code(), std::move(message), error.place()};
}

void CheckTakeRow(const StoredTake& take, const std::filesystem::path& library) {
  if (take.is_intact) return;
  throw Error(
      ErrorCode::kMalformedFile,
      fmt::format("is damaged in what it says of {}; {}", take.path.string(), kDamageRemedy),
      {.file = CatalogueFile(library)});
}

bool HoldsFeatures(const SegmentReader& segment, const StoredFeatures& features,
                   const ContentKey& content) {
  return features.slot >= 0 && features.slot < segment.take_count() &&
         segment.Content(features.slot) == content &&
         segment.feature_set_hash() == features.feature_set_hash &&
         segment.rate_hz() == features.rate_hz;
}

}  // namespace kinebase::internal
