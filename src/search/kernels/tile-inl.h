// What the vector kernels share: how the columns of a tile lie in vectors, and what tables say of
// their features. Compiled once for every instruction set.
//
// With N lanes and stripes of S columns, vector v holds columns v, S + v, 2S + v, … So the column
// before is the vector before, and neither unaligned loads nor shuffles are needed. Two vectors in
// front of the first hold the columns before each stripe.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hwy/highway.h"
#include "search/kernels/scan_plan.h"

// Highway's guard: once a target, not once a file.
#if defined(KINEBASE_SEARCH_KERNELS_TILE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef KINEBASE_SEARCH_KERNELS_TILE_INL
#undef KINEBASE_SEARCH_KERNELS_TILE_INL
#else
#define KINEBASE_SEARCH_KERNELS_TILE_INL
#endif

HWY_BEFORE_NAMESPACE();
namespace kinebase::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The cap keeps its length a divisor of every tile, however long a machine's vectors are.
using BytesTag = hn::CappedTag<std::uint8_t, 64>;

// Feature words of a tile of kColumns, and what tables say of them, all striped.
template <std::size_t kColumns>
struct TileFeatures {
  alignas(64) std::uint64_t words[kColumns];
  alignas(64) std::uint8_t nibbles[kNibblesOfAWord][kColumns];
  alignas(64) std::uint8_t sums[kColumns];
};

// How the columns of a tile lie in vectors.
struct Stripes {
  Stripes(std::size_t columns, std::size_t lanes_of_a_vector)
      : count(columns),
        lanes(lanes_of_a_vector),
        length(std::max<std::size_t>((columns + lanes - 1) / lanes, 2)) {}

  [[nodiscard]] std::size_t padded_count() const { return lanes * length; }

  std::size_t count;  // Columns of the tile.
  std::size_t lanes;
  // Vectors; at least 2, so that both columns before a stripe are in one other.
  std::size_t length;
};

template <std::size_t kColumns>
void StripeWords(const std::uint64_t* HWY_RESTRICT columns, const Stripes& stripes,
                 TileFeatures<kColumns>& tile) {
  for (std::size_t lane = 0; lane < stripes.lanes; ++lane) {
    const std::size_t first = std::min(stripes.count, lane * stripes.length);
    const std::size_t count = std::min(stripes.count - first, stripes.length);
    for (std::size_t v = 0; v < count; ++v) {
      tile.words[v * stripes.lanes + lane] = columns[first + v];
    }
  }
}

#if HWY_TARGET == HWY_SCALAR
template <std::size_t kColumns>
void SplitIntoNibbles(std::size_t count, TileFeatures<kColumns>& tile) {
  for (std::size_t nibble = 0; nibble < kNibblesOfAWord; ++nibble) {
    for (std::size_t i = 0; i < count; ++i) {
      tile.nibbles[nibble][i] = static_cast<std::uint8_t>((tile.words[i] >> (4 * nibble)) & 0xF);
    }
  }
}
#else
// Eight words at a time are transposed by bytes in three rounds of interleaving; each byte is then
// cut in two.
template <std::size_t kColumns>
void SplitIntoNibbles(std::size_t count, TileFeatures<kColumns>& tile) {
  const hn::Full128<std::uint8_t> bytes;
  const hn::Full128<std::uint16_t> pairs;
  const hn::Full64<std::uint8_t> half;
  const auto low_nibbles = hn::Set(bytes, std::uint8_t{0xF});
  for (std::size_t i = 0; i < count; i += 8) {
    const auto load = [&](std::size_t word) {
      return hn::BitCast(bytes, hn::Load(hn::Full128<std::uint64_t>(), tile.words + i + word));
    };
    const auto words01 = load(0), words23 = load(2), words45 = load(4), words67 = load(6);
    const auto words04 = hn::InterleaveLower(bytes, words01, words45);
    const auto words15 = hn::InterleaveUpper(bytes, words01, words45);
    const auto words26 = hn::InterleaveLower(bytes, words23, words67);
    const auto words37 = hn::InterleaveUpper(bytes, words23, words67);
    const auto even_low = hn::InterleaveLower(bytes, words04, words26);
    const auto even_high = hn::InterleaveUpper(bytes, words04, words26);
    const auto odd_low = hn::InterleaveLower(bytes, words15, words37);
    const auto odd_high = hn::InterleaveUpper(bytes, words15, words37);
    // Bytes 2p and 2p + 1 of all eight words.
    const auto store = [&](std::size_t p, hn::Vec<hn::Full128<std::uint8_t>> two_bytes) {
      const auto low = hn::And(two_bytes, low_nibbles);
      const auto shifted = hn::ShiftRight<4>(hn::BitCast(pairs, two_bytes));
      const auto high = hn::And(hn::BitCast(bytes, shifted), low_nibbles);
      hn::Store(hn::LowerHalf(half, low), half, tile.nibbles[4 * p] + i);
      hn::Store(hn::LowerHalf(half, high), half, tile.nibbles[4 * p + 1] + i);
      hn::Store(hn::UpperHalf(half, low), half, tile.nibbles[4 * p + 2] + i);
      hn::Store(hn::UpperHalf(half, high), half, tile.nibbles[4 * p + 3] + i);
    };
    store(0, hn::InterleaveLower(bytes, even_low, odd_low));
    store(1, hn::InterleaveUpper(bytes, even_low, odd_low));
    store(2, hn::InterleaveLower(bytes, even_high, odd_high));
    store(3, hn::InterleaveUpper(bytes, even_high, odd_high));
  }
}
#endif  // HWY_TARGET == HWY_SCALAR

