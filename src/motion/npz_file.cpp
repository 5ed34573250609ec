// The row of NPZ: a recording as arrays for NumPy. docs/formats/npz.md lists them.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/kinematics.h"
#include "motion/file_formats.h"
#include "motion/motion_world.h"
#include "motion/npz_arrays.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

constexpr std::string_view kFormat = "kinebase";
constexpr std::int64_t kVersion = 1;

// Beyond that a quaternion is normalised; single precision is, and what we write is not.
constexpr double kUnitLength = 1e-9;

// How lengths and axes of a file lead to ours.
struct FileWorld {
  std::string units = "cm";
  double unit_cm = 1;
  UpAxis up = UpAxis::kY;
};

void CheckVersion(NpzSource& source) {
  if (const std::string format = source.Text("format"); format != kFormat) {
    source.Fail(fmt::format("array 'format' says {}; expected '{}'", Quoted(format), kFormat));
  }
  const std::int64_t version = source.Integer("version");
  if (version < 1 || version > kVersion) {
    source.Fail(fmt::format("has version {}; this program reads up to version {}: use a newer one",
                            version, kVersion));
  }
}

FileWorld TakeWorld(NpzSource& source, const std::filesystem::path& path,
                    const LoadOptions& options) {
  FileWorld world;
  if (source.Has("units")) world.units = source.Text("units");
  if (!options.units.empty()) world.units = options.units;
  world.unit_cm = CentimetresInOrFail(world.units, path);
  if (source.Has("up_axis")) {
    const std::string text = source.Text("up_axis");
    const auto up = ParseUpAxis(text);
    if (!up) source.Fail(fmt::format("array 'up_axis' says {}; expected X, Y or Z", Quoted(text)));
    world.up = *up;
  }
  world.up = options.up_axis.value_or(world.up);
  return world;
}

double TakeRate(NpzSource& source) {
  const double rate_hz = source.Number("rate_hz");
  if (rate_hz >= kSmallestRateHz && rate_hz <= kLargestRateHz) return rate_hz;
  source.Fail(fmt::format("array 'rate_hz' says {:g}; expected {:g} to {:g}", rate_hz,
                          kSmallestRateHz, kLargestRateHz));
}

int TakeFrameCount(NpzSource& source, std::string_view name) {
  const NpzShape& shape = source.Need(name).shape;
  const std::size_t frames = shape.empty() ? 0 : shape.front();
  if (frames <= static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return static_cast<int>(frames);
  }
  source.Fail(fmt::format("array '{}' has {} frames, more than a recording can", name, frames));
}

void CheckFinite(NpzSource& source, std::string_view name,
                 const std::vector<Eigen::Vector3d>& values, std::size_t per_frame) {
  const auto odd = std::ranges::find_if_not(values, [](const auto& v) { return v.allFinite(); });
  if (odd == values.end()) return;
  source.Fail(fmt::format("array '{}' has no number in frame {} (counted from 1)", name,
                          static_cast<std::size_t>(odd - values.begin()) / per_frame + 1));
}

std::vector<Eigen::Quaterniond> TakeRotations(NpzSource& source, std::size_t frames,
                                              std::size_t joints) {
  const auto numbers =
      source.Numbers("rotations", {frames, joints, 4}, "frames × bones × (w, x, y, z)");
  std::vector<Eigen::Quaterniond> rotations;
  rotations.reserve(frames * joints);
  for (std::size_t i = 0; i < numbers.size(); i += 4) {
    Eigen::Quaterniond rotation(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]);
    const double length = rotation.norm();
    if (!std::isfinite(length) || length < kUnitLength) {
      source.Fail(
          fmt::format("array 'rotations' has no rotation for bone {} in frame {} (both "
                      "counted from 1)",
                      i / 4 % joints + 1, i / 4 / joints + 1));
    }
    if (std::abs(length - 1) > kUnitLength) rotation.coeffs() /= length;
    rotations.push_back(rotation);
  }
  return rotations;
}

