#include "library/catalogue_records.h"

#include <chrono>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "library/row_checksum.h"

namespace kinebase::internal {
namespace {

std::int64_t ChecksumOf(const StoredTemplate& stored) {
  return RowChecksum()
      .Add(stored.name)
      .Add(stored.json)
      .Add(static_cast<std::int64_t>(stored.feature_set_hash))
      .Add(stored.stored_s)
      .value();
}

std::int64_t ChecksumOf(const AnnotationOfTake& row) {
  const StoredAnnotation& annotation = row.annotation;
  RowChecksum sum;
  sum.Add(row.take).Add(annotation.class_name).Add(annotation.template_name);
  sum.Add(annotation.first_frame).Add(annotation.last_frame);
  for (const std::optional<double>& number : {annotation.cost, annotation.confidence}) {
    sum.Add(std::int64_t{number.has_value()}).Add(number.value_or(0));
  }
  sum.Add(static_cast<std::int64_t>(annotation.feature_set_hash)).Add(annotation.stored_s);
  return sum.value();
}

}  // namespace

std::int64_t SecondsSince1970() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::vector<StoredTemplate> TemplateRows(const Catalogue& catalogue) {
  std::vector<StoredTemplate> templates;
  if (catalogue.version() < 2) return templates;
  SqliteStatement rows(catalogue.database(),
                       "SELECT name, json, feature_set, stored_s, checksum FROM templates "
                       "ORDER BY name");
  while (rows.Step()) {
    StoredTemplate& stored = templates.emplace_back();
    stored.name = rows.Text(0);
    stored.json = rows.Text(1);
    stored.feature_set_hash = static_cast<std::uint64_t>(rows.Integer(2));
    stored.stored_s = rows.Integer(3);
    stored.is_intact = ChecksumOf(stored) == rows.Integer(4);
  }
  return templates;
}

std::vector<AnnotationOfTake> AnnotationRows(const Catalogue& catalogue) {
  std::vector<AnnotationOfTake> annotations;
  if (catalogue.version() < 2) return annotations;
  SqliteStatement rows(catalogue.database(),
                       "SELECT take, class, template, first_frame, last_frame, cost, confidence, "
                       "feature_set, stored_s, checksum FROM annotations");
  while (rows.Step()) {
    AnnotationOfTake& row = annotations.emplace_back();
    row.take = rows.Integer(0);
    row.annotation = {.class_name = rows.Text(1),
                      .first_frame = rows.Integer(3),
                      .last_frame = rows.Integer(4),
                      .cost = rows.RealOrNull(5),
                      .confidence = rows.RealOrNull(6),
                      .template_name = rows.Text(2),
                      .feature_set_hash = static_cast<std::uint64_t>(rows.Integer(7)),
                      .stored_s = rows.Integer(8)};
    row.annotation.is_intact = ChecksumOf(row) == rows.Integer(9);
  }
  return annotations;
}

std::string NameOf(const AnnotationOfTake& row) {
  return fmt::format("annotation {}, frames {}-{} of take {}", Quoted(row.annotation.class_name),
                     row.annotation.first_frame, row.annotation.last_frame, row.take);
}

void RemoveTemplate(const Catalogue& catalogue, const std::string& name) {
  SqliteStatement(catalogue.database(), "DELETE FROM templates WHERE name = ?1").Bind(name).Run();
}

void PutTemplate(const Catalogue& catalogue, const StoredTemplate& stored) {
  SqliteStatement(catalogue.database(),
                  "INSERT OR REPLACE INTO templates VALUES(?1, ?2, ?3, ?4, ?5)")
      .Bind(stored.name)
      .Bind(stored.json)
      .Bind(static_cast<std::int64_t>(stored.feature_set_hash))
      .Bind(stored.stored_s)
      .Bind(ChecksumOf(stored))
      .Run();
}

void PutAnnotation(const Catalogue& catalogue, const AnnotationOfTake& row) {
  const StoredAnnotation& annotation = row.annotation;
  SqliteStatement insert(catalogue.database(),
                         "INSERT OR REPLACE INTO annotations "
                         "VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)");
  insert.Bind(row.take).Bind(annotation.class_name).Bind(annotation.template_name);
  insert.Bind(annotation.first_frame).Bind(annotation.last_frame);
  insert.Bind(annotation.cost).Bind(annotation.confidence);
  insert.Bind(static_cast<std::int64_t>(annotation.feature_set_hash)).Bind(annotation.stored_s);
  insert.Bind(ChecksumOf(row)).Run();
}

void RemoveAnnotation(const Catalogue& catalogue, const AnnotationOfTake& row) {
  SqliteStatement(catalogue.database(),
                  "DELETE FROM annotations WHERE take = ?1 AND class = ?2 AND template = ?3 AND "
                  "first_frame = ?4 AND last_frame = ?5")
      .Bind(row.take)
      .Bind(row.annotation.class_name)
      .Bind(row.annotation.template_name)
      .Bind(row.annotation.first_frame)
      .Bind(row.annotation.last_frame)
      .Run();
}

void CutAnnotations(const Catalogue& catalogue, std::int64_t take, std::int64_t frames) {
  for (AnnotationOfTake& row : AnnotationRows(catalogue)) {
    StoredAnnotation& annotation = row.annotation;
    if (row.take != take || !annotation.is_intact || annotation.last_frame <= frames) continue;
    RemoveAnnotation(catalogue, row);
    annotation.last_frame = frames;
    if (annotation.first_frame <= frames) PutAnnotation(catalogue, row);
  }
}

std::vector<std::string> DamagedRecords(const Catalogue& catalogue) {
  std::vector<std::string> damaged;
  for (const StoredTemplate& stored : TemplateRows(catalogue)) {
    if (!stored.is_intact) damaged.push_back(fmt::format("template {}", Quoted(stored.name)));
  }
  for (const AnnotationOfTake& row : AnnotationRows(catalogue)) {
    if (row.annotation.is_intact) continue;
    damaged.push_back(NameOf(row));
  }
  return damaged;
}

std::vector<std::string> RemoveDamagedRecords(const Catalogue& catalogue) {
  std::vector<std::string> removed = DamagedRecords(catalogue);
  for (const StoredTemplate& stored : TemplateRows(catalogue)) {
    if (!stored.is_intact) RemoveTemplate(catalogue, stored.name);
  }
  for (const AnnotationOfTake& row : AnnotationRows(catalogue)) {
    if (!row.annotation.is_intact) RemoveAnnotation(catalogue, row);
  }
  return removed;
}

}  // namespace kinebase::internal
