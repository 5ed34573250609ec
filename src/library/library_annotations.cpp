#include "kinebase/library/library_annotations.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/annotation_file.h"
#include "library/catalogue_records.h"
#include "library/library_layout.h"
#include "library/library_lock.h"
#include "library/named_recordings.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::AnnotationOfTake;
using internal::Catalogue;
using internal::SqliteDatabase;
using internal::SqliteTransaction;

constexpr std::string_view kNoClass = "unknown";  // As `kinebase annotate` calls it.

// A column that may be missing, or empty in a row.
std::string_view Field(const CsvTable& table, std::size_t row, std::string_view column) {
  const auto index = table.FindColumn(column);
  return index ? Trim(table.rows[row][*index]) : std::string_view();
}

std::optional<double> NumberField(const CsvTable& table, std::size_t row, std::string_view column) {
  const std::string_view field = Field(table, row, column);
  if (field.empty()) return {};
  const auto number = ParseDouble(field);
  if (number && *number >= 0) return *number + 0.0;  // Not −0, which SQLite stores as 0.
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("{} {}; expected a number from 0, or nothing", column, Quoted(field)),
              {table.file, table.lines[row]});
}

std::int64_t FrameField(const CsvTable& table, std::size_t row, std::string_view column,
                        std::int64_t lowest) {
  const std::string& field = table.rows[row][table.Column(column)];
  const auto frame = ParseInteger(Trim(field));
  if (frame && *frame >= lowest) return *frame;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("{} {}; expected a whole number from {}", column, Quoted(field), lowest),
              {table.file, table.lines[row]});
}

// The hashes of the feature sets of stored templates, by the templates' names.
std::map<std::string, std::uint64_t> FeatureSetsOfTemplates(const Catalogue& catalogue) {
  std::map<std::string, std::uint64_t> sets;
  for (const StoredTemplate& stored : internal::TemplateRows(catalogue)) {
    sets.emplace(stored.name, stored.feature_set_hash);
  }
  return sets;
}

// Where nobody names the template it is the one that the class is called after, if there is one.
void NameTemplate(const std::map<std::string, std::uint64_t>& feature_sets,
                  StoredAnnotation& annotation) {
  const bool is_named = !annotation.template_name.empty();
  const auto set = feature_sets.find(is_named ? annotation.template_name : annotation.class_name);
  if (set == feature_sets.end()) return;
  annotation.template_name = set->first;
  annotation.feature_set_hash = set->second;
}

void CheckWithin(const StoredAnnotation& annotation, const StoredTake& take, const Place& place) {
  if (annotation.last_frame <= take.frame_count) return;
  throw Error(
      ErrorCode::kInvalidArgument,
      fmt::format("frames {}-{} are not all within {}, which has {}", annotation.first_frame,
                  annotation.last_frame, take.path.string(), take.frame_count),
      place);
}

// Those of the takes, with their paths, and all damaged ones, which may be of any.
std::vector<AnnotationOfTake> RowsOf(std::span<const StoredTake* const> chosen,
                                     const Catalogue& catalogue) {
  std::map<std::int64_t, const StoredTake*> takes;
  for (const StoredTake* take : chosen) takes.emplace(take->id, take);
  std::vector<AnnotationOfTake> rows = internal::AnnotationRows(catalogue);
  std::erase_if(rows, [&](const AnnotationOfTake& row) {
    return row.annotation.is_intact && !takes.contains(row.take);
  });
  for (AnnotationOfTake& row : rows) {
    const auto take = takes.find(row.take);
    if (take != takes.end()) row.annotation.path = take->second->path;
  }
  return rows;
}

Error DamageOf(const AnnotationOfTake& row, const fs::path& library) {
  return {ErrorCode::kMalformedFile,
          fmt::format("the {} is damaged; run 'kinebase library remove LIBRARY --damaged' and add "
                      "it again",
                      internal::NameOf(row)),
          {.file = internal::CatalogueFile(library)}};
}

std::string NumberText(const std::optional<double>& number) {
  return number ? ToShortestText(*number) : std::string();
}

}  // namespace

