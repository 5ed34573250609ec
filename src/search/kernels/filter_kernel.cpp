// Bounds of what paths cost, 16 bits a cell: twice to four times as many side by side as exactly.
// Read search/kernels/filter_plan.h first; the shape is scan_kernel.cpp's, without starts.
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "search/kernels/filter_plan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "search/kernels/filter_kernel.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "search/kernels/tile-inl.h"

#ifndef KINEBASE_FILTER_KERNEL_ONCE
#define KINEBASE_FILTER_KERNEL_ONCE
namespace kinebase::internal {

// Two rows of bounds, 2 bytes a column each, 10 nibbles and a sum: about 15 KiB.
inline constexpr std::size_t kFilterTile = 1024;
inline constexpr std::size_t kFilterLanes = 32;
inline constexpr std::uint16_t kRuledOut = std::numeric_limits<std::uint16_t>::max();

// Striped, with two vectors in front.
struct BoundRow {
  alignas(64) std::uint16_t numbers[2 * kFilterLanes + kFilterTile];

  std::uint16_t* vectors() { return numbers + 2 * kFilterLanes; }
  const std::uint16_t* vectors() const { return numbers + 2 * kFilterLanes; }
};

// The two columns before a tile in one row.
struct LeftBounds {
  std::uint16_t bound[2] = {kRuledOut, kRuledOut};
};

}  // namespace kinebase::internal
#endif  // KINEBASE_FILTER_KERNEL_ONCE

