#include "kinebase/library/take_choice.h"

#include <algorithm>
#include <set>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "library/damage.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

bool IsBelow(const fs::path& path, const fs::path& folder) {
  const auto [folder_end, path_end] = std::ranges::mismatch(folder, path);
  return folder_end == folder.end();
}

// Whether a name means this take: its path, a folder above it, or its file's name.
bool Means(const fs::path& name, const fs::path& resolved, const StoredTake& take) {
  return take.path == name || IsBelow(take.path, resolved) || take.path.filename() == name;
}

fs::path Resolved(const fs::path& name) {
  std::error_code unreachable;  // The file may be gone, and is meant all the same.
  fs::path resolved = fs::weakly_canonical(name, unreachable);
  // A folder that ends in a slash has an empty last part, which no path has.
  return resolved.has_filename() ? resolved : resolved.parent_path();
}

std::set<std::int64_t> TakesOfNames(const std::vector<fs::path>& names,
                                    const TakeLibrary& library) {
  std::set<std::int64_t> ids;
  const bool is_sound = std::ranges::all_of(library.takes(), &StoredTake::is_intact);
  for (const fs::path& name : names) {
    const fs::path resolved = Resolved(name);
    bool is_there = false;
    for (const StoredTake& take : library.takes()) {
      if (!Means(name, resolved, take)) continue;
      ids.insert(take.id);
      is_there = true;
    }
    if (is_there || !is_sound) continue;
    throw Error(ErrorCode::kNotFound,
                fmt::format("has no take {}; 'kinebase library list' shows what there is",
                            Quoted(name.string())),
                {.file = library.folder()});
  }
  return ids;
}

}  // namespace

std::vector<const StoredTake*> ChooseTakes(const TakeLibrary& library, const TakeChoice& choice) {
  const std::set<std::int64_t> named = TakesOfNames(choice.names, library);
  std::vector<const StoredTake*> takes = library.Choose(choice.filter);
  if (!choice.names.empty()) {
    std::erase_if(takes, [&](const StoredTake* take) {
      return take->is_intact && !named.contains(take->id);
    });
  }
  return takes;
}

ChosenTakes ChooseIntactTakes(const TakeLibrary& library, const TakeChoice& choice) {
  ChosenTakes chosen;
  for (const StoredTake* take : ChooseTakes(library, choice)) {
    try {
      internal::CheckTakeRow(*take, library.folder());
      chosen.takes.push_back(take);
    } catch (const Error& error) {
      chosen.failures.push_back({take->path, error});
    }
  }
  return chosen;
}

std::vector<const StoredTake*> ChooseTakesToChange(const TakeLibrary& library,
                                                   const TakeChoice& choice) {
  std::vector<const StoredTake*> takes = ChooseTakes(library, choice);
  for (const StoredTake* take : takes) internal::CheckTakeRow(*take, library.folder());
  return takes;
}

}  // namespace kinebase
