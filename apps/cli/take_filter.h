// Options that choose takes of a library.
#pragma once

#include <CLI/CLI.hpp>

#include "kinebase/library/take_library.h"

namespace kinebase::cli {

// --actors and --classes; given back for needs().
inline std::vector<CLI::Option*> AddTakeFilterOptions(CLI::App& command, TakeFilter& filter) {
  return {command.add_option("--actors", filter.actors, "Only takes of these actors: a,b")
              ->delimiter(',')
              ->type_name("NAMES"),
          command.add_option("--classes", filter.classes, "Only takes of these classes: a,b")
              ->delimiter(',')
              ->type_name("NAMES")};
}

}  // namespace kinebase::cli
