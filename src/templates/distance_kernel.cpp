#include "templates/distance_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "templates/distance_kernel.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace kinebase::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Sums of 1, 2 or 4 neighbouring vectors stay in registers over all features. More of them hide how
// long an addition takes.
template <int kVectors>
HWY_INLINE void SumBlock(std::span<const double> values, std::span<const int> features,
                         const double* HWY_RESTRICT rows, std::size_t stride,
                         double* HWY_RESTRICT sums) {
  const hn::CappedTag<double, 8> tag;
  const std::size_t lanes = hn::Lanes(tag);
  auto sum0 = hn::Zero(tag);
  auto sum1 = sum0;
  auto sum2 = sum0;
  auto sum3 = sum0;
  for (const int feature : features) {
    const auto value = hn::Set(tag, values[feature]);
    const double* row = rows + stride * static_cast<std::size_t>(feature);
    const auto distance = [&](std::size_t vector) {
      return hn::Abs(hn::Sub(value, hn::LoadU(tag, row + vector * lanes)));
    };
    sum0 = hn::Add(sum0, distance(0));
    if constexpr (kVectors > 1) sum1 = hn::Add(sum1, distance(1));
    if constexpr (kVectors > 2) {
      sum2 = hn::Add(sum2, distance(2));
      sum3 = hn::Add(sum3, distance(3));
    }
  }
  hn::StoreU(sum0, tag, sums);
  if constexpr (kVectors > 1) hn::StoreU(sum1, tag, sums + lanes);
  if constexpr (kVectors > 2) {
    hn::StoreU(sum2, tag, sums + 2 * lanes);
    hn::StoreU(sum3, tag, sums + 3 * lanes);
  }
}

void SumDistancesOnTarget(std::span<const double> values, std::span<const int> features,
                          const double* rows, std::size_t stride, double* sums) {
  const std::size_t lanes = hn::Lanes(hn::CappedTag<double, 8>());
  std::size_t column = 0;
  for (; column + 4 * lanes <= stride; column += 4 * lanes) {
    SumBlock<4>(values, features, rows + column, stride, sums + column);
  }
  for (; column + 2 * lanes <= stride; column += 2 * lanes) {
    SumBlock<2>(values, features, rows + column, stride, sums + column);
  }
  for (; column < stride; column += lanes) {
    SumBlock<1>(values, features, rows + column, stride, sums + column);
  }
}

void WeighDistancesOnTarget(double feature_count, double weight, const double* HWY_RESTRICT weights,
                            std::size_t stride, double* HWY_RESTRICT costs) {
  const hn::CappedTag<double, 8> tag;
  for (std::size_t column = 0; column < stride; column += hn::Lanes(tag)) {
    const auto per_feature = hn::Div(hn::LoadU(tag, costs + column), hn::Set(tag, feature_count));
    const auto both = hn::Add(hn::Set(tag, weight), hn::LoadU(tag, weights + column));
    // Half of a double is exact, so this is the division by 2.
    const auto mean = hn::Mul(both, hn::Set(tag, 0.5));
    hn::StoreU(hn::Mul(per_feature, mean), tag, costs + column);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kinebase::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kinebase::internal {

HWY_EXPORT(SumDistancesOnTarget);
HWY_EXPORT(WeighDistancesOnTarget);

void SumDistances(std::span<const double> values, std::span<const int> features, const double* rows,
                  std::size_t stride, double* sums) {
  HWY_DYNAMIC_DISPATCH(SumDistancesOnTarget)(values, features, rows, stride, sums);
}

void WeighDistances(double feature_count, double weight, const double* weights, std::size_t stride,
                    double* costs) {
  HWY_DYNAMIC_DISPATCH(WeighDistancesOnTarget)(feature_count, weight, weights, stride, costs);
}

}  // namespace kinebase::internal
#endif  // HWY_ONCE
