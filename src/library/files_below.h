// Looking for files in a folder tree.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace kinebase::internal {

// All regular files below a folder for which `wanted` holds, sorted. A folder that is reached
// twice, through links, is entered once; one that cannot be read is passed over.
[[nodiscard]] std::vector<std::filesystem::path> FilesBelow(
    const std::filesystem::path& folder,
    const std::function<bool(const std::filesystem::path&)>& wanted);

}  // namespace kinebase::internal
