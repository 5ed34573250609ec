// Which errors of a library are damage, and what is to be done about it. Internal.
#pragma once

#include <filesystem>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/library/take_library.h"

namespace kinebase::internal {

inline constexpr std::string_view kDamageRemedy =
    "run 'kinebase library remove LIBRARY --damaged', with which labels and annotations of what is "
    "damaged go, too, and import its files again";

// Whether what a take was stored as is lost, so that the take may be removed. Not so where the
// system refuses to read (IoFailure), or a newer Kinebase could (Mismatch).
inline bool IsDamage(const Error& error) {
  return error.code() == ErrorCode::kMalformedFile || error.code() == ErrorCode::kNotFound;
}

// The same, with what to do: removing takes is advised for damage alone.
[[nodiscard]] Error WithRemedy(const Error& error);

// What a damaged row says of a take is not to be trusted: not where its features are, nor whose.
// Errors  MalformedFile if it is damaged, with the remedy.
void CheckTakeRow(const StoredTake& take, const std::filesystem::path& library);

// Whether a segment has the take's features where the catalogue says.
[[nodiscard]] bool HoldsFeatures(const SegmentReader& segment, const StoredFeatures& features,
                                 const ContentKey& content);

}  // namespace kinebase::internal
