// Options that choose takes of a library.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

#include "kinebase/library/take_choice.h"

namespace kinebase::cli {

// --actors, --classes, --labelled, --formats and --text; given back for needs().
std::vector<CLI::Option*> AddTakeFilterOptions(CLI::App& command, TakeFilter& filter);

// Those, and TAKE…
void AddTakeChoiceOptions(CLI::App& command, TakeChoice& choice);

}  // namespace kinebase::cli
