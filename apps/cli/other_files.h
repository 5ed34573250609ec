// What `kinebase info` says of files that are no motion by themselves: skeletons, names of markers,
// tables over time, and what is written for other programs.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cli/console.h"

namespace kinebase::cli {

struct OtherFile {
  std::string format;                                      // "ASF".
  std::vector<std::pair<std::string, std::string>> lines;  // For people, as DescribeContents.
  Json contents = Json::object();
  Diagnostics diagnostics;
};

// By the ending of its name: .asf, .mnm, .mot, .sto, .glb, .csv.
[[nodiscard]] bool IsOtherFile(const std::filesystem::path& file);
[[nodiscard]] std::string OtherEndings();  // ".asf, .mnm …".

// Errors  NotFound, MalformedFile, IoFailure.
[[nodiscard]] OtherFile ReadOtherFile(const std::filesystem::path& file,
                                      const LoadOptions& options);

}  // namespace kinebase::cli
