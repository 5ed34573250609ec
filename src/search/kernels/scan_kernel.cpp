// The subsequence DTW by vector instructions, in double precision.
//
// Row k of the cost table depends on rows k−1 and k−2 only, so all columns of a row are computed
// side by side. The recording is cut into tiles whose rows stay in the first-level cache; a tile
// needs nothing of the one before it but the last two columns of every row.
//
// This file is compiled once for every instruction set. All of them do the same operations on
// doubles in the same order, without contraction: results are equal bit for bit, also to
// ComputeDeltaReference.
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "search/kernels/scan_plan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "search/kernels/scan_kernel.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

#ifndef KINEBASE_SCAN_KERNEL_ONCE
#define KINEBASE_SCAN_KERNEL_ONCE
namespace kinebase::internal {

// Two rows of costs and starts, 16 bytes each a column, and 10 nibbles: about 22 KiB of the 32 KiB
// that common processors have.
inline constexpr std::size_t kTile = 512;
inline constexpr std::size_t kNibblesOfAWord = 16;
inline constexpr std::size_t kMargin = 8;  // Doubles before a tile's first column; 2 are used.

// A row of the cost table within a tile. Starts are doubles so that the mask of a cost comparison
// selects them directly; every column number below 2^53 is exact.
struct TileRow {
  alignas(64) double costs[kMargin + kTile];
  alignas(64) double starts[kMargin + kTile];

  double* cost() { return costs + kMargin; }
  double* start() { return starts + kMargin; }
};

// The two columns before a tile in one row.
struct LeftColumns {
  double cost[2] = {std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  double start[2] = {-1, -1};
};

struct Workspace {
  TileRow rows[2];
  alignas(64) std::uint8_t nibbles[kNibblesOfAWord][kTile];
  alignas(64) std::uint8_t mismatches[kTile];
};

}  // namespace kinebase::internal
#endif  // KINEBASE_SCAN_KERNEL_ONCE

HWY_BEFORE_NAMESPACE();
namespace kinebase::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Caps keep every length a divisor of the tile, however long a machine's vectors are.
using BytesTag = hn::CappedTag<std::uint8_t, 64>;
using DoublesTag = hn::CappedTag<double, 8>;

void SplitIntoNibbles(const ScanPlan& plan, const std::uint64_t* HWY_RESTRICT columns,
                      std::size_t count, Workspace& work) {
  for (const std::size_t nibble : plan.nibbles()) {
    std::uint8_t* HWY_RESTRICT out = work.nibbles[nibble];
    const unsigned shift = static_cast<unsigned>(4 * nibble);
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = static_cast<std::uint8_t>((columns[i] >> shift) & 0xF);
    }
  }
}

#if HWY_TARGET == HWY_SCALAR
// A vector of one byte cannot look anything up in sixteen.
void CountMismatches(const ScanRow& row, std::size_t count, Workspace& work) {
  std::fill_n(work.mismatches, count, std::uint8_t{0});
  for (const NibbleTable& table : row.tables) {
    const std::uint8_t* nibbles = work.nibbles[table.nibble];
    for (std::size_t i = 0; i < count; ++i) {
      work.mismatches[i] =
          static_cast<std::uint8_t>(work.mismatches[i] + table.mismatches[nibbles[i]]);
    }
  }
}
#else
// Four vectors at a time, so that a table is loaded once for all of them.
void CountMismatches(const ScanRow& row, std::size_t count, Workspace& work) {
  const BytesTag tag;
  const std::size_t lanes = hn::Lanes(tag);
  for (std::size_t i = 0; i < count; i += 4 * lanes) {
    auto count0 = hn::Zero(tag);
    auto count1 = hn::Zero(tag);
    auto count2 = hn::Zero(tag);
    auto count3 = hn::Zero(tag);
    for (const NibbleTable& table : row.tables) {
      const auto lookup = hn::LoadDup128(tag, table.mismatches.data());
      const std::uint8_t* nibbles = work.nibbles[table.nibble] + i;
      count0 = hn::Add(count0, hn::TableLookupBytes(lookup, hn::Load(tag, nibbles)));
      count1 = hn::Add(count1, hn::TableLookupBytes(lookup, hn::Load(tag, nibbles + lanes)));
      count2 = hn::Add(count2, hn::TableLookupBytes(lookup, hn::Load(tag, nibbles + 2 * lanes)));
      count3 = hn::Add(count3, hn::TableLookupBytes(lookup, hn::Load(tag, nibbles + 3 * lanes)));
    }
    hn::Store(count0, tag, work.mismatches + i);
    hn::Store(count1, tag, work.mismatches + i + lanes);
    hn::Store(count2, tag, work.mismatches + i + 2 * lanes);
    hn::Store(count3, tag, work.mismatches + i + 3 * lanes);
  }
}
#endif  // HWY_TARGET == HWY_SCALAR

