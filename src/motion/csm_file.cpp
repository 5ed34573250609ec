// The row of CSM: markers, with an MNM file their names.

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/csm_motion.h"
#include "motion/file_formats.h"
#include "motion/point_writing.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

constexpr UpAxis kCsmUp = UpAxis::kZ;
constexpr std::string_view kCsmUnits = "mm";

bool IsRate(double rate_hz) { return rate_hz >= kSmallestRateHz && rate_hz <= kLargestRateHz; }

double RateOf(const CsmRecording& csm, const LoadOptions& options, Recording& loaded) {
  if (csm.rate_hz && IsRate(*csm.rate_hz)) return *csm.rate_hz;
  if (csm.rate_hz) {
    loaded.diagnostics.push_back(
        {Severity::kWarning, fmt::format("'$rate' says {:g} Hz, which is none", *csm.rate_hz)});
  }
  return ChooseRate(loaded.name, options, loaded.diagnostics);
}

void CheckLabels(const Recording& loaded, bool strict, Diagnostics& diagnostics) {
  const Diagnostics preset = CheckPreset(loaded.markers.labels);
  diagnostics.insert(diagnostics.end(), preset.begin(), preset.end());
  if (!HasBandAndStick(loaded.markers.labels)) return;
  const std::string message = "a wrist has markers both of a band and of a stick";
  if (strict) {
    throw Error(ErrorCode::kMalformedFile,
                message + ", which the format forbids (without --strict they are read)",
                {loaded.path});
  }
  diagnostics.push_back({Severity::kWarning, message + ", which the format forbids"});
}

// What to write: the file's own record if there is one that fits, else one made of the markers.
CsmRecording RecordToWrite(const Recording& recording, const std::filesystem::path& path,
                           Diagnostics& diagnostics) {
  const auto* kept = recording.record ? std::get_if<CsmRecording>(recording.record.get()) : nullptr;
  const bool keeps_to_format = recording.units == kCsmUnits && recording.up_axis == "Z";
  if (kept != nullptr && keeps_to_format) {
    CsmRecording csm = *kept;
    csm.labels = recording.markers.labels;
    csm.rate_hz = recording.markers.rate_hz;  // Where the file tells none, what was taken.
    return csm;
  }
  CsmRecording csm = ToCsm(recording.markers, diagnostics);
  csm.file_name = path.filename().string();
  csm.actor = recording.name.actor;
  if (kept == nullptr) return csm;
  CsmRecording with_all = *kept;
  with_all.labels = std::move(csm.labels);
  with_all.values = std::move(csm.values);
  with_all.rate_hz = csm.rate_hz;
  return with_all;
}

}  // namespace

Recording LoadCsm(const std::filesystem::path& path, const LoadOptions& options) {
  Recording loaded{.path = path, .format = "CSM", .name = ParseTakeName(path)};
  CsmRecording csm = ReadCsm(path, {.strict = options.strict});
  loaded.diagnostics = csm.diagnostics;
  loaded.units = options.units.empty() ? kCsmUnits : std::string_view(options.units);
  const UpAxis up = options.up_axis.value_or(kCsmUp);
  loaded.up_axis = ToString(up);
  const CsmBuildOptions build{.rate_hz = RateOf(csm, options, loaded),
                              .cm_per_unit = CentimetresInOrFail(loaded.units, path),
                              .up = up};
  loaded.markers = BuildMarkers(csm, build, loaded.diagnostics);
  if (!options.marker_names.empty()) {
    const MarkerNames names =
        ReadMarkerNames(options.marker_names, options.strict, loaded.diagnostics);
    loaded.markers.labels = PresetLabels(csm.labels, names, loaded.diagnostics);
  }
  CheckLabels(loaded, options.strict, loaded.diagnostics);
  loaded.record = std::make_shared<FileRecord>(std::move(csm));
  return loaded;
}

void SaveCsm(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  if (recording.has_skeleton()) {
    throw Error(
        ErrorCode::kMismatch,
        fmt::format("CSM holds markers and {} is a skeleton; formats for skeletons are "
                    "ASF/AMC, BVH, GLB, MOT, NPZ and MAT; C3D and TRC take its joints as points",
                    Quoted(recording.path.filename().string())),
        {path});
  }
  const bool wants_other_units =
      !options.units.empty() && CentimetresIn(options.units) != CentimetresIn(kCsmUnits);
  if (options.up_axis.value_or(kCsmUp) != kCsmUp || wants_other_units) {
    throw Error(ErrorCode::kInvalidArgument,
                "CSM has Z up and millimetres by definition; write it without --up and --units",
                {path});
  }
  CsmRecording csm = RecordToWrite(recording, path, diagnostics);
  if (!options.marker_names.empty()) {
    const MarkerNames names = ReadMarkerNames(options.marker_names, false, diagnostics);
    csm.labels = CustomLabels(csm.labels, names, diagnostics);
  }
  ReportFilledSamples(recording.markers, "CSM", diagnostics);
  ReportRecordLoss(recording, "CSM", diagnostics);
  WriteFile(path, FormatCsm(csm), options.overwrite);
}

}  // namespace kinebase::internal
