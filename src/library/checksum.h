// XXH3 as segment files and keys of contents use it. Internal.
#pragma once

#include <cstdint>
#include <string_view>

#include "kinebase/library/segment_file.h"

namespace kinebase::internal {

[[nodiscard]] std::uint64_t Checksum(std::string_view bytes);

// Of several pieces as if they stood one after the other, each behind its length: pieces that are
// cut elsewhere give another key.
[[nodiscard]] ContentKey KeyOf(std::initializer_list<std::string_view> pieces);

}  // namespace kinebase::internal