std::vector<AnnotationRow> ParseAnnotationTable(std::string_view text, const fs::path& file) {
  const CsvTable table = ParseCsv(text, file);
  const std::size_t path = table.Column("file");
  const std::size_t class_name = table.Column("class");
  std::vector<AnnotationRow> rows;
  rows.reserve(table.rows.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    AnnotationRow row{.line = table.lines[i]};
    StoredAnnotation& annotation = row.annotation;
    annotation.path = table.rows[i][path];
    annotation.class_name = table.rows[i][class_name];
    annotation.first_frame = FrameField(table, i, "first_frame", 1);
    annotation.last_frame = FrameField(table, i, "last_frame", annotation.first_frame);
    annotation.cost = NumberField(table, i, "cost");
    annotation.confidence = NumberField(table, i, "confidence");
    annotation.template_name = Field(table, i, "template");
    if (Trim(annotation.class_name).empty()) {
      throw Error(ErrorCode::kMalformedFile, "an annotation without a class", {file, row.line});
    }
    if (annotation.class_name != kNoClass) rows.push_back(std::move(row));
  }
  return rows;
}

std::string FormatAnnotationTable(std::span<const StoredAnnotation> annotations,
                                  std::span<const StoredTake> takes) {
  std::map<fs::path, double> rates;
  for (const StoredTake& take : takes) rates.emplace(take.path, take.rate_hz);
  std::string text = "file,class,first_frame,last_frame,start_s,end_s,cost,confidence,template\n";
  for (const StoredAnnotation& each : annotations) {
    const auto rate = rates.find(each.path);
    std::optional<double> start_s;
    std::optional<double> end_s;
    if (rate != rates.end()) {
      start_s = static_cast<double>(each.first_frame - 1) / rate->second;
      end_s = static_cast<double>(each.last_frame) / rate->second;
    }
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", CsvField(each.path.string()),
                        CsvField(each.class_name), each.first_frame, each.last_frame,
                        NumberText(start_s), NumberText(end_s), NumberText(each.cost),
                        NumberText(each.confidence), CsvField(each.template_name));
  }
  return text;
}

AnnotationList ListAnnotations(const fs::path& library, const TakeChoice& choice) {
  const TakeLibrary opened(library);
  const Catalogue catalogue(library, SqliteDatabase::Access::kRead);
  ChosenTakes chosen = ChooseIntactTakes(opened, choice);
  std::vector<AnnotationOfTake> rows = RowsOf(chosen.takes, catalogue);
  AnnotationList list{.annotations = {}, .failures = std::move(chosen.failures)};
  list.annotations.reserve(rows.size());
  for (AnnotationOfTake& row : rows) {
    if (row.annotation.is_intact) {
      list.annotations.push_back(std::move(row.annotation));
    } else {
      list.failures.push_back({row.annotation.path, DamageOf(row, library)});
    }
  }
  std::ranges::stable_sort(list.annotations, {}, [](const StoredAnnotation& each) {
    return std::tie(each.path, each.first_frame, each.last_frame, each.class_name);
  });
  return list;
}

AnnotationReport StoreAnnotations(const fs::path& library, const TakeChoice& choice,
                                  std::span<const AnnotationRow> rows, const fs::path& table) {
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  const TakeLibrary opened(library);
  const internal::NamedRecordings recordings(ChooseTakesToChange(opened, choice));
  const Catalogue catalogue(library, SqliteDatabase::Access::kCreate);
  const auto feature_sets = FeatureSetsOfTemplates(catalogue);
  const std::int64_t now = internal::SecondsSince1970();
  AnnotationReport report;
  SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kWrite);
  for (const AnnotationRow& row : rows) {
    const Place place{table, row.line};
    const fs::path& path = row.annotation.path;
    const StoredTake* take = recordings.Find(path, RecordingName(path), place);
    if (take == nullptr) {
      ++report.passed_over;
      continue;
    }
    CheckWithin(row.annotation, *take, place);
    AnnotationOfTake stored{take->id, row.annotation};
    NameTemplate(feature_sets, stored.annotation);
    stored.annotation.stored_s = now;
    internal::PutAnnotation(catalogue, stored);
    ++report.stored;
  }
  if (report.stored == 0) {
    throw Error(ErrorCode::kNotFound, "annotates no recording that the library holds",
                {.file = table});
  }
  transaction.Commit();
  return report;
}

std::int64_t RemoveAnnotations(const fs::path& library, const TakeChoice& choice,
                               std::span<const std::string> classes) {
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  const TakeLibrary opened(library);
  const Catalogue catalogue(library, SqliteDatabase::Access::kCreate);
  std::int64_t removed = 0;
  SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kWrite);
  for (const AnnotationOfTake& row : RowsOf(ChooseTakesToChange(opened, choice), catalogue)) {
    if (!row.annotation.is_intact) throw DamageOf(row, library);
    const bool is_meant =
        classes.empty() || std::ranges::find(classes, row.annotation.class_name) != classes.end();
    if (!is_meant) continue;
    internal::RemoveAnnotation(catalogue, row);
    ++removed;
  }
  transaction.Commit();
  return removed;
}

}  // namespace kinebase
