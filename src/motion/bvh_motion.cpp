#include "kinebase/motion/bvh_motion.h"

#include <limits>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "motion/bvh_figure.h"

namespace kinebase {
namespace {

using internal::RawFigure;

double ChooseRate(const BvhMotion& bvh, const BvhBuildOptions& options) {
  const double rate =
      options.rate_hz > 0 || bvh.frame_time_s <= 0 ? options.rate_hz : SnapRate(bvh.frame_time_s);
  if (rate >= kSmallestRateHz && rate <= kLargestRateHz) return rate;
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("'Frame Time:' {} gives no rate between {:g} and {:g} Hz; state one",
                          Quoted(bvh.frame_time_text), kSmallestRateHz, kLargestRateHz),
              {bvh.file_name});
}

// A motion has a rotation for every joint in every frame. Where joints without channels outnumber
// the channels, that would be many times what the file holds.
void CheckSize(const BvhMotion& bvh, std::size_t bones) {
  constexpr std::size_t kMostBonesPerColumn = 8;
  constexpr std::size_t kHarmless = 10'000'000;
  const bool is_bloated =
      bones / kMostBonesPerColumn > bvh.column_count && bvh.frame_count() > kHarmless / bones;
  if (bvh.frame_count() > static_cast<std::size_t>(std::numeric_limits<int>::max()) || is_bloated) {
    throw Error(ErrorCode::kMalformedFile,
                fmt::format("{} frames of {} joints with {} channels: more than a motion can hold",
                            bvh.frame_count(), bones, bvh.column_count),
                {bvh.file_name});
  }
}

void ReportOtherRoots(const BvhMotion& bvh, Diagnostics& diagnostics) {
  std::string others;
  std::int64_t line = 0;
  for (const BvhJoint& joint : std::span(bvh.joints).subspan(1)) {
    if (joint.parent >= 0) continue;
    if (line == 0) line = joint.line;
    others += (others.empty() ? "" : ", ") + Quoted(joint.name);
    if (others.size() > 200) {
      others += " …";
      break;
    }
  }
  if (others.empty()) return;
  diagnostics.push_back({Severity::kWarning,
                         fmt::format("several roots: the motion is that of {}; left out: {}",
                                     Quoted(bvh.joints[0].name), others),
                         line});
}

// The skeleton and motion of the file's world in ours: M·v · scale for every vector, M·R·M⁻¹ for
// every rotation. The angles that a joint had in the file are then those about its own axes, M.
void BringToOurWorld(RawFigure& figure, UpAxis up, double cm_per_unit, SkeletonSource source) {
  const Eigen::Matrix3d turn = ToYUp(up);
  const Eigen::Quaterniond turn_rotation(turn);
  const Eigen::Vector3d axis = QuaternionToEuler(turn_rotation, EulerOrder::kXyz);
  const auto convert = [&](Eigen::Vector3d& v) { v = turn * v * cm_per_unit; };
  for (std::size_t i = 0; i < figure.joints.size(); ++i) {
    Joint& joint = figure.joints[i];
    convert(joint.offset_cm);
    joint.direction = turn * joint.direction;
    joint.length_cm *= cm_per_unit;
    if (i > 0) joint.axis_rad = axis;
  }
  Motion& motion = figure.motion;
  for (Eigen::Vector3d& position : motion.root_position_cm) convert(position);
  for (Eigen::Vector3d& offset : motion.extra_offsets_cm) convert(offset);
  if (up != UpAxis::kY) {
    for (Eigen::Quaterniond& rotation : motion.rotations) {
      rotation = turn_rotation * rotation * turn_rotation.conjugate();
    }
  }
  motion.skeleton = std::make_shared<const Skeleton>(std::move(figure.joints), std::move(source),
                                                     Eigen::Vector3d::Zero(),
                                                     Eigen::Vector3d::Zero(), figure.rig.name_map);
}

SkeletonSource SourceOf(const BvhMotion& bvh, const RawFigure& raw) {
  return {.file_name = bvh.file_name, .file_type = "BVH", .name = raw.joints.front().name};
}

// Bones and frames as they are in the file.
RawFigure BuildRaw(const BvhMotion& bvh, Diagnostics& diagnostics) {
  RawFigure raw;
  ReportOtherRoots(bvh, diagnostics);
  internal::BuildBones(bvh, raw);
  CheckSize(bvh, raw.bones.size());
  raw.rig = MapRig(raw.joints);
  internal::BuildFrames(bvh, raw, diagnostics);
  raw.motion.skeleton =
      std::make_shared<const Skeleton>(raw.joints, SourceOf(bvh, raw), Eigen::Vector3d::Zero(),
                                       Eigen::Vector3d::Zero(), raw.rig.name_map);
  return raw;
}

}  // namespace

BvhWorld GuessWorld(const BvhMotion& bvh, std::optional<UpAxis> up_axis) {
  Diagnostics ignored;
  const RawFigure raw = BuildRaw(bvh, ignored);
  const UpAxis guess = internal::GuessUpAxis(raw, ignored);
  return {.units = internal::GuessUnits(raw, up_axis.value_or(guess), ignored), .up_axis = guess};
}

BvhFigure BuildFigure(const BvhMotion& bvh, const BvhBuildOptions& options,
                      Diagnostics& diagnostics) {
  RawFigure raw = BuildRaw(bvh, diagnostics);
  raw.motion.rate_hz = ChooseRate(bvh, options);
  internal::ReportMissingBones(raw, diagnostics);

  BvhFigure figure{.rig = raw.rig.rig, .joint_sources = raw.rig.sources};
  figure.up_axis = options.up_axis ? *options.up_axis : internal::GuessUpAxis(raw, diagnostics);
  figure.units = options.units.empty() ? internal::GuessUnits(raw, figure.up_axis, diagnostics)
                                       : options.units;
  BringToOurWorld(raw, figure.up_axis, CentimetresInOrFail(figure.units), SourceOf(bvh, raw));
  figure.motion = std::move(raw.motion);
  return figure;
}

}  // namespace kinebase