HWY_BEFORE_NAMESPACE();
namespace kinebase::internal {
namespace HWY_NAMESPACE {

using BoundsTag = hn::CappedTag<std::uint16_t, kFilterLanes>;

struct FilterWorkspace {
  BoundRow rows[2];
  TileFeatures<kFilterTile> features;
};

HWY_INLINE hn::Vec<BoundsTag> LocalBounds(const FilterWorkspace& work, std::size_t i,
                                          hn::Vec<BoundsTag> factor) {
  const BoundsTag tag;
  const hn::Rebind<std::uint8_t, BoundsTag> bytes;
  return hn::Mul(hn::PromoteTo(tag, hn::LoadU(bytes, work.features.sums + i)), factor);
}

// `row` holds row k−2 and becomes row k.
template <bool kDoublesTwoOne>
void BoundRowOf(const FilterRow& filter_row, const Stripes& stripes, const FilterWorkspace& work,
                const BoundRow& one_up, BoundRow& row) {
  const BoundsTag tag;
  const std::ptrdiff_t lanes = static_cast<std::ptrdiff_t>(stripes.lanes);
  const std::ptrdiff_t end = static_cast<std::ptrdiff_t>(stripes.padded_count());
  const auto factor = hn::Set(tag, filter_row.factor);
  const std::uint16_t* HWY_RESTRICT up = one_up.vectors();
  std::uint16_t* HWY_RESTRICT bounds = row.vectors();
  auto one_one = hn::Load(tag, up - lanes);
  auto one_two = hn::Load(tag, up - 2 * lanes);
  auto two_one = hn::Load(tag, bounds - lanes);
  for (std::ptrdiff_t i = 0; i < end; i += lanes) {
    const auto local = LocalBounds(work, static_cast<std::size_t>(i), factor);
    const auto one = hn::SaturatedAdd(hn::Min(one_one, one_two), local);
    const auto twice = kDoublesTwoOne ? hn::SaturatedAdd(local, local) : local;
    const auto best = hn::Min(one, hn::SaturatedAdd(two_one, twice));
    one_two = one_one;
    one_one = hn::Load(tag, up + i);
    two_one = hn::Load(tag, bounds + i);
    hn::Store(best, tag, bounds + i);
  }
}

void BoundFirstRow(const FilterRow& filter_row, const Stripes& stripes, const FilterWorkspace& work,
                   BoundRow& row) {
  const BoundsTag tag;
  const auto factor = hn::Set(tag, filter_row.factor);
  for (std::size_t i = 0; i < stripes.padded_count(); i += stripes.lanes) {
    hn::Store(LocalBounds(work, i, factor), tag, row.vectors() + i);
  }
}

// All rows of the tile that begins at `first_column`; returns the last.
const BoundRow& BoundTile(const FilterPlan& plan, const std::uint64_t* columns,
                          std::size_t first_column, const Stripes& stripes, FilterWorkspace& work,
                          std::vector<LeftBounds>& left) {
  StripeWords(columns + first_column, stripes, work.features);
  SplitIntoNibbles(stripes.padded_count(), work.features);
  const std::vector<FilterRow>& rows = plan.rows();
  std::ranges::fill(work.rows[1].numbers, kRuledOut);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const BoundRow& one_up = work.rows[(k + 1) % 2];
    BoundRow& row = work.rows[k % 2];
    SumTables(rows[k].tables, stripes.padded_count(), work.features);
    if (k == 0) {
      BoundFirstRow(rows[k], stripes, work, row);
    } else if (plan.doubles_two_one()) {
      BoundRowOf<true>(rows[k], stripes, work, one_up, row);
    } else {
      BoundRowOf<false>(rows[k], stripes, work, one_up, row);
    }
    LinkStripes(BoundsTag(), stripes, row.vectors(), left[k].bound);
  }
  return work.rows[(rows.size() - 1) % 2];
}

bool AnyWithin(const BoundRow& row, const Stripes& stripes, std::uint16_t limit) {
  const BoundsTag tag;
  auto least = hn::Set(tag, kRuledOut);
  for (std::size_t i = 0; i < stripes.padded_count(); i += stripes.lanes) {
    least = hn::Min(least, hn::Load(tag, row.vectors() + i));
  }
  return !hn::AllFalse(tag, hn::Eq(hn::Min(least, hn::Set(tag, limit)), least));
}

// Adds the columns of a tile, from the one at `from`, that are not ruled out.
void AppendLeft(const BoundRow& row, const Stripes& stripes, std::size_t from, std::uint16_t limit,
                std::size_t first_column, std::size_t most_apart, std::vector<ColumnRun>& runs) {
  std::size_t i = 0;
  for (std::size_t lane = 0; lane < stripes.lanes; ++lane) {
    for (std::size_t v = 0; v < stripes.length && i < stripes.count; ++v, ++i) {
      if (i < from || row.vectors()[v * stripes.lanes + lane] > limit) continue;
      const std::size_t column = first_column + i;
      if (runs.empty() || column - runs.back().last > most_apart) runs.push_back({column, column});
      runs.back().last = column;
    }
  }
}

// Runs that are nearer are one: for a template of one column, too, a run has its price.
constexpr std::size_t kLeastApart = 64;

void FilterRangeOnTarget(const FilterPlan& plan, const std::uint64_t* columns, std::size_t begin,
                         std::size_t end, std::vector<ColumnRun>& runs) {
  const std::size_t rows = plan.rows().size();
  // Both as in scan_kernel.cpp: what lies further left no path from there reaches.
  const std::size_t reach = 2 * (rows - 1);
  const std::size_t halo = std::min(begin, reach);
  // Not zeroed: that would cost more than a short recording takes. Nothing is read before it is
  // written but the padding of a tile, whose bounds nobody looks at.
  const auto work = std::make_unique_for_overwrite<FilterWorkspace>();
  std::vector<LeftBounds> left(rows);
  for (std::size_t tile = begin - halo; tile < end; tile += kFilterTile) {
    const Stripes stripes(std::min(kFilterTile, end - tile), hn::Lanes(BoundsTag()));
    const BoundRow& last = BoundTile(plan, columns, tile, stripes, *work, left);
    const std::size_t from = std::min(stripes.count, begin > tile ? begin - tile : 0);
    if (from == stripes.count || !AnyWithin(last, stripes, plan.limit())) continue;
    AppendLeft(last, stripes, from, plan.limit(), tile, std::max(reach, kLeastApart), runs);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kinebase::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kinebase::internal {

HWY_EXPORT(FilterRangeOnTarget);

std::vector<ColumnRun> FilterRange(const FilterPlan& plan, std::span<const std::uint64_t> columns,
                                   std::size_t begin, std::size_t end) {
  std::vector<ColumnRun> runs;
  HWY_DYNAMIC_DISPATCH(FilterRangeOnTarget)(plan, columns.data(), begin, end, runs);
  return runs;
}

}  // namespace kinebase::internal
#endif  // HWY_ONCE