Motion TakeMotion(NpzSource& source, const FileWorld& world) {
  Motion motion{.skeleton = TakeSkeleton(source, world.unit_cm),
                .rate_hz = TakeRate(source),
                .frame_count = TakeFrameCount(source, "rotations")};
  const auto frames = static_cast<std::size_t>(motion.frame_count);
  const std::size_t joints = motion.skeleton->joints().size();
  motion.rotations = TakeRotations(source, frames, joints);
  motion.root_position_cm = source.Vectors("root_position", {frames, 3}, "frames × 3");
  CheckFinite(source, "root_position", motion.root_position_cm, 1);
  if (source.Has("extra_offsets")) {
    motion.extra_offsets_cm =
        source.Vectors("extra_offsets", {frames, joints, 3}, "frames × bones × 3");
    CheckFinite(source, "extra_offsets", motion.extra_offsets_cm, joints);
  }
  for (auto& position : motion.root_position_cm) position *= world.unit_cm;
  for (auto& offset : motion.extra_offsets_cm) offset *= world.unit_cm;
  if (source.Has("positions")) (void)source.Need("positions");  // They follow from the rest.
  if (world.up != UpAxis::kY) return TurnMotion(motion, ToYUp(world.up));
  return motion;
}

MarkerCloud TakeMarkers(NpzSource& source, const FileWorld& world) {
  MarkerCloud markers{.rate_hz = TakeRate(source),
                      .frame_count = TakeFrameCount(source, "positions")};
  const auto frames = static_cast<std::size_t>(markers.frame_count);
  const std::size_t count = source.Need("labels").size();
  markers.labels = source.Texts("labels", {count}, "markers");
  markers.positions_cm =
      source.Vectors("positions", {frames, count, 3}, "frames × markers × (x, y, z)");
  for (auto& position : markers.positions_cm) {
    position *= world.unit_cm;
    if (world.up != UpAxis::kY) position = ToYUp(world.up) * position;
  }
  std::vector<std::int64_t> states(frames * count,
                                   static_cast<std::int64_t>(MarkerState::kMeasured));
  if (source.Has("states")) {
    states = source.Integers("states", {frames, count}, "frames × markers");
  }
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i] < 0 || states[i] > static_cast<std::int64_t>(MarkerState::kMeasured)) {
      source.Fail(
          fmt::format("array 'states' holds {}; expected 0 (missing), 1 (filled) or 2 "
                      "(measured)",
                      states[i]));
    }
    auto state = static_cast<MarkerState>(states[i]);
    if (!markers.positions_cm[i].allFinite()) state = MarkerState::kMissing;
    if (state == MarkerState::kMissing) markers.positions_cm[i] = MissingPosition();
    markers.states.push_back(state);
  }
  return markers;
}

constexpr std::array kMatches = {JointMatch::kTable, JointMatch::kTopology, JointMatch::kNearest,
                                 JointMatch::kMissing};

void AddJointSources(const std::vector<JointSource>& sources, NpzTarget& target) {
  if (sources.empty()) return;
  std::vector<std::string> joints, names, matches;
  std::vector<double> confidences;
  for (const JointSource& source : sources) {
    joints.emplace_back(ToString(source.joint));
    names.push_back(source.source);
    matches.emplace_back(ToString(source.match));
    confidences.push_back(source.confidence);
  }
  const NpzShape shape = {sources.size()};
  target.Add("standard_joints", shape, std::move(joints));
  target.Add("standard_joint_sources", shape, std::move(names));
  target.Add("standard_joint_matches", shape, std::move(matches));
  target.Add("standard_joint_confidences", shape, std::move(confidences));
}

std::vector<JointSource> TakeJointSources(NpzSource& source) {
  std::vector<JointSource> result;
  if (!source.Has("standard_joints")) return result;
  const std::size_t count = source.Need("standard_joints").size();
  const auto joints = source.Texts("standard_joints", {count}, "joints");
  const auto names = source.Texts("standard_joint_sources", {count}, "joints");
  const auto matches = source.Texts("standard_joint_matches", {count}, "joints");
  const auto confidences = source.Numbers("standard_joint_confidences", {count}, "joints");
  for (std::size_t i = 0; i < count; ++i) {
    const auto joint = ParseStandardJoint(joints[i]);
    const auto match =
        std::ranges::find(kMatches, matches[i], [](JointMatch m) { return ToString(m); });
    if (!joint || match == kMatches.end()) {
      source.Fail(fmt::format("array 'standard_joints': {} found by {} is unknown",
                              Quoted(joints[i]), Quoted(matches[i])));
    }
    result.push_back({*joint, names[i], *match, confidences[i]});
  }
  return result;
}

