// The words in names of classes and files. Internal.
#pragma once

#include <string>
#include <string_view>

namespace kinebase::internal {

// With spaces where a word begins inside of a name: "kickRFront1Reps" → "kick R Front 1 Reps".
[[nodiscard]] std::string SpacedName(std::string_view name);

}  // namespace kinebase::internal
