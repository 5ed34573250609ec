// The row of CSV: places over time as a table for every other program.

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "motion/file_formats.h"
#include "motion/motion_world.h"
#include "motion/point_writing.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

// Columns are found by their names: labels that are empty or repeat get a number.
std::vector<std::string> ColumnNames(const std::vector<std::string>& labels,
                                     Diagnostics& diagnostics) {
  std::set<std::string> taken(labels.begin(), labels.end());
  std::set<std::string> used;
  std::vector<std::string> names;
  std::string renamed;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::string name = labels[i];
    if (name.empty() || !used.insert(name).second) {
      const std::string stem = name.empty() ? "unnamed" : name;
      int number = 2;
      if (name.empty()) number = static_cast<int>(i) + 1;
      do {
        name = fmt::format("{}_{}", stem, number++);
      } while (!taken.insert(name).second);
      used.insert(name);
      renamed.append(renamed.empty() ? "" : ", ").append(name);
    }
    names.push_back(std::move(name));
  }
  if (!renamed.empty()) {
    diagnostics.push_back(
        {Severity::kWarning, "columns of labels that are empty or repeat are named: " + renamed});
  }
  return names;
}

std::string Header(const std::vector<std::string>& names) {
  std::string text = "frame,time_s";
  for (const std::string& name : names) {
    for (const std::string_view axis : {"_x", "_y", "_z"}) {
      text += ',';
      text += CsvField(name + std::string(axis));
    }
  }
  return text + '\n';
}

void AppendRow(const MarkerCloud& points, int frame, const Eigen::Matrix3d& turn, double unit_cm,
               std::string& text) {
  text += fmt::format("{},", points.first_frame + frame);
  AppendShortestText(text, static_cast<double>(points.first_frame + frame - 1) / points.rate_hz);
  for (int point = 0; point < points.marker_count(); ++point) {
    if (points.is_missing(frame, point)) {
      text += ",,,";
      continue;
    }
    const Eigen::Vector3d position = turn * points.at(frame, point) / unit_cm;
    for (const double value : position) {
      text += ',';
      AppendShortestText(text, value);
    }
  }
  text += '\n';
}

}  // namespace

void SaveCsv(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  const double unit_cm = options.units.empty() ? 1 : CentimetresInOrFail(options.units, path);
  const Eigen::Matrix3d turn = ToYUp(options.up_axis.value_or(UpAxis::kY)).transpose();
  CheckWritable(path, options.overwrite);
  ReportFilledSamples(recording.markers, "CSV", diagnostics);
  ReportRecordLoss(recording, "CSV", diagnostics);
  const MarkerCloud points = PointsOf(recording, diagnostics);
  std::string text = Header(ColumnNames(points.labels, diagnostics));
  for (int frame = 0; frame < points.frame_count; ++frame) {
    AppendRow(points, frame, turn, unit_cm, text);
  }
  WriteFile(path, text, options.overwrite);
}

}  // namespace kinebase::internal
