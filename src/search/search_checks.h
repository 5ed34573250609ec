// What every search asks of its options.
#pragma once

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase::internal {

inline void CheckTau(double tau) {
  if (tau >= 0) return;
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("threshold tau {}; expected 0 or more", tau));
}

}  // namespace kinebase::internal
