#include "hwy/targets.h"
#include "kinebase/search/subsequence_dtw.h"
#include "search/kernels/scan_plan.h"

namespace kinebase {

DeltaCurve ComputeDelta(const QuantizedTemplate& motion_template,
                        std::span<const std::uint64_t> columns) {
  DeltaCurve curve;
  curve.delta.resize(columns.size());
  curve.start.resize(columns.size());
  internal::ScanRange(internal::ScanPlan(motion_template), columns, 0, columns.size(),
                      curve.delta.data(), curve.start.data());
  return curve;
}

std::vector<std::int64_t> SupportedDeltaTargets() { return hwy::SupportedAndGeneratedTargets(); }

const char* DeltaTargetName(std::int64_t target) { return hwy::TargetName(target); }

void UseDeltaTarget(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace kinebase
