// What reading and writing an array of NumPy share.
//
//   byte 0   0x93 "NUMPY"
//   byte 6   version: 1, 2 or 3, and 0
//   byte 8   length of the header: 2 bytes in version 1, 4 bytes since, little endian
//   then     {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }, blanks, a line feed
//   then     the items
// Source: NumPy Enhancement Proposal 1.
#pragma once

#include <cstddef>
#include <string_view>

namespace kinebase::internal {

inline constexpr std::string_view kNpyMagic = "\x93NUMPY";
inline constexpr std::size_t kBytesPerCharacter = 4;  // UTF-32.

// A byte that is no UTF-8 becomes this plus the byte: Python's "surrogateescape", PEP 383.
inline constexpr char32_t kEscapedByte = 0xDC00;

}  // namespace kinebase::internal
