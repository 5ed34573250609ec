// Reads one array of NumPy: a magic word, a header that is a Python literal, the items.
//
// Its layout: npz_array.h.
// Source: NumPy Enhancement Proposal 1.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

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

constexpr std::size_t kLargestRank = 64;  // Of NumPy 2; 32 before.

struct NpyHeader {
  std::string type;  // "<f8".
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t items_begin = 0;
};

// Errors of one array.
class NpyFailure {
 public:
  NpyFailure(std::string_view name, const std::filesystem::path& file) : name_(name), file_(file) {}

  [[noreturn]] void Fail(const std::string& message, std::size_t byte,
                         ErrorCode code = ErrorCode::kMalformedFile) const {
    throw Error(code, fmt::format("array {}: {}", Quoted(name_), message),
                {.file = file_, .byte = static_cast<std::int64_t>(byte)});
  }

 private:
  std::string_view name_;
  const std::filesystem::path& file_;
};

// The Python literal of the header: a dictionary with three keys in any order.
class HeaderParser {
 public:
  HeaderParser(std::string_view text, std::size_t begin, const NpyFailure& failure)
      : text_(text), begin_(begin), failure_(failure) {}

  NpyHeader Parse() {
    NpyHeader header;
    bool has_type = false;
    bool has_order = false;
    bool has_shape = false;
    Expect('{');
    while (!Take('}')) {
      const std::string_view key = TakeString("a key");
      Expect(':');
      if (key == "descr") {
        header.type = TakeType();
        has_type = true;
      } else if (key == "fortran_order") {
        header.fortran_order = TakeTruth();
        has_order = true;
      } else if (key == "shape") {
        header.shape = TakeShape();
        has_shape = true;
      } else {
        Fail("unknown key " + Quoted(key));
      }
      if (Take(',')) continue;
      Expect('}');
      break;
    }
    if (!has_type) Fail("the header lacks 'descr'");
    if (!has_order) Fail("the header lacks 'fortran_order'");
    if (!has_shape) Fail("the header lacks 'shape'");
    return header;
  }

 private:
  [[noreturn]] void Fail(const std::string& message,
                         ErrorCode code = ErrorCode::kMalformedFile) const {
    failure_.Fail(message, begin_ + at_, code);
  }

  std::string_view rest() const { return text_.substr(at_); }

  void SkipBlanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }

  bool Take(char c) {
    SkipBlanks();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void Expect(char c) {
    if (!Take(c)) Fail(fmt::format("expected '{}' in the header, found {}", c, Quoted(rest())));
  }

  std::string_view TakeString(std::string_view what) {
    SkipBlanks();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '\'' && quote != '"') {
      Fail(fmt::format("expected {} in quotes, found {}", what, Quoted(rest())));
    }
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) Fail("a quote in the header does not end");
    const std::string_view string = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return string;
  }

  std::string TakeType() {
    SkipBlanks();
    if (rest().starts_with('[') || rest().starts_with('(')) {
      Fail("items that are structures are not interpreted", ErrorCode::kMismatch);
    }
    return std::string(TakeString("a type"));
  }

  bool TakeTruth() {
    SkipBlanks();
    for (const auto& [word, value] : {std::pair("True", true), std::pair("False", false)}) {
      if (!rest().starts_with(word)) continue;
      at_ += std::strlen(word);
      return value;
    }
    Fail("expected True or False, found " + Quoted(rest()));
  }

  std::vector<std::size_t> TakeShape() {
    std::vector<std::size_t> shape;
    Expect('(');
    while (!Take(')')) {
      if (shape.size() == kLargestRank) Fail("more than 64 dimensions");
      SkipBlanks();
      std::size_t length = 0;
      const char* const begin = text_.data() + at_;
      const auto result = std::from_chars(begin, text_.data() + text_.size(), length);
      if (result.ec != std::errc()) Fail("expected a length, found " + Quoted(rest()));
      at_ += static_cast<std::size_t>(result.ptr - begin);
      Take('L');  // Python 2 wrote long numbers so.
      shape.push_back(length);
      if (Take(',')) continue;
      Expect(')');
      break;
    }
    return shape;
  }

  std::string_view text_;
  std::size_t begin_;
  const NpyFailure& failure_;
  std::size_t at_ = 0;
};

