// Reads MAT-files of version 5. Their layout: mat_layout.h.
//
// Every size is checked against what holds the element before anything is made of it, so that a
// file that lies cannot make the reader ask for memory, look elsewhere or run for ever.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "formats/mat_inflate.h"
#include "formats/mat_layout.h"
#include "formats/mat_text.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/mat.h"

namespace kinebase {
namespace {

using namespace std::string_view_literals;
using internal::MatElementType;

constexpr int kDeepestNesting = 64;
constexpr std::size_t kMostDimensions = 32;

// An empty array needs 8 bytes in a file and some hundred in memory. Recordings have hundreds.
constexpr std::size_t kMostArrays = 1'000'000;

constexpr std::size_t kLargestGrowth = 100;

struct Element {
  std::uint32_t type = 0;
  std::string_view data;
};

struct NamedArray {
  std::string name;
  bool is_global = false;
  MatArray array;
};

class MatParser {
 public:
  MatParser(std::string_view bytes, const std::filesystem::path& file,
            const MatReadOptions& options)
      : file_(file),
        bytes_(bytes),
        origin_(bytes.data()),
        left_(std::max(options.unpacked_limit, kLargestGrowth * bytes.size())) {}

  MatFile Parse() {
    ReadHeader();
    std::string_view rest = bytes_.substr(internal::kMatHeaderSize);
    while (!rest.empty()) {
      const std::string_view at = rest;
      const Element element = TakeElement(rest);
      if (element.type == internal::kMatMatrix) {
        AddVariable(element.data);
      } else if (element.type == internal::kMatCompressed) {
        AddCompressed(at, element.data);
      } else {
        Fail(at, fmt::format("expected a variable, found an element of type {}", element.type));
      }
    }
    return std::move(result_);
  }

 private:
  // `at` begins where the error is.
  [[noreturn]] void Fail(std::string_view at, std::string message) const {
    std::int64_t byte = at.data() - origin_;
    if (packed_at_) {
      message += fmt::format(" (byte {} of what the variable unpacks to)", byte);
      byte = *packed_at_;
    }
    throw Error(ErrorCode::kMalformedFile, std::move(message), {.file = file_, .byte = byte});
  }

  [[noreturn]] void FailVersion(std::string_view what) const {
    throw Error(ErrorCode::kMalformedFile,
                fmt::format("{}, which is not read; write it with MATLAB's save(…, '-v7') or "
                            "SciPy's savemat(…, format='5')",
                            what),
                {file_});
  }

  void ReadHeader() {
    constexpr std::string_view kHdf5 = "\x89HDF\r\n\x1a\n";
    const std::size_t size = bytes_.size();
    if (bytes_.starts_with(kHdf5)) FailVersion("is an HDF5 file (MAT version 7.3, or other data)");
    // Version 4 has no header: its first number is the type of the first variable, below 5000.
    if (size >= 20 && std::ranges::find(bytes_.substr(0, 4), '\0') != bytes_.substr(0, 4).end()) {
      FailVersion("is a MAT-file of version 4, or none");
    }
    if (size < internal::kMatHeaderSize) {
      Fail(bytes_, fmt::format("expected a MAT-file with a header of {} bytes, found {} bytes",
                               internal::kMatHeaderSize, size));
    }
    const std::string_view mark = bytes_.substr(126, 2);
    if (mark != "IM" && mark != "MI") {
      Fail(bytes_.substr(126),
           fmt::format("expected a MAT-file, found {}", Quoted(bytes_.substr(0, 40))));
    }
    swapped_ = (mark == "MI") == (std::endian::native == std::endian::little);
    big_endian_ = mark == "MI";
    const auto version = Load<std::uint16_t>(bytes_.data() + 124);
    if (version >> 8 == 2) FailVersion("is a MAT-file of version 7.3 (HDF5)");
    if (version >> 8 != internal::kMatVersion >> 8) {
      FailVersion(fmt::format("is a MAT-file of version {:#06x}", version));
    }
    std::string_view text = bytes_.substr(0, internal::kMatTextSize);
    text = text.substr(0, text.find_last_not_of(" \0"sv) + 1);
    result_.header = std::string(text);
  }

  template <typename T>
  T Load(const char* bytes) const {
    std::array<char, sizeof(T)> buffer;
    std::memcpy(buffer.data(), bytes, sizeof(T));
    if (swapped_) std::ranges::reverse(buffer);
    return std::bit_cast<T>(buffer);
  }

