#include "kinebase/motion/motion_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/loose_markers.h"
#include "kinebase/motion/marker_joints.h"
#include "kinebase/motion/motion_editing.h"
#include "motion/file_formats.h"
#include "motion/record_loss.h"

namespace kinebase {
namespace {

constexpr double kUsualRateHz = 120;

constexpr std::array kFormats = {
    MotionFormat{"ASF/AMC", ".amc", "Acclaim motion with its skeleton in an ASF file",
                 &internal::LoadAsfAmc, &internal::SaveAsfAmc},
    MotionFormat{"C3D", ".c3d", "markers, analog channels and events of optical systems",
                 &internal::LoadC3d, &internal::SaveC3d},
    MotionFormat{"BVH", ".bvh", "skeleton and motion of many animation programs",
                 &internal::LoadBvh, &internal::SaveBvh},
    MotionFormat{"CSM", ".csm", "markers for Character Studio", &internal::LoadCsm,
                 &internal::SaveCsm},
    MotionFormat{"TRC", ".trc", "markers for OpenSim", &internal::LoadTrc, &internal::SaveTrc},
    MotionFormat{"MOT", ".mot", "joint angles or analog channels for OpenSim", nullptr,
                 &internal::SaveMot},
    MotionFormat{"STO", ".sto", "orientations or analog channels for OpenSim", nullptr,
                 &internal::SaveSto},
    MotionFormat{"NPZ", ".npz", "arrays for NumPy", &internal::LoadNpz, &internal::SaveNpz},
    MotionFormat{"MAT", ".mat", "skel and mot structures for MATLAB, as HDM05's tools have them",
                 &internal::LoadMat, &internal::SaveMat},
    MotionFormat{"GLB", ".glb", "glTF: skeleton with animation for viewers and engines", nullptr,
                 &internal::SaveGlb},
    MotionFormat{"CSV", ".csv", "a table of places", nullptr, &internal::SaveCsv},
};

// Formats that are worth writing where there are only analog channels.
constexpr std::array<std::string_view, 3> kChannelFormats = {"C3D", "MOT", "STO"};

// Formats whose markers may have names of their own.
constexpr std::array<std::string_view, 3> kMarkerNameFormats = {"C3D", "CSM", "TRC"};

// Extensions of the formats that can be read, or written.
template <typename Function>
std::string Extensions(Function MotionFormat::*can) {
  std::string text;
  for (const MotionFormat& format : kFormats) {
    if (format.*can == nullptr) continue;
    text.append(text.empty() ? "" : ", ").append(format.extension);
  }
  return text;
}

Recording WithoutRecord(const Recording& recording) {
  Recording copy{.path = recording.path,
                 .format = recording.format,
                 .skeleton_path = recording.skeleton_path,
                 .name = recording.name,
                 .units = recording.units,
                 .up_axis = recording.up_axis};
  copy.marker_set = recording.marker_set;
  copy.joint_sources = recording.joint_sources;
  copy.diagnostics = recording.diagnostics;
  return copy;
}

// The frames first … last of what has `per_frame` values a frame.
template <typename T>
void Keep(std::vector<T>& items, std::size_t per_frame, int first, int last) {
  const auto begin = items.begin() + static_cast<std::ptrdiff_t>(per_frame) * first;
  const auto end = items.begin() + static_cast<std::ptrdiff_t>(per_frame) * (last + 1);
  items = std::vector<T>(begin, end);
}

AcclaimRecord Cut(const AcclaimRecord& record, int first, int last) {
  AcclaimRecord cut{.asf = record.asf, .amc = CutAmc(record.amc, first, last)};
  // A clip counts from 1, a stretch as the file does.
  cut.amc.frame_numbers = record.amc.frame_numbers;
  Keep(cut.amc.frame_numbers, 1, first, last);
  return cut;
}

BvhMotion Cut(const BvhMotion& bvh, int first, int last) { return CutBvh(bvh, first, last); }

C3dRecording Cut(const C3dRecording& c3d, int first, int last) { return CutC3d(c3d, first, last); }

CsmRecording Cut(CsmRecording csm, int first, int last) {
  Keep(csm.frame_numbers, 1, first, last);
  Keep(csm.values, csm.marker_count() * 3, first, last);
  return csm;
}

TrcRecording Cut(TrcRecording trc, int first, int last) {
  Keep(trc.frame_numbers, 1, first, last);
  Keep(trc.times_s, 1, first, last);
  Keep(trc.values, trc.marker_count() * 3, first, last);
  return trc;
}

std::shared_ptr<const FileRecord> CutRecord(const FileRecord& record, int first, int last) {
  return std::visit(
      [&](const auto& each) { return std::make_shared<const FileRecord>(Cut(each, first, last)); },
      record);
}

std::span<const MarkerSet> SetsFor(const Recording& recording) {
  return recording.marker_set ? std::span(recording.marker_set.get(), 1) : BuiltInMarkerSets();
}

MarkerJoints JointsFromMarkers(const Recording& recording, Diagnostics& diagnostics) {
  return ApproximateJoints(recording.markers, SetsFor(recording), diagnostics);
}

void ReportLooseMarkers(const Recording& recording, Diagnostics& diagnostics) {
  for (const LooseMarker& loose : FindLooseMarkers(recording.markers, SetsFor(recording))) {
    diagnostics.push_back(
        {Severity::kWarning,
         fmt::format("marker {} does not keep its distance from {}: up to {:.0f} cm off, in {} of "
                     "frames {} to {}; joints placed by it are wrong there",
                     loose.label, fmt::join(loose.others, ", "), loose.farthest_cm, loose.frames,
                     recording.first_frame() + loose.first, recording.first_frame() + loose.last)});
  }
}

template <typename Function>
auto NamingTheFile(const Recording& recording, Function function) {
  try {
    return function();
  } catch (const Error& error) {
    if (!error.place().file.empty()) throw;
    throw Error(error.code(), error.message(), {recording.path});
  }
}

}  // namespace

namespace internal {

double ChooseRate(const TakeName& name, const LoadOptions& options, Diagnostics& diagnostics) {
  if (options.source_rate_hz != 0) {
    if (options.source_rate_hz >= kSmallestRateHz && options.source_rate_hz <= kLargestRateHz) {
      return options.source_rate_hz;
    }
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a source rate of {:g} Hz; it must lie between {:g} and {:g} Hz",
                            options.source_rate_hz, kSmallestRateHz, kLargestRateHz));
  }
  if (name.rate_hz > 0) {
    if (name.class_name.empty() && name.take.find('-') == std::string::npos) {
      diagnostics.push_back(
          {Severity::kInfo,
           fmt::format("rate {} Hz as the name looks like one of the CMU database; --source-rate "
                       "says another",
                       name.rate_hz)});
    }
    return name.rate_hz;
  }
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format("the file does not tell its rate; {} Hz is taken, --source-rate says another",
                   kUsualRateHz)});
  return kUsualRateHz;
}

