// kinebase explain: why a template matches a stretch of a recording.

#include <bit>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
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
  std::filesystem::path motion_template;
  std::filesystem::path motion;
  std::string hit;  // "120-480"; empty: the best one.
  std::filesystem::path output;
  std::string feature_set;
  bool mirror = false;
};

// How one feature fared along the path.
struct FeatureTally {
  int feature = 0;
  int agreed = 0;  // Cells.
  int disagreed = 0;
  double cost = 0;  // Of the hit's.
};

// All that is shown, in one place.
struct Shown {
  std::string template_name;
  std::string file;
  FeatureSet features;
  QuantizedTemplate quantized;
  std::vector<std::uint64_t> recording;  // Feature words of the take.
  HitExplanation explanation;
  std::vector<FeatureTally> tallies;  // Those that cost most first; none of free features.
};

std::vector<FeatureTally> TallyFeatures(const std::vector<ExplainedCell>& cells,
                                        const QuantizedTemplate& motion_template) {
  std::vector<FeatureTally> tallies;
  for (int feature = 0; feature < motion_template.feature_count; ++feature) {
    FeatureTally tally{.feature = feature};
    const std::uint64_t bit = std::uint64_t{1} << feature;
    for (const ExplainedCell& cell : cells) {
      if ((cell.agreed & bit) != 0) ++tally.agreed;
      if ((cell.disagreed & bit) == 0) continue;
      ++tally.disagreed;
      tally.cost += CostOfFeature(motion_template, cell, feature);
    }
    if (tally.agreed + tally.disagreed > 0) tallies.push_back(tally);
  }
  std::ranges::stable_sort(tallies, std::greater(), &FeatureTally::cost);
  return tallies;
}

std::optional<std::int64_t> LastFrame(const ExplainOptions& options) {
  if (options.hit.empty()) return std::nullopt;
  return ParseMotionArgument(options.motion.string() + ':' + options.hit).last_frame;
}

Shown Explain(const ExplainOptions& options) {
  const std::optional<std::int64_t> last_frame = LastFrame(options);
  MotionTemplate motion_template = ReadTemplate(options.motion_template);
  Shown shown{.file = options.motion.string(),
              .features = FeatureSetOfTemplate(options.motion_template, motion_template,
                                               options.feature_set)};
  if (options.mirror) motion_template = MirrorTemplate(motion_template, shown.features);
  shown.template_name = motion_template.name;
  shown.quantized = Quantize(motion_template);
  TakeFeatures take = LoadTakeFeatures({.file = options.motion}, shown.features,
                                       motion_template.matrix.rate_hz, options.common.load);
  PrintDiagnostics(options.common, options.motion, take.diagnostics);
  shown.explanation = ExplainHit(shown.quantized, take, last_frame);
  shown.recording = std::move(take.features.columns);
  shown.tallies = TallyFeatures(shown.explanation.cells, shown.quantized);
  return shown;
}

Json NamesOf(std::uint64_t word, const FeatureSet& features) {
  Json names = Json::array();
  for (int feature = 0; feature < features.feature_count(); ++feature) {
    if (((word >> feature) & 1U) != 0) names.push_back(features.features[feature].id);
  }
  return names;
}

Json ToJson(const Shown& shown) {
  Json path = Json::array();
  for (const ExplainedCell& cell : shown.explanation.cells) {
    path.push_back({{"template_column", cell.cell.template_column},
                    {"column", cell.cell.recording_column},
                    {"cost", cell.cost},
                    {"agreed", NamesOf(cell.agreed, shown.features)},
                    {"disagreed", NamesOf(cell.disagreed, shown.features)}});
  }
  Json features = Json::array();
  for (const FeatureTally& tally : shown.tallies) {
    const Feature& feature = shown.features.features[tally.feature];
    features.push_back({{"id", feature.id},
                        {"name", feature.name},
                        {"agreed", tally.agreed},
                        {"disagreed", tally.disagreed},
                        {"cost", tally.cost}});
  }
  const TakeHit& hit = shown.explanation.hit;
  return {{"template", shown.template_name},
          {"file", shown.file},
          {"first_frame", hit.first_frame},
          {"last_frame", hit.last_frame},
          {"start_s", hit.start_s},
          {"end_s", hit.end_s},
          {"cost", hit.cost},
          {"path", std::move(path)},
          {"features", std::move(features)}};
}

std::string ToText(const Shown& shown) {
  const TakeHit& hit = shown.explanation.hit;
  int agreed = 0;
  int asked = 0;
  TextTable table({"feature", "name", ">as asked", ">not", ">cost"});
  std::size_t without_fault = 0;
  for (const FeatureTally& tally : shown.tallies) {
    agreed += tally.agreed;
    asked += tally.agreed + tally.disagreed;
    if (tally.disagreed == 0) {
      ++without_fault;
      continue;
    }
    const Feature& feature = shown.features.features[tally.feature];
    table.Add({feature.id, feature.name, std::to_string(tally.agreed),
               std::to_string(tally.disagreed), fmt::format("{:.4f}", tally.cost)});
  }
  std::string text = fmt::format(
      "{} in {}, frames {} to {} ({} to {})\n"
      "cost {:.4f}: {} of {} entries along the path are as the template asks\n",
      OnOneLine(shown.template_name), OnOneLine(shown.file), hit.first_frame, hit.last_frame,
      FormatTime(hit.start_s), FormatTime(hit.end_s), hit.cost, agreed, asked);
  if (agreed < asked) text += '\n' + table.ToString() + '\n';
  return text +
         fmt::format("{} without a fault\n", FormatCount(static_cast<std::int64_t>(without_fault),
                                                         "feature is", "features are"));
}

void Draw(const Shown& shown, const ExplainOptions& options) {
  std::vector<ComparedColumn> columns;
  for (const ExplainedCell& cell : shown.explanation.cells) {
    const QuantizedColumn& asked =
        shown.quantized.columns[static_cast<std::size_t>(cell.cell.template_column)];
    columns.push_back({asked.consistent, asked.ones,
                       shown.recording[static_cast<std::size_t>(cell.cell.recording_column)]});
  }
  const TakeHit& hit = shown.explanation.hit;
  const std::string title =
      fmt::format("{} in {}, frames {} to {}, cost {:.4f}", shown.template_name,
                  options.motion.filename().string(), hit.first_frame, hit.last_frame, hit.cost);
  DrawComparison(columns, shown.quantized.rate_hz, shown.features, title, options.output,
                 options.common.overwrite());
  PrintWritten(options.common, options.output);
}

int Run(const ExplainOptions& options) {
  if (!options.output.empty()) CheckWritable(options.output, options.common.overwrite());
  const Shown shown = Explain(options);
  if (!options.output.empty()) Draw(shown, options);
  if (options.common.json) {
    PrintJson(ToJson(shown));
  } else {
    Print(ToText(shown));
  }
  return kDone;
}

}  // namespace

void AddExplainCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App* command = program.add_subcommand(
      "explain", "Say why a template matches a stretch: what agreed and what did not");
  command->add_option("TEMPLATE", options->motion_template, "Template file")->required();
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
