// Numbers of text formats, read as std::from_chars reads them but faster.
//
// What recordings hold is short: a sign, a few digits, a point, a few digits. Such a number is
// taken eight bytes at a time, without a branch for each digit. It is exact: an integer of up to
// 2^53 and a power of ten of up to 10^22 are doubles, so their one quotient or product is rounded
// once, as it should be (W. D. Clinger, "How to read floating point numbers accurately", 1990).
// The digits of a word are added up as in D. Lemire's fast_float. All else is from_chars' work.
#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace kinebase::internal {

// Eight characters as a word, the first in the lowest byte; digits become 0 to 9.
inline std::uint64_t LoadEight(const char* at) {
  std::uint64_t word = 0;
  std::memcpy(&word, at, sizeof(word));
  return word ^ 0x3030303030303030;
}

// Bit i: character i is no digit. Right up to the first character that is not ASCII.
inline std::uint32_t MarkNonDigits(std::uint64_t eight) {
  const std::uint64_t marks = ((eight + 0x7676767676767676) | eight) & 0x8080808080808080;
  return static_cast<std::uint32_t>(((marks >> 7) * 0x0102040810204080) >> 56);
}

// The first `count` of eight characters, digits, as a whole number; count is 1 to 8.
inline std::uint64_t SumDigits(std::uint64_t eight, unsigned count) {
  constexpr std::uint64_t kPairs = 0x000000FF000000FF;
  constexpr std::uint64_t kFirstWeights = 100 + (std::uint64_t{1000000} << 32);
  constexpr std::uint64_t kSecondWeights = 1 + (std::uint64_t{10000} << 32);
  eight <<= 64 - 8 * count;  // Zeros before the digits.
  eight = eight * 10 + (eight >> 8);
  return ((eight & kPairs) * kFirstWeights + ((eight >> 16) & kPairs) * kSecondWeights) >> 32;
}

inline constexpr std::array kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                            1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                            1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

inline constexpr std::array<std::uint64_t, 9> kWholePowersOfTen = {
    1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
inline constexpr int kLargestPower = static_cast<int>(kPowersOfTen.size()) - 1;
inline constexpr std::uint64_t kLargestWhole = std::uint64_t{1} << 53;

// Bytes that TakeShortDecimal may look at.
inline constexpr std::ptrdiff_t kLongestShortDecimal = 32;

// Reads "e-014" after a number's digits. Null if it is of another form.
inline const char* TakeExponent(const char* at, int& power) {
  const bool is_negative = at[1] == '-';
  at += is_negative || at[1] == '+' ? 2 : 1;
  const std::uint64_t eight = LoadEight(at);
  const auto count = static_cast<unsigned>(std::countr_zero(MarkNonDigits(eight) | 0x100U));
  if (count < 1 || count > 4) return nullptr;
  const auto size = static_cast<int>(SumDigits(eight, count));
  power = is_negative ? -size : size;
  return at + count;
}

// Reads "-12", "0.5", "-2.07272e-014". Returns where the number ends; null if it is of another
// form, too long or too large to be exact.
inline const char* TakeShortDecimal(const char* at, double& value) {
  const std::uint64_t is_negative = *at == '-' ? 1 : 0;
  at += is_negative;
  const std::uint64_t eight = LoadEight(at);
  // Both the point and the end are found in one go, as the next number can only begin then.
  std::uint32_t others = MarkNonDigits(eight) | MarkNonDigits(LoadEight(at + 8)) << 8 | 0x30000U;
  const auto whole = static_cast<unsigned>(std::countr_zero(others));
  if (whole - 1 > 7) return nullptr;
  std::uint64_t digits = SumDigits(eight, whole);
  unsigned length = whole;
  int power = 0;
  if (at[whole] == '.') {
    others &= others - 1;
    length = static_cast<unsigned>(std::countr_zero(others));
    const unsigned count = length - whole - 1;
    if (count - 1 > 7 || length > 15) return nullptr;
    digits = digits * kWholePowersOfTen[count] + SumDigits(LoadEight(at + whole + 1), count);
    power = -static_cast<int>(count);
  }
  at += length;
  if (*at == 'e' || *at == 'E') {
    int exponent = 0;
    at = TakeExponent(at, exponent);
    if (at == nullptr) return nullptr;
    power += exponent;
  }
  if (digits > kLargestWhole || power > kLargestPower || power < -kLargestPower) return nullptr;
  const auto number = static_cast<double>(static_cast<std::int64_t>(digits));
  const double size = power <= 0 ? number / kPowersOfTen[static_cast<std::size_t>(-power)]
                                 : number * kPowersOfTen[static_cast<std::size_t>(power)];
  value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) | is_negative << 63);
  return at;
}

// As std::from_chars(at, end, value). Bytes up to `text_end`, at or after `end`, may be looked at.
inline std::from_chars_result NumberFromChars(const char* at, const char* end, const char* text_end,
                                              double& value) {
  if (std::endian::native == std::endian::little && text_end - at >= kLongestShortDecimal)
      [[likely]] {
    const char* const next = TakeShortDecimal(at, value);
    if (next != nullptr && next <= end) [[likely]] {
      return {next, std::errc()};
    }
  }
  return std::from_chars(at, end, value);
}

}  // namespace kinebase::internal
