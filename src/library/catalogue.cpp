#include "library/catalogue.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "library/library_layout.h"

namespace kinebase::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kVersion = 1;

constexpr char kSchema[] = R"(
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

std::string KeyText(const ContentKey& key) { return fmt::format("{:016x}{:016x}", key[1], key[0]); }

ContentKey ParseKey(std::string_view text) {
  constexpr std::size_t kDigits = 16;
  ContentKey key = {};
  if (text.size() != 2 * kDigits) return key;
  for (std::size_t i = 0; i < key.size(); ++i) {
    const char* const begin = text.data() + kDigits * (key.size() - 1 - i);
    std::from_chars(begin, begin + kDigits, key[i], 16);
  }
  return key;
}

// Searching counts with both: places in a take are computed from them.
void CheckTake(const StoredTake& take, const fs::path& catalogue) {
  const bool has_rate = std::isfinite(take.rate_hz) && take.rate_hz > 0;
  const bool has_frames =
      take.frame_count >= 1 && take.frame_count <= std::numeric_limits<std::int32_t>::max();
  if (has_rate && has_frames) return;
  throw Error(
      ErrorCode::kMalformedFile,
      fmt::format("says that {} has {} frames at {:g} Hz; restore it from a copy, or import "
                  "the files into a new library",
                  take.path.string(), take.frame_count, take.rate_hz),
      {.file = catalogue});
}

}  // namespace

void CheckHasNoLostSegments(const fs::path& library) {
  fs::path some;
  std::int64_t count = 0;
  std::error_code unreachable;
  for (const auto& entry : fs::directory_iterator(SegmentFolder(library), unreachable)) {
    if (entry.path().extension() != ".segment") continue;
    some = entry.path().filename();
    ++count;
  }
  if (count == 0) return;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("is missing or empty, but 'segments' beside it holds {} such as {}; "
                          "restore it from a copy, or name a new folder for the library",
                          count == 1 ? "a file" : fmt::format("{} files", count), some.string()),
              {.file = CatalogueFile(library)});
}

void CheckIsLibrary(const fs::path& library) {
  std::error_code unreachable;
  if (fs::exists(CatalogueFile(library), unreachable)) return;
  CheckHasNoLostSegments(library);
  throw Error(ErrorCode::kNotFound,
              fs::exists(library, unreachable)
                  ? "is no library; kinebase import makes one in a new or empty folder"
                  : "does not exist; kinebase import makes a library",
              {.file = library});
}

Catalogue::Catalogue(const fs::path& library, SqliteDatabase::Access access)
    : database_(CatalogueFile(library), access) {
  // What is reported as added has to be there after a power failure, also the journal's absence.
  database_.Execute("PRAGMA synchronous = EXTRA; PRAGMA foreign_keys = ON");
  const std::int64_t version = database_.Number("PRAGMA user_version");
  is_empty_ = version == 0 && database_.Number("SELECT count(*) FROM sqlite_master") == 0;
  constexpr std::int64_t kApplication = 0x4B494E45;
  if (!is_empty_ && database_.Number("PRAGMA application_id") != kApplication) {
    throw Error(ErrorCode::kMismatch, "is a database of another program",
                {.file = CatalogueFile(library)});
  }
  if (version > kVersion) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("is a catalogue of version {}; this Kinebase reads up to {}: use a "
                            "newer one",
                            version, kVersion),
                {.file = CatalogueFile(library)});
  }
  if (is_empty_) CheckHasNoLostSegments(library);
  if (access == SqliteDatabase::Access::kCreate && is_empty_) PrepareSchema();
}

void Catalogue::PrepareSchema() {
  SqliteTransaction transaction(database_, SqliteTransaction::Kind::kWrite);
  database_.Execute(kSchema);
  transaction.Commit();
  is_empty_ = false;
}

std::vector<StoredTake> Catalogue::Takes() const {
  if (is_empty_) return {};
  std::vector<StoredTake> takes;
  std::unordered_map<std::int64_t, std::size_t> places;
  SqliteStatement rows(database_,
                       "SELECT id, path, content, format, actor, class, take, rate_hz, frames "
                       "FROM takes");
  while (rows.Step()) {
    places[rows.Integer(0)] = takes.size();
    takes.push_back({.id = rows.Integer(0),
                     .path = rows.Text(1),
                     .content = ParseKey(rows.Text(2)),
                     .format = rows.Text(3),
                     .name = {rows.Text(4), rows.Text(5), rows.Text(6)},
                     .rate_hz = rows.Real(7),
                     .frame_count = rows.Integer(8)});
    CheckTake(takes.back(), database_.file());
  }
  SqliteStatement features(database_,
                           "SELECT take, feature_set, rate_hz, segment, slot, poses FROM features "
                           "ORDER BY take, feature_set, rate_hz");
  while (features.Step()) {
    const auto take = places.find(features.Integer(0));
    if (take == places.end()) continue;
    takes[take->second].features.push_back(
        {.feature_set_hash = static_cast<std::uint64_t>(features.Integer(1)),
         .rate_hz = features.Real(2),
         .segment = features.Integer(3),
         .slot = static_cast<int>(features.Integer(4)),
         .has_poses = features.Integer(5) != 0});
  }
  // As folders are searched: SQLite would put "a-b" before "a/b".
  std::ranges::sort(takes, {}, &StoredTake::path);
  return takes;
}

