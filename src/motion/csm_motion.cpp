#include "kinebase/motion/csm_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "motion/point_writing.h"

namespace kinebase {
namespace {

using Need = PresetMarker::Need;

constexpr double kCmPerMillimetre = .1;

bool IsMissing(std::span<const double> point) {
  return std::ranges::any_of(point, [](double value) { return !std::isfinite(value); });
}

// "LWRA" for "LWRE": the marker of the same wrist's band that stands for one of its stick.
std::optional<std::string_view> BandOfStick(std::string_view stick) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kPairs = {
      {{"LWRE", "LWRA"}, {"LWRI", "LWRB"}, {"RWRE", "RWRA"}, {"RWRI", "RWRB"}}};
  for (const auto& [each, band] : kPairs) {
    if (EqualsIgnoringCase(each, stick)) return band;
  }
  return std::nullopt;
}

std::vector<std::string> WithoutSubjects(std::span<const std::string> labels,
                                         Diagnostics& diagnostics) {
  std::map<std::string_view, int> count;
  for (const auto& label : labels) ++count[BareLabel(label)];
  std::vector<std::string> result;
  std::string example;
  for (const auto& label : labels) {
    const std::string_view bare = BareLabel(label);
    const bool is_unique = !bare.empty() && count[bare] == 1;
    if (is_unique && bare.size() != label.size() && example.empty()) example = label;
    result.emplace_back(is_unique ? bare : std::string_view(label));
  }
  if (!example.empty()) {
    diagnostics.push_back(
        {Severity::kInfo, fmt::format("markers are written without their "
                                      "subject's name: {} as {}",
                                      Quoted(example), Quoted(BareLabel(example)))});
  }
  return result;
}

std::set<std::string> LowerCaseNames(std::span<const std::string> labels) {
  std::set<std::string> names;
  for (const auto& label : labels) names.insert(ToLower(BareLabel(label)));
  return names;
}

bool HasAll(const std::set<std::string>& names, char side, Need need) {
  return std::ranges::all_of(PresetMarkers(), [&](const PresetMarker& marker) {
    return marker.need != need || marker.name.front() != side ||
           names.contains(ToLower(marker.name));
  });
}

bool HasAny(const std::set<std::string>& names, char side, Need need) {
  return std::ranges::any_of(PresetMarkers(), [&](const PresetMarker& marker) {
    return marker.need == need && marker.name.front() == side &&
           names.contains(ToLower(marker.name));
  });
}

void Append(std::string& list, const std::string& item) {
  list.append(list.empty() ? "" : ", ").append(item);
}

// What is odd about markers that were named by a table, `fitting` of which have a row there.
// hint  Where in a line the names before stand.
void ReportNaming(const MarkerNames& names, std::span<const std::string> before,
                  std::size_t fitting, const std::vector<std::string>& after, std::string_view hint,
                  Diagnostics& diagnostics) {
  if (fitting == 0 && !names.rows.empty() && !before.empty()) {
    diagnostics.push_back(
        {Severity::kWarning, fmt::format("the marker names fit none of the markers, such as {}; {}",
                                         Quoted(BareLabel(before.front())), hint)});
  }
  std::set<std::string> seen;
  std::string repeated;
  for (const auto& label : after) {
    if (!seen.insert(ToLower(label)).second) Append(repeated, Quoted(label));
  }
  if (!repeated.empty() && !std::ranges::equal(before, after)) {
    diagnostics.push_back({Severity::kWarning, "more than one marker is called " + repeated});
  }
}

}  // namespace

MarkerCloud BuildMarkers(const CsmRecording& csm, const CsmBuildOptions& options,
                         Diagnostics& diagnostics) {
  MarkerCloud markers{.labels = csm.labels,
                      .rate_hz = options.rate_hz,
                      .frame_count = internal::FrameCountOrFail(csm.frame_count()),
                      .first_frame = csm.frame_numbers.empty() ? 1 : csm.frame_numbers.front()};
  const Eigen::Matrix3d to_world_cm = ToYUp(options.up) * options.cm_per_unit;
  markers.positions_cm.reserve(csm.values.size() / 3);
  markers.states.reserve(csm.values.size() / 3);
  std::size_t zeros = 0;
  std::size_t incomplete = 0;
  for (std::size_t i = 0; i + 2 < csm.values.size(); i += 3) {
    const auto point = std::span(csm.values).subspan(i, 3);
    const bool is_dropout = std::ranges::all_of(point, [](double v) { return std::isnan(v); });
    const bool is_zero = std::ranges::all_of(point, [](double v) { return v == 0; });
    const bool is_missing = is_zero || IsMissing(point);
    zeros += is_zero ? 1 : 0;
    incomplete += is_missing && !is_zero && !is_dropout ? 1 : 0;
    markers.states.push_back(is_missing ? MarkerState::kMissing : MarkerState::kMeasured);
    markers.positions_cm.emplace_back(
        is_missing ? MissingPosition()
                   : Eigen::Vector3d(to_world_cm * Eigen::Vector3d(point.data())));
  }
  if (zeros > 0) {
    diagnostics.push_back(
        {Severity::kWarning, fmt::format("{} places at (0, 0, 0) are taken as missing", zeros)});
  }
  if (incomplete > 0) {
    diagnostics.push_back(
        {Severity::kWarning,
         fmt::format("{} places with one or two values missing are taken as missing", incomplete)});
  }
  return markers;
}

