// Which errors of a segment are damage. Internal.
#pragma once

#include "kinebase/core/error.h"

namespace kinebase::internal {

// Whether what a take was stored as is lost, so that the take may be removed. Not so where the
// system refuses to read (IoFailure), or a newer Kinebase could (Mismatch).
inline bool IsDamage(const Error& error) {
  return error.code() == ErrorCode::kMalformedFile || error.code() == ErrorCode::kNotFound;
}

}  // namespace kinebase::internal
