#include "cli/file_contents.h"

#include <algorithm>
#include <variant>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase::cli {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

struct MissingSamples {
  std::size_t count = 0;
  std::size_t total = 0;
};

MissingSamples CountMissing(const MarkerCloud& markers) {
  return {static_cast<std::size_t>(std::ranges::count(markers.states, MarkerState::kMissing)),
          markers.states.size()};
}

template <typename Record>
const Record* RecordOf(const Recording& recording) {
  return recording.record ? std::get_if<Record>(recording.record.get()) : nullptr;
}

std::string DescribeAnalog(const C3dRecording& c3d) {
  if (c3d.channel_count == 0) return {};
  return fmt::format(
      "{} at {:g} Hz",
      FormatCount(static_cast<std::int64_t>(c3d.channel_count), "channel", "channels"),
      c3d.rate_hz * static_cast<float>(c3d.subframe_count));
}

std::string DescribeEvents(const std::vector<C3dEvent>& events) {
  constexpr std::size_t kShown = 6;
  std::vector<std::string> texts;
  for (const C3dEvent& event : events) {
    if (texts.size() == kShown) break;
    texts.push_back(fmt::format("{}{}{} at {:.3f} s", event.context,
                                event.context.empty() ? "" : " ", event.label, event.time_s));
  }
  const std::string more =
      events.size() > kShown ? fmt::format(" and {} more", events.size() - kShown) : "";
  return fmt::format("{}{}", fmt::join(texts, ", "), more);
}

std::string DescribeForcePlates(const std::vector<C3dForcePlate>& plates) {
  std::vector<std::string> types;
  types.reserve(plates.size());
  for (const C3dForcePlate& plate : plates) types.push_back(fmt::format("type {}", plate.type));
  return fmt::format("{}", fmt::join(types, ", "));
}

Lines Describe(const C3dRecording& c3d) {
  return {{"stored", fmt::format("{} {}", ToString(c3d.processor), ToString(c3d.storage))},
          {"analog", DescribeAnalog(c3d)},
          {"events", DescribeEvents(Events(c3d))},
          {"plates", DescribeForcePlates(ForcePlates(c3d))}};
}

Lines Describe(const CsmRecording& csm) {
  Lines lines = {
      {"recorded", std::string(Trim(csm.capture_date + ' ' + csm.capture_time))},
      {"performer", csm.actor},
      {"comments", fmt::format("{}", fmt::join(csm.comments, "; "))},
  };
  if (csm.talent) {
    lines.emplace_back("talent", FormatCount(static_cast<std::int64_t>(csm.talent->measures.size()),
                                             "size", "sizes"));
  }
  return lines;
}

Json ToJson(const C3dRecording& c3d) {
  Json events = Json::array();
  for (const C3dEvent& event : Events(c3d)) {
    events.push_back(
        {{"time_s", event.time_s}, {"label", event.label}, {"context", event.context}});
  }
  Json plates = Json::array();
  for (const C3dForcePlate& plate : ForcePlates(c3d)) {
    plates.push_back({{"type", plate.type}, {"channels", plate.channels}});
  }
  return {{"processor", ToString(c3d.processor)},
          {"storage", ToString(c3d.storage)},
          {"analog_channels", ChannelLabels(c3d)},
          {"analog_rate_hz", c3d.channel_count == 0
                                 ? Json()
                                 : Json(c3d.rate_hz * static_cast<float>(c3d.subframe_count))},
          {"events", std::move(events)},
          {"force_plates", std::move(plates)}};
}

Json ToJson(const CsmRecording& csm) {
  Json talent = Json::object();
  if (csm.talent) {
    for (const CsmTalent::Measure& measure : csm.talent->measures) {
      const auto length_cm = csm.talent->LengthCm(measure.name);
      talent[measure.name] = length_cm ? Json(*length_cm) : Json();
    }
  }
  return {{"date", csm.capture_date},
          {"time", csm.capture_time},
          {"performer", csm.actor},
          {"comments", csm.comments},
          {"talent_cm", std::move(talent)}};
}

}  // namespace

std::string DescribeMarkers(const MarkerCloud& markers) {
  std::string text = std::to_string(markers.marker_count());
  const auto unnamed = std::ranges::count_if(markers.labels, [](const std::string& label) {
    return label.empty() || BareLabel(label).starts_with('*');
  });
  if (unnamed > 0) text += fmt::format(" ({} without a name)", unnamed);
  const MissingSamples missing = CountMissing(markers);
  if (missing.count > 0) {
    text +=
        fmt::format(", {:.1f} % of the samples missing",
                    100 * static_cast<double>(missing.count) / static_cast<double>(missing.total));
  }
  return text;
}

Lines DescribeContents(const Recording& recording) {
  if (const auto* c3d = RecordOf<C3dRecording>(recording)) return Describe(*c3d);
  if (const auto* csm = RecordOf<CsmRecording>(recording)) return Describe(*csm);
  return {};
}

Json ContentsAsJson(const Recording& recording) {
  Json contents = Json::object();
  if (const auto* c3d = RecordOf<C3dRecording>(recording)) contents = ToJson(*c3d);
  if (const auto* csm = RecordOf<CsmRecording>(recording)) contents = ToJson(*csm);
  if (!recording.has_skeleton()) {
    contents["labels"] = recording.markers.labels;
    contents["missing_samples"] = CountMissing(recording.markers).count;
  }
  return contents;
}

}  // namespace kinebase::cli
