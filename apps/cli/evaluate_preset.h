// `evaluate --preset`: a table or figure of the motion template paper, its figures beside ours.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/evaluate_options.h"

namespace kinebase::cli {

// Returns the exit code.
// Errors  UsageError; those of CompareWithPaper and of what is read and written.
[[nodiscard]] int RunPreset(const EvaluateCommandOptions& options, const CLI::App& command);

}  // namespace kinebase::cli