MarkerCloud PointsOf(const Recording& recording, Diagnostics& diagnostics) {
  if (!recording.has_skeleton()) return recording.markers;
  const Motion& motion = recording.motion;
  MarkerCloud points{.rate_hz = motion.rate_hz,
                     .frame_count = motion.frame_count,
                     .first_frame = motion.first_frame};
  for (const Joint& joint : motion.skeleton->joints()) points.labels.push_back(joint.bone_name);
  points.positions_cm = ForwardKinematics(motion).positions_cm;
  points.states.assign(points.positions_cm.size(), MarkerState::kMeasured);
  diagnostics.push_back(
      {Severity::kInfo,
       fmt::format("the {} joints are written as points; bones, rotations and limits do not fit",
                   points.labels.size())});
  return points;
}

void RequireSkeleton(const Recording& recording, std::string_view format,
                     const std::filesystem::path& path) {
  if (recording.has_skeleton()) return;
  throw Error(ErrorCode::kMismatch,
              fmt::format("{} needs a skeleton and {} holds markers only; formats for markers are "
                          "C3D, CSM, TRC, NPZ, MAT and CSV",
                          format, Quoted(recording.path.filename().string())),
              {path});
}

}  // namespace internal

std::span<const MotionFormat> MotionFormats() { return kFormats; }

const MotionFormat* FindMotionFormat(const std::filesystem::path& path) {
  const std::string extension = ToLower(path.extension().string());
  for (const MotionFormat& format : kFormats) {
    if (format.extension == extension) return &format;
  }
  return nullptr;
}