  Element TakeElement(std::string_view& rest) const {
    if (rest.size() < 8) Fail(rest, "the file is cut off: an element needs 8 bytes or more");
    const auto first = Load<std::uint32_t>(rest.data());
    if (const std::size_t size = first >> 16; size != 0) {
      if (size > 4) Fail(rest, fmt::format("{} bytes in a tag that has room for 4", size));
      const Element element{first & 0xFFFF, rest.substr(4, size)};
      rest.remove_prefix(8);
      return element;
    }
    const std::size_t size = Load<std::uint32_t>(rest.data() + 4);
    if (size > rest.size() - 8) {
      Fail(rest, fmt::format("the file is cut off or damaged: an element of {} bytes, but {} are "
                             "left",
                             size, rest.size() - 8));
    }
    const Element element{first, rest.substr(8, size)};
    // Packed elements are not padded, and padding at the very end may be missing.
    const std::size_t padded = first == internal::kMatCompressed ? size : (size + 7) / 8 * 8;
    rest.remove_prefix(std::min(8 + padded, rest.size()));
    return element;
  }

  Element TakeElement(std::string_view& rest, std::initializer_list<MatElementType> types,
                      std::string_view what) const {
    const std::string_view at = rest;
    const Element element = TakeElement(rest);
    if (std::ranges::find(types, element.type) == types.end()) {
      Fail(at, fmt::format("expected {}, found an element of type {}", what, element.type));
    }
    return element;
  }

  void AddVariable(std::string_view data) {
    NamedArray named = TakeArray(data, 0);
    result_.variables.push_back({std::move(named.name), named.is_global, std::move(named.array)});
  }

  void AddCompressed(std::string_view at, std::string_view packed) {
    std::string unpacked;
    const auto status = internal::Inflate(packed, left_, unpacked);
    if (status == internal::InflateStatus::kTooLarge) {
      Fail(at,
           "the variables unpack to more than a hundred times the file; if that is right, write "
           "them "
           "with MATLAB's save(…, '-v6'), which does not compress");
    }
    if (status == internal::InflateStatus::kDamaged) {
      Fail(at, "the compressed variable is damaged or cut off");
    }
    left_ -= unpacked.size();
    packed_at_ = at.data() - origin_;
    const char* const file_origin = std::exchange(origin_, unpacked.data());
    std::string_view rest = unpacked;
    AddVariable(TakeElement(rest, {internal::kMatMatrix}, "a variable").data);
    origin_ = file_origin;
    packed_at_.reset();
  }

  // The inside of an element of type 14.
  NamedArray TakeArray(std::string_view data, int depth) {
    NamedArray result;
    if (++array_count_ > kMostArrays) Fail(data, "the file holds more than a million arrays");
    if (depth > kDeepestNesting) Fail(data, "arrays are nested more than 64 levels deep");
    if (data.empty()) return result;  // How MATLAB writes [] in cells and fields.
    const std::string_view whole = data;
    const Element flags = TakeElement(data, {internal::kMatUint32}, "an array's flags");
    if (flags.data.size() < 4) Fail(whole, "an array without flags");
    const auto bits = Load<std::uint32_t>(flags.data.data());
    const std::uint32_t number = bits & 0xFF;
    result.is_global = (bits & internal::kMatGlobal) != 0;
    if (number != internal::kMatOpaque) result.array.dims = TakeDimensions(data);
    result.name = TakeElement(data, {internal::kMatInt8, internal::kMatUint8}, "a name").data;
    const auto type = ClassOf(number);
    if (!type || (bits & internal::kMatComplex) != 0) {
      KeepWhole(whole, result);
      return result;
    }
    result.array.type = *type;
    result.array.is_logical = (bits & internal::kMatLogical) != 0;
    switch (*type) {
      case MatClass::kChar:
        TakeCharacters(data, result.array);
        break;
      case MatClass::kCell:
        TakeElements(data, result.array.size(), result.array, depth);
        break;
      case MatClass::kStruct:
        TakeFields(data, result.array, depth);
        break;
      default:
        TakeNumbers(data, result.array);
    }
    return result;
  }

