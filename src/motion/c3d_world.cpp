// Units and axes of C3D files: as they tell, else guessed from what a body looks like.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/c3d_motion.h"

namespace kinebase {
namespace {

constexpr std::size_t kLooks = 200;  // Frames that a guess looks at, evenly spread.
// A person, crouching or with arms spread, measures .5 to 2.5 m; a lone hand .1 m, two people 6 m.
constexpr double kLargestMetres = 10;
constexpr double kLargestCentimetres = 300;

using Axes = std::array<double, 3>;

bool IsPlace(const C3dPoint& point) {
  const bool is_origin = point.x == 0 && point.y == 0 && point.z == 0;
  return point.is_valid() && !is_origin && std::isfinite(point.x) && std::isfinite(point.y) &&
         std::isfinite(point.z);
}

Axes Coordinates(const C3dPoint& point) {
  return {static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z)};
}

// Calls `action` with frames spread over the recording.
template <typename Action>
void LookAtFrames(const C3dRecording& recording, const Action& action) {
  if (recording.points.empty()) return;
  const std::size_t step = std::max<std::size_t>(1, recording.frame_count / kLooks);
  for (std::size_t frame = 0; frame < recording.frame_count; frame += step) action(frame);
}

// Median over frames of how far the places spread along each axis; 0 where nothing is seen.
Axes MedianSpread(const C3dRecording& recording) {
  const std::vector<std::size_t> places = PlacesAmongPoints(recording);
  std::array<std::vector<double>, 3> spreads;
  LookAtFrames(recording, [&](std::size_t frame) {
    Axes low{INFINITY, INFINITY, INFINITY};
    Axes high{-INFINITY, -INFINITY, -INFINITY};
    for (const std::size_t i : places) {
      if (!IsPlace(recording.point(frame, i))) continue;
      const Axes place = Coordinates(recording.point(frame, i));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], place[axis]);
        high[axis] = std::max(high[axis], place[axis]);
      }
    }
    for (std::size_t axis = 0; axis < 3 && low[0] <= high[0]; ++axis) {
      spreads[axis].push_back(high[axis] - low[axis]);
    }
  });
  Axes median{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto& values = spreads[axis];
    if (values.empty()) continue;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    median[axis] = *middle;
  }
  return median;
}

// Points whose label, without prefix, is one of `names`.
std::vector<std::size_t> PointsNamed(const C3dRecording& recording,
                                     std::initializer_list<std::string_view> names) {
  std::vector<std::size_t> found;
  const std::vector<std::string> labels = PointLabels(recording);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::string_view bare = BareLabel(labels[i]);
    const auto is_same = [&](std::string_view name) { return EqualsIgnoringCase(bare, name); };
    if (std::ranges::any_of(names, is_same)) found.push_back(i);
  }
  return found;
}

// Sum of the places of `points` in a frame, and of how many.
std::pair<Axes, int> SumOf(const C3dRecording& recording, std::size_t frame,
                           const std::vector<std::size_t>& points) {
  Axes sum{};
  int count = 0;
  for (const std::size_t i : points) {
    if (!IsPlace(recording.point(frame, i))) continue;
    const Axes place = Coordinates(recording.point(frame, i));
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += place[axis];
    ++count;
  }
  return {sum, count};
}

// From feet to head and shoulders, summed over frames; zero if either is never seen.
Axes FromFeetToHead(const C3dRecording& recording) {
  const auto high = PointsNamed(
      recording, {"LFHD", "RFHD", "LBHD", "RBHD", "C7", "CLAV", "LSHO", "RSHO", "T10", "STRN"});
  const auto low = PointsNamed(
      recording, {"LTOE", "RTOE", "LHEE", "RHEE", "LHEL", "RHEL", "LANK", "RANK", "LMT5", "RMT5"});
  Axes total{};
  LookAtFrames(recording, [&](std::size_t frame) {
    const auto [head, head_count] = SumOf(recording, frame, high);
    const auto [feet, feet_count] = SumOf(recording, frame, low);
    if (head_count == 0 || feet_count == 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      total[axis] += head[axis] / head_count - feet[axis] / feet_count;
    }
  });
  return total;
}

