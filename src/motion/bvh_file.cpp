// BVH as a row of MotionFormats().

#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/bvh_motion.h"
#include "motion/file_formats.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

// The record of a recording that was read from BVH; null for others.
const BvhMotion* RecordOf(const Recording& recording) {
  return recording.record == nullptr ? nullptr : std::get_if<BvhMotion>(recording.record.get());
}

bool WantsOtherWorld(const Recording& recording, const SaveOptions& options) {
  const bool other_axis = options.up_axis && ToString(*options.up_axis) != recording.up_axis;
  const bool other_units =
      !options.units.empty() && CentimetresIn(options.units) != CentimetresIn(recording.units);
  return other_axis || other_units;
}

bool TellsRate(const BvhMotion& bvh) {
  if (bvh.frame_time_s <= 0) return false;
  const double rate_hz = SnapRate(bvh.frame_time_s);
  return rate_hz >= kSmallestRateHz && rate_hz <= kLargestRateHz;
}

// The text of a frame time as it was read, unless the rate came from elsewhere.
void SetFrameTime(const BvhMotion& record, double rate_hz, BvhMotion& bvh) {
  bvh.frame_time_s = 1 / rate_hz;
  bvh.frame_time_text =
      TellsRate(record) ? record.frame_time_text : ToShortestText(bvh.frame_time_s);
}

// The record, with a frame count and a frame time that are true: others believe them.
std::string FormatRecord(const BvhMotion& bvh, double rate_hz, Diagnostics& diagnostics) {
  const auto rows = static_cast<std::int64_t>(bvh.frame_count());
  if (bvh.declared_frame_count == rows && TellsRate(bvh)) return FormatBvh(bvh);
  BvhMotion corrected = bvh;
  if (bvh.declared_frame_count != rows) {
    corrected.declared_frame_count = rows;
    diagnostics.push_back(
        {Severity::kInfo,
         fmt::format("'Frames:' is written as {}, the number of rows; the file that was read {}",
                     rows,
                     bvh.declared_frame_count ? fmt::format("said {}", *bvh.declared_frame_count)
                                              : std::string("had none"))});
  }
  if (!TellsRate(bvh)) {
    SetFrameTime(bvh, rate_hz, corrected);
    diagnostics.push_back(
        {Severity::kInfo,
         fmt::format(
             "'Frame Time:' is written as {}, for {:g} Hz; the file that was read told none",
             corrected.frame_time_text, rate_hz)});
  }
  return FormatBvh(corrected);
}

// The file tells neither unit nor axis: what readers will take it for, if that is not what it is.
void ReportWrongGuess(const BvhMotion& bvh, const BvhWriteOptions& world,
                      Diagnostics& diagnostics) {
  const BvhWorld guess = GuessWorld(bvh, world.up_axis);
  Untold untold;
  if (guess.up_axis != world.up_axis) untold.up = world.up_axis;
  if (CentimetresIn(guess.units) != CentimetresIn(world.units)) untold.units = world.units;
  ReportUntold(untold, "BVH", diagnostics);
}

}  // namespace

Recording LoadBvh(const std::filesystem::path& path, const LoadOptions& options) {
  BvhMotion bvh = ReadBvh(path, {.strict = options.strict});
  Recording recording{.path = path, .format = "BVH", .name = ParseTakeName(path)};
  recording.diagnostics = std::exchange(bvh.diagnostics, {});
  BvhBuildOptions build{.units = options.units, .up_axis = options.up_axis};
  if (!TellsRate(bvh)) {
    if (bvh.frame_time_s > 0) {
      recording.diagnostics.push_back(
          {Severity::kWarning,
           fmt::format("'Frame Time:' {} gives no rate between {:g} and {:g} Hz",
                       Quoted(bvh.frame_time_text), kSmallestRateHz, kLargestRateHz)});
    }
    build.rate_hz = ChooseRate(recording.name, options, recording.diagnostics);
  }
  try {
    BvhFigure figure = BuildFigure(bvh, build, recording.diagnostics);
    recording.units = std::move(figure.units);
    recording.up_axis = ToString(figure.up_axis);
    recording.motion = std::move(figure.motion);
    recording.joint_sources = std::move(figure.joint_sources);
  } catch (const Error& error) {
    throw Error(error.code(), error.message(), {path});
  }
  recording.record = std::make_shared<const FileRecord>(std::move(bvh));
  return recording;
}

void SaveBvh(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  RequireSkeleton(recording, "BVH", path);
  const BvhMotion* record = RecordOf(recording);
  ReportRecordLoss(recording, "BVH", diagnostics);
  BvhWriteOptions write;
  if (record != nullptr) {
    write.units = recording.units;
    write.up_axis = ParseUpAxis(recording.up_axis).value_or(UpAxis::kY);
  }
  if (!options.units.empty()) write.units = options.units;
  if (options.up_axis) write.up_axis = *options.up_axis;
  if (recording.first_frame() != 1) {
    diagnostics.push_back(
        {Severity::kInfo,
         fmt::format("BVH counts frames from 1; that this one's first is number {} is left out",
                     recording.first_frame())});
  }
  if (record != nullptr && !WantsOtherWorld(recording, options)) {
    const std::string text = FormatRecord(*record, recording.rate_hz(), diagnostics);
    ReportWrongGuess(*record, write, diagnostics);
    WriteFile(path, text, options.overwrite);
    return;
  }
  BvhMotion bvh = ToBvh(recording.motion, write, diagnostics);
  if (record != nullptr) {
    ReportRecordLoss(recording, "BVH in another world", diagnostics);
    SetFrameTime(*record, recording.rate_hz(), bvh);
  }
  ReportWrongGuess(bvh, write, diagnostics);
  WriteFile(path, FormatBvh(bvh), options.overwrite);
}

}  // namespace kinebase::internal
