// kinebase template draw, edit, combine, concatenate: templates made by hand and put together.

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "cli/arguments.h"
#include "cli/feature_options.h"
#include "cli/template_commands.h"
#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/features/vocabulary.h"
#include "kinebase/templates/editing.h"
#include "kinebase/templates/quantized_template.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

struct EditingOptions {
  CommonOptions common;
  FeatureOptions features;                     // draw; edit: the set only.
  std::vector<std::filesystem::path> sources;  // edit: one.
  std::filesystem::path output;
  std::string name;
  std::string length;             // draw
  std::vector<std::string> sets;  // draw, edit: "F13,F32=1@0-9"
  std::string only;               // edit
  std::string cut;
  std::string stretch;
  std::string before;
  std::string after;
  std::optional<double> tau;
  std::string gap;  // concatenate
  std::string learning = "bonn";
};

// "50" columns or "1.5s".
int ParseLength(const std::string& option, std::string_view text, double rate_hz, int lowest) {
  if (text.ends_with('s')) {
    const auto seconds = ParseDouble(text.substr(0, text.size() - 1));
    if (seconds && *seconds == 0 && lowest == 0) return 0;
    try {
      if (seconds) return ColumnsOfDuration(*seconds, rate_hz);
    } catch (const Error& error) {
      throw UsageError(fmt::format("{}: {}", option, error.message()));
    }
  }
  const auto columns = ParseInteger(text);
  if (columns && *columns >= lowest && *columns <= kMostTemplateColumns) {
    return static_cast<int>(*columns);
  }
  throw UsageError(fmt::format("{} takes columns from {} to {}, or seconds, as in 1.5s; not {}",
                               option, lowest, kMostTemplateColumns, Quoted(text)));
}

// "10-40" and "7" are columns, "0.5-1.2s" is a span of time.
ColumnRange ParseColumns(const std::string& option, std::string_view text,
                         const TemplateMatrix& matrix) {
  const bool is_time = text.ends_with('s');
  std::string_view numbers = text;
  if (is_time) numbers.remove_suffix(1);
  const std::size_t dash = numbers.find('-');
  const std::string_view first_text = numbers.substr(0, dash);
  const std::string_view last_text =
      dash == std::string_view::npos ? first_text : numbers.substr(dash + 1);
  if (is_time && dash != std::string_view::npos) {
    const auto start_s = ParseDouble(first_text);
    const auto end_s = ParseDouble(last_text);
    if (start_s && end_s && *start_s <= *end_s) return ColumnsBetween(matrix, *start_s, *end_s);
  } else if (!is_time) {
    const auto first = ParseInteger(first_text);
    const auto last = ParseInteger(last_text);
    if (first && last && *first >= 0 && *first <= *last && *last < kMostTemplateColumns) {
      return {static_cast<int>(*first), static_cast<int>(*last)};
    }
  }
  throw UsageError(
      fmt::format("{}: {} is neither columns from 0, as 10-40, nor seconds, as "
                  "0.5-1.2s",
                  option, Quoted(text)));
}

double ParseValue(std::string_view text, std::string_view setting) {
  if (text == "any") return kAnyValue;
  const auto value = ParseDouble(text);
  if (value && *value >= 0 && *value <= 1) return *value;
  throw UsageError(fmt::format("--set {}: the value is 0, 1, any or a number between, not {}",
                               setting, Quoted(text)));
}

// "F13,rknee bent=1@10-40": features, value, and where, if not everywhere.
MotionTemplate WithSetting(MotionTemplate motion_template, const std::string& setting,
                           const FeatureSet& features) {
  const std::size_t equals = setting.rfind('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(
        fmt::format("--set {}: expected features, '=' and a value, as in F13,F32=1 or "
                    "'rknee bent=any@10-40'",
                    Quoted(setting)));
  }
  const std::string_view text = setting;
  const std::string_view names = text.substr(0, equals);
  std::string_view value = text.substr(equals + 1);
  ColumnRange columns{0, motion_template.matrix.column_count() - 1};
  if (const std::size_t at = value.find('@'); at != std::string_view::npos) {
    columns = ParseColumns("--set", value.substr(at + 1), motion_template.matrix);
    value = value.substr(0, at);
  }
  const double number = ParseValue(value, Quoted(setting));
  return WithEntries(std::move(motion_template), FindFeatures(features, names), columns, number);
}