std::vector<StoredFeatureSet> Catalogue::FeatureSets() const {
  if (is_empty_) return {};
  SqliteStatement rows(database_,
                       "SELECT hash, name, rate_hz, count(*) FROM features JOIN feature_sets "
                       "ON hash = feature_set GROUP BY hash, rate_hz ORDER BY name, rate_hz");
  std::vector<StoredFeatureSet> sets;
  while (rows.Step()) {
    sets.push_back({.hash = static_cast<std::uint64_t>(rows.Integer(0)),
                    .name = rows.Text(1),
                    .rate_hz = rows.Real(2),
                    .takes = rows.Integer(3)});
  }
  return sets;
}

std::vector<std::int64_t> Catalogue::Segments() const {
  if (is_empty_) return {};
  SqliteStatement rows(database_, "SELECT id FROM segments ORDER BY id");
  std::vector<std::int64_t> segments;
  while (rows.Step()) segments.push_back(rows.Integer(0));
  return segments;
}

std::int64_t Catalogue::SegmentBytes() const {
  return is_empty_ ? 0 : database_.Number("SELECT coalesce(sum(bytes), 0) FROM segments");
}

std::int64_t Catalogue::NextSegment() const {
  const std::int64_t last =
      database_.Number("SELECT seq FROM sqlite_sequence WHERE name = 'segments'");
  if (last < 0 || last == std::numeric_limits<std::int64_t>::max()) {
    throw Error(ErrorCode::kMalformedFile,
                fmt::format("cannot number a segment after {}; restore it from a copy, or import "
                            "the files into a new library",
                            last),
                {.file = database_.file()});
  }
  return last + 1;
}

void Catalogue::AddFeatureSet(const FeatureSet& features) {
  SqliteStatement(database_, "INSERT OR IGNORE INTO feature_sets VALUES(?1, ?2)")
      .Bind(static_cast<std::int64_t>(features.hash))
      .Bind(features.name)
      .Run();
}

void Catalogue::AddSegment(std::int64_t segment, std::int64_t bytes) {
  SqliteStatement(database_, "INSERT INTO segments VALUES(?1, ?2)").Bind(segment).Bind(bytes).Run();
}

void Catalogue::PutTake(const StoredTake& take) {
  SqliteStatement row(database_,
                      "INSERT INTO takes(path, content, format, actor, class, take, rate_hz, "
                      "frames) VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) ON CONFLICT(path) DO UPDATE "
                      "SET content = excluded.content, format = excluded.format, "
                      "actor = excluded.actor, class = excluded.class, take = excluded.take, "
                      "rate_hz = excluded.rate_hz, frames = excluded.frames RETURNING id");
  row.Bind(take.path.native()).Bind(KeyText(take.content)).Bind(take.format);
  row.Bind(take.name.actor).Bind(take.name.class_name).Bind(take.name.take);
  row.Bind(take.rate_hz).Bind(take.frame_count);
  const std::int64_t id = row.Step() ? row.Integer(0) : 0;
  row.Run();
  SqliteStatement(database_, "DELETE FROM features WHERE take = ?1").Bind(id).Run();
  SqliteStatement insert(database_, "INSERT INTO features VALUES(?1, ?2, ?3, ?4, ?5, ?6)");
  for (const StoredFeatures& features : take.features) {
    insert.Bind(id).Bind(static_cast<std::int64_t>(features.feature_set_hash));
    insert.Bind(features.rate_hz).Bind(features.segment).Bind(std::int64_t{features.slot});
    insert.Bind(std::int64_t{features.has_poses}).Run();
  }
}

void Catalogue::RemoveTake(std::int64_t id) {
  SqliteStatement(database_, "DELETE FROM takes WHERE id = ?1").Bind(id).Run();
}

std::vector<std::int64_t> Catalogue::DropUnusedSegments() {
  SqliteStatement rows(database_,
                       "DELETE FROM segments WHERE id NOT IN (SELECT segment FROM features) "
                       "RETURNING id");
  std::vector<std::int64_t> dropped;
  while (rows.Step()) dropped.push_back(rows.Integer(0));
  return dropped;
}

std::string Catalogue::Check() const {
  SqliteStatement check(database_, "PRAGMA integrity_check(1)");
  std::string found = check.Step() ? check.Text(0) : "nothing can be read";
  if (found != "ok") return found;
  SqliteStatement references(database_, "PRAGMA foreign_key_check");
  return references.Step() ? "a row of " + references.Text(0) + " refers to nothing" : "";
}

std::vector<fs::path> FindLeftovers(const fs::path& library,
                                    std::span<const std::int64_t> segments) {
  std::set<fs::path> known;
  for (const std::int64_t segment : segments) known.insert(SegmentPath(library, segment));
  std::vector<fs::path> leftovers;
  std::error_code unreachable;
  for (const auto& entry : fs::directory_iterator(SegmentFolder(library), unreachable)) {
    const std::string name = entry.path().filename().string();
    const bool is_ours = name.ends_with(".segment") || name.starts_with(".kinebase-");
    if (is_ours && !known.contains(entry.path())) leftovers.push_back(entry.path());
  }
  std::ranges::sort(leftovers);
  return leftovers;
}

}  // namespace kinebase::internal
