#include "search/reference_kernel.h"

#include "search/plain_scan.h"

namespace kinebase {
namespace internal {

DeltaCurve ComputeDelta(const LocalCosts& costs, std::size_t rows, Profile matching,
                        std::span<const std::uint64_t> columns) {
  return ScanPlainly(static_cast<int>(rows), columns.size(), matching, [&](int k, std::size_t l) {
    return costs.At(static_cast<std::size_t>(k), columns[l]);
  });
}

}  // namespace internal

DeltaCurve ComputeDeltaReference(const QuantizedTemplate& motion_template,
                                 std::span<const std::uint64_t> columns) {
  return internal::ComputeDelta(internal::LocalCosts(motion_template),
                                motion_template.columns.size(), motion_template.matching, columns);
}

}  // namespace kinebase