int WriteResult(MotionTemplate motion_template, const EditingOptions& options) {
  if (!options.name.empty()) motion_template.name = options.name;
  WriteTemplate(motion_template, options.output, options.common.overwrite());
  NoteIfBlank(motion_template, options.common);
  const int columns = motion_template.matrix.column_count();
  if (options.common.json) {
    PrintJson(
        {{"name", motion_template.name}, {"columns", columns}, {"file", options.output.string()}});
  } else {
    PrintNote(options.common,
              fmt::format("{}: {}, written to {}", motion_template.name,
                          FormatCount(columns, "column", "columns"), options.output.string()));
  }
  return kDone;
}

int Draw(const EditingOptions& options) {
  CheckWritable(options.output, options.common.overwrite());
  const FeatureSet features = options.features.Load();
  const int columns = ParseLength("--length", options.length, options.features.rate_hz, 1);
  MotionTemplate drawn = BlankTemplate("drawn", features, columns, options.features.rate_hz);
  drawn.matching = options.features.ParsedProfile();
  for (const std::string& setting : options.sets) {
    drawn = WithSetting(std::move(drawn), setting, features);
  }
  return WriteResult(std::move(drawn), options);
}

// One change after the other, in the order of the help text.
MotionTemplate Edited(MotionTemplate edited, const EditingOptions& options) {
  const double rate_hz = edited.matrix.rate_hz;
  if (!options.sets.empty() || !options.only.empty()) {
    const FeatureSet features =
        FeatureSetOfTemplate(options.sources[0], edited, options.features.feature_set);
    for (const std::string& setting : options.sets) {
      edited = WithSetting(std::move(edited), setting, features);
    }
    if (!options.only.empty()) {
      edited = RestrictToFeatures(std::move(edited), FindFeatures(features, options.only));
    }
  }
  if (!options.cut.empty()) {
    const ColumnRange columns = ParseColumns("--cut", options.cut, edited.matrix);
    edited = CutTemplate(std::move(edited), columns);
  }
  if (!options.stretch.empty()) {
    edited =
        StretchTemplate(std::move(edited), ParseLength("--stretch", options.stretch, rate_hz, 1));
  }
  if (!options.before.empty() || !options.after.empty()) {
    const auto length = [&](const std::string& option, const std::string& text) {
      return text.empty() ? 0 : ParseLength(option, text, rate_hz, 0);
    };
    edited = ExtendTemplate(std::move(edited), length("--before", options.before),
                            length("--after", options.after));
  }
  if (options.tau) {
    edited.tau = options.tau;
    edited.tau_origin = "set by hand";
  }
  return edited;
}

int Edit(const EditingOptions& options) {
  CheckWritable(options.output, options.common.overwrite());
  return WriteResult(Edited(ReadTemplate(options.sources[0]), options), options);
}

std::vector<MotionTemplate> ReadSources(const EditingOptions& options) {
  if (options.sources.size() < 2)
    throw UsageError("one template alone cannot be put together; name two or more");
  CheckWritable(options.output, options.common.overwrite());
  std::vector<MotionTemplate> templates;
  templates.reserve(options.sources.size());
  for (const auto& source : options.sources) templates.push_back(ReadTemplate(source));
  return templates;
}

int Combine(const EditingOptions& options) {
  const std::vector<MotionTemplate> templates = ReadSources(options);
  const LearnOptions learning{.profile = *ParseProfile(options.learning),
                              .threads = options.common.threads,
                              .progress = MakeProgress(options.common)};
  return WriteResult(CombineTemplates(templates, learning), options);
}

int Concatenate(const EditingOptions& options) {
  const std::vector<MotionTemplate> templates = ReadSources(options);
  const int gap = ParseLength("--gap", options.gap, templates[0].matrix.rate_hz, 0);
  return WriteResult(ConcatenateTemplates(templates, gap), options);
}

using Action = int (*)(const EditingOptions&);

CLI::App* AddAction(CLI::App& parent, int& exit_code, const char* name, const char* description,
                    Action action, const std::shared_ptr<EditingOptions>& options) {
  CLI::App* command = parent.add_subcommand(name, description);
  AddTemplateOutputOptions(*command, options->output, options->name, options->common);
  AddOutputOptions(*command, options->common);
  command->callback([options, &exit_code, action] { exit_code = action(*options); });
  return command;
}

void AddSetOption(CLI::App& command, std::vector<std::string>& sets) {
  command
      .add_option("--set", sets,
                  "Entries: features (ids, names, groups, all), value (0, 1, any, or between) and, "
                  "if not everywhere, columns or seconds: 'F13,rknee bent=1@10-40'")
      ->allow_extra_args(false)
      ->type_name("FEATURES=VALUE[@RANGE]");
}

