// What sort and rename share: showing a plan, applying it.
#pragma once

#include "cli/console.h"
#include "kinebase/library/file_moves.h"

namespace kinebase::cli {

// Applies the plan unless something is in its way or `dry_run` is set, and prints it. Returns the
// exit code.
// left  What the files that stay lack: "no motion class in its name".
[[nodiscard]] int ShowAndApply(const MovePlan& plan, bool dry_run, std::string_view left,
                               const CommonOptions& options);

}  // namespace kinebase::cli
