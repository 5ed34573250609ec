// What is odd about a file that could still be read. The library collects these, it never prints.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinebase {

enum class Severity {
  kInfo,     // A choice that was made for the user: "rate 120 Hz from the name".
  kWarning,  // Something wrong that was repaired or left out.
};

struct Diagnostic {
  Severity severity = Severity::kWarning;
  std::string message;
  std::int64_t line = 0;   // 1-based; 0 = unknown or not a text file.
  std::int64_t byte = -1;  // 0-based offset; -1 = unknown.

  friend bool operator==(const Diagnostic&, const Diagnostic&) = default;
};

using Diagnostics = std::vector<Diagnostic>;

[[nodiscard]] std::string_view ToString(Severity severity);  // "info", "warning".

}  // namespace kinebase
