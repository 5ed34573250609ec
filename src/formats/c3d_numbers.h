// Words and floats of the three processors that C3D files come from.
//
// Intel  little endian, IEEE 754.
// DEC    little endian words; a float is two of them, the high one first, with an exponent whose
//        bias makes the same bits mean 4 times less than in IEEE 754. Exponent 0 is zero, or with
//        the sign set no number.
// MIPS   big endian, IEEE 754.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kinebase/formats/c3d.h"

namespace kinebase::internal {

[[nodiscard]] inline float DecToFloat(std::uint32_t bits) {
  const std::uint32_t exponent = (bits >> 23) & 0xff;
  const bool is_negative = (bits >> 31) != 0;
  if (exponent == 0) return is_negative ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
  if (exponent > 2) return std::bit_cast<float>(bits - (2U << 23));
  // Below what an IEEE float holds in full.
  const auto mantissa = std::bit_cast<float>((bits & 0x807fffff) | 0x3f800000);
  return static_cast<float>(std::ldexp(static_cast<double>(mantissa), int(exponent) - 129));
}

// What is too large becomes the largest, what is too small zero.
[[nodiscard]] inline std::uint32_t FloatToDec(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits & 0x80000000;
  if (std::isnan(value)) return 0x80000000;
  const std::uint32_t exponent = (bits >> 23) & 0xff;
  if (exponent >= 254) return sign | 0x7fffffff;
  if (exponent > 0) return bits + (2U << 23);
  int power = 0;  // |value| = m · 2^power with m in [.5, 1), as DEC has it.
  const double m = std::frexp(std::abs(static_cast<double>(value)), &power);
  if (m == 0 || power + 128 < 1) return 0;
  const auto fraction = static_cast<std::uint32_t>((2 * m - 1) * 8388608);
  return sign | (static_cast<std::uint32_t>(power + 128) << 23) | fraction;
}

// How one processor lays out its numbers.
template <C3dProcessor kProcessor>
struct C3dCodec {
  [[nodiscard]] static std::uint16_t LoadWord(const char* bytes) {
    const auto first = static_cast<unsigned char>(bytes[0]);
    const auto second = static_cast<unsigned char>(bytes[1]);
    if constexpr (kProcessor == C3dProcessor::kMips) {
      return static_cast<std::uint16_t>(first << 8 | second);
    } else {
      return static_cast<std::uint16_t>(second << 8 | first);
    }
  }

  [[nodiscard]] static float LoadFloat(const char* bytes) {
    const std::uint32_t first = LoadWord(bytes);
    const std::uint32_t second = LoadWord(bytes + 2);
    if constexpr (kProcessor == C3dProcessor::kIntel) {
      return std::bit_cast<float>(second << 16 | first);
    } else if constexpr (kProcessor == C3dProcessor::kDec) {
      return DecToFloat(first << 16 | second);
    } else {
      return std::bit_cast<float>(first << 16 | second);
    }
  }

  static void StoreWord(char* bytes, std::uint16_t value) {
    const auto low = static_cast<char>(value & 0xff);
    const auto high = static_cast<char>(value >> 8);
    constexpr bool kHighFirst = kProcessor == C3dProcessor::kMips;
    bytes[0] = kHighFirst ? high : low;
    bytes[1] = kHighFirst ? low : high;
  }

  static void StoreFloat(char* bytes, float value) {
    const std::uint32_t bits =
        kProcessor == C3dProcessor::kDec ? FloatToDec(value) : std::bit_cast<std::uint32_t>(value);
    const auto low = static_cast<std::uint16_t>(bits & 0xffff);
    const auto high = static_cast<std::uint16_t>(bits >> 16);
    constexpr bool kHighFirst = kProcessor != C3dProcessor::kIntel;
    StoreWord(bytes, kHighFirst ? high : low);
    StoreWord(bytes + 2, kHighFirst ? low : high);
  }
};

// Calls `action` with the processor's codec.
template <typename Action>
auto WithCodec(C3dProcessor processor, const Action& action) {
  switch (processor) {
    case C3dProcessor::kDec:
      return action(C3dCodec<C3dProcessor::kDec>());
    case C3dProcessor::kMips:
      return action(C3dCodec<C3dProcessor::kMips>());
    case C3dProcessor::kIntel:
      break;
  }
  return action(C3dCodec<C3dProcessor::kIntel>());
}

[[nodiscard]] inline std::uint16_t LoadWord(C3dProcessor processor, const char* bytes) {
  return WithCodec(processor, [&](auto codec) { return codec.LoadWord(bytes); });
}
[[nodiscard]] inline float LoadFloat(C3dProcessor processor, const char* bytes) {
  return WithCodec(processor, [&](auto codec) { return codec.LoadFloat(bytes); });
}
inline void StoreWord(C3dProcessor processor, char* bytes, std::uint16_t value) {
  WithCodec(processor, [&](auto codec) { codec.StoreWord(bytes, value); });
}
inline void StoreFloat(C3dProcessor processor, char* bytes, float value) {
  WithCodec(processor, [&](auto codec) { codec.StoreFloat(bytes, value); });
}

}  // namespace kinebase::internal