void AddDraw(CLI::App& parent, int& exit_code) {
  auto options = std::make_shared<EditingOptions>();
  CLI::App* draw = AddAction(parent, exit_code, "draw",
                             "Draw a template from nothing: all entries that are not set are free",
                             &Draw, options);
  draw->add_option("--length", options->length, "Columns, or seconds: 50 or 1.7s")
      ->required()
      ->type_name("LENGTH");
  AddSetOption(*draw, options->sets);
  AddProfileOption(*draw, options->features.profile, "Features and matching (default: bonn)");
  AddFeatureSetOption(*draw, options->features.feature_set);
  AddRateOption(*draw, options->features.rate_hz);
  draw->footer(
      "Example:\n"
      "  kinebase template draw --length 50 --set F13,F32,F33=1 -o brush.template.json");
}

void AddEdit(CLI::App& parent, int& exit_code) {
  auto options = std::make_shared<EditingOptions>();
  CLI::App* edit =
      AddAction(parent, exit_code, "edit",
                "Change a template: what is asked for first, then its columns", &Edit, options);
  edit->add_option("TEMPLATE", options->sources, "Template file")->required()->expected(1);
  AddSetOption(*edit, options->sets);
  edit->add_option("--only", options->only, "Features that count; all others become free")
      ->type_name("FEATURES");
  edit->add_option("--cut", options->cut, "Columns to keep: 10-40, or seconds: 0.5-1.2s")
      ->type_name("RANGE");
  edit->add_option("--stretch", options->stretch, "New length: 60 or 2s")->type_name("LENGTH");
  edit->add_option("--before", options->before, "Free columns to put before: 10 or 0.5s")
      ->type_name("LENGTH");
  edit->add_option("--after", options->after, "Free columns to put after")->type_name("LENGTH");
  edit->add_option("--tau", options->tau,
                   "Its own threshold; that of the source is dropped when "
                   "anything else changes")
      ->check(NonNegativeNumber())
      ->type_name("COST");
  AddFeatureSetOption(*edit, options->features.feature_set);
  edit->footer(
      "Examples:\n"
      "  kinebase template edit squat.template.json --only lower,mix --cut 0.3-2s -o "
      "s.template.json\n"
      "  kinebase template edit kick.template.json --set 'rhand fast,lhand fast=any' -o "
      "k.template.json");
}

void AddCombine(CLI::App& parent, int& exit_code) {
  auto options = std::make_shared<EditingOptions>();
  CLI::App* combine = AddAction(parent, exit_code, "combine",
                                "One template of several: aligned and averaged", &Combine, options);
  combine->add_option("TEMPLATE", options->sources, "Template files, two or more")->required();
  combine->add_option("--learning", options->learning, "Averaging by this profile (default: bonn)")
      ->check(OneOf({"bonn", "paper"}))
      ->type_name("bonn|paper");
  AddThreadsOption(*combine, options->common);
  combine->footer(
      "Example:\n"
      "  kinebase template combine kickL.template.json kickR.template.json -o kick.template.json");
}

void AddConcatenate(CLI::App& parent, int& exit_code) {
  auto options = std::make_shared<EditingOptions>();
  options->gap = "0";
  CLI::App* concatenate = AddAction(parent, exit_code, "concatenate", "One motion after the other",
                                    &Concatenate, options);
  concatenate->add_option("TEMPLATE", options->sources, "Template files, two or more")->required();
  concatenate->add_option("--gap", options->gap, "Free columns between: 10 or 0.5s (default: 0)")
      ->type_name("LENGTH");
  concatenate->footer(
      "Example:\n"
      "  kinebase template concatenate squat.template.json kick.template.json --gap 0.5s -o "
      "both.json");
}

}  // namespace

void AddTemplateOutputOptions(CLI::App& command, std::filesystem::path& output, std::string& name,
                              CommonOptions& common) {
  command.add_option("-o,--output", output, "Template file")->required()->type_name("FILE");
  command.add_option("--name", name, "Name of the new template")->type_name("NAME");
  AddForceOption(command, common);
}

void NoteIfBlank(const MotionTemplate& motion_template, const CommonOptions& common) {
  const QuantizedTemplate quantized =
      Quantize(motion_template.matrix, motion_template.quantisation, motion_template.matching);
  const auto asks = [](const QuantizedColumn& column) { return column.consistent != 0; };
  if (std::ranges::any_of(quantized.columns, asks)) return;
  PrintNote(common, fmt::format("{}: warning: asks for nothing, so it fits everywhere at no cost",
                                motion_template.name));
}

void AddTemplateEditingCommands(CLI::App& parent, int& exit_code) {
  AddDraw(parent, exit_code);
  AddEdit(parent, exit_code);
  AddCombine(parent, exit_code);
  AddConcatenate(parent, exit_code);
}

}  // namespace kinebase::cli
