// The subcommands. Each function adds its command to the program; its callback does the work,
// prints and puts the exit code into `exit_code`.
#pragma once

#include <CLI/CLI.hpp>

namespace kinebase::cli {

void AddInfoCommand(CLI::App& program, int& exit_code);
void AddConvertCommand(CLI::App& program, int& exit_code);
void AddJointsCommand(CLI::App& program, int& exit_code);
void AddRenderCommand(CLI::App& program, int& exit_code);
void AddFeaturesCommand(CLI::App& program, int& exit_code);
void AddCutCommand(CLI::App& program, int& exit_code);
void AddSortCommand(CLI::App& program, int& exit_code);
void AddRenameCommand(CLI::App& program, int& exit_code);
void AddLearnCommand(CLI::App& program, int& exit_code);
void AddTemplateCommand(CLI::App& program, int& exit_code);
void AddSearchCommand(CLI::App& program, int& exit_code);
void AddExplainCommand(CLI::App& program, int& exit_code);
void AddEvaluateCommand(CLI::App& program, int& exit_code);
void AddAnnotateCommand(CLI::App& program, int& exit_code);
void AddImportCommand(CLI::App& program, int& exit_code);
void AddLibraryCommand(CLI::App& program, int& exit_code);
void AddSynthCommand(CLI::App& program, int& exit_code);
void AddHdm05Command(CLI::App& program, int& exit_code);
void AddManualCommands(CLI::App& program, int& exit_code);  // manual, completion

}  // namespace kinebase::cli
