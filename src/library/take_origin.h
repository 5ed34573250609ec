// How a take comes into a library. Internal.
#pragma once

#include <filesystem>

#include "kinebase/library/take_library.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase::internal {

// The path as the library has it: links followed, where it can be reached.
[[nodiscard]] std::filesystem::path Resolved(const std::filesystem::path& file);

// The skeleton file of a recording, with the key of its bytes; empty if it has none.
[[nodiscard]] StoredSkeleton SkeletonFileOf(const Recording& recording);

// What is true of a file now.
[[nodiscard]] TakeOrigin OriginOf(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace kinebase::internal
