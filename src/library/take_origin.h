// How a take comes into a library. Internal.
#pragma once

#include <filesystem>

#include "kinebase/library/take_library.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase::internal {

// The path as the library has it: links followed, where it can be reached.
[[nodiscard]] std::filesystem::path Resolved(const std::filesystem::path& file);

// A skeleton file with the key of its bytes; empty for no file.
[[nodiscard]] StoredSkeleton SkeletonAt(const std::filesystem::path& file);

// What is true of a file now.
[[nodiscard]] TakeOrigin OriginOf(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace kinebase::internal
