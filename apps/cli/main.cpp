// The program `kinebase`: parses what was asked, calls the library, shows the result.

#include <algorithm>
#include <exception>
#include <new>
#include <string>

#include "cli/commands.h"
#include "cli/console.h"
#include "fmt/format.h"
#include "fmt/ranges.h"

namespace {

constexpr char kDescription[] =
    "Kinebase finds motions in motion-capture recordings.\n\n"
    "Learn what a motion looks like from a few examples, then find every place where it happens:\n"
    "  kinebase learn squat_*.amc -o squat.template.json\n"
    "  kinebase search squat.template.json --in recordings/";

// What is wrong with a command line, in one line, and where to read on.
std::string UsageMessage(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App* command = &program;
  std::string path = program.get_name();
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    path += ' ' + command->get_name();
  }
  std::vector<std::string> names;
  for (const CLI::App* known : command->get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(known->get_name());
  }
  const std::vector<std::string> unknown = program.remaining(true);
  std::string what = error.what();
  if (!unknown.empty() && (names.empty() || unknown.front().starts_with('-'))) {
    what = fmt::format("{} does not take '{}'", path, fmt::join(unknown, "' '"));
  } else if (!unknown.empty()) {
    what = fmt::format("{} has no command '{}'; there are {}", path, unknown.front(),
                       fmt::join(names, ", "));
  } else if (!names.empty()) {
    what = fmt::format("{} needs a command: {}", path, fmt::join(names, ", "));
  }
  return fmt::format("{}; see '{} --help'", what, path);
}

// "PATH" in a help text needs no "TEXT" behind it.
void LeaveOutTypesOfArguments(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_positional() && option->get_type_name() == "TEXT") option->type_name("");
  }
  for (CLI::App* subcommand : command.get_subcommands([](const CLI::App*) { return true; })) {
    LeaveOutTypesOfArguments(*subcommand);
  }
}

int RunProgram(int argc, char** argv) {
  int exit_code = kinebase::cli::kDone;
  CLI::App program(kDescription, "kinebase");
  program.set_version_flag("--version", "kinebase " KINEBASE_VERSION);
  program.require_subcommand(1);
  program.get_formatter()->column_width(36);
  kinebase::cli::AddInfoCommand(program, exit_code);
  kinebase::cli::AddConvertCommand(program, exit_code);
  kinebase::cli::AddRenderCommand(program, exit_code);
  kinebase::cli::AddJointsCommand(program, exit_code);
  kinebase::cli::AddFeaturesCommand(program, exit_code);
  kinebase::cli::AddCutCommand(program, exit_code);
  kinebase::cli::AddSortCommand(program, exit_code);
  kinebase::cli::AddRenameCommand(program, exit_code);
  kinebase::cli::AddLearnCommand(program, exit_code);
  kinebase::cli::AddTemplateCommand(program, exit_code);
  kinebase::cli::AddSearchCommand(program, exit_code);
  kinebase::cli::AddExplainCommand(program, exit_code);
  kinebase::cli::AddEvaluateCommand(program, exit_code);
  kinebase::cli::AddAnnotateCommand(program, exit_code);
  kinebase::cli::AddImportCommand(program, exit_code);
  kinebase::cli::AddLibraryCommand(program, exit_code);
  kinebase::cli::AddSynthCommand(program, exit_code);
  kinebase::cli::AddHdm05Command(program, exit_code);
  kinebase::cli::AddManualCommands(program, exit_code);
  LeaveOutTypesOfArguments(program);
  if (std::any_of(argv + 1, argv + argc, [](const char* text) { return *text == '\0'; })) {
    throw kinebase::cli::UsageError("an argument is empty; was a variable of a script not set?");
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    program.exit(asked);
  } catch (const CLI::ParseError& error) {
    kinebase::cli::PrintError(UsageMessage(program, error));
    return kinebase::cli::kWrongUsage;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return RunProgram(argc, argv);
  } catch (const kinebase::cli::UsageError& error) {
    kinebase::cli::PrintError(error.what());
    return kinebase::cli::kWrongUsage;
  } catch (const kinebase::Error& error) {
    kinebase::cli::PrintError(error.what());
  } catch (const std::bad_alloc&) {
    kinebase::cli::PrintError("out of memory");
  } catch (const std::exception& error) {
    kinebase::cli::PrintError(error.what());
  }
  return kinebase::cli::kCouldNot;
}
