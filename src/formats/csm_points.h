// The `$points` section of a CSM file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "kinebase/formats/csm.h"

namespace kinebase::internal {

// Where a section ended.
struct CsmRest {
  std::string_view text;  // From the '$' of the next title; empty at the end of the file.
  std::int64_t line = 0;  // That its first byte stands in.
};

// Reads frames for the record's labels until the next title or the end of the file.
//
// text, line  What follows the title `$points`, and the line that it begins in.
// Errors      As ParseCsm.
CsmRest ReadCsmPoints(std::string_view text, std::int64_t line, const std::filesystem::path& file,
                      const CsmReadOptions& options, CsmRecording& recording);

}  // namespace kinebase::internal
