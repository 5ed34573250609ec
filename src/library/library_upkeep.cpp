#include "kinebase/library/library_upkeep.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/parallel.h"
#include "kinebase/core/text_scanner.h"
#include "library/catalogue.h"
#include "library/damage.h"
#include "library/library_layout.h"
#include "library/library_lock.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::Catalogue;
using internal::SqliteDatabase;
using internal::SqliteTransaction;

void CheckCatalogue(const fs::path& library, const Catalogue& catalogue) {
  const std::string wrong = catalogue.Check();
  if (wrong.empty()) return;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("is damaged ({}); restore it from a copy, or import the files into a new "
                          "library",
                          wrong),
              {.file = internal::CatalogueFile(library)});
}

// Errors  Of a take of which nobody can tell: see damage.h.
bool IsDamaged(const TakeLibrary& library, const StoredTake& take) {
  try {
    library.Check(take);
    return false;
  } catch (const Error& error) {
    if (!internal::IsDamage(error)) throw;
    return true;
  }
}

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
                                    std::span<const StoredTake> takes, const fs::path& library) {
  std::set<std::int64_t> ids;
  for (const fs::path& name : names) {
    const fs::path resolved = Resolved(name);
    bool is_there = false;
    for (const StoredTake& take : takes) {
      if (!Means(name, resolved, take)) continue;
      ids.insert(take.id);
      is_there = true;
    }
    if (is_there) continue;
    throw Error(ErrorCode::kNotFound,
                fmt::format("has no take {}; 'kinebase library list' shows what there is",
                            Quoted(name.string())),
                {.file = library});
  }
  return ids;
}

void RemoveFiles(const fs::path& library, std::span<const std::int64_t> segments) {
  for (const std::int64_t segment : segments) {
    std::error_code ignored;  // What stays is a leftover.
    fs::remove(internal::SegmentPath(library, segment), ignored);
  }
}

}  // namespace

VerifyReport VerifyLibrary(const fs::path& library, int threads, const ProgressCallback& progress) {
  internal::CheckIsLibrary(library);
  VerifyReport report;
  {
    const Catalogue catalogue(library, SqliteDatabase::Access::kRead);
    CheckCatalogue(library, catalogue);
  }
  const TakeLibrary opened(library);
  const auto& takes = opened.takes();
  std::vector<std::optional<Error>> errors(takes.size());
  ParallelFor(takes.size(), threads, "checking", progress, [&](std::size_t i) {
    try {
      opened.Check(takes[i]);
    } catch (const Error& error) {
      errors[i] = error;
    }
  });
  report.takes = std::ssize(takes);
  report.segment_bytes = opened.segment_bytes();
  for (std::size_t i = 0; i < takes.size(); ++i) {
    if (errors[i]) report.damaged.push_back({takes[i].path, *errors[i]});
  }
  report.leftovers = internal::FindLeftovers(library, opened.segments());
  return report;
}

std::vector<fs::path> RemoveTakes(const fs::path& library, const Removal& removal) {
  const bool is_filtered = !removal.filter.actors.empty() || !removal.filter.classes.empty();
  if (removal.names.empty() && !is_filtered && !removal.damaged) {
    throw Error(ErrorCode::kInvalidArgument, "nothing was named that is to be removed");
  }
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  const TakeLibrary opened(library);
  opened.CheckFilter(removal.filter);
  const std::set<std::int64_t> named = TakesOfNames(removal.names, opened.takes(), library);
  std::vector<const StoredTake*> chosen;
  for (const StoredTake& take : opened.takes()) {
    if (!removal.names.empty() && !named.contains(take.id)) continue;
    if (!removal.filter.Accepts(take)) continue;
    if (!removal.damaged || IsDamaged(opened, take)) chosen.push_back(&take);
  }
  if (chosen.empty()) return {};

  Catalogue catalogue(library, SqliteDatabase::Access::kCreate);
  SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kWrite);
  for (const StoredTake* take : chosen) catalogue.RemoveTake(take->id);
  const std::vector<std::int64_t> unused = catalogue.DropUnusedSegments();
  transaction.Commit();
  RemoveFiles(library, unused);
  std::vector<fs::path> removed;
  removed.reserve(chosen.size());
  for (const StoredTake* take : chosen) removed.push_back(take->path);
  return removed;
}

std::string FormatTakeList(std::span<const StoredTake> takes) {
  std::string text = "file,class,actor,take,format,frames,rate_hz\n";
  for (const StoredTake& take : takes) {
    for (const std::string& field :
         {take.path.string(), take.name.class_name, take.name.actor, take.name.take, take.format}) {
      text += CsvField(field) + ',';
    }
    text += fmt::format("{},{}\n", take.frame_count, ToShortestText(take.rate_hz));
  }
  return text;
}

}  // namespace kinebase
