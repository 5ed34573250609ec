#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "kinebase/core/text_scanner.h"
#include "kinebase/core/units.h"
#include "kinebase/formats/csm.h"

namespace kinebase {
namespace {

constexpr std::array<std::string_view, 12> kTalentNames = {
    "head",       "neck",       "clavicle", "upperarm", "forearm",    "spine",
    "pelvheight", "pelvlength", "thigh",    "calf",     "footheight", "footlength"};

bool SameValue(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void AppendText(std::string& out, std::string_view title, const std::string& value) {
  if (!value.empty()) out.append(title).append(" ").append(value) += '\n';
}

void AppendComments(std::string& out, const std::vector<std::string>& comments) {
  if (comments.empty()) return;
  out += "$Comments\n";
  for (const auto& line : comments) {
    // On a line of its own it would begin a section.
    if (line.starts_with('$')) out += "$Comments ";
    out += line + '\n';
  }
}

void AppendTalent(std::string& out, const CsmTalent& talent) {
  out += "$Talent";
  if (talent.unit == CsmTalent::Unit::kMillimetres) out += " millimeters";
  if (talent.unit == CsmTalent::Unit::kInches) out += " inches";
  for (const auto& measure : talent.measures) {
    out += ' ' + measure.name + ' ';
    AppendShortestText(out, measure.value);
  }
  out += '\n';
}

void AppendUnknown(std::string& out, const CsmUnknownSection& section) {
  out += '$' + section.title;
  if (!section.lines.empty() && !section.lines.front().empty()) out += ' ' + section.lines.front();
  out += '\n';
  for (std::size_t i = 1; i < section.lines.size(); ++i) out += section.lines[i] + '\n';
}

void AppendFrame(std::string& out, const CsmRecording& csm, std::size_t frame) {
  out += std::to_string(csm.frame_numbers[frame]);
  for (std::size_t marker = 0; marker < csm.marker_count(); ++marker) {
    const auto point = csm.Point(frame, marker);
    if (std::ranges::all_of(point, [](double value) { return std::isnan(value); })) {
      out += " DROPOUT";
      continue;
    }
    for (const double value : point) {
      out += ' ';
      AppendShortestText(out, value);
    }
  }
  out += '\n';
}

}  // namespace

std::span<const std::string_view> CsmTalentNames() { return kTalentNames; }

std::optional<double> CsmTalent::LengthCm(std::string_view name) const {
  const auto found = std::ranges::find_if(
      measures, [&](const Measure& measure) { return EqualsIgnoringCase(measure.name, name); });
  if (found == measures.end() || unit == Unit::kUnstated) return std::nullopt;
  return unit == Unit::kInches ? found->value * kCentimetresPerInch : found->value / 10;
}

std::string FormatCsm(const CsmRecording& csm) {
  std::string out;
  out.reserve(csm.values.size() * 12);
  AppendText(out, "$Filename", csm.file_name);
  AppendText(out, "$CaptureDate", csm.capture_date);
  AppendText(out, "$CaptureTime", csm.capture_time);
  AppendText(out, "$Actor", csm.actor);
  AppendComments(out, csm.comments);
  if (!csm.frame_numbers.empty()) {
    out += "$FirstFrame " + std::to_string(csm.frame_numbers.front()) + '\n';
    out += "$LastFrame " + std::to_string(csm.frame_numbers.back()) + '\n';
  }
  if (csm.spine_links) out += "$SpineLinks " + std::to_string(*csm.spine_links) + '\n';
  if (csm.rate_hz) out += "$Rate " + ToShortestText(*csm.rate_hz) + '\n';
  if (csm.talent) AppendTalent(out, *csm.talent);
  for (const auto& section : csm.unknown_sections) AppendUnknown(out, section);
  out += "$Order\n";
  for (std::size_t i = 0; i < csm.labels.size(); ++i) out += (i == 0 ? "" : " ") + csm.labels[i];
  out += "\n$Points\n";
  for (std::size_t frame = 0; frame < csm.frame_count(); ++frame) AppendFrame(out, csm, frame);
  return out;
}

bool operator==(const CsmRecording& a, const CsmRecording& b) {
  return a.file_name == b.file_name && a.capture_date == b.capture_date &&
         a.capture_time == b.capture_time && a.actor == b.actor && a.comments == b.comments &&
         a.rate_hz == b.rate_hz && a.spine_links == b.spine_links && a.talent == b.talent &&
         a.unknown_sections == b.unknown_sections && a.labels == b.labels &&
         a.frame_numbers == b.frame_numbers && std::ranges::equal(a.values, b.values, SameValue);
}

}  // namespace kinebase
