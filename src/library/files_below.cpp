#include "library/files_below.h"

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

namespace kinebase::internal {

namespace fs = std::filesystem;

std::vector<fs::path> FilesBelow(const fs::path& folder,
                                 const std::function<bool(const fs::path&)>& wanted) {
  std::vector<fs::path> files;
  std::vector<fs::path> open = {folder};
  std::set<fs::path> entered;
  while (!open.empty()) {
    const fs::path current = std::move(open.back());
    open.pop_back();
    std::error_code error;
    const fs::path real = fs::canonical(current, error);
    if (error || !entered.insert(real).second) continue;
    // Not a range-based loop: its ++ throws where a folder cannot be read on.
    for (fs::directory_iterator entry(current, error), end; !error && entry != end;
         entry.increment(error)) {
      std::error_code ignored;
      if (entry->is_directory(ignored)) {
        open.push_back(entry->path());
      } else if (entry->is_regular_file(ignored) && wanted(entry->path())) {
        files.push_back(entry->path());
      }
    }
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace kinebase::internal
