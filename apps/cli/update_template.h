// kinebase learn --update: a template learns from hits that were marked right or wrong.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/console.h"

namespace kinebase::cli {

struct UpdateCommandOptions {
  CommonOptions common;
  std::filesystem::path template_file;
  std::vector<std::filesystem::path> marks;    // Tables.
  std::vector<std::filesystem::path> folders;  // With the takes.
  std::string feature_set;
  std::filesystem::path output;  // Empty: the template's own file.
  int max_rounds = 10;
};

// Returns the exit code.
int RunUpdate(UpdateCommandOptions options);

}  // namespace kinebase::cli
