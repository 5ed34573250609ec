// What the actions of `kinebase library` share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/take_filter.h"

namespace kinebase::cli {

// Each action takes those that make sense for it.
struct LibraryOptions {
  CommonOptions common;
  std::filesystem::path library;
  TakeChoice choice;
  std::filesystem::path output;
  bool damaged = false;           // remove
  std::vector<std::string> show;  // list
  std::vector<std::string> add;   // label, templates
  std::vector<std::string> remove;
  std::string frames;  // label
  std::filesystem::path table;
  std::string name;  // templates
  bool is_removing = false;
};

using LibraryAction = int (*)(const LibraryOptions&);  // Gives the exit code.

CLI::App* AddLibraryAction(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                           int& exit_code, const std::string& name, LibraryAction run);

[[nodiscard]] std::string FormatSize(std::int64_t bytes);   // "1.50 MB".
[[nodiscard]] std::string FormatDate(std::int64_t time_s);  // "2006-09-02T10:00:00Z"; "" for 0.
[[nodiscard]] Json TextOrNull(const std::string& text);

// What could not be used, beside what could: on standard error, and as "failed" of the output.
void PrintFailures(std::span<const TakeFailure> failures);
void AddFailures(std::span<const TakeFailure> failures, Json& json);
[[nodiscard]] int ExitCodeOf(std::span<const TakeFailure> failures);

void AddLabelActions(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                     int& exit_code);  // label, compact
void AddRecordActions(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                      int& exit_code);  // templates, annotations

}  // namespace kinebase::cli