#if HWY_TARGET == HWY_SCALAR
// A vector of one byte cannot look anything up in sixteen.
template <std::size_t kColumns>
void SumTables(std::span<const NibbleTable> tables, std::size_t count,
               TileFeatures<kColumns>& tile) {
  std::fill_n(tile.sums, count, std::uint8_t{0});
  for (const NibbleTable& table : tables) {
    const std::uint8_t* nibbles = tile.nibbles[table.nibble];
    for (std::size_t i = 0; i < count; ++i) {
      tile.sums[i] = static_cast<std::uint8_t>(tile.sums[i] + table.sums[nibbles[i]]);
    }
  }
}
#else
// Four vectors at a time, so that a table is loaded once for all of them.
template <std::size_t kColumns>
void SumTables(std::span<const NibbleTable> tables, std::size_t count,
               TileFeatures<kColumns>& tile) {
  const BytesTag tag;
  const std::size_t lanes = hn::Lanes(tag);
  for (std::size_t i = 0; i < count; i += 4 * lanes) {
    auto count0 = hn::Zero(tag);
    auto count1 = hn::Zero(tag);
    auto count2 = hn::Zero(tag);
    auto count3 = hn::Zero(tag);
    for (const NibbleTable& table : tables) {
      const auto lookup = hn::LoadDup128(tag, table.sums.data());
      const std::uint8_t* nibbles = tile.nibbles[table.nibble] + i;
      count0 = hn::Add(count0, hn::TableLookupBytes(lookup, hn::Load(tag, nibbles)));
      count1 = hn::Add(count1, hn::TableLookupBytes(lookup, hn::Load(tag, nibbles + lanes)));
      count2 = hn::Add(count2, hn::TableLookupBytes(lookup, hn::Load(tag, nibbles + 2 * lanes)));
      count3 = hn::Add(count3, hn::TableLookupBytes(lookup, hn::Load(tag, nibbles + 3 * lanes)));
    }
    hn::Store(count0, tag, tile.sums + i);
    hn::Store(count1, tag, tile.sums + i + lanes);
    hn::Store(count2, tag, tile.sums + i + 2 * lanes);
    hn::Store(count3, tag, tile.sums + i + 3 * lanes);
  }
}
#endif  // HWY_TARGET == HWY_SCALAR

// Puts the last two columns of every stripe in front of the next one, and in front of the first
// those that the tile before left; leaves the last two of a full tile for the next.
//
// tag  A full vector of as many numbers as there are stripes.
template <class Tag, typename Number = hn::TFromD<Tag>>
void LinkStripes(Tag tag, const Stripes& stripes, Number* vectors, Number (&left)[2]) {
  const std::size_t lanes = stripes.lanes;
  Number* before = vectors - 2 * lanes;
  const Number* last = vectors + (stripes.length - 2) * lanes;
  const Number next[2] = {last[lanes - 1], last[2 * lanes - 1]};
  for (std::size_t i = 0; i < 2; ++i) {
    hn::Store(hn::LoadU(tag, last + i * lanes - 1), tag, before + i * lanes);
    before[i * lanes] = left[i];
    left[i] = next[i];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kinebase::internal
HWY_AFTER_NAMESPACE();

#endif  // The guard.
