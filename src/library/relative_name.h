// Names of files that stand in lists made elsewhere.
#pragma once

#include <string>
#include <string_view>

#include "kinebase/core/error.h"

namespace kinebase::internal {

// `name` without empty parts and ".", provided that it leads nowhere but down: an absolute name,
// one with a drive or with ".." could reach any file on the machine.
// what    What is named, for messages: "take".
// Errors  InvalidArgument with `place`: as above, nothing named, a control character.
[[nodiscard]] std::string CheckedRelativeName(std::string_view name, std::string_view what,
                                              const Place& place);

}  // namespace kinebase::internal
