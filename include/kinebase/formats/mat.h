// MAT, MATLAB's file of variables (version 5, which MATLAB calls -v6 and -v7), as it stands there.
//
// motion/mat_file.cpp says what the variables `skel` and `mot` of HDM05's MATLAB tools mean.
// Source: The MathWorks, "MAT-File Format", Sect. 1; docs/formats/mat.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinebase/core/diagnostic.h"

namespace kinebase {

enum class MatClass : std::uint8_t {
  kDouble,
  kSingle,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kChar,
  kCell,
  kStruct,
  kOther,  // Sparse, complex and 64-bit numbers, objects, functions: kept, not interpreted.
};

[[nodiscard]] std::string_view ToString(MatClass type);  // "double", "cell" …

// One MATLAB array. Everything runs down the columns: the first index fastest.
struct MatArray {
  MatClass type = MatClass::kDouble;
  bool is_logical = false;                  // Truth values; their class is kUint8.
  std::vector<std::int32_t> dims = {0, 0};  // Two or more.
  std::vector<double> numbers;      // Of every class of numbers, which a double holds exactly.
  std::u16string characters;        // kChar: UTF-16 as MATLAB has it.
  std::vector<std::string> fields;  // kStruct: names.
  std::vector<MatArray> elements;   // kCell: [element]; kStruct: [element × field].
  std::string bytes;                // kOther: the array's element of the file as it stands.

  [[nodiscard]] std::size_t size() const;  // Elements, by `dims`.

  // A field of one element of a structure; null if there is no such field or element.
  [[nodiscard]] const MatArray* Field(std::string_view name, std::size_t element = 0) const;
  [[nodiscard]] std::string Text() const;  // kChar: its characters as UTF-8.

  // NaN equals NaN.
  friend bool operator==(const MatArray& a, const MatArray& b);
};

struct MatVariable {
  std::string name;
  bool is_global = false;
  MatArray value;

  friend bool operator==(const MatVariable&, const MatVariable&) = default;
};

struct MatFile {
  std::string header = "MATLAB 5.0 MAT-file, written by Kinebase";  // At most 116 bytes.
  std::vector<MatVariable> variables;
  Diagnostics diagnostics;  // What was odd; not part of equality.

  [[nodiscard]] const MatArray* Find(std::string_view name) const;  // Null if it is not there.

  friend bool operator==(const MatFile& a, const MatFile& b) {
    return a.header == b.header && a.variables == b.variables;
  }
};

// Small arrays as MATLAB makes them.
[[nodiscard]] MatArray MatText(std::string_view utf8);          // 1 × n characters.
[[nodiscard]] MatArray MatScalar(double value);                 // 1 × 1.
[[nodiscard]] MatArray MatColumn(std::vector<double> numbers);  // n × 1.
[[nodiscard]] MatArray MatMatrix(std::size_t rows, std::vector<double> numbers);  // By columns.
[[nodiscard]] MatArray MatCells(std::vector<MatArray> elements);                  // n × 1.
[[nodiscard]] MatArray MatStruct(std::vector<std::pair<std::string, MatArray>> fields);  // 1 × 1.

struct MatReadOptions {
  // Bytes that the variables may unpack to in any case. Beyond that a file may unpack to a hundred
  // times its size.
  std::size_t unpacked_limit = std::size_t{1} << 30;
};

// Reads the bytes of a MAT-file of version 5, either byte order, compressed or not. `file` is for
// messages only.
//
// Errors  MalformedFile with the byte (in what a compressed variable unpacks to: of the variable):
//         an element that is larger than what holds it, dimensions that its data does not fill,
//         nesting beyond 64 levels, a million arrays, more unpacked bytes than the options allow;
//         a file of version 4 or 7.3, with the command that helps.
// Cost    Linear in what the variables unpack to; no allocation is bounded by an unchecked number.
[[nodiscard]] MatFile ParseMat(std::string_view bytes, const std::filesystem::path& file,
                               const MatReadOptions& options = {});
[[nodiscard]] MatFile ReadMat(const std::filesystem::path& path,
                              const MatReadOptions& options = {});

// The bytes of a MAT-file, little endian, compressed, the same every time.
// ParseMat(FormatMat(f)) == f.
// Errors  Mismatch: a variable of more than 2 GiB, which the format cannot hold.
[[nodiscard]] std::string FormatMat(const MatFile& mat);

}  // namespace kinebase
