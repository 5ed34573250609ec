// Which file of a library is where. Internal.
//
//   catalogue.sqlite   which takes there are and where their features are (library/catalogue.h)
//   segments/          segment files, named by their numbers (kinebase/library/segment_file.h)
//   lock               held by whoever writes
#pragma once

#include <cstdint>
#include <filesystem>
#include <system_error>

#include "fmt/format.h"

namespace kinebase::internal {

inline std::filesystem::path CatalogueFile(const std::filesystem::path& library) {
  return library / "catalogue.sqlite";
}

inline std::filesystem::path LockFile(const std::filesystem::path& library) {
  return library / "lock";
}

inline std::filesystem::path SegmentFolder(const std::filesystem::path& library) {
  return library / "segments";
}

inline std::filesystem::path SegmentPath(const std::filesystem::path& library,
                                         std::int64_t segment) {
  return SegmentFolder(library) / fmt::format("{:08}.segment", segment);
}

// Of a file; 0 where that is not known, which reading it will say.
inline std::int64_t FileBytes(const std::filesystem::path& file) {
  std::error_code unreachable;
  const auto bytes = std::filesystem::file_size(file, unreachable);
  return unreachable ? 0 : static_cast<std::int64_t>(bytes);
}

}  // namespace kinebase::internal
