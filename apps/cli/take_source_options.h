// Options that say what is searched or annotated: files, or takes of a library.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinebase/library/take_source.h"

namespace kinebase::cli {

struct TakeSourceOptions {
  std::vector<std::filesystem::path> paths;
  std::filesystem::path library;  // Instead of paths.
  TakeFilter filter;
  std::uint64_t memory_bytes = kDefaultMemoryBytes;

  [[nodiscard]] bool is_given() const { return !paths.empty() || !library.empty(); }
  [[nodiscard]] std::int64_t memory_limit() const {
    return static_cast<std::int64_t>(memory_bytes);
  }
};

// --in, --library, those of AddTakeFilterOptions and --memory.
//
// verb     "search": what is done with the takes, for help texts.
// Returns  --library, for excludes().
CLI::Option* AddSourceOptions(CLI::App& command, TakeSourceOptions& options,
                              const std::string& verb);

// Errors  UsageError if there are options of reading for takes of a library, which have been read.
void CheckReadsFiles(const std::filesystem::path& library, const LoadOptions& load);

// Errors  As FindMotionFiles and TakeLibrary.
[[nodiscard]] TakeSource SourceOf(const TakeSourceOptions& options, const LoadOptions& load);

}  // namespace kinebase::cli
