#include "kinebase/motion/c3d_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr double kResidualStepCm = .01;  // Of records that are made anew.
constexpr std::int64_t kLargestFrameNumber = 4294967295;

bool IsNumber(const C3dPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

Eigen::Vector3d PlaceOf(const C3dPoint& point) {
  return {static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z)};
}

void Report(Severity severity, std::string message, Diagnostics& diagnostics) {
  diagnostics.push_back({severity, std::move(message)});
}

// --- The way back.

bool HasFramesOf(const MarkerCloud& markers, const C3dRecording& base) {
  return base.frame_count == static_cast<std::size_t>(markers.frame_count) &&
         base.first_frame == markers.first_frame &&
         base.rate_hz == static_cast<float>(markers.rate_hz);
}

// What every reader expects to find (user guide, "Required parameters").
void AddRequired(C3dRecording& c3d) {
  const auto add = [&](std::string_view group, C3dParameter parameter) {
    if (FindParameter(c3d, group, parameter.name) == nullptr) {
      SetParameter(c3d, group, std::move(parameter));
    }
  };
  const auto empty = [](std::string_view name, std::vector<std::uint8_t> dimensions,
                        C3dValues values) {
    return C3dParameter{.name = std::string(name),
                        .dimensions = std::move(dimensions),
                        .values = std::move(values)};
  };
  using Reals = std::vector<float>;
  using Integers = std::vector<std::int16_t>;
  add("POINT", IntegerParameter("USED", 0));
  add("POINT", IntegerParameter("FRAMES", 0));
  add("POINT", IntegerParameter("DATA_START", 0));
  add("POINT", RealParameter("SCALE", -1));
  add("POINT", RealParameter("RATE", 0));
  add("ANALOG", IntegerParameter("USED", 0));
  add("ANALOG", empty("LABELS", {4, 0}, std::string()));
  add("ANALOG", empty("DESCRIPTIONS", {4, 0}, std::string()));
  add("ANALOG", RealParameter("GEN_SCALE", 1));
  add("ANALOG", empty("SCALE", {0}, Reals()));
  add("ANALOG", empty("OFFSET", {0}, Integers()));
  add("ANALOG", empty("UNITS", {4, 0}, std::string()));
  add("ANALOG", RealParameter("RATE", c3d.rate_hz * static_cast<float>(c3d.subframe_count)));
  add("FORCE_PLATFORM", IntegerParameter("USED", 0));
  add("FORCE_PLATFORM", empty("TYPE", {0}, Integers()));
  add("FORCE_PLATFORM", empty("ZERO", {2}, Integers{1, 0}));
  add("FORCE_PLATFORM", empty("CORNERS", {3, 4, 0}, Reals()));
  add("FORCE_PLATFORM", empty("ORIGIN", {3, 0}, Reals()));
  add("FORCE_PLATFORM", empty("CHANNEL", {6, 0}, Integers()));
}

// Analog samples and what belongs to them or to other times than the markers'.
void LeaveOutTimes(C3dRecording& c3d, Diagnostics& diagnostics) {
  const std::size_t events = Events(c3d).size();
  if (c3d.channel_count + events > 0) {
    Report(Severity::kWarning,
           fmt::format("{} analog channels and {} events are left out: they belong to other frames "
                       "or to another rate",
                       c3d.channel_count, events),
           diagnostics);
  }
  c3d.analog.clear();
  c3d.channel_count = 0;
  c3d.subframe_count = 0;
  c3d.trailing.clear();
  if (events > 0) SetEvents(c3d, {});
  // Some readers hold the rate against the samples in a frame, which are none.
  if (FindParameter(c3d, "ANALOG", "RATE") != nullptr) {
    SetParameter(c3d, "ANALOG", RealParameter("RATE", 0));
  }
  if (FindParameter(c3d, "FORCE_PLATFORM", "USED") != nullptr) {
    SetParameter(c3d, "FORCE_PLATFORM", IntegerParameter("USED", 0));
  }
}

