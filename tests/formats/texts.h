// Small made-up ASF and AMC files, whole ones and ones with a single thing changed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace kinebase::test {

inline constexpr std::string_view kArmAsf = R"(# made up
:version 1.10
:name arm
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
  two bones
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 1 2 3
  orientation 0 0 0
:bonedata
  begin
    id 1
    name upper
    direction 0 1 0
    length 2
    axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160 20)
           (-70 70)
           (-60 70)
  end
  begin
    id 2
    name lower
    direction 1 0 0
    length 3
    axis 0 0 0 XYZ
    dof rz
  end
:hierarchy
  begin
    root upper
    upper lower
  end
)";

inline constexpr std::string_view kArmAmc = R"(# made up
:FULLY-SPECIFIED
:DEGREES
8
root 0 1.5 -2 10 20 30
upper -20.5 2.25 -19
lower 35
9
root 0 1.5 -2.5 10 20 31
upper -20.25 2.5 -19.5
lower 36.5
10
root 0 1.5 -3 10 20 32
upper -20 2.75 -20
lower 37.25
11
root 0 1.5 -3.5 10 20 33
upper -19.75 3 -20.5
lower 38.125
)";

// `text` with `from`, which stands in it once, replaced by `to`.
inline std::string With(std::string_view text, std::string_view from, std::string_view to) {
  std::string result(text);
  const std::size_t at = result.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at == std::string::npos) return result;
  EXPECT_EQ(result.find(from, at + 1), std::string::npos) << from << " stands more than once";
  return result.replace(at, from.size(), to);
}

inline std::string WithLineEnds(std::string_view text, std::string_view ending) {
  std::string result;
  for (const char c : text) {
    if (c == '\n') {
      result += ending;
    } else {
      result += c;
    }
  }
  return result;
}

// 1-based number of the line that holds `part`.
inline std::int64_t LineOf(std::string_view text, std::string_view part) {
  return std::ranges::count(text.substr(0, text.find(part)), '\n') + 1;
}

}  // namespace kinebase::test