UpAxis LargestAxis(const Axes& values) {
  std::size_t largest = 2;  // Of equal ones z, which most of these files have.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (values[axis] > values[largest]) largest = axis;
  }
  return static_cast<UpAxis>(largest);
}

// POINT:UNITS often has room for four bytes only: "mete".
std::string KnownUnit(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kLongNames = {
      {{"mill", "mm"}, {"cent", "cm"}, {"met", "m"}, {"inch", "inch"}}};
  if (CentimetresIn(text)) return ToLower(Trim(text));
  for (const auto& [start, unit] : kLongNames) {
    if (ToLower(Trim(text)).starts_with(start)) return std::string(unit);
  }
  return {};
}

std::string TextOf(const C3dRecording& recording, std::string_view name) {
  const C3dParameter* parameter = FindParameter(recording, "POINT", name);
  const auto texts = parameter == nullptr ? std::vector<std::string>() : parameter->Strings();
  return texts.empty() ? std::string() : std::string(Trim(texts.front()));
}

}  // namespace

std::string FindUnits(const C3dRecording& recording, Diagnostics& diagnostics) {
  const std::string told = TextOf(recording, "UNITS");
  if (std::string unit = KnownUnit(told); !unit.empty()) return unit;
  const Axes spread = MedianSpread(recording);
  const double size = *std::ranges::max_element(spread);
  std::string unit = "mm";
  if (size == 0) return unit;  // Nothing that has a length.
  if (size < kLargestCentimetres) unit = size < kLargestMetres ? "m" : "cm";
  const std::string why = told.empty() ? "the file does not tell its unit of length"
                                       : "unknown unit of length " + Quoted(told);
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format("{}; {} is taken, as markers are {:.4g} apart; --source-units says "
                   "another",
                   why, unit, size)});
  return unit;
}

UpAxis FindUpAxis(const C3dRecording& recording, Diagnostics& diagnostics) {
  const std::string told = TextOf(recording, "Y_SCREEN");
  const std::string_view axis = std::string_view(told).substr(
      told.find_first_not_of("+-") == std::string::npos ? told.size()
                                                        : told.find_first_not_of("+-"));
  if (const auto up = ParseUpAxis(axis)) {
    if (told.starts_with('-')) {
      diagnostics.push_back(
          {Severity::kWarning,
           fmt::format("POINT:Y_SCREEN says {}: up is taken for down", Quoted(told))});
    }
    return *up;
  }
  const Axes body = FromFeetToHead(recording);
  const bool has_body = std::ranges::any_of(body, [](double value) { return value > 0; });
  const Axes spread = MedianSpread(recording);
  const UpAxis up = LargestAxis(has_body ? body : spread);
  if (std::ranges::all_of(spread, [](double value) { return value == 0; })) return up;
  diagnostics.push_back(
      {has_body ? Severity::kInfo : Severity::kWarning,
       fmt::format(
           "the file does not tell which axis points up; {} is taken, as {}; --source-up says "
           "another",
           ToString(up), has_body ? "feet and heads say" : "the markers spread most along it")});
  return up;
}

std::vector<std::size_t> PlacesAmongPoints(const C3dRecording& recording) {
  std::set<std::string> others;
  for (const auto name : {"ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS"}) {
    for (std::string& label : TextList(recording, "POINT", name)) others.insert(std::move(label));
  }
  others.erase("");
  const std::vector<std::string> labels = PointLabels(recording);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!others.contains(labels[i])) places.push_back(i);
  }
  return places;
}

void SetUnits(C3dRecording& recording, const std::string& units) {
  SetParameter(recording, "POINT", TextParameter("UNITS", units));
}

void SetUpAxis(C3dRecording& recording, UpAxis up) {
  SetParameter(recording, "POINT", TextParameter("X_SCREEN", up == UpAxis::kX ? "+Y" : "+X"));
  SetParameter(recording, "POINT", TextParameter("Y_SCREEN", fmt::format("+{}", ToString(up))));
}

}  // namespace kinebase