// Force plates stand in the world, so they turn and grow with it.
void MovePlates(C3dRecording& c3d, const Eigen::Matrix3d& turn, double factor) {
  const auto move = [&](std::string_view name, const Eigen::Matrix3d& by) {
    const C3dParameter* found = FindParameter(c3d, "FORCE_PLATFORM", name);
    if (found == nullptr || !std::holds_alternative<std::vector<float>>(found->values)) return;
    C3dParameter parameter = *found;
    auto& values = std::get<std::vector<float>>(parameter.values);
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
      Eigen::Map<Eigen::Vector3f> place(values.data() + i);
      place = (by * place.cast<double>()).cast<float>();
    }
    SetParameter(c3d, "FORCE_PLATFORM", std::move(parameter));
  };
  move("CORNERS", turn * factor);
  move("ORIGIN", Eigen::Matrix3d::Identity() * factor);
}

// The record to fill: the base's parameters and, where they belong to these frames, its data.
C3dRecording StartFrom(const MarkerCloud& markers, const C3dWriteOptions& options,
                       double cm_per_unit, Diagnostics& diagnostics) {
  C3dRecording c3d;
  c3d.scale = static_cast<float>(kResidualStepCm / cm_per_unit);
  if (options.base.recording != nullptr) {
    const C3dRecording& base = *options.base.recording;
    const double factor = options.base.cm_per_unit / cm_per_unit;
    c3d = base;
    c3d.diagnostics.clear();
    ChangeStorage(c3d, C3dStorage::kFloat);
    c3d.processor = C3dProcessor::kIntel;
    if (factor != 1) c3d.scale = static_cast<float>(static_cast<double>(c3d.scale) * factor);
    if (!HasFramesOf(markers, base)) LeaveOutTimes(c3d, diagnostics);
    MovePlates(c3d, ToYUp(options.up).transpose() * ToYUp(options.base.up), factor);
  }
  c3d.frame_count = static_cast<std::size_t>(markers.frame_count);
  c3d.rate_hz = static_cast<float>(markers.rate_hz);
  c3d.first_frame = markers.first_frame;
  if (c3d.first_frame < 0 || c3d.first_frame > kLargestFrameNumber - markers.frame_count) {
    Report(
        Severity::kWarning,
        fmt::format("C3D cannot number frames from {}; they are numbered from 1", c3d.first_frame),
        diagnostics);
    c3d.first_frame = 1;
  }
  return c3d;
}

// Which points of the base take the markers, one by one; empty if they are others.
std::vector<std::size_t> MatchingPlaces(const MarkerCloud& markers, const C3dBase& base) {
  if (base.recording == nullptr || !HasFramesOf(markers, *base.recording)) return {};
  std::vector<std::size_t> places = PlacesAmongPoints(*base.recording);
  if (places.size() != markers.labels.size()) places.clear();
  return places;
}

// `known` is the point as it was before, or a measured one of which nothing is known.
C3dPoint PointOf(const Eigen::Vector3d& place, MarkerState state, const C3dPoint& known) {
  if (state == MarkerState::kMissing || !place.allFinite()) return {.quality = -1};
  const Eigen::Vector3f written = place.cast<float>();
  C3dPoint point{.x = written.x(), .y = written.y(), .z = written.z()};
  const bool was_measured = known.is_valid() && known.residual_steps() > 0;
  point.quality = state == MarkerState::kFilled
                      ? static_cast<float>(known.is_valid() ? known.camera_mask() * 256 : 0)
                      : (was_measured ? known.quality : 1);
  return point;
}

// Whether the record, as its base did, says already which axis points up.
bool TellsUpAxis(const C3dRecording& c3d, const C3dWriteOptions& options) {
  if (options.base.recording == nullptr || options.base.up != options.up) return false;
  Diagnostics ignored;
  return FindParameter(c3d, "POINT", "Y_SCREEN") != nullptr &&
         FindUpAxis(c3d, ignored) == options.up;
}

// diagnostics  Labels that are too long.
void SetLabels(C3dRecording& c3d, const std::vector<std::string>& labels,
               Diagnostics& diagnostics) {
  constexpr std::size_t kLongest = 255;
  const auto long_ones = std::ranges::count_if(
      labels, [](const std::string& label) { return label.size() > kLongest; });
  if (long_ones > 0) {
    Report(Severity::kWarning,
           fmt::format("{} labels are longer than {} bytes and are cut", long_ones, kLongest),
           diagnostics);
  }
  SetTextList(c3d, "POINT", "LABELS", labels);
}

}  // namespace

