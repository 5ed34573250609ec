#include "cli/console.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "cli/arguments.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/parallel.h"

namespace kinebase::cli {
namespace {

constexpr int kBarWidth = 24;

bool IsTerminal(std::FILE* stream) { return ::isatty(::fileno(stream)) == 1; }

bool UseColour() {
  const char* no_colour = std::getenv("NO_COLOR");
  return IsTerminal(stderr) && (no_colour == nullptr || *no_colour == '\0');
}

// Columns that a text takes on a terminal: continuation bytes of UTF-8 take none.
std::size_t DisplayWidth(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

// Whether the terminal's last line is a bar. Progress has one line, and whatever else is printed
// clears it first: on a terminal results and messages go to the same place.
bool& BarIsDrawn() {
  static bool is_drawn = false;
  return is_drawn;
}

void ClearBar() {
  if (!std::exchange(BarIsDrawn(), false)) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

// Clears its line when the work is over, whether it went well or not.
class ProgressBar {
 public:
  ~ProgressBar() { ClearBar(); }

  bool Show(std::string_view what, std::size_t done, std::size_t total) {
    const auto now = std::chrono::steady_clock::now();
    constexpr auto kBetweenDrawings = std::chrono::milliseconds(50);
    if (now - last_ < kBetweenDrawings) return true;
    last_ = now;
    BarIsDrawn() = true;
    const double share = total == 0 ? 0 : static_cast<double>(done) / static_cast<double>(total);
    const int filled = static_cast<int>(share * kBarWidth);
    fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {}/{}\033[K", what, "", filled, "",
               kBarWidth - filled, done, total);
    std::fflush(stderr);
    return true;
  }

 private:
  std::chrono::steady_clock::time_point last_;
};

}  // namespace

void AddOutputOptions(CLI::App& command, CommonOptions& options) {
  command.add_flag("--json", options.json, "Print the result as JSON");
  command.add_flag("-q,--quiet", options.quiet, "No progress, no diagnostics");
}

void AddThreadsOption(CLI::App& command, CommonOptions& options) {
  command.add_option("--threads", options.threads, "Threads to use (default: all that there are)")
      ->check(WholeNumber(1, 4096))
      ->type_name("N");
}

void AddForceOption(CLI::App& command, CommonOptions& options) {
  command.add_flag("-f,--force", options.force, "Overwrite what is there");
}

void AddLoadOptions(CLI::App& command, CommonOptions& options) {
  command.add_option("--skeleton", options.load.skeleton, "Skeleton of the motion (ASF)")
      ->type_name("FILE");
  command
      .add_option("--source-rate", options.load.source_rate_hz,
                  "Frames a second, for files that do not tell")
      ->check(NumberBetween(kSmallestRateHz, kLargestRateHz))
      ->type_name("HZ");
  command.add_flag("--strict", options.load.strict, "Refuse files that would be repaired");
  static const std::map<std::string, LengthReading> kReadings = {
      {"auto", LengthReading::kAuto},
      {"inches", LengthReading::kDivideToInches},
      {"centimetres", LengthReading::kMultiplyToCentimetres}};
  command
      .add_option_function<std::string>(
          "--asf-length",
          [&options](const std::string& word) { options.load.length_reading = kReadings.at(word); },
          "What an ASF's ':units length u' means: v / u inches, or v · u centimetres")
      ->check(OneOf({"auto", "inches", "centimetres"}))
      ->type_name("auto|inches|centimetres");
  command
      .add_option_function<std::string>(
          "--source-up",
          [&options](const std::string& axis) { options.load.up_axis = ParseUpAxis(axis); },
          "Axis that points up in the file, where it does not tell or tells wrong")
      ->check(OneOf({"x", "y", "z"}))
      ->type_name("x|y|z");
  command
      .add_option("--source-units", options.load.units,
                  fmt::format("Unit of lengths in the file, where it does not tell or tells wrong: "
                              "{}",
                              fmt::join(kSourceUnits, ", ")))
      ->check(OneOf({kSourceUnits.begin(), kSourceUnits.end()}))
      ->type_name("UNIT");
  command
      .add_option("--names", options.load.marker_names,
                  "Which of the file's names is which marker (MNM)")
      ->type_name("FILE");
  command
      .add_option("--marker-set", options.load.marker_set,
                  "Which markers tell where joints are (TOML; default: the built-in sets)")
      ->type_name("FILE");
}

ProgressCallback MakeProgress(const CommonOptions& options) {
  if (options.quiet || !IsTerminal(stderr)) return {};
  return [bar = std::make_shared<ProgressBar>()](std::string_view what, std::size_t done,
                                                 std::size_t total) {
    return bar->Show(what, done, total);
  };
}

void Print(std::string_view text) {
  ClearBar();
  const bool failed =
      std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0;
  if (failed) throw Error(ErrorCode::kIoFailure, "cannot write to standard output");
}

void PrintJson(const Json& json) {
  // Names of files need not be UTF-8: what is not is replaced, as JSON cannot hold it.
  Print(json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

void PrintError(std::string_view message) {
  ClearBar();
  fmt::print(stderr, "{}error:{} {}\n", UseColour() ? "\033[1;31m" : "",
             UseColour() ? "\033[0m" : "", OnOneLine(message));
}

void PrintMarked(std::string_view lines) {
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    fmt::print(stderr, "  {}\n", OnOneLine(lines.substr(0, end)));
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
}

void PrintNote(const CommonOptions& options, std::string_view message) {
  if (options.quiet) return;
  ClearBar();
  fmt::print(stderr, "{}\n", OnOneLine(message));
}

void PrintDiagnostics(const CommonOptions& options, const std::filesystem::path& file,
                      const Diagnostics& diagnostics) {
  for (const Diagnostic& diagnostic : diagnostics) {
    if (diagnostic.severity == Severity::kInfo) continue;  // `info` shows these.
    const Place place{file, diagnostic.line, diagnostic.byte};
    PrintNote(options, fmt::format("{}: {}: {}", place.ToString(), ToString(diagnostic.severity),
                                   diagnostic.message));
  }
}

void PrintWritten(const CommonOptions& options, const std::filesystem::path& path) {
  PrintNote(options, "written to " + path.string());
}

bool IsStandardOutput(const std::filesystem::path& path) { return path.empty() || path == "-"; }

void WriteTextOrPrint(const std::filesystem::path& path, std::string_view text,
                      const CommonOptions& options) {
  if (IsStandardOutput(path)) {
    Print(text);
  } else {
    WriteFile(path, text, options.overwrite());
  }
}

std::string OnOneLine(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      line += fmt::format("\\x{:02X}", byte);
    } else {
      line += c;
    }
  }
  return line;
}

std::string FormatCount(std::int64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string FormatTime(double seconds) {
  // Rounded first, so that 59.97 becomes 1:00.0 and not 0:60.0.
  const std::int64_t tenths = std::llround(seconds * 10);
  return fmt::format("{}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10);
}

TextTable::TextTable(std::vector<std::string> titles) {
  for (std::string& title : titles) {
    right_aligned_.push_back(title.starts_with('>'));
    if (right_aligned_.back()) title.erase(0, 1);
  }
  rows_.push_back(std::move(titles));
}

void TextTable::Add(std::vector<std::string> cells) {
  cells.resize(right_aligned_.size());
  for (std::string& cell : cells) cell = OnOneLine(cell);
  rows_.push_back(std::move(cells));
}

std::string TextTable::ToString() const {
  std::vector<std::size_t> widths(right_aligned_.size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], DisplayWidth(row[i]));
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - DisplayWidth(row[i]), ' ');
      if (i > 0) line += "  ";
      line += right_aligned_[i] ? padding + row[i] : row[i] + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

double Stopwatch::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace kinebase::cli
