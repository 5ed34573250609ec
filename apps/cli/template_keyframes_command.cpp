// kinebase template keyframes: moments that a recording must show before a template is looked for.

#include <bit>
#include <memory>

#include "cli/arguments.h"
#include "cli/console.h"
#include "cli/feature_options.h"
#include "cli/template_commands.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/templates/keyframes.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

struct KeyframesOptions {
  CommonOptions common;
  std::filesystem::path file;
  std::filesystem::path output;
  std::string feature_set;
  std::optional<int> most;  // Of automatic ones.
  int misses = 0;
  std::optional<double> stiffness;
  std::vector<std::string> set;
  bool clear = false;

  [[nodiscard]] bool changes() const { return most || !set.empty() || clear; }
};

std::vector<std::string> Split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// A group of features, or features by their ids.
std::uint64_t ParseFeatures(const std::string& text, const FeatureSet& features) {
  std::vector<std::string> names;
  for (const FeatureGroup& group : features.Groups()) {
    if (group.name == text) return group.features;
    if (!group.name.empty()) names.push_back(group.name);
  }
  std::uint64_t bits = 0;
  for (const std::string& id : Split(text, ',')) {
    const std::optional<int> row = features.Find(id);
    if (!row) {
      throw UsageError(fmt::format(
          "--set: '{}' is neither a feature of set '{}' ({} to {}) nor one of its groups ({})", id,
          features.name, features.features.front().id, features.features.back().id,
          fmt::join(names, ", ")));
    }
    bits |= std::uint64_t{1} << *row;
  }
  for (const FeatureGroup& group : features.Groups()) {
    if ((bits & ~group.features) == 0) return bits;
  }
  throw UsageError(
      fmt::format("--set: {} are of several groups; set a keyframe for each group", text));
}

Keyframe ParseKeyframe(const std::string& text, const MotionTemplate& motion_template,
                       const FeatureSet& features) {
  const std::vector<std::string> parts = Split(text, ':');
  constexpr std::size_t kWithMisses = 3;
  const auto column = ParseInteger(parts[0]);
  const auto misses = parts.size() == kWithMisses ? ParseInteger(parts[2]) : 0;
  const int columns = motion_template.matrix.column_count();
  if (parts.size() < 2 || parts.size() > kWithMisses || !column || !misses || *misses < 0 ||
      *misses > kMaxFeatures) {
    throw UsageError(fmt::format(
        "--set '{}': a keyframe is COLUMN:FEATURES or COLUMN:FEATURES:MISSES, as 12:upper:1",
        text));
  }
  if (*column < 0 || *column >= columns) {
    throw UsageError(
        fmt::format("--set '{}': the template has columns 0 to {}", text, columns - 1));
  }
  return MakeKeyframe(motion_template, static_cast<int>(*column), ParseFeatures(parts[1], features),
                      static_cast<int>(*misses));
}

std::vector<Keyframe> NewKeyframes(const MotionTemplate& motion_template,
                                   const FeatureSet& features, const KeyframesOptions& options) {
  std::vector<Keyframe> keyframes;
  if (options.most) {
    keyframes = ChooseKeyframes(motion_template, features,
                                {.most = *options.most, .misses = options.misses});
    if (keyframes.empty()) {
      throw Error(ErrorCode::kNotFound,
                  "no moment is telling enough for a keyframe; choose one by hand with --set",
                  {options.file});
    }
  }
  for (const std::string& text : options.set) {
    keyframes.push_back(ParseKeyframe(text, motion_template, features));
  }
  std::ranges::stable_sort(keyframes, {}, &Keyframe::column);
  for (std::size_t i = 1; i < keyframes.size(); ++i) keyframes[i].stiffness = options.stiffness;
  return keyframes;
}

std::vector<std::string> Ids(std::uint64_t bits, const FeatureSet& features) {
  std::vector<std::string> ids;
  for (std::size_t row = 0; row < features.features.size(); ++row) {
    if (((bits >> row) & 1U) != 0) ids.push_back(features.features[row].id);
  }
  return ids;
}

