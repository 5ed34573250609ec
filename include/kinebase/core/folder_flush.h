// Making names of files as durable as the files.
#pragma once

#include <filesystem>

namespace kinebase {

// After this, what was written into a folder, renamed or removed in it is still so when the power
// fails. core/output_file.h flushes the files themselves.
// Errors  NotFound, IoFailure.
void FlushFolder(const std::filesystem::path& folder);

}  // namespace kinebase
