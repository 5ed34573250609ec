#include "kinebase/motion/trc_motion.h"

#include <cmath>
#include <span>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/motion.h"
#include "motion/point_writing.h"

namespace kinebase {
namespace {

constexpr double kDigitsPerMillimetre = 1e6;
constexpr double kCmPerMillimetre = .1;

bool IsRate(double rate_hz) { return rate_hz >= kSmallestRateHz && rate_hz <= kLargestRateHz; }

// Times have a few digits only: a rate next to a whole number is that.
double Snapped(double rate_hz) {
  const double whole = std::round(rate_hz);
  return std::abs(rate_hz - whole) <= whole * 1e-3 ? whole : rate_hz;
}

}  // namespace

MarkerCloud BuildMarkers(const TrcRecording& trc, const TrcBuildOptions& options,
                         Diagnostics& diagnostics) {
  MarkerCloud markers{.labels = trc.labels,
                      .rate_hz = options.rate_hz,
                      .frame_count = internal::FrameCountOrFail(trc.frame_count()),
                      .first_frame = trc.frame_numbers.empty() ? 1 : trc.frame_numbers.front()};
  const Eigen::Matrix3d to_world_cm = ToYUp(options.up) * options.cm_per_unit;
  markers.positions_cm.reserve(trc.values.size() / 3);
  markers.states.reserve(trc.values.size() / 3);
  std::size_t incomplete = 0;
  for (std::size_t i = 0; i + 2 < trc.values.size(); i += 3) {
    const Eigen::Vector3d place(trc.values.data() + i);
    const bool is_missing = !place.allFinite();
    incomplete += is_missing && !place.array().isNaN().all() ? 1 : 0;
    markers.states.push_back(is_missing ? MarkerState::kMissing : MarkerState::kMeasured);
    markers.positions_cm.emplace_back(is_missing ? MissingPosition()
                                                 : Eigen::Vector3d(to_world_cm * place));
  }
  if (incomplete > 0) {
    diagnostics.push_back(
        {Severity::kWarning,
         fmt::format("{} places with one or two values missing are taken as missing", incomplete)});
  }
  return markers;
}

double FindRate(const TrcRecording& trc, Diagnostics& diagnostics) {
  const double told_hz = trc.data_rate_hz.value_or(0);
  if (IsRate(told_hz)) return told_hz;
  if (trc.frame_count() < 2) return 0;
  const auto frames = static_cast<double>(trc.frame_numbers.back()) -
                      static_cast<double>(trc.frame_numbers.front());
  const double rate_hz = Snapped(frames / (trc.times_s.back() - trc.times_s.front()));
  if (!IsRate(rate_hz)) return 0;
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format("the header tells no rate; the times make it {:g} Hz", rate_hz)});
  return rate_hz;
}

TrcRecording ToTrc(const MarkerCloud& markers, const TrcWriteOptions& options,
                   Diagnostics& diagnostics) {
  const double cm_per_unit = CentimetresInOrFail(options.units);
  TrcRecording trc{.file_name = options.file_name,
                   .data_rate_hz = markers.rate_hz,
                   .camera_rate_hz = markers.rate_hz,
                   .units = options.units,
                   .original_rate_hz = markers.rate_hz,
                   .original_first_frame = markers.first_frame,
                   .original_frame_count = markers.frame_count};
  trc.labels = internal::WritableLabels(markers.labels, "\t", ' ', diagnostics);
  const Eigen::Matrix3d to_file = ToYUp(options.up).transpose() / cm_per_unit;
  const double digits = kDigitsPerMillimetre * std::max(1.0, cm_per_unit / kCmPerMillimetre);
  for (int frame = 0; frame < markers.frame_count; ++frame) {
    const std::int64_t number = markers.first_frame + frame;
    trc.frame_numbers.push_back(number);
    trc.times_s.push_back(static_cast<double>(number - 1) / markers.rate_hz);
  }
  trc.values.reserve(markers.positions_cm.size() * 3);
  for (std::size_t i = 0; i < markers.positions_cm.size(); ++i) {
    const bool is_missing = markers.states[i] == MarkerState::kMissing;
    const Eigen::Vector3d place =
        is_missing ? MissingPosition() : Eigen::Vector3d(to_file * markers.positions_cm[i]);
    for (const double value : place) trc.values.push_back(internal::RoundedPlace(value, digits));
  }
  return trc;
}

}  // namespace kinebase