  static std::optional<MatClass> ClassOf(std::uint32_t number) {
    switch (number) {
      case internal::kMatCell:
        return MatClass::kCell;
      case internal::kMatStruct:
        return MatClass::kStruct;
      case internal::kMatChar:
        return MatClass::kChar;
      default:
        break;
    }
    if (number < internal::kMatClassDouble || number > internal::kMatClassUint32) {
      return std::nullopt;
    }
    return static_cast<MatClass>(number - internal::kMatClassDouble);
  }

  void KeepWhole(std::string_view whole, NamedArray& result) {
    result.array = {.type = MatClass::kOther};
    if (big_endian_) {
      result.array = {};
      result_.diagnostics.push_back(
          {Severity::kWarning,
           fmt::format("array {} is sparse, complex, 64-bit or an object; it is left out as the "
                       "file is big-endian",
                       Quoted(result.name))});
      return;
    }
    result.array.bytes = std::string(whole);
  }

  std::vector<std::int32_t> TakeDimensions(std::string_view& data) const {
    const std::string_view at = data;
    const Element element =
        TakeElement(data, {internal::kMatInt32, internal::kMatUint32}, "an array's dimensions");
    const std::size_t rank = element.data.size() / 4;
    if (rank < 2 || rank > kMostDimensions || element.data.size() % 4 != 0) {
      Fail(at, fmt::format("{} bytes of dimensions; an array has 2 to {}", element.data.size(),
                           kMostDimensions));
    }
    std::vector<std::int32_t> dims;
    std::int64_t count = 1;
    for (std::size_t i = 0; i < rank; ++i) {
      dims.push_back(Load<std::int32_t>(element.data.data() + 4 * i));
      if (dims.back() < 0) Fail(at, fmt::format("a dimension of {}", dims.back()));
    }
    if (std::ranges::find(dims, 0) != dims.end()) return dims;
    for (const std::int32_t length : dims) {
      if (__builtin_mul_overflow(count, std::int64_t{length}, &count)) {
        Fail(at, fmt::format("dimensions {} of no array", fmt::join(dims, " × ")));
      }
    }
    return dims;
  }

  void TakeElements(std::string_view& data, std::size_t count, MatArray& array, int depth) {
    if (count > data.size() / 8) {
      Fail(data, fmt::format("{} elements, but only {} bytes are left", count, data.size()));
    }
    array.elements.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Element element = TakeElement(data, {internal::kMatMatrix}, "an array");
      array.elements.push_back(TakeArray(element.data, depth + 1).array);
    }
  }

  void TakeFields(std::string_view& data, MatArray& array, int depth) {
    const std::string_view at = data;
    const Element length = TakeElement(data, {internal::kMatInt32}, "the length of field names");
    const auto size = length.data.size() == 4 ? Load<std::int32_t>(length.data.data()) : 0;
    const Element names =
        TakeElement(data, {internal::kMatInt8, internal::kMatUint8}, "the names of fields");
    const auto step = static_cast<std::size_t>(std::max(size, 0));
    if (names.data.empty()) return;  // A structure without fields.
    if (step == 0 || names.data.size() % step != 0) {
      Fail(at, fmt::format("{} bytes of field names of {} bytes each", names.data.size(), size));
    }
    for (std::size_t i = 0; i < names.data.size(); i += step) {
      const std::string_view name = names.data.substr(i, step);
      array.fields.emplace_back(name.substr(0, name.find('\0')));
    }
    std::size_t count = 0;
    if (__builtin_mul_overflow(array.size(), array.fields.size(), &count)) {
      Fail(at, "more fields than any file can hold");
    }
    TakeElements(data, count, array, depth);
  }

  void TakeCharacters(std::string_view& data, MatArray& array) const {
    const std::string_view at = data;
    if (data.empty() && array.size() == 0) return;
    const Element element = TakeElement(data);
    switch (element.type) {
      case internal::kMatUtf8:
        array.characters = internal::Utf8ToUtf16(element.data);
        break;
      case internal::kMatInt8:
      case internal::kMatUint8:
        for (const char c : element.data) {
          array.characters.push_back(static_cast<unsigned char>(c));
        }
        break;
      case internal::kMatUint16:
      case internal::kMatUtf16:
        for (std::size_t i = 0; i + 2 <= element.data.size(); i += 2) {
          array.characters.push_back(Load<char16_t>(element.data.data() + i));
        }
        break;
      case internal::kMatUtf32:
        for (std::size_t i = 0; i + 4 <= element.data.size(); i += 4) {
          const auto c = Load<char32_t>(element.data.data() + i);
          internal::AppendUtf16(array.characters, c <= 0x10FFFF ? c : U'\xFFFD');
        }
        break;
      default:
        Fail(at, fmt::format("expected characters, found an element of type {}", element.type));
    }
    const std::size_t count = array.characters.size();
    if (count == array.size()) return;
    // Writers differ in what they count for characters beyond 16 bits.
    if (array.dims.size() != 2 || array.dims[0] != 1 || count > array.size() * 4) {
      Fail(at, fmt::format("{} characters do not fill {}", count, fmt::join(array.dims, " × ")));
    }
    array.dims[1] = static_cast<std::int32_t>(count);
  }

