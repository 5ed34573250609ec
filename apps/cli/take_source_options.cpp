#include "cli/take_source_options.h"

#include "cli/arguments.h"
#include "cli/console.h"
#include "cli/take_filter.h"

namespace kinebase::cli {

CLI::Option* AddSourceOptions(CLI::App& command, TakeSourceOptions& options,
                              const std::string& verb) {
  auto* paths = command.add_option("--in", options.paths, "Motion files and folders to " + verb)
                    ->type_name("PATH");
  auto* library = command
                      .add_option("--library", options.library,
                                  "Library to " + verb + " instead, from kinebase import")
                      ->excludes(paths)
                      ->type_name("FOLDER");
  for (CLI::Option* filter : AddTakeFilterOptions(command, options.filter)) filter->needs(library);
  AddMemoryOption(command, options.memory_bytes);
  return library;
}

void CheckReadsFiles(const std::filesystem::path& library, const LoadOptions& load) {
  if (library.empty() || load == LoadOptions{}) return;
  throw UsageError("takes of a --library have been read; options of reading are for files");
}

TakeSource SourceOf(const TakeSourceOptions& options, const LoadOptions& load) {
  if (!options.library.empty()) return {options.library, options.filter, options.memory_limit()};
  std::vector<TakeStretch> stretches;
  for (auto& file : FindMotionFiles(options.paths)) stretches.push_back({.file = std::move(file)});
  return {std::move(stretches), load};
}

}  // namespace kinebase::cli