MarkerCloud BuildMarkers(const C3dRecording& recording, const C3dBuildOptions& options,
                         Diagnostics& diagnostics) {
  if (recording.frame_count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("has {} frames; up to {} can be taken", recording.frame_count,
                            std::numeric_limits<int>::max()));
  }
  const std::vector<std::size_t> places = PlacesAmongPoints(recording);
  const std::vector<std::string> labels = PointLabels(recording);
  MarkerCloud markers{.rate_hz = options.rate_hz,
                      .frame_count = static_cast<int>(recording.frame_count),
                      .first_frame = recording.first_frame};
  for (const std::size_t i : places) markers.labels.push_back(labels[i]);
  markers.positions_cm.reserve(recording.points.empty() ? 0
                                                        : places.size() * recording.frame_count);
  markers.states.reserve(markers.positions_cm.capacity());
  const Eigen::Matrix3d to_world_cm = ToYUp(options.up) * options.cm_per_unit;
  std::size_t at_origin = 0;
  std::size_t no_number = 0;
  for (std::size_t frame = 0; !places.empty() && frame < recording.frame_count; ++frame) {
    for (const std::size_t i : places) {
      const C3dPoint& point = recording.point(frame, i);
      const bool is_origin = point.x == 0 && point.y == 0 && point.z == 0;
      if (!point.is_valid() || is_origin || !IsNumber(point)) {
        if (point.is_valid()) ++(is_origin ? at_origin : no_number);
        markers.positions_cm.push_back(MissingPosition());
        markers.states.push_back(MarkerState::kMissing);
        continue;
      }
      markers.positions_cm.emplace_back(to_world_cm * PlaceOf(point));
      markers.states.push_back(point.residual_steps() == 0 ? MarkerState::kFilled
                                                           : MarkerState::kMeasured);
    }
  }
  if (places.size() < recording.point_count) {
    Report(Severity::kInfo,
           fmt::format("{} of {} points are angles, forces and the like, not places; they are no "
                       "markers",
                       recording.point_count - places.size(), recording.point_count),
           diagnostics);
  }
  if (at_origin > 0) {
    Report(Severity::kWarning,
           fmt::format("{} samples at (0, 0, 0) are taken as missing", at_origin), diagnostics);
  }
  if (no_number > 0) {
    Report(Severity::kWarning,
           fmt::format("{} samples that are no numbers are taken as missing", no_number),
           diagnostics);
  }
  return markers;
}

C3dRecording ToC3d(const MarkerCloud& markers, const C3dWriteOptions& options,
                   Diagnostics& diagnostics) {
  const double cm_per_unit = CentimetresInOrFail(options.units);
  C3dRecording c3d = StartFrom(markers, options, cm_per_unit, diagnostics);
  std::vector<std::size_t> places = MatchingPlaces(markers, options.base);
  const std::size_t count = markers.labels.size();
  if (places.empty()) {
    if (options.base.recording != nullptr && c3d.point_count > count) {
      Report(Severity::kWarning,
             fmt::format("{} of {} points are left out", c3d.point_count - count, c3d.point_count),
             diagnostics);
    }
    c3d.point_count = count;
    c3d.points.assign(c3d.frame_count * count, C3dPoint{.quality = 1});
    for (std::size_t i = 0; i < count; ++i) places.push_back(i);
  }
  std::vector<std::string> labels = PointLabels(c3d);
  for (std::size_t i = 0; i < count; ++i) labels[places[i]] = markers.labels[i];
  const Eigen::Matrix3d to_file = ToYUp(options.up).transpose() / cm_per_unit;
  for (std::size_t frame = 0; count > 0 && frame < c3d.frame_count; ++frame) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t index = frame * count + i;
      C3dPoint& point = c3d.points[frame * c3d.point_count + places[i]];
      point = PointOf(to_file * markers.positions_cm[index], markers.states[index], point);
    }
  }
  AddRequired(c3d);
  SetLabels(c3d, labels, diagnostics);
  SetUnits(c3d, options.units);
  if (!TellsUpAxis(c3d, options)) SetUpAxis(c3d, options.up);
  return c3d;
}

}  // namespace kinebase
