// The rows of MOT and STO: joint angles or orientations of a skeleton; of a C3D with analog samples
// the ground forces or all channels.

#include <string>
#include <utility>
#include <variant>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/sto_motion.h"
#include "motion/file_formats.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

void CheckOptions(const SaveOptions& options, const std::filesystem::path& path) {
  const bool wants_other_units =
      !options.units.empty() && CentimetresIn(options.units) != CentimetresIn("m");
  if (options.up_axis.value_or(UpAxis::kY) == UpAxis::kY && !wants_other_units) return;
  throw Error(ErrorCode::kInvalidArgument,
              "OpenSim's tables have Y up and metres by definition; write them without --up and "
              "--units",
              {path});
}

const C3dRecording& AnalogOf(const Recording& recording, const std::filesystem::path& path) {
  const auto* c3d = recording.record ? std::get_if<C3dRecording>(recording.record.get()) : nullptr;
  if (c3d != nullptr && c3d->analog_per_frame() > 0) return *c3d;
  if (c3d == nullptr && recording.format == "C3D") {
    throw Error(ErrorCode::kMismatch,
                "MOT and STO hold the analog channels of a C3D at the rate they have there; write "
                "them without --rate",
                {path});
  }
  throw Error(ErrorCode::kMismatch,
              fmt::format("MOT and STO hold joint angles or analog channels and {} has markers "
                          "only; TRC holds markers",
                          Quoted(recording.path.filename().string())),
              {path});
}

void ReportMarkersLeft(const Recording& recording, Diagnostics& diagnostics) {
  if (recording.markers.marker_count() == 0) return;
  diagnostics.push_back(
      {Severity::kInfo, fmt::format("the {} markers are not in this file; TRC holds them",
                                    recording.markers.marker_count())});
}

void Write(StoTable table, const std::filesystem::path& path, const SaveOptions& options) {
  table.name = path.stem().string();
  WriteFile(path, FormatSto(table), options.overwrite);
}

StoTable AnalogTable(const Recording& recording, std::string_view format,
                     const std::filesystem::path& path, Diagnostics& diagnostics) {
  StoTable table = ToAnalogTable(AnalogOf(recording, path), diagnostics);
  ReportMarkersLeft(recording, diagnostics);
  ReportRecordLoss(recording, format, diagnostics, {Extra::kAnalog});
  return table;
}

}  // namespace

void SaveMot(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  CheckOptions(options, path);
  if (recording.has_skeleton()) {
    diagnostics.push_back(
        {Severity::kInfo, "MOT holds angles only; bones and limits belong into an OpenSim model"});
    ReportRecordLoss(recording, "MOT", diagnostics);
    return Write(ToJointAngles(recording.motion), path, options);
  }
  const C3dRecording& c3d = AnalogOf(recording, path);
  const GroundForceOptions ground{.up = ParseUpAxis(recording.up_axis).value_or(UpAxis::kZ),
                                  .cm_per_unit = CentimetresIn(recording.units).value_or(.1)};
  StoTable forces = ToGroundForces(c3d, ground, diagnostics);
  if (forces.labels.empty()) {
    return Write(AnalogTable(recording, "MOT", path, diagnostics), path, options);
  }
  diagnostics.push_back(
      {Severity::kInfo, "MOT holds the ground forces; STO holds all analog channels as they are"});
  ReportMarkersLeft(recording, diagnostics);
  ReportRecordLoss(recording, "MOT", diagnostics, {Extra::kAnalog, Extra::kForcePlates});
  Write(std::move(forces), path, options);
}

void SaveSto(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  CheckOptions(options, path);
  if (!recording.has_skeleton()) {
    return Write(AnalogTable(recording, "STO", path, diagnostics), path, options);
  }
  ReportRecordLoss(recording, "STO", diagnostics);
  diagnostics.push_back(
      {Severity::kInfo,
       "STO holds orientations only; MOT holds joint angles and where the root is"});
  Write(ToOrientations(recording.motion), path, options);
}

}  // namespace kinebase::internal
