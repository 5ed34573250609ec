// The row of MAT: the structures `skel` and `mot` for MATLAB code written for HDM05.

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/core/units.h"
#include "kinebase/motion/kinematics.h"
#include "motion/file_formats.h"
#include "motion/mat_structs.h"
#include "motion/motion_world.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

constexpr std::string_view kBoneUnits = "inch";  // Of the original cache files.
constexpr std::string_view kMarkerUnits = "cm";  // Of what the tools made of C3D files.
constexpr double kSmallestStatureCm = 120;
constexpr double kLargestStatureCm = 220;

const MatArray& NeedVariable(const MatFile& mat, std::string_view name,
                             const std::filesystem::path& path) {
  if (const MatArray* const found = mat.Find(name)) return *found;
  std::string names;
  for (const MatVariable& variable : mat.variables) {
    names.append(names.empty() ? "" : ", ").append(variable.name);
  }
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("expected the variables skel and mot of HDM05's MATLAB tools, found {}",
                          names.empty() ? "none" : Quoted(names)),
              {path});
}

// The cache files are named HDM_bd_squat1Reps_001_120.amc.mat.
TakeName NameOf(const std::filesystem::path& path) {
  const std::filesystem::path stem = path.stem();
  return ParseTakeName(FindMotionFormat(stem) != nullptr ? stem : path);
}

bool IsHumanStature(const Skeleton& skeleton) {
  double low = 0;
  double high = 0;
  for (const Eigen::Vector3d& place : NeutralPose(skeleton)) {
    low = std::min(low, place.y());
    high = std::max(high, place.y());
  }
  return high - low >= kSmallestStatureCm && high - low <= kLargestStatureCm;
}

// Inches, unless only centimetres make the figure human.
std::string ChooseUnits(const MatStructReader& skel, const LoadOptions& options,
                        Diagnostics& diagnostics) {
  if (!options.units.empty()) return options.units;
  const auto fits = [&](double unit_cm) { return IsHumanStature(*TakeSkel(skel, unit_cm)); };
  if (fits(kCentimetresPerInch) || !fits(1)) return std::string(kBoneUnits);
  diagnostics.push_back({Severity::kInfo,
                         "lengths are taken as centimetres, as in inches the figure would not "
                         "have a human's stature; --source-units says another"});
  return "cm";
}

}  // namespace

Recording LoadMat(const std::filesystem::path& path, const LoadOptions& options) {
  const MatFile mat = ReadMat(path);
  const MatStructReader skel(NeedVariable(mat, "skel", path), "skel", path);
  const MatStructReader mot(NeedVariable(mat, "mot", path), "mot", path);
  const UpAxis up = options.up_axis.value_or(UpAxis::kY);
  Recording recording{
      .path = path, .format = "MAT", .name = NameOf(path), .up_axis = std::string(ToString(up))};
  recording.diagnostics = mat.diagnostics;
  double rate_hz = RateOf(mot);
  if (rate_hz == 0) rate_hz = ChooseRate(recording.name, options, recording.diagnostics);
  if (HasRotations(skel, mot)) {
    recording.units = ChooseUnits(skel, options, recording.diagnostics);
    const double unit_cm = CentimetresInOrFail(recording.units, path);
    recording.motion = TakeMot(mot, TakeSkel(skel, unit_cm), unit_cm, recording.diagnostics);
    recording.motion.rate_hz = rate_hz;
    if (up != UpAxis::kY) recording.motion = TurnMotion(recording.motion, ToYUp(up));
  } else {
    recording.units = options.units.empty() ? std::string(kMarkerUnits) : options.units;
    recording.markers = TakeTrajectories(mot, CentimetresInOrFail(recording.units, path));
    recording.markers.rate_hz = rate_hz;
    for (auto& position : recording.markers.positions_cm) position = ToYUp(up) * position;
  }
  return recording;
}

void SaveMat(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  const UpAxis up = options.up_axis.value_or(UpAxis::kY);
  const Eigen::Matrix3d turn = ToYUp(up).transpose();
  const std::string file_name = recording.path.filename().string();
  const std::string_view usual_units = recording.has_skeleton() ? kBoneUnits : kMarkerUnits;
  const std::string units(options.units.empty() ? usual_units : options.units);
  const double unit_cm = CentimetresInOrFail(units, path);
  CheckWritable(path, options.overwrite);
  ReportRecordLoss(recording, "MAT", diagnostics, {Extra::kSkeletonSource});
  Untold untold;
  if (up != UpAxis::kY) untold.up = up;
  if (unit_cm != CentimetresInOrFail(usual_units)) untold.units = units;
  ReportUntold(untold, "MAT", diagnostics);
  MatFile mat;
  if (recording.has_skeleton()) {
    const Motion motion = up == UpAxis::kY ? recording.motion : TurnMotion(recording.motion, turn);
    mat.variables.push_back({"skel", false, SkelOf(*motion.skeleton, unit_cm)});
    mat.variables.push_back({"mot", false, MotOf(motion, file_name, unit_cm)});
  } else {
    MarkerCloud markers = recording.markers;
    for (auto& position : markers.positions_cm) position = turn * position;
    mat.variables.push_back({"skel", false, SkelOf(markers, file_name)});
    mat.variables.push_back({"mot", false, MotOf(markers, file_name, unit_cm)});
    if (std::ranges::find(markers.states, MarkerState::kFilled) != markers.states.end()) {
      diagnostics.push_back(
          {Severity::kInfo, "the structures do not tell filled markers from measured ones"});
    }
  }
  if (recording.first_frame() != 1) {
    diagnostics.push_back(
        {Severity::kInfo, fmt::format("frames count from 1 in the structures; the first was {}",
                                      recording.first_frame())});
  }
  WriteFile(path, FormatMat(mat), options.overwrite);
}

}  // namespace kinebase::internal