Json ToJson(const MotionTemplate& motion_template, const FeatureSet& features) {
  Json list = Json::array();
  for (const Keyframe& keyframe : motion_template.keyframes) {
    list.push_back({{"column", keyframe.column},
                    {"ones", Ids(keyframe.ones, features)},
                    {"zeros", Ids(keyframe.tested & ~keyframe.ones, features)},
                    {"misses", keyframe.misses},
                    {"stiffness", keyframe.stiffness ? Json(*keyframe.stiffness) : Json()}});
  }
  return {{"name", motion_template.name},
          {"columns", motion_template.matrix.column_count()},
          {"keyframes", std::move(list)}};
}

std::string ToText(const MotionTemplate& motion_template, const FeatureSet& features) {
  TextTable table({">column", ">s", "must hold", "must not", ">misses", ">stiffness"});
  for (const Keyframe& keyframe : motion_template.keyframes) {
    table.Add({std::to_string(keyframe.column),
               fmt::format("{:.2f}", keyframe.column / motion_template.matrix.rate_hz),
               fmt::format("{}", fmt::join(Ids(keyframe.ones, features), " ")),
               fmt::format("{}", fmt::join(Ids(keyframe.tested & ~keyframe.ones, features), " ")),
               std::to_string(keyframe.misses),
               keyframe.stiffness ? fmt::format("{:g}", *keyframe.stiffness) : "-"});
  }
  return table.ToString();
}

int Run(const KeyframesOptions& options) {
  if (options.changes() && options.output.empty()) {
    throw UsageError("-o, --output is required to change keyframes");
  }
  if (!options.changes() && !options.output.empty()) {
    throw UsageError("nothing to write: say --auto, --set or --clear");
  }
  if (options.clear && (options.most || !options.set.empty())) {
    throw UsageError("--clear takes all keyframes away; leave out --auto and --set");
  }
  if (options.changes()) CheckWritable(options.output, options.common.overwrite());
  MotionTemplate motion_template = ReadTemplate(options.file);
  const FeatureSet features =
      FeatureSetOfTemplate(options.file, motion_template, options.feature_set);
  if (options.changes()) {
    motion_template.keyframes = NewKeyframes(motion_template, features, options);
    WriteTemplate(motion_template, options.output, options.common.overwrite());
  }
  if (options.common.json) {
    PrintJson(ToJson(motion_template, features));
    return kDone;
  }
  if (!motion_template.keyframes.empty()) Print(ToText(motion_template, features));
  const std::string count =
      FormatCount(std::ssize(motion_template.keyframes), "keyframe", "keyframes");
  PrintNote(options.common,
            fmt::format("{}: {}{}", OnOneLine(motion_template.name), count,
                        options.changes() ? ", written to " + options.output.string() : ""));
  return kDone;
}

}  // namespace

void AddTemplateKeyframesCommand(CLI::App& parent, int& exit_code) {
  auto options = std::make_shared<KeyframesOptions>();
  CLI::App* command = parent.add_subcommand(
      "keyframes", "Moments that a recording must show before the template is looked for there");
  command->add_option("TEMPLATE", options->file, "Template file")->required();
  command->add_option("--auto", options->most, "Choose the most telling moments, at most N")
      ->check(WholeNumber(1, kMaxFeatures))
      ->type_name("N");
  command
      ->add_option("--misses", options->misses, "Features of each of these that may be otherwise")
      ->needs("--auto")
      ->check(WholeNumber(0, kMaxFeatures))
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--set", options->set,
                   "One by hand: a column from 0, a group of features or their ids, and how many "
                   "may be otherwise: 12:upper:1 or 12:F13,F14; may be repeated")
      ->allow_extra_args(false)
      ->type_name("COLUMN:FEATURES[:MISSES]");
  command
      ->add_option("--stiffness", options->stiffness,
                   "How closely times between keyframes must be the template's: from 0, half to "
                   "twice as long, to 1, as long (default: not bounded)")
      ->check(NumberBetween(0, 1))
      ->type_name("S");
  command->add_flag("--clear", options->clear, "Take all keyframes away");
  command->add_option("-o,--output", options->output, "Template file")->type_name("FILE");
  AddOutputOptions(*command, options->common);
  AddFeatureSetOption(*command, options->feature_set);
  AddForceOption(*command, options->common);
  command->footer(
      "Example:\n  kinebase template keyframes squat.template.json --auto 2 -o "
      "squat2.template.json");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
