#include "synth/random.h"

#include <algorithm>

namespace kinebase::internal {
namespace {

std::uint64_t Mix(std::uint64_t value) {
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15ULL;

}  // namespace

std::uint64_t HashText(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char character : text) {
    hash = (hash ^ static_cast<unsigned char>(character)) * 0x100000001b3ULL;
  }
  return hash;
}

Random::Random(std::initializer_list<std::uint64_t> keys) {
  for (const std::uint64_t key : keys)
    state_ = Mix(state_ + kGoldenGamma) ^ Mix(key + kGoldenGamma);
}

std::uint64_t Random::Next() {
  state_ += kGoldenGamma;
  return Mix(state_);
}

double Random::Uniform(double low, double high) {
  const double fraction = static_cast<double>(Next() >> 11) * 0x1.0p-53;
  return low + (high - low) * fraction;
}

double Random::Normal() {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += Uniform(0, 1);
  return sum;
}

double Random::Around(double mean, double deviation) {
  return mean + deviation * std::clamp(Normal(), -3.0, 3.0);
}

std::size_t Random::Below(std::size_t count) {
  return static_cast<std::size_t>(Next() % count);  // The bias is below 1e-15 for small counts.
}

}  // namespace kinebase::internal
