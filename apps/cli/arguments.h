// What options and arguments may be: checks with messages for people, and motions by name.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kinebase/library/takes.h"

namespace kinebase::cli {

// Checks for `option->check(…)`. They add nothing to an option's type in help texts: name that
// with type_name().
[[nodiscard]] CLI::Validator PositiveNumber();     // Finite, above 0.
[[nodiscard]] CLI::Validator NonNegativeNumber();  // Finite, 0 or more.
[[nodiscard]] CLI::Validator NumberBetween(double lowest, double highest);
[[nodiscard]] CLI::Validator WholeNumber(
    std::uint64_t lowest, std::uint64_t highest = std::numeric_limits<std::uint64_t>::max());
[[nodiscard]] CLI::Validator OneOf(std::vector<std::string> words);
[[nodiscard]] CLI::Validator PictureFile();  // Ends in .png or .svg.

// A number of bytes, "512M" or "2G" (of 1024 each), at least kLeastMemoryBytes: given on in bytes.
[[nodiscard]] CLI::Validator MemorySize();

// --memory, for what works on a library; given back for needs().
CLI::Option* AddMemoryOption(CLI::App& command, std::uint64_t& bytes);

// A motion file that somebody named, or a stretch of it.
// Errors  UsageError for a stretch that is none, as "take.amc:120"; InvalidArgument for a folder.
[[nodiscard]] TakeStretch ParseMotionArgument(const std::string& text);

}  // namespace kinebase::cli