  void TakeNumbers(std::string_view& data, MatArray& array) const {
    const std::string_view at = data;
    if (data.empty() && array.size() == 0) return;
    const Element element = TakeElement(data);
    switch (element.type) {
      case internal::kMatInt8:
        return Convert<std::int8_t>(at, element.data, array);
      case internal::kMatUint8:
        return Convert<std::uint8_t>(at, element.data, array);
      case internal::kMatInt16:
        return Convert<std::int16_t>(at, element.data, array);
      case internal::kMatUint16:
        return Convert<std::uint16_t>(at, element.data, array);
      case internal::kMatInt32:
        return Convert<std::int32_t>(at, element.data, array);
      case internal::kMatUint32:
        return Convert<std::uint32_t>(at, element.data, array);
      case internal::kMatInt64:
        return Convert<std::int64_t>(at, element.data, array);
      case internal::kMatUint64:
        return Convert<std::uint64_t>(at, element.data, array);
      case internal::kMatSingle:
        return Convert<float>(at, element.data, array);
      case internal::kMatDouble:
        return Convert<double>(at, element.data, array);
      default:
        Fail(at, fmt::format("expected numbers, found an element of type {}", element.type));
    }
  }

  // The numbers of an array may stand in a smaller type than its class, where they fit.
  template <typename T>
  void Convert(std::string_view at, std::string_view data, MatArray& array) const {
    if (data.size() % sizeof(T) != 0 || data.size() / sizeof(T) != array.size()) {
      Fail(at, fmt::format("{} bytes of numbers do not fill {}", data.size(),
                           fmt::join(array.dims, " × ")));
    }
    const auto [low, high] = RangeOf(array.type);
    array.numbers.reserve(array.size());
    for (std::size_t i = 0; i < data.size(); i += sizeof(T)) {
      auto value = static_cast<double>(Load<T>(data.data() + i));
      if (array.type == MatClass::kSingle) value = static_cast<double>(static_cast<float>(value));
      const bool fits = array.type <= MatClass::kSingle ||
                        (value >= low && value <= high && value == std::floor(value));
      if (!fits) Fail(at, fmt::format("{} in an array of class {}", value, ToString(array.type)));
      array.numbers.push_back(value);
    }
  }

  static std::pair<double, double> RangeOf(MatClass type) {
    const auto range = []<typename T>(T) {
      return std::pair<double, double>(std::numeric_limits<T>::min(),
                                       std::numeric_limits<T>::max());
    };
    switch (type) {
      case MatClass::kInt8:
        return range(std::int8_t{});
      case MatClass::kUint8:
        return range(std::uint8_t{});
      case MatClass::kInt16:
        return range(std::int16_t{});
      case MatClass::kUint16:
        return range(std::uint16_t{});
      case MatClass::kInt32:
        return range(std::int32_t{});
      default:
        return range(std::uint32_t{});
    }
  }

  const std::filesystem::path& file_;
  std::string_view bytes_;
  const char* origin_;  // What bytes are counted from.
  std::size_t left_;    // What may still be unpacked.
  bool swapped_ = false;
  bool big_endian_ = false;
  std::optional<std::int64_t> packed_at_;  // The compressed variable that is being read.
  std::size_t array_count_ = 0;
  MatFile result_;
};

}  // namespace

MatFile ParseMat(std::string_view bytes, const std::filesystem::path& file,
                 const MatReadOptions& options) {
  return MatParser(bytes, file, options).Parse();
}

MatFile ReadMat(const std::filesystem::path& path, const MatReadOptions& options) {
  return ParseMat(MappedFile(path).text(), path, options);
}

}  // namespace kinebase
