// kinebase explain: why a template matches a stretch of a recording.

#include <algorithm>
#include <cmath>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/explain_output.h"
#include "cli/feature_options.h"
#include "fmt/format.h"
#include "kinebase/library/hit_explanation.h"
#include "kinebase/pictures/template_picture.h"
#include "kinebase/templates/quantized_template.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

struct ExplainOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> templates;  // The first is explained; rivals.
  std::filesystem::path motion;
  std::string hit;  // "120-480"; empty: the best one.
  std::filesystem::path output;
  std::string feature_set;
  std::string method;  // Empty: as the template knows.
  bool mirror = false;
};

std::optional<std::int64_t> LastFrame(const ExplainOptions& options) {
  if (options.hit.empty()) return std::nullopt;
  return ParseMotionArgument(options.motion.string() + ':' + options.hit).last_frame;
}

// The template as it is to be looked at.
MotionTemplate LoadTemplate(const std::filesystem::path& file, const FeatureSet& features,
                            const ExplainOptions& options) {
  MotionTemplate motion_template = ReadTemplate(file);
  CheckFeatureSet(motion_template, features);
  if (options.mirror) motion_template = MirrorTemplate(motion_template, features);
  if (options.method == "mt") motion_template.contrast.reset();
  return motion_template;
}

Explained Explain(const ExplainOptions& options) {
  const std::optional<std::int64_t> last_frame = LastFrame(options);
  const std::filesystem::path& first = options.templates.front();
  Explained explained{
      .file = options.motion.string(),
      .features = FeatureSetOfTemplate(first, ReadTemplate(first), options.feature_set)};
  std::vector<MotionTemplate> templates;
  for (const auto& file : options.templates) {
    templates.push_back(LoadTemplate(file, explained.features, options));
    explained.template_names.push_back(templates.back().name);
    if (options.templates.size() == 1 || templates.back().contrast) continue;
    throw Error(ErrorCode::kInvalidArgument,
                "is searched for as a plain template, which has no rivals; name it alone, or learn "
                "it with --method mt+",
                {file});
  }
  const bool is_plain = !templates.front().contrast;
  if (is_plain && options.method == "mt+") {
    throw Error(ErrorCode::kInvalidArgument,
                "is a plain template; learn it with --method mt+ for that", {first});
  }
  explained.quantized = Quantize(templates.front());
  explained.take =
      LoadTakeFeatures({.file = options.motion}, explained.features,
                       templates.front().matrix.rate_hz, options.common.load, {.poses = !is_plain});
  PrintDiagnostics(options.common, options.motion, explained.take.diagnostics);
  explained.explanation = is_plain ? ExplainHit(explained.quantized, explained.take, last_frame)
                                   : ExplainRankedHit(templates, explained.take, last_frame);
  explained.tallies = TallyFeatures(explained.explanation.cells, explained.quantized);
  explained.joints = TallyJoints(explained.explanation);
  return explained;
}

// The costs and poses that a picture shows beside the features.
ComparedCosts CostsOf(const Explained& explained) {
  const HitExplanation& explanation = explained.explanation;
  ComparedCosts costs{.lookalikes = explanation.lookalikes_cost};
  costs.features.resize(explained.features.features.size());
  for (const FeatureTally& tally : explained.tallies) costs.features[tally.feature] = tally.cost;
  std::vector<JointTally> joints = explained.joints;
  std::ranges::sort(joints, {}, &JointTally::joint);  // As the body has them.
  for (const JointTally& tally : joints) {
    costs.joints.push_back({.joint = tally.joint,
                            .cost = tally.cost,
                            .off = std::vector<double>(explanation.cells.size())});
  }
  for (std::size_t cell = 0; cell < explanation.cells.size(); ++cell) {
    for (const JointOffset& offset : OffsetsOfCell(explanation, cell)) {
      const auto joint = std::ranges::find(costs.joints, offset.joint, &ComparedJoint::joint);
      joint->off[cell] = std::abs(offset.off);
    }
  }
  return costs;
}

void Draw(const Explained& explained, const ExplainOptions& options) {
  std::vector<ComparedColumn> columns;
  for (const ExplainedCell& cell : explained.explanation.cells) {
    const QuantizedColumn& asked =
        explained.quantized.columns[static_cast<std::size_t>(cell.cell.template_column)];
    const auto found = static_cast<std::size_t>(cell.cell.recording_column);
    columns.push_back({asked.consistent, asked.ones, explained.take.features.columns[found]});
  }
  const TakeHit& hit = explained.explanation.hit;
  std::string title =
      fmt::format("{} in {}, frames {} to {}, cost {:.4f}", explained.template_names.front(),
                  options.motion.filename().string(), hit.first_frame, hit.last_frame, hit.cost);
  std::optional<ComparedCosts> costs;
  if (explained.has_poses()) costs = CostsOf(explained);
  DrawComparison(columns, explained.quantized.rate_hz, explained.features, title, options.output,
                 options.common.overwrite(), costs);
  PrintWritten(options.common, options.output);
}

int Run(const ExplainOptions& options) {
  if (!options.output.empty()) CheckWritable(options.output, options.common.overwrite());
  const Explained explained = Explain(options);
  if (!options.output.empty()) Draw(explained, options);
  if (options.common.json) {
    PrintJson(ToJson(explained));
  } else {
    Print(ToText(explained));
  }
  return kDone;
}

}  // namespace

void AddExplainCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App* command = program.add_subcommand(
      "explain", "Say why a template matches a stretch: what agreed and what did not");
  command
      ->add_option("TEMPLATE", options->templates,
                   "Template file; more are its rivals, as in search, if they were learned with "
                   "--method mt+")
      ->required();
  command->add_option("--in", options->motion, "Motion file")->required()->type_name("FILE");
  command
      ->add_option("--hit", options->hit,
                   "Frames of the hit, as search gives them; what ends there is explained "
                   "(default: the best hit)")
      ->type_name("RANGE");
  command
      ->add_option("-o,--output", options->output,
                   "Picture: the template and below it the recording, .png or .svg")
      ->check(PictureFile())
      ->type_name("FILE");
  AddMethodOption(*command, options->method);
  command->add_flag("--mirror", options->mirror, "Left and right exchanged");
  AddFeatureSetOption(*command, options->feature_set);
  AddOutputOptions(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer(
      "Example:\n  kinebase explain squat.template.json --in gym.amc --hit 120-480 -o why.png");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
