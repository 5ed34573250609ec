// How a MAT-file of version 5 is laid out, for its reader and its writer.
//
//   byte 0    116 bytes of text, not beginning with a zero byte
//   byte 116  8 bytes: where a subsystem's data lie; of no use to others
//   byte 124  version 0x0100 and "MI", each as a 16-bit number in the file's byte order
//   byte 128  elements: the variables
//
// An element is a tag, the 32-bit numbers type and size, and then its data, padded to 8 bytes; up
// to 4 bytes may stand in the tag itself, whose first number is then size · 65536 + type. A
// variable is an element of type 14, or one of type 15: such an element packed by zlib, without
// padding. Inside stand elements: flags and class; dimensions; name; and by class
//
//   numbers    one element of any type of numbers
//   char       one element, UTF-8 or UTF-16
//   cell       an element of type 14 for each of its elements
//   struct     length of a field's name; the names; an element of type 14 for each field of each
//
// Source: The MathWorks, "MAT-File Format", Sect. 1.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kinebase::internal {

inline constexpr std::size_t kMatTextSize = 116;
inline constexpr std::size_t kMatHeaderSize = 128;
inline constexpr std::uint16_t kMatVersion = 0x0100;

enum MatElementType : std::uint32_t {
  kMatInt8 = 1,
  kMatUint8 = 2,
  kMatInt16 = 3,
  kMatUint16 = 4,
  kMatInt32 = 5,
  kMatUint32 = 6,
  kMatSingle = 7,
  kMatDouble = 9,
  kMatInt64 = 12,
  kMatUint64 = 13,
  kMatMatrix = 14,
  kMatCompressed = 15,
  kMatUtf8 = 16,
  kMatUtf16 = 17,
  kMatUtf32 = 18,
};

// Classes of arrays, in the low byte of the flags.
enum MatClassNumber : std::uint32_t {
  kMatCell = 1,
  kMatStruct = 2,
  kMatChar = 4,
  kMatClassDouble = 6,
  kMatClassSingle = 7,
  kMatClassInt8 = 8,
  kMatClassUint8 = 9,
  kMatClassInt16 = 10,
  kMatClassUint16 = 11,
  kMatClassInt32 = 12,
  kMatClassUint32 = 13,
  kMatOpaque = 17,  // Objects of MATLAB's newer classes: no dimensions.
};

inline constexpr std::uint32_t kMatComplex = 0x0800;
inline constexpr std::uint32_t kMatGlobal = 0x0400;
inline constexpr std::uint32_t kMatLogical = 0x0200;

}  // namespace kinebase::internal
