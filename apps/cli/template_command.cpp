// kinebase template: a template as data, as a picture, and for the other side of the body.

#include <algorithm>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/feature_options.h"
#include "cli/template_commands.h"
#include "fmt/format.h"
#include "kinebase/pictures/template_picture.h"
#include "kinebase/search/template_search.h"
#include "kinebase/templates/quantized_template.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

struct TemplateOptions {
  CommonOptions common;
  std::filesystem::path file;
  std::filesystem::path output;
  std::string feature_set;
  std::string name;
  bool quantized = false;
};

// How many entries of the quantised template are ones, zeros and free, in percent.
std::string ConsistencyText(const MotionTemplate& motion_template) {
  const QuantizedTemplate quantized =
      Quantize(motion_template.matrix, motion_template.quantisation, motion_template.matching);
  int consistent = 0;
  int ones = 0;
  for (const QuantizedColumn& column : quantized.columns) {
    consistent += std::popcount(column.consistent);
    ones += std::popcount(column.ones & column.consistent);
  }
  const double all =
      static_cast<double>(quantized.column_count()) * motion_template.matrix.feature_count;
  return fmt::format("{:.0f} % always, {:.0f} % never, {:.0f} % free", 100 * ones / all,
                     100 * (consistent - ones) / all, 100 - 100 * consistent / all);
}

std::string LearningText(const MotionTemplate& motion_template) {
  if (motion_template.clips.empty() && motion_template.rounds == 0) return "from no clips";
  return fmt::format("from {} in {}",
                     FormatCount(std::ssize(motion_template.clips), "clip", "clips"),
                     FormatCount(motion_template.rounds, "round", "rounds"));
}

std::string Describe(const MotionTemplate& motion_template) {
  const TemplateMatrix& matrix = motion_template.matrix;
  std::string text = OnOneLine(motion_template.name) + '\n';
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<11}{}\n", name, OnOneLine(value));
  };
  line("length", fmt::format("{} at {:g} Hz, {:.2f} s",
                             FormatCount(matrix.column_count(), "column", "columns"),
                             matrix.rate_hz, matrix.total_weight() / matrix.rate_hz));
  line("features", fmt::format("{} of set {} ({:016x})", matrix.feature_count,
                               motion_template.feature_set, motion_template.feature_set_hash));
  line("entries", ConsistencyText(motion_template));
  line("profile", fmt::format("learning {}, matching {}", ToString(motion_template.learning),
                              ToString(motion_template.matching)));
  line("threshold", motion_template.tau
                        ? fmt::format("{:g} ({})", *motion_template.tau, motion_template.tau_origin)
                        : fmt::format("none of its own; {:g} is used", kDefaultTau));
  if (!motion_template.origin.empty()) line("origin", motion_template.origin);
  if (!motion_template.keyframes.empty()) {
    line("keyframes", fmt::format("{} (kinebase template keyframes lists them)",
                                  motion_template.keyframes.size()));
  }
  line("learned", LearningText(motion_template));
  for (const TemplateClip& clip : motion_template.clips) {
    line("", clip.first_frame == 0
                 ? clip.file
                 : fmt::format("{}:{}-{}", clip.file, clip.first_frame, clip.last_frame));
  }
  if (!motion_template.marks.empty()) {
    const auto right =
        std::ranges::count(motion_template.marks, Verdict::kRight, &TemplateMark::verdict);
    line("marks", fmt::format("{} right, {} wrong (kinebase learn --update)", right,
                              std::ssize(motion_template.marks) - right));
  }
  return text;
}

int Show(const TemplateOptions& options) {
  const MotionTemplate motion_template = ReadTemplate(options.file);
  Print(options.common.json ? FormatTemplate(motion_template) : Describe(motion_template));
  return kDone;
}

int Render(const TemplateOptions& options) {
  CheckWritable(options.output, options.common.overwrite());
  const MotionTemplate motion_template = ReadTemplate(options.file);
  const FeatureSet features =
      FeatureSetOfTemplate(options.file, motion_template, options.feature_set);
  DrawTemplate(motion_template, features, options.output, options.common.overwrite(),
               {.quantized = options.quantized});
  if (options.common.json) {
    PrintJson({{"file", options.output.string()}});
  } else {
    PrintWritten(options.common, options.output);
  }
  return kDone;
}

int Mirror(const TemplateOptions& options) {
  CheckWritable(options.output, options.common.overwrite());
  const MotionTemplate motion_template = ReadTemplate(options.file);
  const FeatureSet features =
      FeatureSetOfTemplate(options.file, motion_template, options.feature_set);
  MotionTemplate mirrored = MirrorTemplate(motion_template, features);
  if (!options.name.empty()) mirrored.name = options.name;
  WriteTemplate(mirrored, options.output, options.common.overwrite());
  if (options.common.json) {
    PrintJson({{"name", mirrored.name}, {"file", options.output.string()}});
  } else {
    PrintNote(options.common,
              fmt::format("{}: written to {}", mirrored.name, options.output.string()));
  }
  return kDone;
}

using Action = int (*)(const TemplateOptions&);

CLI::App* AddAction(CLI::App& parent, const std::shared_ptr<TemplateOptions>& options,
                    int& exit_code, const char* name, const char* description, Action action) {
  CLI::App* command = parent.add_subcommand(name, description);
  command->add_option("TEMPLATE", options->file, "Template file")->required();
  AddOutputOptions(*command, options->common);
  command->callback([options, &exit_code, action] { exit_code = action(*options); });
  return command;
}

}  // namespace

void AddTemplateCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<TemplateOptions>();
  CLI::App* command =
      program.add_subcommand("template", "Make templates, look at them and change them");
  command->require_subcommand(1);
  command->footer("Example:\n  kinebase template render squat.template.json -o squat.png");

  CLI::App* show = AddAction(*command, options, exit_code, "show",
                             "What a template holds; whole with --json", &Show);
  show->footer("Example:\n  kinebase template show squat.template.json");

  CLI::App* render = AddAction(*command, options, exit_code, "render",
                               "Draw a template: features over time", &Render);
  render->add_option("-o,--output", options->output, "Picture: .png or .svg")
      ->required()
      ->check(PictureFile())
      ->type_name("FILE");
  render->add_flag("--quantized", options->quantized, "As it is matched: always, never, free");
  render->footer("Example:\n  kinebase template render squat.template.json -o squat.svg");

  CLI::App* mirror = AddAction(*command, options, exit_code, "mirror",
                               "The same motion with left and right exchanged", &Mirror);
  mirror->add_option("-o,--output", options->output, "Template file")
      ->required()
      ->type_name("FILE");
  mirror->add_option("--name", options->name, "Name of the new template")->type_name("NAME");
  mirror->footer("Example:\n  kinebase template mirror kickR.template.json -o kickL.template.json");
  for (CLI::App* action : {render, mirror}) {
    AddFeatureSetOption(*action, options->feature_set);
    AddForceOption(*action, options->common);
  }
  AddTemplateEditingCommands(*command, exit_code);
  AddTemplateCompileCommand(*command, exit_code);
  AddTemplateKeyframesCommand(*command, exit_code);
}

}  // namespace kinebase::cli
