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
#include "search/reference_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "search/kernels/scan_kernel.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "search/kernels/tile-inl.h"

#ifndef KINEBASE_SCAN_KERNEL_ONCE
#define KINEBASE_SCAN_KERNEL_ONCE
namespace kinebase::internal {

// Two rows of costs and starts, 16 bytes a column each, and 10 nibbles: about 22 KiB of the 32 KiB
// that common processors have.
inline constexpr std::size_t kTile = 512;
inline constexpr std::size_t kMostLanes = 8;
inline constexpr std::size_t kMargin = 2 * kMostLanes;

// One number for each column of a tile, in stripes (search/kernels/tile-inl.h).
struct StripedNumbers {
  alignas(64) double numbers[kMargin + kTile];

  double* vectors() { return numbers + kMargin; }
  const double* vectors() const { return numbers + kMargin; }
};

// A row of the cost table within a tile. Starts are doubles so that the mask of a cost comparison
// selects them directly; every column number below 2^53 is exact.
struct TileRow {
  StripedNumbers costs;
  StripedNumbers starts;
};

// The two columns before a tile in one row.
struct LeftColumns {
  double cost[2] = {std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  double start[2] = {-1, -1};
};

}  // namespace kinebase::internal
#endif  // KINEBASE_SCAN_KERNEL_ONCE

HWY_BEFORE_NAMESPACE();
namespace kinebase::internal {
namespace HWY_NAMESPACE {

// The cap keeps its length a divisor of the tile, however long a machine's vectors are.
using DoublesTag = hn::CappedTag<double, kMostLanes>;

struct Workspace {
  TileRow rows[2];
  TileFeatures<kTile> features;
};

// Local costs of the vector that begins at number i.
HWY_INLINE hn::Vec<DoublesTag> LocalCosts(const Workspace& work, std::size_t i,
                                          hn::Vec<DoublesTag> scale) {
  const DoublesTag tag;
  const hn::Rebind<std::int32_t, DoublesTag> ints;
  const hn::Rebind<std::uint8_t, DoublesTag> bytes;
  const auto counts = hn::PromoteTo(ints, hn::LoadU(bytes, work.features.sums + i));
  return hn::Mul(hn::PromoteTo(tag, counts), scale);
}

// Every column is a start.
void FillFirstRow(const ScanRow& scan_row, std::size_t first_column, const Stripes& stripes,
                  const Workspace& work, TileRow& row) {
  const DoublesTag tag;
  const auto scale = hn::Set(tag, scan_row.scale);
  const auto stripe_starts =
      hn::Mul(hn::Iota(tag, 0.0), hn::Set(tag, static_cast<double>(stripes.length)));
  for (std::size_t v = 0; v < stripes.length; ++v) {
    const std::size_t i = v * stripes.lanes;
    const auto column = hn::Set(tag, static_cast<double>(first_column + v));
    hn::Store(LocalCosts(work, i, scale), tag, row.costs.vectors() + i);
    hn::Store(hn::Add(column, stripe_starts), tag, row.starts.vectors() + i);
  }
}

void FillUnreachable(TileRow& row) {
  std::ranges::fill(row.costs.numbers, std::numeric_limits<double>::infinity());
  std::ranges::fill(row.starts.numbers, -1.0);
}

// `row` holds row k−2 and becomes row k. What the next vector needs of the old row is read before
// it is overwritten.
template <bool kDoublesTwoOne>
void FillRow(const ScanRow& scan_row, const Stripes& stripes, const Workspace& work,
             const TileRow& one_up, TileRow& row) {
  const DoublesTag tag;
  const std::ptrdiff_t lanes = static_cast<std::ptrdiff_t>(stripes.lanes);
  const std::ptrdiff_t end = static_cast<std::ptrdiff_t>(stripes.padded_count());
  const auto scale = hn::Set(tag, scan_row.scale);
  const double* HWY_RESTRICT up_costs = one_up.costs.vectors();
  const double* HWY_RESTRICT up_starts = one_up.starts.vectors();
  double* HWY_RESTRICT costs = row.costs.vectors();
  double* HWY_RESTRICT starts = row.starts.vectors();
  auto one_one = hn::Load(tag, up_costs - lanes);
  auto one_two = hn::Load(tag, up_costs - 2 * lanes);
  auto two_one = hn::Load(tag, costs - lanes);
  auto one_one_start = hn::Load(tag, up_starts - lanes);
  auto one_two_start = hn::Load(tag, up_starts - 2 * lanes);
  auto two_one_start = hn::Load(tag, starts - lanes);
  for (std::ptrdiff_t i = 0; i < end; i += lanes) {
    const auto takes_one_two = hn::Lt(one_two, one_one);
    const auto one_best = hn::Min(one_two, one_one);
    const auto takes_two_one = hn::Lt(two_one, one_best);
    const auto best = hn::Min(two_one, one_best);
    const auto one_start = hn::IfThenElse(takes_one_two, one_two_start, one_one_start);
    const auto best_start = hn::IfThenElse(takes_two_one, two_one_start, one_start);
    auto added = LocalCosts(work, static_cast<std::size_t>(i), scale);
    if constexpr (kDoublesTwoOne) {
      added = hn::Add(added, hn::IfThenElseZero(takes_two_one, added));
    }
    one_two = one_one;
    one_two_start = one_one_start;
    one_one = hn::Load(tag, up_costs + i);
    one_one_start = hn::Load(tag, up_starts + i);
    two_one = hn::Load(tag, costs + i);
    two_one_start = hn::Load(tag, starts + i);
    hn::Store(hn::Add(best, added), tag, costs + i);
    hn::Store(best_start, tag, starts + i);
  }
}

void WriteResult(const TileRow& row, const Stripes& stripes, std::size_t from,
                 double template_columns, double* HWY_RESTRICT delta,
                 std::int32_t* HWY_RESTRICT start) {
  const double* costs = row.costs.vectors();
  const double* starts = row.starts.vectors();
  std::size_t column = 0;
  for (std::size_t lane = 0; lane < stripes.lanes; ++lane) {
    for (std::size_t v = 0; v < stripes.length && column < stripes.count; ++v, ++column) {
      if (column < from) continue;
      delta[column - from] = costs[v * stripes.lanes + lane] / template_columns;
      start[column - from] = static_cast<std::int32_t>(starts[v * stripes.lanes + lane]);
    }
  }
}

// All rows of the tile that begins at `first_column`; returns the last.
const TileRow& ScanTile(const ScanPlan& plan, const std::uint64_t* columns,
                        std::size_t first_column, const Stripes& stripes, Workspace& work,
                        std::vector<LeftColumns>& left) {
  StripeWords(columns + first_column, stripes, work.features);
  SplitIntoNibbles(stripes.padded_count(), work.features);
  const std::vector<ScanRow>& rows = plan.rows();
  FillUnreachable(work.rows[1]);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const TileRow& one_up = work.rows[(k + 1) % 2];
    TileRow& row = work.rows[k % 2];
    SumTables(rows[k].tables, stripes.padded_count(), work.features);
    if (k == 0) {
      FillFirstRow(rows[k], first_column, stripes, work, row);
    } else if (plan.doubles_two_one()) {
      FillRow<true>(rows[k], stripes, work, one_up, row);
    } else {
      FillRow<false>(rows[k], stripes, work, one_up, row);
    }
    LinkStripes(DoublesTag(), stripes, row.costs.vectors(), left[k].cost);
    LinkStripes(DoublesTag(), stripes, row.starts.vectors(), left[k].start);
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
    const Stripes stripes(std::min(kTile, end - tile), hn::Lanes(DoublesTag()));
    const TileRow& last = ScanTile(plan, columns, tile, stripes, *work, left);
    // A tile may lie in the halo altogether.
    const std::size_t from = std::min(stripes.count, begin > tile ? begin - tile : 0);
    if (from == stripes.count) continue;
    const std::size_t written = tile + from - begin;
    WriteResult(last, stripes, from, static_cast<double>(rows), delta + written, start + written);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kinebase::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kinebase::internal {

HWY_EXPORT(ScanRangeOnTarget);

// Entry weights cannot be counted in bytes.
void ScanWeighted(const ScanPlan& plan, std::span<const std::uint64_t> columns, std::size_t begin,
                  std::size_t end, double* delta, std::int32_t* start) {
  constexpr std::size_t kWeightedTile = 4096;  // Three rows of it stay in the second-level cache.
  const std::size_t rows = plan.rows().size();
  const Profile matching = plan.doubles_two_one() ? Profile::kBonn : Profile::kPaper;
  for (std::size_t tile = begin; tile < end; tile += kWeightedTile) {
    const std::size_t tile_end = std::min(end, tile + kWeightedTile);
    const std::size_t halo = std::min(tile, 2 * (rows - 1));
    const std::size_t first = tile - halo;
    const DeltaCurve curve =
        ComputeDelta(plan.costs(), rows, matching, columns.subspan(first, tile_end - first));
    for (std::size_t i = halo; i < curve.delta.size(); ++i) {
      delta[first + i - begin] = curve.delta[i];
      const std::int32_t local = curve.start[i];
      start[first + i - begin] = local < 0 ? -1 : local + static_cast<std::int32_t>(first);
    }
  }
}

void ScanRange(const ScanPlan& plan, std::span<const std::uint64_t> columns, std::size_t begin,
               std::size_t end, double* delta, std::int32_t* start) {
  if (plan.rows().empty()) {
    std::fill_n(delta, end - begin, std::numeric_limits<double>::infinity());
    std::fill_n(start, end - begin, -1);
    return;
  }
  if (plan.costs().has_weights()) {
    ScanWeighted(plan, columns, begin, end, delta, start);
    return;
  }
  HWY_DYNAMIC_DISPATCH(ScanRangeOnTarget)(plan, columns.data(), begin, end, delta, start);
}

}  // namespace kinebase::internal
#endif  // HWY_ONCE
