#include "cli/search_curve.h"

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/pictures/delta_picture.h"
#include "kinebase/search/subsequence_dtw.h"
#include "kinebase/templates/quantized_template.h"

namespace kinebase::cli {
namespace {

namespace fs = std::filesystem;

// A row for each label, in the order in which they first come.
std::vector<TimelineRow> LabelRows(std::span<const SegmentLabel> labels, const TakeFeatures& take) {
  std::vector<TimelineRow> rows;
  const std::string recording = RecordingName(take.path);
  for (const SegmentLabel& label : labels) {
    if (label.recording != recording) continue;
    auto row = std::ranges::find(rows, label.label, &TimelineRow::name);
    if (row == rows.end()) row = rows.insert(rows.end(), {label.label, {}, {}});
    row->truth.push_back({static_cast<double>(label.first_frame - 1) / take.rate_hz,
                          static_cast<double>(label.last_frame) / take.rate_hz});
  }
  return rows;
}

DeltaRow RowOf(const SearchedTemplate& searched, std::size_t take) {
  const TakeFeatures& features = searched.batch->takes[take];
  DeltaRow row{.name = searched.motion_template->name,
               .cost = CostCurve(*searched.motion_template, features),
               .rate_hz = features.features.rate_hz,
               .tau = searched.tau,
               .hits = {}};
  for (const TakeHit& hit : searched.hits) {
    if (hit.take == take) row.hits.push_back({hit.start_s, hit.end_s});
  }
  return row;
}

}  // namespace

bool IsPicture(const fs::path& path) {
  const std::string extension = ToLower(path.extension().string());
  return extension == ".svg" || extension == ".png";
}

std::string CurveTable(const MotionTemplate& motion_template, const TakeBatch& batch) {
  std::string text = "file,column,frame,delta,start_frame\n";
  const QuantizedTemplate quantized = Quantize(motion_template);
  for (const TakeFeatures& take : batch.takes) {
    const DeltaCurve curve = ComputeDelta(quantized, take.features.columns);
    const std::string file = CsvField(take.path.string());
    const auto first_frame_of = [&](int column) {
      return FramesOfColumns(column, column, take.features.rate_hz, take.rate_hz, take.frame_count)
                 .first +
             1;
    };
    for (int column = 0; column < take.features.column_count(); ++column) {
      const auto i = static_cast<std::size_t>(column);
      text += fmt::format(
          "{},{},{},{},{}\n", file, column, first_frame_of(column), ToShortestText(curve.delta[i]),
          curve.start[i] < 0 ? std::string() : std::to_string(first_frame_of(curve.start[i])));
    }
  }
  return text;
}

void DrawCurves(std::span<const SearchedTemplate> templates, std::span<const SegmentLabel> labels,
                const fs::path& path, Overwrite overwrite) {
  std::vector<DeltaPanel> panels;
  const std::vector<TakeFeatures>& takes = templates.front().batch->takes;
  for (std::size_t i = 0; i < takes.size(); ++i) {
    DeltaPanel& panel = panels.emplace_back();
    panel.title = takes[i].path.filename().string();
    panel.duration_s = static_cast<double>(takes[i].frame_count) / takes[i].rate_hz;
    panel.frame_rate_hz = takes[i].rate_hz;
    for (const SearchedTemplate& each : templates) panel.rows.push_back(RowOf(each, i));
    panel.labels = LabelRows(labels, takes[i]);
  }
  DrawDeltaCurves(panels, path, overwrite);
}

void CheckLabels(std::span<const SegmentLabel> labels, const TakeBatch& batch,
                 const fs::path& file) {
  for (const TakeFeatures& take : batch.takes) {
    const std::string recording = RecordingName(take.path);
    if (std::ranges::find(labels, recording, &SegmentLabel::recording) != labels.end()) return;
  }
  throw Error(ErrorCode::kMismatch,
              "has no labels for any of the recordings; its column of files holds their names, "
              "with or without folder and extension",
              {file});
}

}  // namespace kinebase::cli
