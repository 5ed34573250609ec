// What the plans of moves check alike.
#pragma once

#include "kinebase/library/file_moves.h"

namespace kinebase::internal {

// Errors  NotFound.
void CheckIsFolder(const std::filesystem::path& folder);

// Whether its format is one that motions are read from.
[[nodiscard]] bool IsMotionFile(const std::filesystem::path& file);

// Whether there is anything of that name, a broken link too.
[[nodiscard]] bool IsThere(const std::filesystem::path& path);

// Warns of each motion whose skeleton is found now and would not be found any more.
void WarnOfLostSkeletons(MovePlan& plan);

}  // namespace kinebase::internal
