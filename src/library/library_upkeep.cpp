#include "kinebase/library/library_upkeep.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/parallel.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/take_choice.h"
#include "library/catalogue.h"
#include "library/catalogue_records.h"
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

void VerifyCatalogue(const fs::path& library, VerifyReport& report) {
  const Catalogue catalogue(library, SqliteDatabase::Access::kRead);
  {
    const SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kRead);
    CheckCatalogue(library, catalogue);
    report.words_are_damaged = !catalogue.HasText();
    report.damaged_records = internal::DamagedRecords(catalogue);
    report.orphaned_rows = catalogue.CountOrphans();
  }
  if (!catalogue.HasSoundTextIndex()) report.words_are_damaged = true;
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

}  // namespace

VerifyReport VerifyLibrary(const fs::path& library, int threads, const ProgressCallback& progress) {
  internal::CheckIsLibrary(library);
  VerifyReport report;
  VerifyCatalogue(library, report);
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
  report.leftovers =
      internal::FindLeftovers(library, Catalogue(library, SqliteDatabase::Access::kRead));
  return report;
}

std::vector<fs::path> RemoveTakes(const fs::path& library, const Removal& removal) {
  if (removal.names.empty() && removal.filter == TakeFilter() && !removal.damaged) {
    throw Error(ErrorCode::kInvalidArgument, "nothing was named that is to be removed");
  }
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  const TakeLibrary opened(library);
  const TakeChoice choice{removal.names, removal.filter};
  std::vector<const StoredTake*> chosen =
      removal.damaged ? ChooseTakes(opened, choice) : ChooseTakesToChange(opened, choice);
  if (removal.damaged) {
    std::erase_if(chosen, [&](const StoredTake* take) { return !IsDamaged(opened, *take); });
  }
  if (chosen.empty()) return {};

  Catalogue catalogue(library, SqliteDatabase::Access::kCreate);
  SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kWrite);
  for (const StoredTake* take : chosen) catalogue.RemoveTake(take->id);
  const std::vector<std::int64_t> unused = catalogue.DropUnusedSegments();
  transaction.Commit();
  internal::RemoveSegments(library, unused);
  std::vector<fs::path> removed;
  removed.reserve(chosen.size());
  for (const StoredTake* take : chosen) removed.push_back(take->path);
  return removed;
}

std::vector<std::string> RemoveDamagedRecords(const fs::path& library) {
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  Catalogue catalogue(library, SqliteDatabase::Access::kCreate);
  SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kWrite);
  std::vector<std::string> removed = internal::RemoveDamagedRecords(catalogue);
  const std::int64_t orphans = catalogue.CountOrphans();
  catalogue.RemoveOrphans();
  const std::vector<std::int64_t> unused = catalogue.DropUnusedSegments();
  transaction.Commit();
  internal::RemoveSegments(library, unused);
  if (orphans > 0) removed.push_back(fmt::format("rows that belonged to no take: {}", orphans));
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