CsmRecording ToCsm(const MarkerCloud& markers, Diagnostics& diagnostics) {
  CsmRecording csm{.rate_hz = markers.rate_hz};
  csm.labels = internal::WritableLabels(WithoutSubjects(markers.labels, diagnostics), " ,$", '_',
                                        diagnostics);
  const Eigen::Matrix3d to_file = ToYUp(UpAxis::kZ).transpose() / kCmPerMillimetre;
  for (int frame = 0; frame < markers.frame_count; ++frame) {
    csm.frame_numbers.push_back(markers.first_frame + frame);
  }
  csm.values.reserve(markers.positions_cm.size() * 3);
  for (std::size_t i = 0; i < markers.positions_cm.size(); ++i) {
    const bool is_missing = markers.states[i] == MarkerState::kMissing;
    const Eigen::Vector3d place =
        is_missing ? MissingPosition() : Eigen::Vector3d(to_file * markers.positions_cm[i]);
    for (const double value : place) csm.values.push_back(internal::RoundedPlace(value));
  }
  return csm;
}

std::vector<std::string> PresetLabels(std::span<const std::string> labels, const MarkerNames& names,
                                      Diagnostics& diagnostics) {
  std::vector<std::string> result;
  std::string bands;
  std::size_t fitting = 0;
  for (const auto& label : labels) {
    auto preset = names.PresetName(label);
    if (!preset) preset = names.PresetName(BareLabel(label));
    if (preset) ++fitting;
    const auto band = preset ? BandOfStick(*preset) : std::nullopt;
    if (band && EqualsIgnoringCase(*band, label)) {
      Append(bands, fmt::format("{} for {}", Quoted(label), Quoted(*preset)));
      preset.reset();
    }
    result.emplace_back(preset.value_or(label));
  }
  if (!bands.empty()) {
    diagnostics.push_back(
        {Severity::kInfo, fmt::format("the marker names give the wrist's band as its stick ({}); "
                                      "the band keeps its names, as it stands elsewhere",
                                      bands)});
  }
  ReportNaming(names, labels, fitting, result,
               "a line is what a marker is, and then what the file calls it", diagnostics);
  return result;
}

std::vector<std::string> CustomLabels(std::span<const std::string> labels, const MarkerNames& names,
                                      Diagnostics& diagnostics) {
  std::vector<std::string> result;
  std::size_t fitting = 0;
  for (const auto& label : labels) {
    auto custom = names.CustomName(label);
    if (!custom) custom = names.CustomName(BareLabel(label));
    if (custom) ++fitting;
    result.emplace_back(custom.value_or(label));
  }
  ReportNaming(names, labels, fitting, result,
               "a line is what a marker is here, and then what the file is to call it",
               diagnostics);
  return result;
}

Diagnostics CheckPreset(std::span<const std::string> labels) {
  const std::set<std::string> names = LowerCaseNames(labels);
  std::string required;
  std::string optional;
  for (const auto& marker : PresetMarkers()) {
    if (names.contains(ToLower(marker.name))) continue;
    const std::string item = fmt::format("{} ({})", marker.name, marker.tells);
    if (marker.need == Need::kRequired) Append(required, item);
    if (marker.need == Need::kOptional) Append(optional, item);
  }
  for (const char side : {'L', 'R'}) {
    if (HasAll(names, side, Need::kBand) || HasAll(names, side, Need::kStick)) continue;
    Append(required, fmt::format("{0}WRA and {0}WRB, or {0}WRE and {0}WRI (the {1} wrist)", side,
                                 side == 'L' ? "left" : "right"));
  }
  std::string unknown;
  for (const auto& label : labels) {
    if (FindPresetMarker(BareLabel(label)) == nullptr) Append(unknown, Quoted(label));
  }
  if (std::ranges::none_of(labels, [](const auto& label) {
        return FindPresetMarker(BareLabel(label)) != nullptr;
      })) {
    return {
        {Severity::kWarning,
         "no marker has a name of Character Studio's preset; an MNM file tells which is which"}};
  }
  Diagnostics diagnostics;
  if (!required.empty()) {
    diagnostics.push_back(
        {Severity::kWarning,
         "markers that Character Studio requires are missing, and with them is known less well "
         "what stands in brackets: " +
             required});
  }
  if (!optional.empty()) {
    diagnostics.push_back({Severity::kInfo, "optional markers are missing: " + optional});
  }
  if (!unknown.empty()) {
    diagnostics.push_back({Severity::kInfo, "markers that the preset lacks: " + unknown});
  }
  return diagnostics;
}

bool HasBandAndStick(std::span<const std::string> labels) {
  const std::set<std::string> names = LowerCaseNames(labels);
  return std::ranges::any_of(std::array{'L', 'R'}, [&](char side) {
    return HasAny(names, side, Need::kBand) && HasAny(names, side, Need::kStick);
  });
}

}  // namespace kinebase