NpyHeader ParseHeader(std::string_view bytes, const NpyFailure& failure) {
  constexpr std::size_t kLengthAt = kNpyMagic.size() + 2;
  if (!bytes.starts_with(kNpyMagic)) {
    failure.Fail("expected an array of NumPy, found " + Quoted(bytes), 0);
  }
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i]));
  };
  if (bytes.size() < kLengthAt) failure.Fail("is cut off in its header", bytes.size());
  const std::size_t version = byte(kNpyMagic.size());
  if (version < 1 || version > 3) {
    failure.Fail(fmt::format("header version {} of NumPy is unknown; 1, 2 and 3 are", version),
                 kNpyMagic.size());
  }
  const std::size_t length_size = version == 1 ? 2 : 4;
  const std::size_t begin = kLengthAt + length_size;
  if (bytes.size() < begin) failure.Fail("is cut off in its header", bytes.size());
  std::size_t length = 0;
  for (std::size_t i = 0; i < length_size; ++i) length |= byte(kLengthAt + i) << (8 * i);
  if (length > bytes.size() - begin) {
    failure.Fail(
        fmt::format("a header of {} bytes, but only {} are left", length, bytes.size() - begin),
        kLengthAt);
  }
  NpyHeader header = HeaderParser(bytes.substr(begin, length), begin, failure).Parse();
  header.items_begin = begin + length;
  return header;
}

// The type of items: '<f8' is byte order, kind and size.
struct ItemType {
  bool swapped = false;  // Against this machine.
  char kind = 0;         // f, i, u, b, U, S.
  std::size_t size = 0;  // Bytes of an item.
};

ItemType ParseType(const std::string& text, const NpyFailure& failure, std::size_t byte) {
  std::string_view rest = text;
  ItemType type;
  if (!rest.empty() && std::string_view("<>|=").find(rest.front()) != std::string_view::npos) {
    constexpr bool kLittle = std::endian::native == std::endian::little;
    type.swapped = rest.front() == (kLittle ? '>' : '<');
    rest.remove_prefix(1);
  }
  if (!rest.empty()) type.kind = rest.front();
  const auto size = ParseInteger(rest.substr(std::min<std::size_t>(rest.size(), 1)));
  if (size && *size >= 0) type.size = static_cast<std::size_t>(*size);
  const auto fits = [&](char kind, std::initializer_list<std::size_t> sizes) {
    return type.kind == kind && std::ranges::find(sizes, type.size) != sizes.end();
  };
  const bool is_text = (type.kind == 'U' || type.kind == 'S') && size && *size >= 0;
  if (!is_text && !fits('f', {4, 8}) && !fits('i', {1, 2, 4, 8}) && !fits('u', {1, 2, 4, 8}) &&
      !fits('b', {1})) {
    failure.Fail(fmt::format("items of type {} are not interpreted", Quoted(text)), byte,
                 ErrorCode::kMismatch);
  }
  if (type.kind == 'U' && __builtin_mul_overflow(type.size, kBytesPerCharacter, &type.size)) {
    failure.Fail(fmt::format("text of {} characters an item", *size), byte);
  }
  return type;
}

// How many items there are, after making sure that all their bytes are there.
std::size_t CountItems(const NpyHeader& header, const ItemType& type, std::size_t byte_count,
                       const NpyFailure& failure) {
  std::size_t count = 1;
  if (std::ranges::find(header.shape, std::size_t{0}) != header.shape.end()) return 0;
  bool overflow = false;
  for (const std::size_t length : header.shape) {
    overflow = overflow || __builtin_mul_overflow(count, length, &count);
  }
  std::size_t needed = 0;
  overflow = overflow || __builtin_mul_overflow(count, type.size, &needed);
  // Text without characters needs no bytes: nothing would bound the number of items.
  if (overflow || needed > byte_count || type.size == 0) {
    failure.Fail(fmt::format("shape ({}) of items of {} bytes needs more than the {} bytes that "
                             "are there",
                             fmt::join(header.shape, ", "), type.size, byte_count),
                 header.items_begin);
  }
  return count;
}

template <typename T>
T Load(const char* bytes, bool swapped) {
  std::array<char, sizeof(T)> buffer;
  std::memcpy(buffer.data(), bytes, sizeof(T));
  if (swapped) std::ranges::reverse(buffer);
  return std::bit_cast<T>(buffer);
}

// Appends a character as UTF-8; false if it is none.
bool AppendCharacter(std::string& text, char32_t c) {
  if (c >= kEscapedByte + 0x80 && c <= kEscapedByte + 0xFF) {
    text.push_back(static_cast<char>(c - kEscapedByte));
    return true;
  }
  if (internal::IsSurrogate(c) || c > internal::kLargestCharacter) return false;
  internal::AppendUtf8(text, c);
  return true;
}

