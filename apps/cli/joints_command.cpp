// kinebase joints: where the 24 standard joints are, or how they are turned, in every frame.

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/core/units.h"
#include "kinebase/library/takes.h"
#include "kinebase/motion/kinematics.h"

namespace kinebase::cli {
namespace {

struct JointsOptions {
  CommonOptions common;
  std::string motion;
  std::filesystem::path output;
  std::string rotations;  // "", "quaternions" or "euler".
};

std::string PositionTable(const JointTrajectories& joints) {
  std::string text = "frame";
  for (int j = 0; j < kStandardJointCount; ++j) {
    const auto name = ToString(static_cast<StandardJoint>(j));
    text += fmt::format(",{0}_x,{0}_y,{0}_z", name);
  }
  for (int frame = 0; frame < joints.frame_count(); ++frame) {
    text += '\n' + std::to_string(frame + 1);
    for (int j = 0; j < kStandardJointCount; ++j) {
      for (const double value : joints.at(frame, j)) {
        text += ',';
        AppendShortestText(text, value);
      }
    }
  }
  return text + '\n';
}

// Standard joints that have a rotation, with the file's joint that it is taken from.
std::vector<std::pair<std::string_view, int>> RotatingJoints(const Skeleton& skeleton) {
  std::vector<std::pair<std::string_view, int>> joints;
  for (int j = 0; j < kStandardJointCount; ++j) {
    const int joint = skeleton.name_map()[static_cast<std::size_t>(j)].rotation_joint;
    if (joint >= 0) joints.emplace_back(ToString(static_cast<StandardJoint>(j)), joint);
  }
  return joints;
}

std::string RotationTable(const Motion& motion, bool euler) {
  const auto joints = RotatingJoints(*motion.skeleton);
  std::vector<std::vector<Eigen::Vector3d>> angles;
  std::string text = "frame";
  for (const auto& [name, joint] : joints) {
    text += euler ? fmt::format(",{0}_rx,{0}_ry,{0}_rz", name)
                  : fmt::format(",{0}_w,{0}_x,{0}_y,{0}_z", name);
    if (euler) angles.push_back(EulerAngles(motion, joint));
  }
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    text += '\n' + std::to_string(frame + 1);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      Eigen::VectorXd values;
      if (euler) {
        values = angles[j][static_cast<std::size_t>(frame)] / kRadiansPerDegree;
      } else {
        const Eigen::Quaterniond& q = motion.rotation(frame, joints[j].second);
        values = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
      }
      for (const double value : values) {
        text += ',';
        AppendShortestText(text, value);
      }
    }
  }
  return text + '\n';
}

std::string MakeTable(const Recording& recording, const JointsOptions& options) {
  Diagnostics diagnostics = recording.diagnostics;
  if (options.rotations.empty()) {
    std::string table = PositionTable(StandardJoints(recording, diagnostics));
    PrintDiagnostics(options.common, recording.path, diagnostics);
    return table;
  }
  PrintDiagnostics(options.common, recording.path, diagnostics);
  if (!recording.has_skeleton()) {
    throw Error(ErrorCode::kMismatch, "holds markers; --rotations needs a skeleton",
                {recording.path});
  }
  return RotationTable(recording.motion, options.rotations == "euler");
}

int Run(const JointsOptions& options) {
  const bool is_printed = IsStandardOutput(options.output);
  if (is_printed && options.common.json)
    throw UsageError("--json needs -o FILE: the table itself is CSV");
  if (!is_printed) CheckWritable(options.output, options.common.overwrite());
  const TakeStretch stretch = ParseMotionArgument(options.motion);
  const Recording recording = LoadStretch(stretch, options.common.load);
  WriteTextOrPrint(options.output, MakeTable(recording, options), options.common);
  if (is_printed) return kDone;
  if (options.common.json) {
    PrintJson({{"file", options.output.string()},
               {"frames", recording.frame_count()},
               {"rate_hz", recording.rate_hz()}});
  } else {
    PrintWritten(options.common, options.output);
  }
  return kDone;
}

}  // namespace

void AddJointsCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<JointsOptions>();
  CLI::App* command = program.add_subcommand(
      "joints", "The 24 standard joints in every frame as CSV: centimetres, Y up");
  command->add_option("MOTION", options->motion, "Motion file, or a stretch: take.amc:120-480")
      ->required();
  command->add_option("-o,--output", options->output, "CSV file (default: standard output)")
      ->type_name("FILE");
  command
      ->add_option("--rotations", options->rotations,
                   "Local rotations instead: quaternions (w, x, y, z) or euler (degrees)")
      ->check(OneOf({"quaternions", "euler"}))
      ->type_name("quaternions|euler");
  AddOutputOptions(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer("Example:\n  kinebase joints squat.amc -o squat.joints.csv");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
