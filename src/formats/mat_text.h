// MATLAB's characters are UTF-16; ours are UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace kinebase::internal {

// A byte that belongs to no character is taken as Latin-1: old files hold such.
[[nodiscard]] std::u16string Utf8ToUtf16(std::string_view utf8);

// Half of a pair becomes U+FFFD.
[[nodiscard]] std::string Utf16ToUtf8(std::u16string_view utf16);

void AppendUtf16(std::u16string& out, char32_t character);

}  // namespace kinebase::internal
