#include "kinebase/library/library_templates.h"

#include <algorithm>
#include <set>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/templates/template_file.h"
#include "library/catalogue_records.h"
#include "library/library_layout.h"
#include "library/library_lock.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::Catalogue;
using internal::SqliteDatabase;
using internal::SqliteTransaction;

const StoredTemplate& Find(std::span<const StoredTemplate> templates, const std::string& name,
                           const fs::path& library) {
  const auto found = std::ranges::find(templates, name, &StoredTemplate::name);
  if (found != templates.end()) return *found;
  std::vector<std::string> names;
  names.reserve(templates.size());
  for (const StoredTemplate& stored : templates) names.push_back(stored.name);
  throw Error(
      ErrorCode::kNotFound,
      templates.empty()
          ? "holds no templates; 'kinebase library templates LIBRARY --add FILE' adds some"
          : fmt::format("has no template {}; there are: {}", Quoted(name), fmt::join(names, ", ")),
      {.file = library});
}

// Names that are not there, or there twice, are found before anything is changed.
void CheckNames(std::span<const MotionTemplate> templates, std::span<const StoredTemplate> stored,
                Overwrite overwrite, const fs::path& library) {
  std::set<std::string> names;
  if (overwrite == Overwrite::kNo) {
    for (const StoredTemplate& each : stored) names.insert(each.name);
  }
  for (const MotionTemplate& each : templates) {
    if (Trim(each.name).empty()) {
      throw Error(ErrorCode::kInvalidArgument,
                  "a template without a name cannot be stored; give it one with 'kinebase learn "
                  "--name' or 'template edit'");
    }
    if (names.insert(each.name).second) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("has a template {}, or would have two of that name; --force replaces "
                            "those that are there",
                            Quoted(each.name)),
                {.file = library});
  }
}

}  // namespace

std::vector<StoredTemplate> ListTemplates(const fs::path& library) {
  internal::CheckIsLibrary(library);
  return internal::TemplateRows(Catalogue(library, SqliteDatabase::Access::kRead));
}

MotionTemplate ParseStoredTemplate(const StoredTemplate& stored, const fs::path& library) {
  const fs::path file = internal::CatalogueFile(library);
  if (!stored.is_intact) {
    throw Error(
        ErrorCode::kMalformedFile,
        fmt::format("the template {} is damaged; remove it and add it again", Quoted(stored.name)),
        {.file = file});
  }
  return ParseTemplate(stored.json, file);
}

MotionTemplate LoadTemplate(const fs::path& library, const std::string& name) {
  return ParseStoredTemplate(Find(ListTemplates(library), name, library), library);
}

MotionTemplate ReadOrLoadTemplate(const fs::path& file_or_name, const fs::path& library) {
  std::error_code unreachable;
  // A folder is no template, whatever its name: it may be called after a class.
  const bool is_file =
      fs::exists(file_or_name, unreachable) && !fs::is_directory(file_or_name, unreachable);
  if (is_file || library.empty() || ListTemplates(library).empty()) {
    return ReadTemplate(file_or_name);
  }
  return LoadTemplate(library, file_or_name.string());
}

void StoreTemplates(const fs::path& library, std::span<const MotionTemplate> templates,
                    Overwrite overwrite) {
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  const Catalogue catalogue(library, SqliteDatabase::Access::kCreate);
  CheckNames(templates, internal::TemplateRows(catalogue), overwrite, library);
  const std::int64_t now = internal::SecondsSince1970();
  SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kWrite);
  for (const MotionTemplate& each : templates) {
    internal::PutTemplate(catalogue, {.name = each.name,
                                      .json = FormatTemplate(each),
                                      .feature_set_hash = each.feature_set_hash,
                                      .stored_s = now});
  }
  transaction.Commit();
}

void RemoveTemplates(const fs::path& library, std::span<const std::string> names) {
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  const Catalogue catalogue(library, SqliteDatabase::Access::kCreate);
  const std::vector<StoredTemplate> templates = internal::TemplateRows(catalogue);
  SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kWrite);
  for (const std::string& name : names) {
    internal::RemoveTemplate(catalogue, Find(templates, name, library).name);
  }
  transaction.Commit();
}

}  // namespace kinebase
