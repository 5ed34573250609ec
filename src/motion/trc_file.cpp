// The row of TRC: markers, or the joints of a skeleton as points.

#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/csm_motion.h"
#include "kinebase/motion/trc_motion.h"
#include "motion/file_formats.h"
#include "motion/point_writing.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

constexpr std::string_view kUsualUnits = "mm";

// The unit asked for, else the file's, else millimetres with a diagnostic.
std::string ChooseUnits(const TrcRecording& trc, const LoadOptions& options,
                        const std::filesystem::path& path, Diagnostics& diagnostics) {
  if (!options.units.empty()) {
    (void)CentimetresInOrFail(options.units, path);
    return options.units;
  }
  if (CentimetresIn(trc.units)) return trc.units;
  diagnostics.push_back(
      {Severity::kWarning,
       trc.units.empty()
           ? "the file does not tell its unit of length; mm is taken, --source-units says "
             "another"
           : fmt::format("unknown unit of length {}; mm is taken, --source-units says "
                         "another",
                         Quoted(trc.units))});
  return std::string(kUsualUnits);
}

// As asked for, else that of the TRC that was read.
UpAxis UpAxisToWrite(const Recording& recording, const SaveOptions& options) {
  const bool is_trc = recording.record && std::holds_alternative<TrcRecording>(*recording.record);
  const UpAxis before = ParseUpAxis(is_trc ? recording.up_axis : "").value_or(UpAxis::kY);
  return options.up_axis.value_or(before);
}

TrcRecording RecordToWrite(const Recording& recording, const std::filesystem::path& path,
                           const SaveOptions& options, Diagnostics& diagnostics) {
  const auto* kept = recording.record ? std::get_if<TrcRecording>(recording.record.get()) : nullptr;
  TrcWriteOptions write{.file_name = path.filename().string()};
  write.up = UpAxisToWrite(recording, options);
  if (kept != nullptr) write.units = recording.units;
  const bool same_units =
      options.units.empty() || CentimetresIn(options.units) == CentimetresIn(write.units);
  if (kept != nullptr && same_units && ToString(write.up) == recording.up_axis) {
    TrcRecording trc = *kept;
    trc.labels = recording.markers.labels;
    // What was taken on the user's word, or because the file does not tell.
    trc.data_rate_hz = recording.markers.rate_hz;
    const double told = CentimetresIn(trc.units).value_or(*CentimetresIn(kUsualUnits));
    if (told != CentimetresIn(recording.units)) trc.units = recording.units;
    return trc;
  }
  if (!options.units.empty()) write.units = options.units;
  TrcRecording trc = ToTrc(PointsOf(recording, diagnostics), write, diagnostics);
  if (kept == nullptr) return trc;
  TrcRecording with_all = *kept;
  with_all.labels = std::move(trc.labels);
  with_all.data_rate_hz = trc.data_rate_hz;
  with_all.units = std::move(trc.units);
  with_all.values = std::move(trc.values);
  return with_all;
}

}  // namespace

Recording LoadTrc(const std::filesystem::path& path, const LoadOptions& options) {
  Recording loaded{.path = path, .format = "TRC", .name = ParseTakeName(path)};
  TrcRecording trc = ReadTrc(path, {.strict = options.strict});
  loaded.diagnostics = trc.diagnostics;
  loaded.units = ChooseUnits(trc, options, path, loaded.diagnostics);
  const UpAxis up = options.up_axis.value_or(UpAxis::kY);
  loaded.up_axis = ToString(up);
  double rate_hz = FindRate(trc, loaded.diagnostics);
  if (rate_hz == 0) rate_hz = ChooseRate(loaded.name, options, loaded.diagnostics);
  loaded.markers =
      BuildMarkers(trc, {.rate_hz = rate_hz, .cm_per_unit = *CentimetresIn(loaded.units), .up = up},
                   loaded.diagnostics);
  if (!options.marker_names.empty()) {
    const MarkerNames names =
        ReadMarkerNames(options.marker_names, options.strict, loaded.diagnostics);
    loaded.markers.labels = PresetLabels(trc.labels, names, loaded.diagnostics);
  }
  loaded.record = std::make_shared<FileRecord>(std::move(trc));
  return loaded;
}

void SaveTrc(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  TrcRecording trc = RecordToWrite(recording, path, options, diagnostics);
  if (!options.marker_names.empty()) {
    const MarkerNames names = ReadMarkerNames(options.marker_names, false, diagnostics);
    trc.labels = CustomLabels(trc.labels, names, diagnostics);
  }
  ReportFilledSamples(recording.markers, "TRC", diagnostics);
  ReportRecordLoss(recording, "TRC", diagnostics);
  const UpAxis up = UpAxisToWrite(recording, options);
  if (up != UpAxis::kY) ReportUntold({.up = up}, "TRC", diagnostics);
  WriteFile(path, FormatTrc(trc), options.overwrite);
}

}  // namespace kinebase::internal
