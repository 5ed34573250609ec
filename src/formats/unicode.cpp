#include "formats/unicode.h"

#include <array>
#include <cstddef>

namespace kinebase::internal {
namespace {

// How many bytes a character has by its first; 0 for a byte that begins none.
std::size_t CharacterSize(char32_t first) {
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  return first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
}

}  // namespace

std::optional<char32_t> TakeCharacter(std::string_view& utf8) {
  constexpr std::array<char32_t, 5> kSmallest = {0, 0, 0x80, 0x800, 0x10000};
  const auto byte = [&](std::size_t i) -> char32_t { return static_cast<unsigned char>(utf8[i]); };
  const std::size_t size = CharacterSize(byte(0));
  bool good = size > 0 && size <= utf8.size();
  char32_t c = size < 2 ? byte(0) : byte(0) & (0x7Fu >> size);
  for (std::size_t i = 1; good && i < size; ++i) {
    good = (byte(i) & 0xC0) == 0x80;
    c = (c << 6) | (byte(i) & 0x3F);
  }
  good = good && c >= kSmallest[size] && c <= kLargestCharacter && !IsSurrogate(c);
  utf8.remove_prefix(good ? size : 1);
  if (!good) return std::nullopt;
  return c;
}

void AppendUtf8(std::string& out, char32_t character) {
  const auto push = [&](char32_t byte) { out.push_back(static_cast<char>(byte)); };
  const auto push_rest = [&](int shift) { push(0x80 | ((character >> shift) & 0x3F)); };
  if (character < 0x80) {
    push(character);
  } else if (character < 0x800) {
    push(0xC0 | (character >> 6));
    push_rest(0);
  } else if (character < 0x10000) {
    push(0xE0 | (character >> 12));
    push_rest(6);
    push_rest(0);
  } else {
    push(0xF0 | (character >> 18));
    push_rest(12);
    push_rest(6);
    push_rest(0);
  }
}

}  // namespace kinebase::internal
