// The program `kinebase`: parses what was asked, calls the library, shows the result.

#include <exception>
#include <new>

#include "cli/commands.h"
#include "cli/console.h"

namespace {

constexpr char kDescription[] =
    "Kinebase finds motions in motion-capture recordings.\n\n"
    "Learn what a motion looks like from a few examples, then find every place where it happens:\n"
    "  kinebase learn squat_*.amc -o squat.template.json\n"
    "  kinebase search squat.template.json --in recordings/";

int RunProgram(int argc, char** argv) {
  int exit_code = kinebase::cli::kDone;
  CLI::App program(kDescription, "kinebase");
  program.set_version_flag("--version", "kinebase " KINEBASE_VERSION);
  program.require_subcommand(1);
  program.get_formatter()->column_width(36);
  kinebase::cli::AddInfoCommand(program, exit_code);
  kinebase::cli::AddRenderCommand(program, exit_code);
  kinebase::cli::AddJointsCommand(program, exit_code);
  kinebase::cli::AddFeaturesCommand(program, exit_code);
  kinebase::cli::AddLearnCommand(program, exit_code);
  kinebase::cli::AddTemplateCommand(program, exit_code);
  kinebase::cli::AddSearchCommand(program, exit_code);
  kinebase::cli::AddSynthCommand(program, exit_code);
  kinebase::cli::AddManualCommands(program, exit_code);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    program.exit(asked);
  } catch (const CLI::ParseError& error) {
    program.exit(error);
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
