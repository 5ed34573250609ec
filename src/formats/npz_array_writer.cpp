// Writes one array of NumPy. Its layout: npz_array.h.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "formats/npz_array.h"
#include "formats/unicode.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/npz.h"

namespace kinebase {
namespace {

using internal::kBytesPerCharacter;
using internal::kEscapedByte;
using internal::kNpyMagic;

constexpr std::size_t kHeaderAlignment = 64;  // So that the items can be mapped into memory.

template <typename T>
constexpr std::string_view TypeName() {
  if constexpr (std::is_same_v<T, double>) return "<f8";
  if constexpr (std::is_same_v<T, float>) return "<f4";
  if constexpr (std::is_same_v<T, bool>) return "|b1";
  if constexpr (std::is_same_v<T, std::int8_t>) return "|i1";
  if constexpr (std::is_same_v<T, std::int16_t>) return "<i2";
  if constexpr (std::is_same_v<T, std::int32_t>) return "<i4";
  if constexpr (std::is_same_v<T, std::int64_t>) return "<i8";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "|u1";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "<u2";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "<u4";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "<u8";
}

std::string HeaderText(const std::string& type, const std::vector<std::size_t>& shape) {
  const std::string_view comma = shape.size() == 1 ? "," : "";
  const std::string literal =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}", type,
                  fmt::join(shape, ", "), comma);
  // Version 1 counts the header in two bytes; 64 dimensions always fit.
  const std::size_t before = kNpyMagic.size() + 4;
  const std::size_t whole =
      (before + literal.size() + kHeaderAlignment) / kHeaderAlignment * kHeaderAlignment;
  const std::size_t length = whole - before;
  std::string header(kNpyMagic);
  for (const std::size_t byte : {std::size_t{1}, std::size_t{0}, length & 0xFF, length >> 8}) {
    header.push_back(static_cast<char>(byte));
  }
  header += literal;
  header.resize(whole - 1, ' ');
  header += '\n';
  return header;
}

template <typename T>
void AppendLittleEndian(std::string& out, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  out.append(bytes.data(), bytes.size());
}

std::string FormatTexts(const std::vector<std::string>& texts,
                        const std::vector<std::size_t>& shape) {
  std::size_t width = 1;  // NumPy has no text of no characters.
  std::vector<std::u32string> wide;
  wide.reserve(texts.size());
  for (std::string_view text : texts) {
    std::u32string& characters = wide.emplace_back();
    while (!text.empty()) {
      const char32_t escaped = kEscapedByte + static_cast<unsigned char>(text.front());
      characters.push_back(internal::TakeCharacter(text).value_or(escaped));
    }
    width = std::max(width, characters.size());
  }
  std::string out = HeaderText(fmt::format("<U{}", width), shape);
  out.reserve(out.size() + texts.size() * width * kBytesPerCharacter);
  for (std::u32string& characters : wide) {
    characters.resize(width, U'\0');
    for (const char32_t c : characters) AppendLittleEndian(out, c);
  }
  return out;
}

}  // namespace

std::size_t NpzArray::size() const {
  return std::visit([](const auto& vector) { return vector.size(); }, items);
}

bool operator==(const NpzArray& a, const NpzArray& b) {
  if (a.name != b.name || a.shape != b.shape || a.items.index() != b.items.index()) return false;
  return std::visit(
      [&](const auto& mine) {
        using Vector = std::decay_t<decltype(mine)>;
        using Item = typename Vector::value_type;
        const auto& other = std::get<Vector>(b.items);
        if constexpr (std::is_floating_point_v<Item>) {
          return mine.size() == other.size() &&
                 (mine.empty() ||
                  std::memcmp(mine.data(), other.data(), mine.size() * sizeof(Item)) == 0);
        } else {
          return mine == other;
        }
      },
      a.items);
}

std::string FormatNpy(const NpzArray& array) {
  std::size_t count = 1;
  for (const std::size_t length : array.shape) count *= length;
  if (count != array.size()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("array {}: {} items do not fill the shape ({})", Quoted(array.name),
                            array.size(), fmt::join(array.shape, ", ")));
  }
  return std::visit(
      [&](const auto& items) {
        using Item = typename std::decay_t<decltype(items)>::value_type;
        if constexpr (std::is_same_v<Item, std::string>) {
          return FormatTexts(items, array.shape);
        } else {
          std::string out = HeaderText(std::string(TypeName<Item>()), array.shape);
          out.reserve(out.size() + items.size() * sizeof(Item));
          for (const Item item : items) {
            if constexpr (std::is_same_v<Item, bool>) {
              out.push_back(item ? '\1' : '\0');
            } else {
              AppendLittleEndian(out, item);
            }
          }
          return out;
        }
      },
      array.items);
}

}  // namespace kinebase