std::string LoadText(const char* bytes, const ItemType& type, const NpyFailure& failure,
                     std::size_t byte) {
  if (type.kind == 'S') {
    std::string text(bytes, type.size);
    text.resize(text.find_last_not_of('\0') + 1);
    return text;
  }
  std::size_t count = type.size / kBytesPerCharacter;
  const auto character = [&](std::size_t i) {
    return Load<char32_t>(bytes + i * kBytesPerCharacter, type.swapped);
  };
  while (count > 0 && character(count - 1) == 0) --count;
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    if (AppendCharacter(text, character(i))) continue;
    failure.Fail(
        fmt::format("{:#x} is no Unicode character", static_cast<std::uint32_t>(character(i))),
        byte + i * kBytesPerCharacter);
  }
  return text;
}

// Calls `take` with where each item of the file stands in C order.
template <typename Take>
void ForEachInCOrder(const NpyHeader& header, std::size_t count, Take take) {
  if (!header.fortran_order || header.shape.size() < 2) {
    for (std::size_t i = 0; i < count; ++i) take(i);
    return;
  }
  const std::size_t rank = header.shape.size();
  std::vector<std::size_t> stride(rank, 1);
  for (std::size_t d = 1; d < rank; ++d) stride[d] = stride[d - 1] * header.shape[d - 1];
  std::vector<std::size_t> index(rank, 0);
  std::size_t place = 0;
  for (std::size_t i = 0; i < count; ++i) {
    take(place);
    for (std::size_t d = rank; d-- > 0;) {
      place += stride[d];
      if (++index[d] < header.shape[d]) break;
      place -= stride[d] * header.shape[d];
      index[d] = 0;
    }
  }
}

class ItemReader {
 public:
  ItemReader(const NpyHeader& header, const ItemType& type, std::size_t count,
             std::string_view items, const NpyFailure& failure)
      : header_(header), type_(type), count_(count), items_(items), failure_(failure) {}

  NpzItems Read() const {
    switch (type_.kind) {
      case 'f':
        return type_.size == 8 ? NpzItems(Numbers<double>()) : NpzItems(Numbers<float>());
      case 'i':
        return Integers<std::int8_t, std::int16_t, std::int32_t, std::int64_t>();
      case 'u':
        return Integers<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>();
      case 'b':
        return Truths();
      default:
        return Texts();
    }
  }

 private:
  template <typename T>
  std::vector<T> Numbers() const {
    std::vector<T> numbers;
    numbers.reserve(count_);
    ForEachInCOrder(header_, count_, [&](std::size_t i) {
      numbers.push_back(Load<T>(items_.data() + i * sizeof(T), type_.swapped));
    });
    return numbers;
  }

  template <typename T1, typename T2, typename T4, typename T8>
  NpzItems Integers() const {
    if (type_.size == 1) return Numbers<T1>();
    if (type_.size == 2) return Numbers<T2>();
    if (type_.size == 4) return Numbers<T4>();
    return Numbers<T8>();
  }

  NpzItems Truths() const {
    std::vector<bool> truths;
    truths.reserve(count_);
    ForEachInCOrder(header_, count_, [&](std::size_t i) { truths.push_back(items_[i] != 0); });
    return truths;
  }

  NpzItems Texts() const {
    std::vector<std::string> texts;
    texts.reserve(count_);
    ForEachInCOrder(header_, count_, [&](std::size_t i) {
      const std::size_t begin = i * type_.size;
      texts.push_back(
          LoadText(items_.data() + begin, type_, failure_, header_.items_begin + begin));
    });
    return texts;
  }

  const NpyHeader& header_;
  const ItemType& type_;
  std::size_t count_;
  std::string_view items_;
  const NpyFailure& failure_;
};

}  // namespace

NpzArray ParseNpy(std::string_view bytes, std::string name, const std::filesystem::path& file) {
  const NpyFailure failure(name, file);
  const NpyHeader header = ParseHeader(bytes, failure);
  const ItemType type = ParseType(header.type, failure, header.items_begin);
  const std::string_view items = bytes.substr(header.items_begin);
  const std::size_t count = CountItems(header, type, items.size(), failure);
  NpzItems values = ItemReader(header, type, count, items, failure).Read();
  return {std::move(name), header.shape, std::move(values)};
}

}  // namespace kinebase
