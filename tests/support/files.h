// Small verbs for files in tests.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"

namespace kinebase::test {

std::string ReadText(const std::filesystem::path& path);
void WriteText(const std::filesystem::path& path, std::string_view text);  // Makes folders.

// All files below a folder with this extension (".amc"), sorted.
std::vector<std::filesystem::path> FilesBelow(const std::filesystem::path& folder,
                                              std::string_view extension);

CsvTable ReadCsv(const std::filesystem::path& path);

// Runs `action` and returns the Error that it throws; fails the test if it throws none.
Error ErrorOf(const std::function<void()>& action);

}  // namespace kinebase::test
