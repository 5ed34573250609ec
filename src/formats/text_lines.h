// What the readers of text formats share.
#pragma once

#include <algorithm>
#include <string_view>

namespace kinebase::internal {

// Whether a line holds bytes that no text has: a file of another kind under this name.
inline bool HoldsBinaryData(std::string_view line) {
  return std::ranges::any_of(line, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && c != '\t' && c != '\f' && c != '\v';
  });
}

}  // namespace kinebase::internal
