// Cutting frames out of a C3D recording, and changing how its numbers are stored.

#include <algorithm>
#include <cmath>
#include <set>

#include "fmt/format.h"
#include "formats/c3d_layout.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr float kLargestStored = 32000;  // A little room below 32,767, as other writers leave it.

// --- Cutting.

// Values that a list has: one for each column; a single text is none.
std::size_t ColumnCount(const C3dParameter& parameter) {
  const bool is_text = std::holds_alternative<std::string>(parameter.values);
  if (parameter.dimensions.size() < (is_text ? 2 : 1)) return 0;
  return parameter.dimensions.back();
}

// Keeps the columns that `is_kept` has from `first` on.
void KeepColumns(C3dParameter& parameter, const std::vector<bool>& is_kept, std::size_t first) {
  const std::size_t columns = ColumnCount(parameter);
  if (columns == 0) return;
  std::size_t kept = 0;
  std::visit(
      [&](auto& values) {
        const std::size_t rows = values.size() / columns;
        std::remove_reference_t<decltype(values)> remaining;
        for (std::size_t column = 0; column < columns; ++column) {
          if (first + column >= is_kept.size() || !is_kept[first + column]) continue;
          const auto begin = values.begin() + static_cast<std::ptrdiff_t>(column * rows);
          remaining.insert(remaining.end(), begin, begin + static_cast<std::ptrdiff_t>(rows));
          ++kept;
        }
        values = std::move(remaining);
      },
      parameter.values);
  parameter.dimensions.back() = static_cast<std::uint8_t>(kept);
}

// "TIMES2" → "times".
std::string BaseName(std::string_view name) {
  const std::size_t last = name.find_last_not_of("0123456789");
  return ToLower(name.substr(0, last == std::string_view::npos ? 0 : last + 1));
}

// Those of the user guide; they may have more columns than EVENT:USED says.
bool IsEventList(std::string_view name) {
  constexpr std::string_view kLists[] = {"times",    "labels",   "contexts",     "descriptions",
                                         "subjects", "icon_ids", "generic_flags"};
  return std::ranges::find(kLists, name) != std::end(kLists);
}

// Drops the events of the group that are not kept from every parameter that has a value an event.
void KeepGroupEvents(C3dRecording& recording, const std::vector<bool>& is_kept) {
  C3dGroup* group = internal::FindGroupToEdit(recording, "EVENT");
  if (group == nullptr || is_kept.empty()) return;
  std::set<std::string> lists;
  for (const C3dParameter& parameter : group->parameters) {
    std::size_t columns = 0;
    for (const C3dParameter& part : group->parameters) {
      if (BaseName(part.name) == BaseName(parameter.name)) columns += ColumnCount(part);
    }
    if (columns == is_kept.size() || IsEventList(BaseName(parameter.name))) {
      lists.insert(BaseName(parameter.name));
    }
  }
  for (const std::string& list : lists) {
    std::size_t first = 0;
    for (C3dParameter& parameter : group->parameters) {
      if (BaseName(parameter.name) != list) continue;
      const std::size_t columns = ColumnCount(parameter);
      KeepColumns(parameter, is_kept, first);
      first += columns;
    }
  }
  const auto kept = static_cast<double>(std::ranges::count(is_kept, true));
  C3dParameter* used = internal::FindParameterToEdit(recording, "EVENT", "USED");
  if (used != nullptr && used->Number()) internal::SetNumber(*used, 0, kept);
}

// Whether the frame nearest to a time is among those of `clip`. What is up to a frame beyond the
// take, as its very end is, belongs to the frame there.
bool HoldsTime(const C3dRecording& take, const C3dRecording& clip, double time_s) {
  const double frame = std::round(time_s * static_cast<double>(clip.rate_hz)) + 1;
  const auto first = static_cast<double>(take.first_frame);
  const auto last = static_cast<double>(take.last_frame());
  if (!(frame >= first - 1 && frame <= last + 1)) return false;
  const double nearest = std::clamp(frame, first, last);
  return nearest >= static_cast<double>(clip.first_frame) &&
         nearest <= static_cast<double>(clip.last_frame());
}

void CutEvents(const C3dRecording& recording, C3dRecording& clip) {
  if (!(recording.rate_hz > 0)) return;
  std::vector<bool> is_kept;
  clip.header_events.clear();
  std::size_t header_event = 0;
  const double moved_s = static_cast<double>(clip.first_frame - recording.first_frame) /
                         static_cast<double>(recording.rate_hz);
  for (const C3dEvent& event : Events(recording)) {
    const bool is_inside = HoldsTime(recording, clip, event.time_s);
    if (!event.is_in_header) {
      is_kept.push_back(is_inside);
      continue;
    }
    C3dHeaderEvent moved = recording.header_events[header_event++];
    moved.time_s = static_cast<float>(static_cast<double>(moved.time_s) - moved_s);
    if (is_inside) clip.header_events.push_back(std::move(moved));
  }
  KeepGroupEvents(clip, is_kept);
}

