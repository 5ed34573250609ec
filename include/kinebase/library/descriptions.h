// What recordings show, in words: tables that come with databases, and what is known of HDM05.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/library/take_import.h"

namespace kinebase {

// A row of a table of descriptions.
struct Description {
  std::string recording;   // Name of a file, without folder and extension; empty: see the class.
  std::string class_name;  // All recordings of this motion class.
  std::string text;
  std::int64_t line = 0;
};

// A table (CSV) with a column file, trial, take or class, and a column description, or one whose
// name ends in "_description", as CMU's has it. Other columns are passed over; so are rows without
// a description.
// Errors  MalformedFile, naming the columns that there are.
[[nodiscard]] std::vector<Description> ParseDescriptions(std::string_view text,
                                                         const std::filesystem::path& file);

// Gives each file its description: that of its name, with or without the rate at its end
// ("HDM_bd_01-01_01_120"), else that of its class. The first row of a name counts. How many got
// one.
std::int64_t Describe(std::span<ImportSource> sources, std::span<const Description> descriptions);

// What the HDM05 documentation says of a take or clip of this name: the take's own description, or
// what the script asks for; a clip's class. Empty for other names.
[[nodiscard]] std::string Hdm05Description(const std::filesystem::path& file);

}  // namespace kinebase