Recording LoadRecording(const std::filesystem::path& path, const LoadOptions& options) {
  std::error_code ignored;  // A name that is too long, say: there is no such file either.
  if (!std::filesystem::exists(path, ignored)) {
    throw Error(ErrorCode::kNotFound, "does not exist", {path});
  }
  const MotionFormat* format = FindMotionFormat(path);
  if (format == nullptr || format->load == nullptr) {
    if (EqualsIgnoringCase(path.extension().string(), ".asf")) {
      throw Error(ErrorCode::kInvalidArgument,
                  "is a skeleton, which does not move; name a motion that it belongs to (.amc)",
                  {path});
    }
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} files cannot be read as motion; those that can: {}",
                            Quoted(path.extension().string()), Extensions(&MotionFormat::load)),
                {path});
  }
  Recording recording = format->load(path, options);
  if (recording.frame_count() == 0) {
    throw Error(ErrorCode::kMalformedFile, "has no frames", {path});
  }
  if (!options.marker_set.empty()) {
    recording.marker_set = std::make_shared<MarkerSet>(ReadMarkerSet(options.marker_set));
  }
  return recording;
}

void SaveRecording(const Recording& recording, const std::filesystem::path& path,
                   const SaveOptions& options, Diagnostics& diagnostics) {
  const MotionFormat* format = FindMotionFormat(path);
  if (format == nullptr || format->save == nullptr) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} files cannot be written; those that can: {}",
                            Quoted(path.extension().string()), Extensions(&MotionFormat::save)),
                {path});
  }
  const bool has_places = recording.has_skeleton() || recording.markers.marker_count() > 0;
  if (!has_places && std::ranges::find(kChannelFormats, format->name) == kChannelFormats.end()) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("{} holds neither markers nor a skeleton; formats for analog channels "
                            "alone are C3D, MOT and STO",
                            Quoted(recording.path.filename().string())),
                {path});
  }
  if (!options.marker_names.empty() &&
      std::ranges::find(kMarkerNameFormats, format->name) == kMarkerNameFormats.end()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} files do not take the names of an MNM file; C3D, CSM and TRC do",
                            format->name),
                {path});
  }
  format->save(recording, path, options, diagnostics);
}

JointTrajectories StandardJoints(const Recording& recording, Diagnostics& diagnostics) {
  return NamingTheFile(recording, [&] {
    return recording.has_skeleton() ? StandardJoints(recording.motion)
                                    : JointsFromMarkers(recording, diagnostics).joints;
  });
}

std::vector<JointSource> FindStandardJoints(const Recording& recording, Diagnostics& diagnostics) {
  return NamingTheFile(recording, [&] {
    if (!recording.has_skeleton()) {
      ReportLooseMarkers(recording, diagnostics);
      return JointsFromMarkers(recording, diagnostics).sources;
    }
    const Skeleton& skeleton = *recording.motion.skeleton;
    CheckStandardJoints(skeleton);  // What is known of the file's joints may be too few.
    if (!recording.joint_sources.empty()) return recording.joint_sources;
    std::vector<JointSource> sources;
    for (int j = 0; j < kStandardJointCount; ++j) {
      const int joint = skeleton.name_map()[static_cast<std::size_t>(j)].trajectory_joint;
      sources.push_back({static_cast<StandardJoint>(j),
                         skeleton.joints()[static_cast<std::size_t>(joint)].bone_name,
                         JointMatch::kTable, 1});
    }
    return sources;
  });
}

Recording CutRecording(const Recording& recording, int first, int last) {
  Recording cut = WithoutRecord(recording);
  if (recording.has_skeleton()) {
    cut.motion = CutMotion(recording.motion, first, last);
  } else {
    cut.markers = CutMarkers(recording.markers, first, last);
  }
  if (recording.record != nullptr) cut.record = CutRecord(*recording.record, first, last);
  return cut;
}

Recording ResampleRecording(const Recording& recording, double rate_hz) {
  Recording result = WithoutRecord(recording);
  if (recording.has_skeleton()) {
    result.motion = ResampleMotion(recording.motion, rate_hz);
  } else {
    result.markers = ResampleMarkers(recording.markers, rate_hz);
  }
  internal::ReportRecordLoss(recording, "a recording at another rate", result.diagnostics,
                             {internal::Extra::kSkeletonSource});
  return result;
}

}  // namespace kinebase