// Local costs of a vector of columns from column i on.
HWY_INLINE hn::Vec<DoublesTag> LocalCosts(const Workspace& work, std::size_t i,
                                          hn::Vec<DoublesTag> scale) {
  const DoublesTag tag;
  const hn::Rebind<std::int32_t, DoublesTag> ints;
  const hn::Rebind<std::uint8_t, DoublesTag> bytes;
  const auto counts = hn::PromoteTo(ints, hn::LoadU(bytes, work.mismatches + i));
  return hn::Mul(hn::PromoteTo(tag, counts), scale);
}

// Every column is a start.
void FillFirstRow(const ScanRow& row, std::size_t first_column, std::size_t count, TileRow& out,
                  const Workspace& work) {
  const DoublesTag tag;
  const std::size_t lanes = hn::Lanes(tag);
  const auto scale = hn::Set(tag, row.scale);
  for (std::size_t i = 0; i < count; i += lanes) {
    hn::Store(LocalCosts(work, i, scale), tag, out.cost() + i);
    hn::Store(hn::Iota(tag, static_cast<double>(first_column + i)), tag, out.start() + i);
  }
}

void FillUnreachable(std::size_t count, TileRow& out) {
  std::fill_n(out.costs, kMargin + count, std::numeric_limits<double>::infinity());
  std::fill_n(out.starts, kMargin + count, -1.0);
}

// `row` holds row k−2 and becomes row k. From right to left: a cell needs columns to its left only,
// so nothing is overwritten that is still needed.
template <bool kDoublesTwoOne>
void FillRow(const ScanRow& scan_row, std::size_t count, TileRow& one_up, TileRow& row,
             const Workspace& work) {
  const DoublesTag tag;
  const std::size_t lanes = hn::Lanes(tag);
  const auto scale = hn::Set(tag, scan_row.scale);
  const double* HWY_RESTRICT up_cost = one_up.cost();
  const double* HWY_RESTRICT up_start = one_up.start();
  double* HWY_RESTRICT cost = row.cost();
  double* HWY_RESTRICT start = row.start();
  for (std::size_t i = (count + lanes - 1) / lanes * lanes; i > 0;) {
    i -= lanes;
    const auto one_one = hn::LoadU(tag, up_cost + i - 1);
    const auto one_two = hn::LoadU(tag, up_cost + i - 2);
    const auto two_one = hn::LoadU(tag, cost + i - 1);
    const auto takes_one_two = hn::Lt(one_two, one_one);
    const auto one_best = hn::Min(one_two, one_one);
    const auto takes_two_one = hn::Lt(two_one, one_best);
    const auto best = hn::Min(two_one, one_best);
    const auto one_start = hn::IfThenElse(takes_one_two, hn::LoadU(tag, up_start + i - 2),
                                          hn::LoadU(tag, up_start + i - 1));
    const auto best_start = hn::IfThenElse(takes_two_one, hn::LoadU(tag, start + i - 1), one_start);
    auto added = LocalCosts(work, i, scale);
    if constexpr (kDoublesTwoOne) {
      added = hn::Add(added, hn::IfThenElseZero(takes_two_one, added));
    }
    hn::Store(hn::Add(best, added), tag, cost + i);
    hn::Store(best_start, tag, start + i);
  }
}

