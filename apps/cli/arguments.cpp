#include "cli/arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "cli/console.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/memory_limits.h"

namespace kinebase::cli {
namespace {

// CLI11's own checks write their ranges into help texts and messages, down to the last digit of the
// largest double, and let "nan" pass.
template <typename Test>
CLI::Validator Check(std::string expected, Test test) {
  const auto check = [expected = std::move(expected), test](const std::string& text) {
    return test(text) ? std::string() : fmt::format("takes {}, not {}", expected, Quoted(text));
  };
  CLI::Validator validator;
  return validator.operation(check).non_modifying();
}

// "2G" in bytes.
std::optional<std::int64_t> ParseSize(std::string text) {
  try {
    (void)CLI::AsSizeValue(false)(text);
    return ParseInteger(text);
  } catch (const CLI::Error&) {
    return std::nullopt;
  }
}

}  // namespace

CLI::Validator PositiveNumber() {
  return Check("a number above 0", [](std::string_view text) {
    const auto number = ParseDouble(text);
    return number && std::isfinite(*number) && *number > 0;
  });
}

CLI::Validator NonNegativeNumber() {
  return Check("a number of at least 0", [](std::string_view text) {
    const auto number = ParseDouble(text);
    return number && std::isfinite(*number) && *number >= 0;
  });
}

CLI::Validator NumberBetween(double lowest, double highest) {
  return Check(fmt::format("a number from {:g} to {:g}", lowest, highest),
               [=](std::string_view text) {
                 const auto number = ParseDouble(text);
                 return number && *number >= lowest && *number <= highest;
               });
}

CLI::Validator WholeNumber(std::uint64_t lowest, std::uint64_t highest) {
  const bool is_open = highest == std::numeric_limits<std::uint64_t>::max();
  return Check(is_open ? fmt::format("a whole number of at least {}", lowest)
                       : fmt::format("a whole number from {} to {}", lowest, highest),
               [=](std::string_view text) {
                 std::uint64_t number = 0;
                 const char* end = text.data() + text.size();
                 const auto result = std::from_chars(text.data(), end, number);
                 // CLI11 would read "010" as octal.
                 const bool octal = text.size() > 1 && text.front() == '0';
                 return result.ec == std::errc() && result.ptr == end && !octal &&
                        number >= lowest && number <= highest;
               });
}

CLI::Validator OneOf(std::vector<std::string> words) {
  std::string expected = fmt::format("{}", fmt::join(words, ", "));
  if (words.size() > 1) expected = "one of " + expected;
  return Check(std::move(expected), [words = std::move(words)](const std::string& text) {
    return std::ranges::find(words, text) != words.end();
  });
}

CLI::Validator PictureFile() {
  return Check("a file that ends in .png or .svg", [](const std::string& text) {
    const std::string extension = ToLower(std::filesystem::path(text).extension().string());
    return extension == ".png" || extension == ".svg";
  });
}

CLI::Validator MemorySize() {
  const auto to_bytes = [](std::string& text) {
    const auto bytes = ParseSize(text);
    if (!bytes || *bytes < kLeastMemoryBytes) {
      return fmt::format("takes a size of at least {}M, as 512M or 2G, not {}",
                         kLeastMemoryBytes >> 20, Quoted(text));
    }
    text = std::to_string(*bytes);
    return std::string();
  };
  return {to_bytes, ""};
}

CLI::Option* AddMemoryOption(CLI::App& command, std::uint64_t& bytes) {
  return command
      .add_option("--memory", bytes,
                  "Roughly the most memory that takes use, however many there are (default: 1G)")
      ->transform(MemorySize())
      ->type_name("SIZE");
}

TakeStretch ParseMotionArgument(const std::string& text) {
  std::optional<TakeStretch> stretch;
  try {
    stretch = ParseTakeStretch(text);
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(stretch->file, ignored)) {
    throw Error(ErrorCode::kInvalidArgument, "is a folder; name a motion file in it",
                {stretch->file});
  }
  const std::filesystem::path before_colon = text.substr(0, text.rfind(':'));
  if (stretch->first_frame == 0 && before_colon != stretch->file &&
      !std::filesystem::exists(stretch->file, ignored) &&
      std::filesystem::exists(before_colon, ignored)) {
    throw UsageError(fmt::format("'{}': a stretch is first-last, as in take.amc:120-480", text));
  }
  return *stretch;
}

}  // namespace kinebase::cli
