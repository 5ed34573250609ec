// The subcommands of `kinebase template` that make templates, and what they share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "cli/console.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase::cli {

void AddTemplateEditingCommands(CLI::App& parent, int& exit_code);  // draw, edit, combine, …
void AddTemplateCompileCommand(CLI::App& parent, int& exit_code);
void AddTemplateKeyframesCommand(CLI::App& parent, int& exit_code);

// -o, --name and --force of a command that writes a template.
void AddTemplateOutputOptions(CLI::App& command, std::filesystem::path& output, std::string& name,
                              CommonOptions& common);

// Says on stderr if a template asks for nothing: it fits everywhere.
void NoteIfBlank(const MotionTemplate& motion_template, const CommonOptions& common);

}  // namespace kinebase::cli
