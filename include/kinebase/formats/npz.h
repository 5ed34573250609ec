// NPZ, NumPy's archive of named arrays, as it stands in the file.
//
// A ZIP archive with one `name.npy` an array. motion/npz_file.cpp says which arrays a recording
// has; docs/formats/npz.md lists them. Source: NumPy Enhancement Proposal 1, "A Simple File Format
// for NumPy Arrays".
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kinebase/core/diagnostic.h"

namespace kinebase {

// The items of an array, in C order (the last index runs fastest) whatever the file's order was.
// Text is UTF-8; bytes that are none go into the file and come back as Python's "surrogateescape".
using NpzItems =
    std::variant<std::vector<double>, std::vector<float>, std::vector<std::int8_t>,
                 std::vector<std::int16_t>, std::vector<std::int32_t>, std::vector<std::int64_t>,
                 std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<std::uint32_t>,
                 std::vector<std::uint64_t>, std::vector<bool>, std::vector<std::string>>;

struct NpzArray {
  std::string name;                // Without ".npy".
  std::vector<std::size_t> shape;  // Empty for a single item.
  NpzItems items;                  // As many as the product of `shape`.

  [[nodiscard]] std::size_t size() const;  // Items.

  // NaN equals NaN, bit for bit.
  friend bool operator==(const NpzArray& a, const NpzArray& b);
};

// What is in the archive and is no array as above: objects, structures, complex numbers, other
// files. Kept for writing.
struct NpzMember {
  std::string name;  // With its extension.
  std::string bytes;

  friend bool operator==(const NpzMember&, const NpzMember&) = default;
};

struct NpzArchive {
  std::vector<NpzArray> arrays;    // In the order of the file.
  std::vector<NpzMember> members;  // The same.
  Diagnostics diagnostics;         // What was odd; not part of equality.

  [[nodiscard]] const NpzArray* Find(std::string_view name) const;  // Null if it is not there.

  friend bool operator==(const NpzArchive& a, const NpzArchive& b) {
    return a.arrays == b.arrays && a.members == b.members;
  }
};

// Reads the bytes of one array (`.npy`): header versions 1 to 3, either byte order, C or Fortran
// order. `file` is for messages only.
//
// Errors  MalformedFile with the byte: no such header, fewer bytes than its shape needs, text that
//         is no Unicode; Mismatch: items that are neither numbers, truth values nor text.
// Cost    Linear in the bytes; nothing is allocated before they are known to be there.
[[nodiscard]] NpzArray ParseNpy(std::string_view bytes, std::string name,
                                const std::filesystem::path& file);

struct NpzReadOptions {
  // Bytes that the members may unpack to in any case. Beyond that an archive may unpack to a
  // hundred times its size: recordings shrink to a half, masks to a thousandth of their size.
  std::size_t unpacked_limit = std::size_t{1} << 30;
};

// Reads the bytes of an archive whose members are stored or deflated.
//
// Errors  MalformedFile, naming the member: no ZIP archive, one that is cut off, encrypted, packed
//         in another way, of another size than it says, or there twice; an array as ParseNpy; more
//         unpacked bytes than the options allow.
// Cost    Linear in what the members unpack to.
[[nodiscard]] NpzArchive ParseNpz(std::string_view bytes, const std::filesystem::path& file,
                                  const NpzReadOptions& options = {});
[[nodiscard]] NpzArchive ReadNpz(const std::filesystem::path& path,
                                 const NpzReadOptions& options = {});

// The bytes of one array, little endian, in C order.
[[nodiscard]] std::string FormatNpy(const NpzArray& array);

// The bytes of an archive, deflated, the same every time. ParseNpz(FormatNpz(a)) == a, but for
// zero bytes at the end of texts, which NumPy does not tell from padding.
// Errors  InvalidArgument: two members of one name, an array whose items do not fill its shape.
[[nodiscard]] std::string FormatNpz(const NpzArchive& archive);

}  // namespace kinebase
