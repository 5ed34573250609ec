#include "formats/mat_text.h"

#include <cstddef>

#include "formats/unicode.h"

namespace kinebase::internal {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

bool IsHighHalf(char32_t c) { return c >= 0xD800 && c <= 0xDBFF; }
bool IsLowHalf(char32_t c) { return c >= 0xDC00 && c <= 0xDFFF; }

}  // namespace

void AppendUtf16(std::u16string& out, char32_t character) {
  if (character < 0x10000) {
    out.push_back(static_cast<char16_t>(character));
    return;
  }
  const char32_t above = character - 0x10000;
  out.push_back(static_cast<char16_t>(0xD800 + (above >> 10)));
  out.push_back(static_cast<char16_t>(0xDC00 + (above & 0x3FF)));
}

std::u16string Utf8ToUtf16(std::string_view utf8) {
  std::u16string out;
  out.reserve(utf8.size());
  while (!utf8.empty()) {
    const char32_t latin1 = static_cast<unsigned char>(utf8.front());
    AppendUtf16(out, TakeCharacter(utf8).value_or(latin1));
  }
  return out;
}

std::string Utf16ToUtf8(std::u16string_view utf16) {
  std::string out;
  out.reserve(utf16.size());
  for (std::size_t i = 0; i < utf16.size(); ++i) {
    char32_t c = utf16[i];
    if (IsHighHalf(c) && i + 1 < utf16.size() && IsLowHalf(utf16[i + 1])) {
      c = 0x10000 + ((c - 0xD800) << 10) + (utf16[++i] - 0xDC00);
    } else if (IsSurrogate(c)) {
      c = kReplacement;
    }
    AppendUtf8(out, c);
  }
  return out;
}

}  // namespace kinebase::internal
