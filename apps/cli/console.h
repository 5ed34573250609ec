// What every command shares: common options, progress, messages, output.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "kinebase/core/diagnostic.h"
#include "kinebase/core/error.h"
#include "kinebase/core/output_file.h"
#include "kinebase/core/progress.h"
#include "kinebase/motion/motion_file.h"
#include "nlohmann/json.hpp"

namespace kinebase::cli {

// Exit codes that scripts rely on.
inline constexpr int kDone = 0;
inline constexpr int kCouldNot = 1;
inline constexpr int kWrongUsage = 2;
inline constexpr int kPartFailed = 3;

// JSON with the fields in the order in which they are written.
using Json = nlohmann::ordered_json;

// Options that commands have in common; each takes those that make sense for it.
struct CommonOptions {
  bool json = false;
  bool quiet = false;
  bool force = false;
  int threads = 0;
  LoadOptions load;

  [[nodiscard]] Overwrite overwrite() const { return force ? Overwrite::kYes : Overwrite::kNo; }
};

void AddOutputOptions(CLI::App& command, CommonOptions& options);  // --json, --quiet
void AddThreadsOption(CLI::App& command, CommonOptions& options);  // --threads
void AddForceOption(CLI::App& command, CommonOptions& options);    // --force
void AddLoadOptions(CLI::App& command, CommonOptions& options);    // --skeleton, --source-rate, …

// Wrong usage that CLI11 cannot see. Exit code 2.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A callback that draws a bar on stderr, if that is a terminal and nobody asked for quiet; else
// empty.
[[nodiscard]] ProgressCallback MakeProgress(const CommonOptions& options);

// Results go to stdout, everything else to stderr.
void Print(std::string_view text);
void PrintJson(const Json& json);
void PrintError(std::string_view message);
void PrintMarked(std::string_view lines);  // Below an error: a text with marks under a part of it.
void PrintNote(const CommonOptions& options, std::string_view message);
void PrintDiagnostics(const CommonOptions& options, const std::filesystem::path& file,
                      const Diagnostics& diagnostics);

void PrintWritten(const CommonOptions& options, const std::filesystem::path& path);

// The text to `path`, or to stdout if that is empty or "-".
[[nodiscard]] bool IsStandardOutput(const std::filesystem::path& path);
void WriteTextOrPrint(const std::filesystem::path& path, std::string_view text,
                      const CommonOptions& options);

// For terminals and messages: a file may have a line break or worse in its name.
[[nodiscard]] std::string OnOneLine(std::string_view text);
[[nodiscard]] std::string FormatCount(std::int64_t count, std::string_view one,
                                      std::string_view many);  // "1 clip", "3 clips".
[[nodiscard]] std::string FormatTime(double seconds);          // "1:23.4".

// A table with aligned columns, for people.
class TextTable {
 public:
  // A '>' at the beginning of a title aligns its column to the right.
  explicit TextTable(std::vector<std::string> titles);
  void Add(std::vector<std::string> cells);
  [[nodiscard]] std::string ToString() const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::vector<bool> right_aligned_;
};

// Seconds since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace kinebase::cli