void AddMotion(const Motion& motion, double unit_cm, NpzTarget& target) {
  const auto frames = static_cast<std::size_t>(motion.frame_count);
  const std::size_t joints = motion.skeleton->joints().size();
  AddSkeleton(*motion.skeleton, unit_cm, target);
  target.AddVectors("root_position", {frames}, motion.root_position_cm, 1 / unit_cm);
  std::vector<double> rotations;
  rotations.reserve(motion.rotations.size() * 4);
  for (const Eigen::Quaterniond& q : motion.rotations) {
    rotations.insert(rotations.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  target.Add("rotations", {frames, joints, 4}, std::move(rotations));
  if (!motion.extra_offsets_cm.empty()) {
    target.AddVectors("extra_offsets", {frames, joints}, motion.extra_offsets_cm, 1 / unit_cm);
  }
  target.AddVectors("positions", {frames, joints}, ForwardKinematics(motion).positions_cm,
                    1 / unit_cm);
}

void AddMarkers(const MarkerCloud& markers, const FileWorld& world, NpzTarget& target) {
  const auto frames = static_cast<std::size_t>(markers.frame_count);
  const std::size_t count = markers.labels.size();
  target.Add("labels", {count}, markers.labels);
  std::vector<Eigen::Vector3d> positions = markers.positions_cm;
  if (world.up != UpAxis::kY) {
    const Eigen::Matrix3d turn = ToYUp(world.up).transpose();
    for (auto& position : positions) position = turn * position;
  }
  target.AddVectors("positions", {frames, count}, positions, 1 / world.unit_cm);
  std::vector<std::uint8_t> states;
  states.reserve(markers.states.size());
  for (const MarkerState state : markers.states) states.push_back(static_cast<std::uint8_t>(state));
  target.Add("states", {frames, count}, std::move(states));
}

}  // namespace

Recording LoadNpz(const std::filesystem::path& path, const LoadOptions& options) {
  const NpzArchive archive = ReadNpz(path);
  NpzSource source(archive, path);
  CheckVersion(source);
  const FileWorld world = TakeWorld(source, path, options);
  Recording recording{.path = path,
                      .format = "NPZ",
                      .name = ParseTakeName(path),
                      .units = world.units,
                      .up_axis = std::string(ToString(world.up))};
  const std::int64_t first_frame = source.Has("first_frame") ? source.Integer("first_frame") : 1;
  if (source.Has("labels")) {
    recording.markers = TakeMarkers(source, world);
    recording.markers.first_frame = first_frame;
  } else {
    recording.motion = TakeMotion(source, world);
    recording.motion.first_frame = first_frame;
  }
  recording.joint_sources = TakeJointSources(source);
  recording.diagnostics = archive.diagnostics;
  if (const std::string unread = source.Unread(); !unread.empty()) {
    recording.diagnostics.push_back(
        {Severity::kWarning, "arrays that are no part of a recording are left out: " + unread});
  }
  return recording;
}

void SaveNpz(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  FileWorld world{.up = options.up_axis.value_or(UpAxis::kY)};
  if (!options.units.empty()) world.units = options.units;
  world.unit_cm = CentimetresInOrFail(world.units, path);
  CheckWritable(path, options.overwrite);
  ReportRecordLoss(recording, "NPZ", diagnostics, {Extra::kSkeletonSource});
  NpzTarget target;
  target.Add("format", std::string(kFormat));
  target.Add("version", kVersion);
  target.Add("units", world.units);
  target.Add("up_axis", std::string(ToString(world.up)));
  target.Add("rate_hz", recording.rate_hz());
  target.Add("first_frame", recording.first_frame());
  if (!recording.has_skeleton()) {
    AddMarkers(recording.markers, world, target);
  } else if (world.up == UpAxis::kY) {
    AddMotion(recording.motion, world.unit_cm, target);
  } else {
    AddMotion(TurnMotion(recording.motion, ToYUp(world.up).transpose()), world.unit_cm, target);
  }
  AddJointSources(recording.joint_sources, target);
  WriteFile(path, FormatNpz(target.Take()), options.overwrite);
}

}  // namespace kinebase::internal
