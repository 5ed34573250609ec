// kinebase render: stick figures in a row.

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "fmt/format.h"
#include "kinebase/library/takes.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/pictures/pose_strip.h"

namespace kinebase::cli {
namespace {

struct RenderOptions {
  CommonOptions common;
  std::vector<std::string> motions;
  std::filesystem::path output;
  std::string frames;  // "120-480"
  std::string view = "three-quarter";
  std::vector<std::string> trails;
  int poses = 10;
  bool no_floor = false;
};

StandardJoint ParseTrail(const std::string& name) {
  if (const auto joint = ParseStandardJoint(name)) return *joint;
  std::string known;
  for (int j = 0; j < kStandardJointCount; ++j) {
    known.append(j == 0 ? "" : ", ").append(ToString(static_cast<StandardJoint>(j)));
  }
  throw UsageError(fmt::format("--trail {}: no such joint; there are {}", name, known));
}

PoseStripRow LoadRow(const std::string& text, const RenderOptions& options) {
  TakeStretch stretch = ParseMotionArgument(text);
  if (stretch.first_frame == 0 && !options.frames.empty()) {
    stretch = ParseMotionArgument(text + ':' + options.frames);
    if (stretch.first_frame == 0) throw UsageError("--frames takes first-last, as in 120-480");
  }
  const Recording recording = LoadStretch(stretch, options.common.load);
  Diagnostics diagnostics = recording.diagnostics;
  JointTrajectories joints = StandardJoints(recording, diagnostics);
  PrintDiagnostics(options.common, stretch.file, diagnostics);
  return {.title = stretch.file.stem().string(),
          .standard_joints = std::move(joints),
          .first_frame = stretch.first_frame == 0 ? 1 : stretch.first_frame};
}

int Run(const RenderOptions& options) {
  PoseStripOptions strip{.poses = options.poses, .floor = !options.no_floor};
  strip.view = *ParsePoseView(options.view);
  for (const auto& name : options.trails) strip.trails.push_back(ParseTrail(name));
  CheckWritable(options.output, options.common.overwrite());
  std::vector<PoseStripRow> rows;
  rows.reserve(options.motions.size());
  for (const auto& motion : options.motions) rows.push_back(LoadRow(motion, options));
  DrawPoseStrip(rows, options.output, options.common.overwrite(), strip);
  if (options.common.json) {
    PrintJson({{"file", options.output.string()}, {"recordings", rows.size()}});
  } else {
    PrintWritten(options.common, options.output);
  }
  return kDone;
}

}  // namespace

void AddRenderCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command =
      program.add_subcommand("render", "Draw recordings as rows of stick-figure poses");
  command->add_option("MOTION", options->motions, "Motion files, or stretches: take.amc:120-480")
      ->required();
  command->add_option("-o,--output", options->output, "Picture: .png or .svg")
      ->required()
      ->check(PictureFile())
      ->type_name("FILE");
  command->add_option("--frames", options->frames, "Only these frames of each motion: first-last")
      ->type_name("RANGE");
  command->add_option("--view", options->view, "Where the camera stands, seen from the first pose")
      ->check(OneOf({"front", "side", "top", "three-quarter"}))
      ->type_name("front|side|top|three-quarter")
      ->capture_default_str();
  command->add_option("--trail", options->trails, "Draw the way of these joints: rwrist,lwrist")
      ->delimiter(',')
      ->type_name("JOINT");
  command->add_option("--poses", options->poses, "Poses in a row")
      ->check(WholeNumber(1, 200))
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--no-floor", options->no_floor, "No grid on the floor");
  AddOutputOptions(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer(
      "Example:\n  kinebase render squat.amc gym.amc:120-480 -o squats.png --view side");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
