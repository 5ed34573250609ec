#include "library/catalogue_schema.h"

#include <string>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase::internal {
namespace {

constexpr char kVersion1[] = R"(
CREATE TABLE takes(
  id INTEGER PRIMARY KEY AUTOINCREMENT, path TEXT NOT NULL UNIQUE, content TEXT NOT NULL,
  format TEXT NOT NULL, actor TEXT NOT NULL, class TEXT NOT NULL, take TEXT NOT NULL,
  rate_hz REAL NOT NULL, frames INTEGER NOT NULL);
CREATE TABLE segments(id INTEGER PRIMARY KEY AUTOINCREMENT, bytes INTEGER NOT NULL);
CREATE TABLE feature_sets(hash INTEGER PRIMARY KEY, name TEXT NOT NULL);
CREATE TABLE features(
  take INTEGER NOT NULL REFERENCES takes(id) ON DELETE CASCADE,
  feature_set INTEGER NOT NULL REFERENCES feature_sets(hash),
  rate_hz REAL NOT NULL,
  segment INTEGER NOT NULL REFERENCES segments(id),
  slot INTEGER NOT NULL, poses INTEGER NOT NULL,
  PRIMARY KEY(take, feature_set, rate_hz)) WITHOUT ROWID;
CREATE INDEX features_of_segment ON features(segment);
PRAGMA application_id = 0x4B494E45;
PRAGMA user_version = 1;
)";

// All that version 1 has stays as it was, so that a reader that opened it as such goes on.
constexpr char kVersion2[] = R"(
ALTER TABLE takes ADD COLUMN description TEXT NOT NULL DEFAULT '';
ALTER TABLE takes ADD COLUMN skeleton TEXT NOT NULL DEFAULT '';
ALTER TABLE takes ADD COLUMN skeleton_key TEXT NOT NULL DEFAULT '';
ALTER TABLE takes ADD COLUMN imported_s INTEGER NOT NULL DEFAULT 0;
ALTER TABLE takes ADD COLUMN file_time_s INTEGER NOT NULL DEFAULT 0;
ALTER TABLE takes ADD COLUMN file_bytes INTEGER NOT NULL DEFAULT 0;
ALTER TABLE takes ADD COLUMN program TEXT NOT NULL DEFAULT '';
ALTER TABLE takes ADD COLUMN options TEXT NOT NULL DEFAULT '';
ALTER TABLE takes ADD COLUMN checksum INTEGER NOT NULL DEFAULT 0;
CREATE TABLE labels(
  take INTEGER NOT NULL REFERENCES takes(id) ON DELETE CASCADE,
  label TEXT NOT NULL, first_frame INTEGER NOT NULL, last_frame INTEGER NOT NULL,
  PRIMARY KEY(take, label, first_frame, last_frame)) WITHOUT ROWID;
CREATE TABLE templates(
  name TEXT PRIMARY KEY, json TEXT NOT NULL, feature_set INTEGER NOT NULL,
  stored_s INTEGER NOT NULL, checksum INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE annotations(
  take INTEGER NOT NULL REFERENCES takes(id) ON DELETE CASCADE,
  class TEXT NOT NULL, template TEXT NOT NULL,
  first_frame INTEGER NOT NULL, last_frame INTEGER NOT NULL,
  cost REAL, confidence REAL, feature_set INTEGER NOT NULL,
  stored_s INTEGER NOT NULL, checksum INTEGER NOT NULL,
  PRIMARY KEY(take, class, template, first_frame, last_frame)) WITHOUT ROWID;
PRAGMA user_version = 2;
)";

}  // namespace

void MakeVersion(const SqliteDatabase& database, std::int64_t version) {
  database.Execute(version == 1 ? kVersion1 : kVersion2);
  if (version == 2) MakeTextTable(database, "main");
}

void MakeTextTable(const SqliteDatabase& database, const char* schema) {
  database.Execute(
      fmt::format("CREATE VIRTUAL TABLE {}.take_text USING fts5(name, class, actor, skeleton, "
                  "labels, description, tokenize = 'unicode61 remove_diacritics 2')",
                  schema)
          .c_str());
}

void CheckSchema(const SqliteDatabase& database) {
  SqliteStatement foreign(database,
                          "SELECT type, name FROM sqlite_master WHERE type IN ('view', 'trigger')");
  if (!foreign.Step()) return;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("has a {} '{}', which Kinebase did not make; restore it from a copy, or "
                          "import the files into a new library",
                          foreign.Text(0), foreign.Text(1)),
              {.file = database.file()});
}

}  // namespace kinebase::internal
