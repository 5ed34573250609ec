// UTF-8, character by character.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kinebase::internal {

inline constexpr char32_t kLargestCharacter = 0x10FFFF;

[[nodiscard]] constexpr bool IsSurrogate(char32_t c) { return c >= 0xD800 && c <= 0xDFFF; }

// Takes a character off the front of a text that is not empty; of bytes that are no character the
// first goes, and there is none.
[[nodiscard]] std::optional<char32_t> TakeCharacter(std::string_view& utf8);

void AppendUtf8(std::string& out, char32_t character);

}  // namespace kinebase::internal