// Keeps a finished row's last two columns for the next tile, and puts those of the tile before in
// front of it for the rows below.
void ExchangeLeftColumns(std::size_t count, TileRow& row, LeftColumns& left) {
  LeftColumns next;
  double* cost = row.cost();
  double* start = row.start();
  for (std::ptrdiff_t i = 0; i < 2; ++i) {
    const std::ptrdiff_t column = static_cast<std::ptrdiff_t>(count) - 2 + i;
    next.cost[i] = cost[column];
    next.start[i] = start[column];
    cost[i - 2] = left.cost[i];
    start[i - 2] = left.start[i];
  }
  left = next;
}

void WriteResult(const TileRow& row, std::size_t from, std::size_t count, double template_columns,
                 double* HWY_RESTRICT delta, std::int32_t* HWY_RESTRICT start) {
  const double* costs = row.costs + kMargin;
  const double* starts = row.starts + kMargin;
  for (std::size_t i = from; i < count; ++i) {
    delta[i - from] = costs[i] / template_columns;
    start[i - from] = static_cast<std::int32_t>(starts[i]);
  }
}

// All rows of the tile that begins at `first_column`; returns the last.
TileRow& ScanTile(const ScanPlan& plan, const std::uint64_t* columns, std::size_t first_column,
                  std::size_t count, Workspace& work, std::vector<LeftColumns>& left) {
  SplitIntoNibbles(plan, columns + first_column, count, work);
  const std::vector<ScanRow>& rows = plan.rows();
  CountMismatches(rows[0], count, work);
  FillFirstRow(rows[0], first_column, count, work.rows[0], work);
  ExchangeLeftColumns(count, work.rows[0], left[0]);
  FillUnreachable(count, work.rows[1]);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    TileRow& one_up = work.rows[(k - 1) % 2];
    TileRow& row = work.rows[k % 2];
    CountMismatches(rows[k], count, work);
    if (plan.doubles_two_one()) {
      FillRow<true>(rows[k], count, one_up, row, work);
    } else {
      FillRow<false>(rows[k], count, one_up, row, work);
    }
    ExchangeLeftColumns(count, row, left[k]);
  }
  return work.rows[(rows.size() - 1) % 2];
}

void ScanRangeOnTarget(const ScanPlan& plan, const std::uint64_t* columns, std::size_t begin,
                       std::size_t end, double* delta, std::int32_t* start) {
  const std::size_t rows = plan.rows().size();
  // Paths that end in `begin` or later start at most this far before it. What lies further left is
  // taken for unreachable, which no cell of these paths notices.
  const std::size_t halo = std::min(begin, 2 * (rows - 1));
  const auto work = std::make_unique<Workspace>();
  std::vector<LeftColumns> left(rows);
  for (std::size_t tile = begin - halo; tile < end; tile += kTile) {
    const std::size_t count = std::min(kTile, end - tile);
    const TileRow& last = ScanTile(plan, columns, tile, count, *work, left);
    const std::size_t from = std::min(count, begin > tile ? begin - tile : 0);
    const std::size_t written = tile + from - begin;
    WriteResult(last, from, count, static_cast<double>(rows), delta + written, start + written);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kinebase::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kinebase::internal {

HWY_EXPORT(ScanRangeOnTarget);

void ScanRange(const ScanPlan& plan, std::span<const std::uint64_t> columns, std::size_t begin,
               std::size_t end, double* delta, std::int32_t* start) {
  if (plan.rows().empty()) {
    std::fill_n(delta, end - begin, std::numeric_limits<double>::infinity());
    std::fill_n(start, end - begin, -1);
    return;
  }
  HWY_DYNAMIC_DISPATCH(ScanRangeOnTarget)(plan, columns.data(), begin, end, delta, start);
}

}  // namespace kinebase::internal
#endif  // HWY_ONCE
