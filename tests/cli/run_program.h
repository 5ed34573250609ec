// Runs the built program as a script would: arguments in, exit code and texts out. No shell.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "nlohmann/json.hpp"

namespace kinebase::test {

struct ProgramResult {
  int exit_code = -1;  // 128 + signal for a program that was killed.
  std::string out;
  std::string err;

  // Standard output as JSON; fails the test and returns null if it is none.
  [[nodiscard]] nlohmann::ordered_json Json() const;
  [[nodiscard]] std::vector<std::string> ErrorLines() const;
};

struct RunOptions {
  std::filesystem::path folder;                    // To run in; empty: as it is.
  std::map<std::string, std::string> environment;  // Beside that of the test.
  bool on_terminal = false;                        // Standard error is a terminal.
  std::filesystem::path out_file;                  // Standard output goes there instead.
};

// argv[0] is looked up in PATH, as far as it has no slash.
ProgramResult RunCommand(const std::vector<std::string>& arguments, const RunOptions& options = {});

// Whether `on_terminal` can be had: a bare chroot has no /dev/pts.
bool HasTerminals();

// The program kinebase.
ProgramResult RunKinebase(std::vector<std::string> arguments, const RunOptions& options = {});

}  // namespace kinebase::test
