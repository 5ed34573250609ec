// Writes MAT-files of version 5. Their layout: mat_layout.h.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

#include "fmt/format.h"
#include "formats/mat_inflate.h"
#include "formats/mat_layout.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/mat.h"

namespace kinebase {
namespace {

constexpr std::size_t kLargestVariable = std::size_t{1} << 31;  // What MATLAB reads.
constexpr std::size_t kSmallestFieldLength = 32;  // As MATLAB; older programs expect no less.

template <typename T>
void Append(std::string& out, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  out.append(bytes.data(), bytes.size());
}

void Pad(std::string& out, std::size_t begin) {
  while ((out.size() - begin) % 8 != 0) out.push_back('\0');
}

// An element with its tag; small ones go into the tag, as MATLAB wants it for names' lengths.
void AppendElement(std::string& out, std::uint32_t type, std::string_view data) {
  const auto size = static_cast<std::uint32_t>(data.size());
  const std::size_t begin = out.size();
  if (size > 0 && size <= 4) {
    Append(out, size << 16 | type);
  } else {
    Append(out, type);
    Append(out, size);
  }
  out.append(data);
  Pad(out, begin);
}

std::uint32_t ClassNumber(MatClass type) {
  switch (type) {
    case MatClass::kChar:
      return internal::kMatChar;
    case MatClass::kCell:
      return internal::kMatCell;
    case MatClass::kStruct:
      return internal::kMatStruct;
    default:
      return internal::kMatClassDouble + static_cast<std::uint32_t>(type);
  }
}

template <typename T>
std::string Numbers(const std::vector<double>& numbers) {
  std::string data;
  data.reserve(numbers.size() * sizeof(T));
  for (const double number : numbers) Append(data, static_cast<T>(number));
  return data;
}

void AppendNumbers(std::string& out, const MatArray& array) {
  const auto& numbers = array.numbers;
  switch (array.type) {
    case MatClass::kSingle:
      return AppendElement(out, internal::kMatSingle, Numbers<float>(numbers));
    case MatClass::kInt8:
      return AppendElement(out, internal::kMatInt8, Numbers<std::int8_t>(numbers));
    case MatClass::kUint8:
      return AppendElement(out, internal::kMatUint8, Numbers<std::uint8_t>(numbers));
    case MatClass::kInt16:
      return AppendElement(out, internal::kMatInt16, Numbers<std::int16_t>(numbers));
    case MatClass::kUint16:
      return AppendElement(out, internal::kMatUint16, Numbers<std::uint16_t>(numbers));
    case MatClass::kInt32:
      return AppendElement(out, internal::kMatInt32, Numbers<std::int32_t>(numbers));
    case MatClass::kUint32:
      return AppendElement(out, internal::kMatUint32, Numbers<std::uint32_t>(numbers));
    default:
      return AppendElement(out, internal::kMatDouble, Numbers<double>(numbers));
  }
}

void AppendCharacters(std::string& out, const std::u16string& characters) {
  const bool ascii = std::ranges::all_of(characters, [](char16_t c) { return c < 0x80; });
  std::string data;
  for (const char16_t c : characters) {
    if (ascii) {
      data.push_back(static_cast<char>(c));
    } else {
      Append(data, c);
    }
  }
  AppendElement(out, ascii ? internal::kMatUtf8 : internal::kMatUint16, data);
}

void AppendFieldNames(std::string& out, const std::vector<std::string>& fields) {
  std::size_t length = kSmallestFieldLength;
  for (const std::string& field : fields) length = std::max(length, field.size() + 1);
  std::string number;
  Append(number, static_cast<std::int32_t>(length));
  AppendElement(out, internal::kMatInt32, number);
  std::string names;
  for (const std::string& field : fields) {
    const std::size_t begin = names.size();
    names += field;
    names.resize(begin + length);
  }
  AppendElement(out, internal::kMatInt8, names);
}

// An element of type 14.
void AppendArray(std::string& out, const MatArray& array, std::string_view name, bool is_global) {
  const std::size_t begin = out.size();
  Append(out, std::uint32_t{internal::kMatMatrix});
  Append(out, std::uint32_t{0});  // The size, when it is known.
  if (array.type == MatClass::kOther) {
    out += array.bytes;  // With its own name.
  } else {
    std::string flags;
    Append(flags, ClassNumber(array.type) | (array.is_logical ? internal::kMatLogical : 0u) |
                      (is_global ? internal::kMatGlobal : 0u));
    Append(flags, std::uint32_t{0});
    AppendElement(out, internal::kMatUint32, flags);
    std::string dims;
    for (const std::int32_t length : array.dims) Append(dims, length);
    AppendElement(out, internal::kMatInt32, dims);
    AppendElement(out, internal::kMatInt8, name);
    if (array.type == MatClass::kChar) {
      AppendCharacters(out, array.characters);
    } else if (array.type == MatClass::kStruct || array.type == MatClass::kCell) {
      if (array.type == MatClass::kStruct) AppendFieldNames(out, array.fields);
      for (const MatArray& element : array.elements) AppendArray(out, element, "", false);
    } else {
      AppendNumbers(out, array);
    }
  }
  const std::size_t size = out.size() - begin - 8;
  std::string number;
  Append(number, static_cast<std::uint32_t>(size));
  out.replace(begin + 4, 4, number);
  Pad(out, begin);
}

}  // namespace

std::string FormatMat(const MatFile& mat) {
  std::string out = mat.header.substr(0, internal::kMatTextSize);
  if (out.empty()) out = " ";  // A zero byte there would mean version 4.
  out.resize(internal::kMatTextSize, ' ');
  out.append(8, '\0');
  Append(out, internal::kMatVersion);
  out += "IM";
  for (const MatVariable& variable : mat.variables) {
    std::string element;
    AppendArray(element, variable.value, variable.name, variable.is_global);
    if (element.size() >= kLargestVariable) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("variable {} has {} bytes; MAT-files hold up to 2 GiB a variable, so "
                              "cut the recording first",
                              Quoted(variable.name), element.size()));
    }
    const std::string packed = internal::Deflate(element);
    Append(out, std::uint32_t{internal::kMatCompressed});
    Append(out, static_cast<std::uint32_t>(packed.size()));
    out += packed;
  }
  return out;
}

}  // namespace kinebase
