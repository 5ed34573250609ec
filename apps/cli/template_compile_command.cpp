// kinebase template compile: words become a template.

#include <memory>

#include "cli/feature_options.h"
#include "cli/template_commands.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/features/vocabulary.h"
#include "kinebase/templates/query.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

struct CompileOptions {
  CommonOptions common;
  FeatureOptions features;
  std::string query;
  std::filesystem::path output;
  std::string name;
  bool list = false;
};

// "F3", "not F4"; by name for people.
std::vector<std::string> StateTexts(const std::vector<FeatureState>& states,
                                    const FeatureSet& features, bool by_name) {
  std::vector<std::string> texts;
  for (const auto& [row, holds] : states) {
    const Feature& feature = features.features[static_cast<std::size_t>(row)];
    texts.push_back((holds ? "" : "not ") + (by_name ? feature.name : feature.id));
  }
  return texts;
}

int List(const CompileOptions& options) {
  const FeatureSet features = options.features.Load();
  const Vocabulary vocabulary(features);
  TextTable table({"phrase", "asks for"});
  Json phrases = Json::array();
  for (const FeaturePhrase& phrase : vocabulary.phrases()) {
    if (features.Find(phrase.text)) continue;  // Ids go without saying.
    const auto states = StateTexts(phrase.states, features, false);
    table.Add({phrase.text, fmt::format("{}", fmt::join(states, " & "))});
    phrases.push_back({{"text", phrase.text}, {"asks_for", states}});
  }
  if (options.common.json) {
    PrintJson({{"feature_set", features.name}, {"phrases", std::move(phrases)}});
  } else {
    Print(table.ToString());
  }
  return kDone;
}

// "kick.template.json" → "kick-mirrored.template.json".
std::filesystem::path MirroredPath(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  constexpr std::string_view kEnding = ".template.json";
  const std::size_t ending =
      name.ends_with(kEnding) ? name.size() - kEnding.size() : path.stem().string().size();
  return path.parent_path() / name.insert(ending, "-mirrored");
}

std::string PhaseTable(const CompiledQuery& compiled, const FeatureSet& features) {
  const double rate_hz = compiled.templates[0].matrix.rate_hz;
  TextTable table({">columns", ">seconds", "asks for"});
  for (const QueryPhase& phase : compiled.phases) {
    const auto states = StateTexts(phase.states, features, true);
    table.Add({fmt::format("{}-{}", phase.columns.first, phase.columns.last),
               fmt::format("{:.2f}-{:.2f}", phase.columns.first / rate_hz,
                           (phase.columns.last + 1) / rate_hz),
               states.empty() ? "any" : fmt::format("{}", fmt::join(states, " & "))});
  }
  return table.ToString();
}

Json ToJson(const CompiledQuery& compiled, const FeatureSet& features,
            const std::vector<std::filesystem::path>& files) {
  const double rate_hz = compiled.templates[0].matrix.rate_hz;
  Json templates = Json::array();
  for (std::size_t i = 0; i < files.size(); ++i) {
    templates.push_back({{"name", compiled.templates[i].name},
                         {"columns", compiled.templates[i].matrix.column_count()},
                         {"file", files[i].string()}});
  }
  Json phases = Json::array();
  for (const QueryPhase& phase : compiled.phases) {
    phases.push_back({{"first_column", phase.columns.first},
                      {"last_column", phase.columns.last},
                      {"start_s", phase.columns.first / rate_hz},
                      {"end_s", (phase.columns.last + 1) / rate_hz},
                      {"asks_for", StateTexts(phase.states, features, false)}});
  }
  return {{"templates", std::move(templates)}, {"phases", std::move(phases)}};
}

void WriteTemplates(const CompiledQuery& compiled, const std::vector<std::filesystem::path>& files,
                    Overwrite overwrite) {
  std::vector<std::string> texts;
  texts.reserve(files.size());
  for (const MotionTemplate& motion_template : compiled.templates) {
    texts.push_back(FormatTemplate(motion_template));
  }
  std::vector<FileContents> contents;
  contents.reserve(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) contents.push_back({files[i], texts[i]});
  WriteFiles(contents, overwrite);
}

int Compile(const CompileOptions& options) {
  const FeatureSet features = options.features.Load();
  CompiledQuery compiled = CompileQuery(options.query, features,
                                        {.name = options.name,
                                         .rate_hz = options.features.rate_hz,
                                         .matching = options.features.ParsedProfile()});
  std::vector<std::filesystem::path> files = {options.output};
  if (compiled.templates.size() > 1) files.push_back(MirroredPath(options.output));
  WriteTemplates(compiled, files, options.common.overwrite());
  if (options.common.json) {
    PrintJson(ToJson(compiled, features, files));
    return kDone;
  }
  Print(PhaseTable(compiled, features));
  for (const auto& file : files) PrintWritten(options.common, file);
  return kDone;
}

int Run(const CompileOptions& options) {
  if (options.list) return List(options);
  if (options.query.empty()) throw UsageError("compile needs a query, or --list");
  if (options.output.empty()) throw UsageError("compile needs -o FILE for the template");
  try {
    return Compile(options);
  } catch (const QueryError& error) {
    PrintError(error.what());
    PrintMarked(error.marked());
    return kWrongUsage;
  }
}

}  // namespace

void AddTemplateCompileCommand(CLI::App& parent, int& exit_code) {
  auto options = std::make_shared<CompileOptions>();
  CLI::App* command = parent.add_subcommand("compile", "Make a template from words");
  command->add_option("QUERY", options->query, "What to look for, in one argument");
  command->add_option("-o,--output", options->output, "Template file")->type_name("FILE");
  command->add_option("--name", options->name, "Name of the template (default: the query)")
      ->type_name("NAME");
  command->add_flag("--list", options->list, "Print the phrases that queries are made of");
  AddProfileOption(*command, options->features.profile, "Features and matching (default: bonn)");
  AddFeatureSetOption(*command, options->features.feature_set);
  AddRateOption(*command, options->features.rate_hz);
  AddOutputOptions(*command, options->common);
  AddForceOption(*command, options->common);
  command->footer(
      "Examples:\n"
      "  kinebase template compile 'rhand raised & lknee bent for 0.3s then feet apart' "
      "-o q.template.json\n"
      "  kinebase template compile --list");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
