// The row of C3D: markers, with everything else that such a file holds in the record.

#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/c3d_motion.h"
#include "kinebase/motion/csm_motion.h"
#include "motion/file_formats.h"
#include "motion/point_writing.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

std::string ChooseUnits(const C3dRecording& c3d, const LoadOptions& options,
                        const std::filesystem::path& path, Diagnostics& diagnostics) {
  if (options.units.empty()) return FindUnits(c3d, diagnostics);
  (void)CentimetresInOrFail(options.units, path);
  return options.units;
}

double RateOf(const C3dRecording& c3d, const LoadOptions& options, Recording& loaded) {
  const auto rate_hz = static_cast<double>(c3d.rate_hz);
  if (rate_hz >= kSmallestRateHz && rate_hz <= kLargestRateHz) return rate_hz;
  if (rate_hz != 0) {
    loaded.diagnostics.push_back(
        {Severity::kWarning, fmt::format("POINT:RATE says {:g} Hz, which is none", rate_hz)});
  }
  return ChooseRate(loaded.name, options, loaded.diagnostics);
}

// Labels of all points, those of the markers as `labels` has them.
void SetMarkerLabels(C3dRecording& c3d, const std::vector<std::string>& labels) {
  const std::vector<std::size_t> places = PlacesAmongPoints(c3d);
  std::vector<std::string> all = PointLabels(c3d);
  const std::vector<std::string> before = all;
  for (std::size_t i = 0; i < std::min(places.size(), labels.size()); ++i) {
    all[places[i]] = labels[i];
  }
  if (all != before) SetTextList(c3d, "POINT", "LABELS", all);
}

// The record as it was read, with what was taken on the user's word.
C3dRecording RecordAsTaken(const Recording& recording, const C3dRecording& kept) {
  C3dRecording c3d = kept;
  Diagnostics ignored;  // They were told when the file was read.
  if (CentimetresIn(FindUnits(kept, ignored)) != CentimetresIn(recording.units)) {
    SetUnits(c3d, recording.units);
  }
  const auto up = ParseUpAxis(recording.up_axis);
  if (up && FindUpAxis(kept, ignored) != *up) SetUpAxis(c3d, *up);
  c3d.rate_hz = static_cast<float>(recording.markers.rate_hz);
  SetMarkerLabels(c3d, recording.markers.labels);
  return c3d;
}

C3dRecording RecordToWrite(const Recording& recording, const SaveOptions& options,
                           Diagnostics& diagnostics) {
  const auto* kept = recording.record ? std::get_if<C3dRecording>(recording.record.get()) : nullptr;
  C3dWriteOptions write;
  if (kept != nullptr) {
    write.units = recording.units;
    write.up = ParseUpAxis(recording.up_axis).value_or(write.up);
    write.base = {kept, CentimetresIn(recording.units).value_or(write.base.cm_per_unit), write.up};
  }
  const bool same_units =
      options.units.empty() || CentimetresIn(options.units) == CentimetresIn(write.units);
  if (kept != nullptr && same_units && options.up_axis.value_or(write.up) == write.up) {
    return RecordAsTaken(recording, *kept);
  }
  if (!options.units.empty()) write.units = options.units;
  write.up = options.up_axis.value_or(write.up);
  return ToC3d(PointsOf(recording, diagnostics), write, diagnostics);
}

}  // namespace

Recording LoadC3d(const std::filesystem::path& path, const LoadOptions& options) {
  Recording loaded{.path = path, .format = "C3D", .name = ParseTakeName(path)};
  C3dRecording c3d = ReadC3d(path, {.strict = options.strict});
  loaded.diagnostics = c3d.diagnostics;
  loaded.units = ChooseUnits(c3d, options, path, loaded.diagnostics);
  const UpAxis up = options.up_axis ? *options.up_axis : FindUpAxis(c3d, loaded.diagnostics);
  loaded.up_axis = ToString(up);
  loaded.markers = BuildMarkers(c3d,
                                {.rate_hz = RateOf(c3d, options, loaded),
                                 .cm_per_unit = *CentimetresIn(loaded.units),
                                 .up = up},
                                loaded.diagnostics);
  if (!options.marker_names.empty()) {
    const MarkerNames names =
        ReadMarkerNames(options.marker_names, options.strict, loaded.diagnostics);
    loaded.markers.labels = PresetLabels(loaded.markers.labels, names, loaded.diagnostics);
  }
  loaded.record = std::make_shared<FileRecord>(std::move(c3d));
  return loaded;
}

void SaveC3d(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  C3dRecording c3d = RecordToWrite(recording, options, diagnostics);
  ReportRecordLoss(recording, "C3D", diagnostics);
  if (options.storage) ChangeStorage(c3d, *options.storage);
  if (!options.marker_names.empty()) {
    const MarkerNames names = ReadMarkerNames(options.marker_names, false, diagnostics);
    std::vector<std::string> labels;
    const std::vector<std::string> all = PointLabels(c3d);
    for (const std::size_t i : PlacesAmongPoints(c3d)) labels.push_back(all[i]);
    SetMarkerLabels(c3d, CustomLabels(labels, names, diagnostics));
  }
  WriteFile(path, FormatC3d(c3d), options.overwrite);
}

}  // namespace kinebase::internal
