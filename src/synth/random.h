// Random numbers that are the same on every machine.
//
// The distributions of <random> differ between standard libraries, so nothing of it is used here.
// Generator: Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014
// (SplitMix64).
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace kinebase::internal {

// A number for a text (FNV-1a), to be used as one of a stream's keys.
[[nodiscard]] std::uint64_t HashText(std::string_view text);

// A stream of numbers that depends on its keys alone, never on which other streams were used
// before: what is made for one clip does not change when others are left out.
class Random {
 public:
  Random(std::initializer_list<std::uint64_t> keys);

  [[nodiscard]] std::uint64_t Next();
  [[nodiscard]] double Uniform(double low, double high);  // [low, high).

  // Mean 0, variance 1, within ±6: the sum of twelve uniform draws, which needs no logarithm whose
  // last bit could differ between systems.
  [[nodiscard]] double Normal();

  // A normal draw around `mean`, kept within three standard deviations.
  [[nodiscard]] double Around(double mean, double deviation);

  [[nodiscard]] std::size_t Below(std::size_t count);  // [0, count).

 private:
  std::uint64_t state_ = 0;
};

}  // namespace kinebase::internal