template <typename T>
std::vector<T> Part(const std::vector<T>& values, std::size_t begin, std::size_t end) {
  return {values.begin() + static_cast<std::ptrdiff_t>(begin),
          values.begin() + static_cast<std::ptrdiff_t>(end)};
}

// --- Storage.

bool FitsWords(const std::vector<float>& samples, bool is_unsigned) {
  const float low = is_unsigned ? 0 : -32768;
  const float high = is_unsigned ? 65535 : 32767;
  return std::ranges::all_of(samples, [&](float sample) {
    return sample == std::floor(sample) && sample >= low && sample <= high;
  });
}

// Makes whole numbers of the samples of each channel and keeps their values in real units.
void RescaleAnalog(C3dRecording& recording) {
  const C3dAnalogScaling scaling = AnalogScaling(recording);
  const std::size_t channels = recording.channel_count;
  std::vector<float> scales;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    double largest = 0;
    for (std::size_t i = channel; i < recording.analog.size(); i += channels) {
      const double value =
          std::abs(static_cast<double>(recording.analog[i]) - scaling.offset[channel]);
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
    const double step = largest > 0 ? largest / static_cast<double>(kLargestStored) : 1;
    for (std::size_t i = channel; i < recording.analog.size(); i += channels) {
      const double value = static_cast<double>(recording.analog[i]) - scaling.offset[channel];
      recording.analog[i] = std::isfinite(value) ? static_cast<float>(std::round(value / step)) : 0;
    }
    scales.push_back(static_cast<float>(scaling.scale[channel] * step));
  }
  SetRealList(recording, "ANALOG", "SCALE", scales);
  SetRealList(recording, "ANALOG", "OFFSET", std::vector<float>(channels));
  RemoveParameter(recording, "ANALOG", "OFFSETS");
  SetParameter(recording, "ANALOG", TextParameter("FORMAT", "SIGNED"));
}

// The smallest step with which 16 bits reach all points.
float IntegerScale(const C3dRecording& recording) {
  float largest = 0;
  for (const C3dPoint& point : recording.points) {
    if (!point.is_valid()) continue;
    for (const float value : {std::abs(point.x), std::abs(point.y), std::abs(point.z)}) {
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
  }
  return largest > 0 ? std::max(largest / kLargestStored, 1e-30F) : recording.scale;
}

}  // namespace

C3dRecording CutC3d(const C3dRecording& recording, std::int64_t first, std::int64_t last) {
  const auto frames = static_cast<std::int64_t>(recording.frame_count);
  if (first < 0 || last < first || last >= frames) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("frames {} to {} of a recording that has frames 0 to {}", first, last,
                            frames - 1));
  }
  const auto begin = static_cast<std::size_t>(first);
  const auto end = static_cast<std::size_t>(last) + 1;
  C3dRecording clip;
  clip.processor = recording.processor;
  clip.storage = recording.storage;
  clip.scale = recording.scale;
  clip.rate_hz = recording.rate_hz;
  clip.first_frame = recording.first_frame + first;
  clip.frame_count = end - begin;
  clip.point_count = recording.point_count;
  clip.channel_count = recording.channel_count;
  clip.subframe_count = recording.subframe_count;
  clip.max_gap = recording.max_gap;
  clip.points = Part(recording.points, begin * recording.point_count, end * recording.point_count);
  clip.analog = Part(recording.analog, begin * recording.analog_per_frame(),
                     end * recording.analog_per_frame());
  clip.other_header_words = recording.other_header_words;
  clip.header_events = recording.header_events;
  clip.groups = recording.groups;
  CutEvents(recording, clip);
  if (!recording.trailing.empty()) {
    clip.diagnostics.push_back(
        {Severity::kInfo,
         fmt::format("{} bytes behind the last frame do not go along", recording.trailing.size())});
  }
  internal::AlignParameters(clip);
  return clip;
}

void ChangeStorage(C3dRecording& recording, C3dStorage storage) {
  if (recording.storage == storage) return;
  recording.storage = storage;
  if (storage == C3dStorage::kInteger) {
    const float residual_step = recording.scale;
    recording.scale = IntegerScale(recording);
    for (C3dPoint& point : recording.points) {
      const int steps = point.is_valid() ? point.residual_steps() : 0;
      for (float* value : {&point.x, &point.y, &point.z}) {
        *value = std::isfinite(*value) && point.is_valid()
                     ? std::round(*value / recording.scale) * recording.scale
                     : 0;
      }
      if (steps == 0) {
        point.quality = static_cast<float>(point.QualityWord());
        continue;
      }
      // The residual counts in steps of the scale too; one that was measured stays above 0.
      const float residual =
          std::round(static_cast<float>(steps) * residual_step / recording.scale);
      const int mask = point.camera_mask();
      point.quality =
          static_cast<float>(mask * 256 + static_cast<int>(std::clamp(residual, 1.F, 255.F)));
    }
    if (!FitsWords(recording.analog, HasUnsignedAnalog(recording))) RescaleAnalog(recording);
  }
  internal::AlignParameters(recording);
}

}  // namespace kinebase
