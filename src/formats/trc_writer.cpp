#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/trc.h"

namespace kinebase {
namespace {

bool SameValue(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

// The two lines of the header, field by field.
class Header {
 public:
  void Add(std::string_view name, std::string_view value) {
    const std::string_view gap = names_.empty() ? "" : "\t";
    names_.append(gap).append(name);
    values_.append(gap).append(value);
  }
  void Add(std::string_view name, std::optional<double> value) {
    Add(name, value ? std::string_view(ToShortestText(*value)) : "");
  }
  void Add(std::string_view name, std::optional<std::int64_t> value) {
    Add(name, value ? std::string_view(std::to_string(*value)) : "");
  }

  [[nodiscard]] std::string text() const { return names_ + '\n' + values_ + '\n'; }

 private:
  std::string names_;
  std::string values_;
};

std::string FormatHeader(const TrcRecording& trc) {
  Header header;
  header.Add("DataRate", trc.data_rate_hz);
  header.Add("CameraRate", trc.camera_rate_hz);
  header.Add("NumFrames", std::optional(static_cast<std::int64_t>(trc.frame_count())));
  header.Add("NumMarkers", std::optional(static_cast<std::int64_t>(trc.marker_count())));
  header.Add("Units", std::string_view(trc.units));
  header.Add("OrigDataRate", trc.original_rate_hz);
  header.Add("OrigDataStartFrame", trc.original_first_frame);
  header.Add("OrigNumFrames", trc.original_frame_count);
  for (const auto& field : trc.other_fields) header.Add(field.name, std::string_view(field.value));
  return header.text();
}

void AppendRow(std::string& out, const TrcRecording& trc, std::size_t frame) {
  out += std::to_string(trc.frame_numbers[frame]) + '\t';
  AppendShortestText(out, trc.times_s[frame]);
  for (std::size_t marker = 0; marker < trc.marker_count(); ++marker) {
    for (const double value : trc.Point(frame, marker)) {
      out += '\t';
      if (!std::isnan(value)) AppendShortestText(out, value);
    }
  }
  out += '\n';
}

}  // namespace

std::string FormatTrc(const TrcRecording& trc) {
  std::string out;
  out.reserve(trc.values.size() * 12);
  out += "PathFileType\t" + trc.path_file_type + '\t' + trc.axes + '\t' + trc.file_name + '\n';
  out += FormatHeader(trc);
  out += "Frame#\tTime";
  for (const auto& label : trc.labels) out += '\t' + label + "\t\t";
  out += "\n\t";
  for (std::size_t i = 1; i <= trc.marker_count(); ++i) out += fmt::format("\tX{0}\tY{0}\tZ{0}", i);
  out += "\n\n";
  for (std::size_t frame = 0; frame < trc.frame_count(); ++frame) AppendRow(out, trc, frame);
  return out;
}

bool operator==(const TrcRecording& a, const TrcRecording& b) {
  return a.path_file_type == b.path_file_type && a.axes == b.axes && a.file_name == b.file_name &&
         a.data_rate_hz == b.data_rate_hz && a.camera_rate_hz == b.camera_rate_hz &&
         a.units == b.units && a.original_rate_hz == b.original_rate_hz &&
         a.original_first_frame == b.original_first_frame &&
         a.original_frame_count == b.original_frame_count && a.other_fields == b.other_fields &&
         a.labels == b.labels && a.frame_numbers == b.frame_numbers && a.times_s == b.times_s &&
         std::ranges::equal(a.values, b.values, SameValue);
}

}  // namespace kinebase
