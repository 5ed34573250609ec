// Events: those of the group EVENT, whose times count from frame 1, and those of the header, whose
// times count from the first frame that is stored (user guide, "EVENT:TIMES" and "Event times").

#include <algorithm>
#include <cmath>

#include "fmt/format.h"
#include "formats/c3d_layout.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr double kSecondsPerMinute = 60;

// Seconds from frame 1 to the first frame that is stored.
double StartOf(const C3dRecording& recording) {
  return recording.rate_hz > 0 ? static_cast<double>(recording.first_frame - 1) / recording.rate_hz
                               : 0;
}

// EVENT:TIMES holds minutes and seconds of each event; some writers leave the minutes out.
std::vector<double> EventTimes(const C3dRecording& recording) {
  std::vector<double> stored = NumberList(recording, "EVENT", "TIMES");
  const C3dParameter* times = FindParameter(recording, "EVENT", "TIMES");
  if (times == nullptr) return {};
  if (times->dimensions.size() < 2 || times->dimensions.front() != 2) return stored;
  std::vector<double> seconds;
  for (std::size_t i = 0; i + 1 < stored.size(); i += 2) {
    seconds.push_back(stored[i] * kSecondsPerMinute + stored[i + 1]);
  }
  return seconds;
}

// How many events the group has: those that have a time, up to EVENT:USED.
std::size_t GroupEventCount(const C3dRecording& recording, const std::vector<double>& times) {
  const C3dParameter* used = FindParameter(recording, "EVENT", "USED");
  const auto number = used == nullptr ? std::nullopt : used->UnsignedNumber();
  if (!number || !(*number >= 0 && *number <= 65535)) return times.size();
  return std::min(times.size(), static_cast<std::size_t>(*number));
}

std::string TextAt(const std::vector<std::string>& texts, std::size_t index) {
  return index < texts.size() ? texts[index] : std::string();
}

int IntegerAt(const std::vector<double>& numbers, std::size_t index) {
  if (index >= numbers.size() || !(std::abs(numbers[index]) <= 32768)) return 0;
  return static_cast<int>(numbers[index]);
}

// A list of two rows, or of one, in parts of 255 columns.
template <typename T>
void SetColumns(C3dRecording& recording, std::string_view name, std::uint8_t rows,
                const std::vector<T>& values) {
  constexpr std::size_t kMaxColumns = 255;
  int part = 1;
  std::size_t at = 0;
  do {
    const std::size_t count = std::min(kMaxColumns, (values.size() - at) / rows);
    const std::string part_name = internal::ListPartName(name, part);
    C3dParameter parameter{.name = part_name};
    if (rows > 1) parameter.dimensions.push_back(rows);
    parameter.dimensions.push_back(static_cast<std::uint8_t>(count));
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(at);
    parameter.values = std::vector<T>(begin, begin + static_cast<std::ptrdiff_t>(count * rows));
    SetParameter(recording, "EVENT", std::move(parameter));
    at += count * rows;
    ++part;
  } while (at < values.size());
  while (RemoveParameter(recording, "EVENT", internal::ListPartName(name, part))) ++part;
}

void SetGroupEvents(C3dRecording& recording, const std::vector<C3dEvent>& events) {
  if (events.empty() && FindGroup(recording, "EVENT") == nullptr) return;
  if (C3dGroup* group = internal::FindGroupToEdit(recording, "EVENT")) group->parameters.clear();
  std::vector<float> times;
  std::vector<std::string> labels;
  std::vector<std::string> contexts;
  std::vector<std::string> subjects;
  std::vector<std::string> descriptions;
  std::vector<std::int16_t> icons;
  std::vector<std::int8_t> flags;
  for (const C3dEvent& event : events) {
    const double minutes = std::floor(event.time_s / kSecondsPerMinute);
    times.push_back(static_cast<float>(minutes));
    times.push_back(static_cast<float>(event.time_s - minutes * kSecondsPerMinute));
    labels.push_back(event.label);
    contexts.push_back(event.context);
    subjects.push_back(event.subject);
    descriptions.push_back(event.description);
    icons.push_back(static_cast<std::int16_t>(event.icon_id));
    flags.push_back(static_cast<std::int8_t>(event.generic_flag));
  }
  SetParameter(recording, "EVENT", IntegerParameter("USED", static_cast<int>(events.size())));
  SetTextList(recording, "EVENT", "CONTEXTS", contexts);
  SetTextList(recording, "EVENT", "LABELS", labels);
  SetTextList(recording, "EVENT", "DESCRIPTIONS", descriptions);
  SetTextList(recording, "EVENT", "SUBJECTS", subjects);
  SetColumns(recording, "TIMES", 2, times);
  SetColumns(recording, "ICON_IDS", 1, icons);
  SetColumns(recording, "GENERIC_FLAGS", 1, flags);
}

}  // namespace

std::vector<C3dEvent> Events(const C3dRecording& recording) {
  const std::vector<double> times = EventTimes(recording);
  const auto labels = TextList(recording, "EVENT", "LABELS");
  const auto contexts = TextList(recording, "EVENT", "CONTEXTS");
  const auto subjects = TextList(recording, "EVENT", "SUBJECTS");
  const auto descriptions = TextList(recording, "EVENT", "DESCRIPTIONS");
  const auto icons = NumberList(recording, "EVENT", "ICON_IDS");
  const auto flags = NumberList(recording, "EVENT", "GENERIC_FLAGS");
  std::vector<C3dEvent> events;
  for (std::size_t i = 0; i < GroupEventCount(recording, times); ++i) {
    events.push_back({.time_s = times[i],
                      .label = TextAt(labels, i),
                      .context = TextAt(contexts, i),
                      .subject = TextAt(subjects, i),
                      .description = TextAt(descriptions, i),
                      .icon_id = IntegerAt(icons, i),
                      .generic_flag = IntegerAt(flags, i)});
  }
  for (const C3dHeaderEvent& event : recording.header_events) {
    events.push_back({.time_s = StartOf(recording) + static_cast<double>(event.time_s),
                      .label = event.label,
                      .is_in_header = true,
                      .display_flag = event.display_flag});
  }
  return events;
}

void SetEvents(C3dRecording& recording, std::span<const C3dEvent> events) {
  std::vector<C3dEvent> in_group;
  std::vector<C3dHeaderEvent> in_header;
  for (const C3dEvent& event : events) {
    if (!event.is_in_header) {
      in_group.push_back(event);
      continue;
    }
    if (event.label.size() > 4) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("the header's events have labels of 4 bytes; {} is longer",
                              Quoted(event.label)));
    }
    in_header.push_back({.label = event.label,
                         .time_s = static_cast<float>(event.time_s - StartOf(recording)),
                         .display_flag = event.display_flag});
  }
  if (in_header.size() > internal::kC3dMaxHeaderEvents) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("the header of a C3D file has room for {} events, not {}",
                            internal::kC3dMaxHeaderEvents, in_header.size()));
  }
  SetGroupEvents(recording, in_group);
  recording.header_events = std::move(in_header);
}

}  // namespace kinebase
