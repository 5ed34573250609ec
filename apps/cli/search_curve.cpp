#include "cli/search_curve.h"

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/search/subsequence_dtw.h"
#include "kinebase/templates/quantized_template.h"

namespace kinebase::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTableHead = "file,column,frame,delta,start_frame\n";
constexpr std::size_t kBytesAtATime = std::size_t{1} << 16;

// A row for each label, in the order in which they first come.
std::vector<TimelineRow> LabelRows(std::span<const SegmentLabel> labels, const fs::path& file,
                                   double rate_hz) {
  std::vector<TimelineRow> rows;
  const std::string recording = RecordingName(file);
  for (const SegmentLabel& label : labels) {
    if (label.recording != recording) continue;
    auto row = std::ranges::find(rows, label.label, &TimelineRow::name);
    if (row == rows.end()) row = rows.insert(rows.end(), {label.label, {}, {}});
    row->truth.push_back({static_cast<double>(label.first_frame - 1) / rate_hz,
                          static_cast<double>(label.last_frame) / rate_hz});
  }
  return rows;
}

}  // namespace

bool IsPicture(const fs::path& path) {
  const std::string extension = ToLower(path.extension().string());
  return extension == ".svg" || extension == ".png";
}

CurveFile::CurveFile(fs::path path, std::size_t templates, Overwrite overwrite)
    : path_(std::move(path)), templates_(templates), overwrite_(overwrite) {
  if (IsPicture(path_)) return;
  table_.emplace(path_, overwrite);
  table_->Append(kTableHead);
}

DeltaPanel& CurveFile::PanelOf(const TakeView& take) {
  const auto [place, is_new] = of_.try_emplace(*take.path, panels_.size());
  if (!is_new) return panels_[place->second];
  files_.push_back(*take.path);
  DeltaPanel& panel = panels_.emplace_back();
  panel.title = take.path->filename().string();
  panel.duration_s = static_cast<double>(take.frame_count) / take.rate_hz;
  panel.frame_rate_hz = take.rate_hz;
  panel.rows.resize(templates_);
  return panel;
}

void CurveFile::AddTable(const QuantizedTemplate& quantized, const TakeView& take) {
  const DeltaCurve curve = ComputeDelta(quantized, take.features.columns);
  const std::string file = CsvField(take.path->string());
  const auto first_frame_of = [&](int column) {
    return FramesOfColumns(column, column, take.features.rate_hz, take.rate_hz, take.frame_count)
               .first +
           1;
  };
  std::string text;
  for (int column = 0; column < take.features.column_count(); ++column) {
    const auto i = static_cast<std::size_t>(column);
    text += fmt::format(
        "{},{},{},{},{}\n", file, column, first_frame_of(column), ToShortestText(curve.delta[i]),
        curve.start[i] < 0 ? std::string() : std::to_string(first_frame_of(curve.start[i])));
    if (text.size() < kBytesAtATime) continue;
    table_->Append(text);
    text.clear();
  }
  table_->Append(text);
}

void CurveFile::Add(const MotionTemplate& motion_template, double tau, std::size_t which,
                    std::span<const TakeView> takes) {
  if (table_) {
    const QuantizedTemplate quantized = Quantize(motion_template);
    for (const TakeView& take : takes) AddTable(quantized, take);
    return;
  }
  for (const TakeView& take : takes) {
    PanelOf(take).rows[which] = {.name = motion_template.name,
                                 .cost = CostCurve(motion_template, take),
                                 .rate_hz = take.features.rate_hz,
                                 .tau = tau,
                                 .hits = {}};
  }
}

void CurveFile::Write(const std::vector<NamedHit>& hits, std::span<const SegmentLabel> labels) {
  if (table_) {
    table_->Publish();
    return;
  }
  for (const NamedHit& named : hits) {
    panels_[of_.at(named.file)].rows[named.query].hits.push_back(
        {named.hit.start_s, named.hit.end_s});
  }
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    panels_[i].labels = LabelRows(labels, files_[i], panels_[i].frame_rate_hz);
  }
  DrawDeltaCurves(panels_, path_, overwrite_);
}

void CheckLabels(std::span<const SegmentLabel> labels, std::span<const fs::path> recordings,
                 const fs::path& file) {
  for (const fs::path& path : recordings) {
    const std::string recording = RecordingName(path);
    if (std::ranges::find(labels, recording, &SegmentLabel::recording) != labels.end()) return;
  }
  throw Error(ErrorCode::kMismatch,
              "has no labels for any of the recordings; its column of files holds their names, "
              "with or without folder and extension",
              {file});
}

}  // namespace kinebase::cli
