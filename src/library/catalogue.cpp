#include "library/catalogue.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "library/catalogue_schema.h"
#include "library/catalogue_text.h"
#include "library/library_layout.h"
#include "library/row_checksum.h"

namespace kinebase::internal {
namespace {

namespace fs = std::filesystem;

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
bool IsPossible(const StoredTake& take) {
  const bool has_rate = std::isfinite(take.rate_hz) && take.rate_hz > 0;
  return has_rate && take.frame_count >= 1 &&
         take.frame_count <= std::numeric_limits<std::int32_t>::max();
}

// For version 1, which has no checksum that says whether a take is meant to be so.
void CheckIsPossible(const StoredTake& take, const fs::path& catalogue) {
  if (IsPossible(take)) return;
  throw Error(
      ErrorCode::kMalformedFile,
      fmt::format("says that {} has {} frames at {:g} Hz; restore it from a copy, or import "
                  "the files into a new library",
                  take.path.string(), take.frame_count, take.rate_hz),
      {.file = catalogue});
}

using Places = std::unordered_map<std::int64_t, std::size_t>;  // Of takes, by their ids.

void ReadFeatures(const SqliteDatabase& database, const Places& places,
                  std::vector<StoredTake>& takes) {
  SqliteStatement rows(database,
                       "SELECT take, feature_set, rate_hz, segment, slot, poses FROM features "
                       "ORDER BY take, feature_set, rate_hz");
  while (rows.Step()) {
    const auto take = places.find(rows.Integer(0));
    if (take == places.end()) continue;
    takes[take->second].features.push_back(
        {.feature_set_hash = static_cast<std::uint64_t>(rows.Integer(1)),
         .rate_hz = rows.Real(2),
         .segment = rows.Integer(3),
         .slot = static_cast<int>(rows.Integer(4)),
         .has_poses = rows.Integer(5) != 0});
  }
}

void ReadLabels(const SqliteDatabase& database, const Places& places,
                std::vector<StoredTake>& takes) {
  SqliteStatement rows(database,
                       "SELECT take, label, first_frame, last_frame FROM labels "
                       "ORDER BY take, label, first_frame, last_frame");
  while (rows.Step()) {
    const auto take = places.find(rows.Integer(0));
    if (take == places.end()) continue;
    takes[take->second].labels.push_back({rows.Text(1), rows.Integer(2), rows.Integer(3)});
  }
}

void CompareChecksums(const SqliteDatabase& database, const Places& places,
                      std::vector<StoredTake>& takes) {
  SqliteStatement rows(database, "SELECT id, checksum FROM takes");
  while (rows.Step()) {
    const auto place = places.find(rows.Integer(0));
    if (place == places.end()) continue;
    StoredTake& take = takes[place->second];
    take.is_intact = ChecksumOf(take) == rows.Integer(1) && IsPossible(take);
    if (take.is_intact) continue;
    take.frame_count = 0;  // Nobody is to count with what they may have become.
    take.rate_hz = 1;
  }
}

// In the order of the table's key, as they are read again.
void PutFeatures(const SqliteDatabase& database, StoredTake& take) {
  std::ranges::sort(take.features, {}, [](const StoredFeatures& features) {
    return std::pair(static_cast<std::int64_t>(features.feature_set_hash), features.rate_hz);
  });
  SqliteStatement(database, "DELETE FROM features WHERE take = ?1").Bind(take.id).Run();
  SqliteStatement insert(database, "INSERT INTO features VALUES(?1, ?2, ?3, ?4, ?5, ?6)");
  for (const StoredFeatures& features : take.features) {
    insert.Bind(take.id).Bind(static_cast<std::int64_t>(features.feature_set_hash));
    insert.Bind(features.rate_hz).Bind(features.segment).Bind(std::int64_t{features.slot});
    insert.Bind(std::int64_t{features.has_poses}).Run();
  }
}

void PutLabels(const SqliteDatabase& database, StoredTake& take) {
  std::ranges::sort(take.labels);
  const auto repeated = std::ranges::unique(take.labels);
  take.labels.erase(repeated.begin(), repeated.end());
  SqliteStatement(database, "DELETE FROM labels WHERE take = ?1").Bind(take.id).Run();
  SqliteStatement insert(database, "INSERT INTO labels VALUES(?1, ?2, ?3, ?4)");
  for (const StoredLabel& label : take.labels) {
    insert.Bind(take.id).Bind(label.text).Bind(label.first_frame).Bind(label.last_frame).Run();
  }
}

// The tables whose rows belong to takes.
std::span<const char* const> TablesOfTakes(std::int64_t version) {
  static constexpr const char* kTables[] = {"features", "labels", "annotations"};
  return std::span(kTables).first(version == 0 ? 0 : version == 1 ? 1 : 3);
}

std::string Orphans(const char* table) {
  return fmt::format("FROM {} WHERE take NOT IN (SELECT id FROM takes)", table);
}

void PutChecksum(const SqliteDatabase& database, const StoredTake& take) {
  SqliteStatement(database, "UPDATE takes SET checksum = ?2 WHERE id = ?1")
      .Bind(take.id)
      .Bind(ChecksumOf(take))
      .Run();
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
  // Of a catalogue that somebody else made up, nothing is run.
  database_.Execute(
      "PRAGMA synchronous = EXTRA; PRAGMA foreign_keys = ON; PRAGMA trusted_schema = OFF");
  version_ = database_.Number("PRAGMA user_version");
  const bool is_empty =
      version_ == 0 && database_.Number("SELECT count(*) FROM sqlite_master") == 0;
  if (!is_empty && database_.Number("PRAGMA application_id") != kCatalogueApplication) {
    throw Error(ErrorCode::kMismatch, "is a database of another program",
                {.file = database_.file()});
  }
  if (version_ > kCatalogueVersion || version_ < 0) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("is a catalogue of version {}; this Kinebase reads up to {}: use a "
                            "newer one",
                            version_, kCatalogueVersion),
                {.file = database_.file()});
  }
  CheckSchema(database_);
  if (is_empty) CheckHasNoLostSegments(library);
  if (access != SqliteDatabase::Access::kCreate) return;
  if (version_ < kCatalogueVersion) Upgrade();
  MakeMissingText();
}

void Catalogue::Upgrade() {
  SqliteTransaction transaction(database_, SqliteTransaction::Kind::kWrite);
  const std::vector<StoredTake> takes = Takes();  // Before their checksums are asked for.
  while (version_ < kCatalogueVersion) MakeVersion(database_, ++version_);
  for (const StoredTake& take : takes) PutTake(take);
  transaction.Commit();
}

void Catalogue::MakeMissingText() {
  if (HasTextTable(database_)) return;
  SqliteTransaction transaction(database_, SqliteTransaction::Kind::kWrite);
  MakeTextTable(database_, "main");
  FillText(database_, Takes());
  transaction.Commit();
}

std::vector<StoredTake> Catalogue::TakeRows() const {
  std::vector<StoredTake> takes;
  takes.reserve(static_cast<std::size_t>(database_.Number("SELECT count(*) FROM takes")));
  SqliteStatement rows(
      database_,
      version_ == 1
          ? "SELECT id, path, content, format, actor, class, take, rate_hz, frames FROM takes"
          : "SELECT id, path, content, format, actor, class, take, rate_hz, frames, description, "
            "skeleton, skeleton_key, imported_s, file_time_s, file_bytes, program, options "
            "FROM takes");
  while (rows.Step()) {
    takes.push_back({.id = rows.Integer(0),
                     .path = rows.Text(1),
                     .content = ParseKey(rows.Text(2)),
                     .format = rows.Text(3),
                     .name = {rows.Text(4), rows.Text(5), rows.Text(6)},
                     .rate_hz = rows.Real(7),
                     .frame_count = rows.Integer(8)});
    StoredTake& take = takes.back();
    if (version_ == 1) {
      CheckIsPossible(take, database_.file());
      continue;
    }
    take.description = rows.Text(9);
    take.skeleton = {rows.Text(10), ParseKey(rows.Text(11))};
    take.origin = {.imported_s = rows.Integer(12),
                   .file_time_s = rows.Integer(13),
                   .file_bytes = rows.Integer(14),
                   .program = rows.Text(15),
                   .options = rows.Text(16)};
  }
  return takes;
}

std::vector<StoredTake> Catalogue::Takes() const {
  if (version_ == 0) return {};
  std::vector<StoredTake> takes = TakeRows();
  std::unordered_map<std::int64_t, std::size_t> places;
  places.reserve(takes.size());
  for (std::size_t i = 0; i < takes.size(); ++i) places[takes[i].id] = i;
  ReadFeatures(database_, places, takes);
  if (version_ > 1) {
    ReadLabels(database_, places, takes);
    CompareChecksums(database_, places, takes);
  }
  // As folders are searched: SQLite would put "a-b" before "a/b".
  std::ranges::sort(takes, {}, &StoredTake::path);
  return takes;
}

std::vector<StoredFeatureSet> Catalogue::FeatureSets() const {
  if (version_ == 0) return {};
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
  if (version_ == 0) return {};
  SqliteStatement rows(database_, "SELECT id FROM segments ORDER BY id");
  std::vector<std::int64_t> segments;
  while (rows.Step()) segments.push_back(rows.Integer(0));
  return segments;
}

std::vector<std::int64_t> Catalogue::NamedSegments() const {
  if (version_ == 0) return {};
  SqliteStatement rows(database_,
                       "SELECT id FROM segments UNION SELECT segment FROM features ORDER BY 1");
  std::vector<std::int64_t> segments;
  while (rows.Step()) segments.push_back(rows.Integer(0));
  return segments;
}

std::int64_t Catalogue::SegmentBytes() const {
  return version_ == 0 ? 0 : database_.Number("SELECT coalesce(sum(bytes), 0) FROM segments");
}

std::vector<std::int64_t> Catalogue::FindText(std::string_view query) const {
  if (version_ == 0) return {};
  const bool has_words = database_.Number("SELECT count(*) FROM temp.sqlite_master") > 0 ||
                         (version_ > 1 && HasTextOfAll(database_));
  if (!has_words) {
    MakeTextTable(database_, "temp");
    FillText(database_, Takes());
  }
  return internal::FindText(database_, query);
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
  SqliteStatement row(
      database_,
      "INSERT INTO takes(path, content, format, actor, class, take, rate_hz, frames, description, "
      "skeleton, skeleton_key, imported_s, file_time_s, file_bytes, program, options) "
      "VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16) "
      "ON CONFLICT(path) DO UPDATE SET content = excluded.content, format = excluded.format, "
      "actor = excluded.actor, class = excluded.class, take = excluded.take, "
      "rate_hz = excluded.rate_hz, frames = excluded.frames, description = excluded.description, "
      "skeleton = excluded.skeleton, skeleton_key = excluded.skeleton_key, "
      "imported_s = excluded.imported_s, file_time_s = excluded.file_time_s, "
      "file_bytes = excluded.file_bytes, program = excluded.program, options = excluded.options "
      "RETURNING id");
  row.Bind(take.path.native()).Bind(KeyText(take.content)).Bind(take.format);
  row.Bind(take.name.actor).Bind(take.name.class_name).Bind(take.name.take);
  row.Bind(take.rate_hz).Bind(take.frame_count).Bind(take.description);
  row.Bind(take.skeleton.path.native()).Bind(KeyText(take.skeleton.key));
  row.Bind(take.origin.imported_s).Bind(take.origin.file_time_s).Bind(take.origin.file_bytes);
  row.Bind(take.origin.program).Bind(take.origin.options);
  StoredTake stored = take;
  stored.id = row.Step() ? row.Integer(0) : 0;
  row.Run();
  PutFeatures(database_, stored);
  PutLabels(database_, stored);
  PutChecksum(database_, stored);
  PutText(database_, stored);
}

void Catalogue::MoveFeatures(const StoredTake& take) {
  StoredTake stored = take;
  PutFeatures(database_, stored);
  PutChecksum(database_, stored);
}

void Catalogue::RemoveTake(std::int64_t id) {
  RemoveText(database_, id);
  SqliteStatement(database_, "DELETE FROM takes WHERE id = ?1").Bind(id).Run();
}

std::vector<std::int64_t> Catalogue::DropUnusedSegments() {
  std::vector<std::int64_t> dropped;
  const bool has_unused = database_.Number(
                              "SELECT EXISTS(SELECT 1 FROM segments WHERE id NOT IN "
                              "(SELECT segment FROM features))") != 0;
  if (!has_unused || HasDamagedRows()) return dropped;
  SqliteStatement rows(database_,
                       "DELETE FROM segments WHERE id NOT IN (SELECT segment FROM features) "
                       "RETURNING id");
  while (rows.Step()) dropped.push_back(rows.Integer(0));
  return dropped;
}

std::int64_t Catalogue::CountOrphans() const {
  std::int64_t orphans = 0;
  for (const char* table : TablesOfTakes(version_)) {
    orphans += database_.Number(fmt::format("SELECT count(*) {}", Orphans(table)).c_str());
  }
  return orphans;
}

void Catalogue::RemoveOrphans() {
  for (const char* table : TablesOfTakes(version_)) {
    database_.Execute(fmt::format("DELETE {}", Orphans(table)).c_str());
  }
}

bool Catalogue::HasDamagedRows() const {
  return CountOrphans() > 0 ||
         std::ranges::any_of(Takes(), [](const StoredTake& take) { return !take.is_intact; });
}

std::string Catalogue::Check() const {
  SqliteStatement check(database_, "PRAGMA integrity_check(1)");
  std::string found = check.Step() ? check.Text(0) : "nothing can be read";
  if (found != "ok") return found;
  if (version_ == 0) return {};
  std::set<std::uint64_t> sets;
  SqliteStatement rows(database_, "SELECT hash FROM feature_sets");
  while (rows.Step()) sets.insert(static_cast<std::uint64_t>(rows.Integer(0)));
  for (const StoredTake& take : Takes()) {
    const bool is_known = std::ranges::all_of(take.features, [&](const StoredFeatures& features) {
      return sets.contains(features.feature_set_hash);
    });
    if (take.is_intact && !is_known) return "it lacks a feature set of " + take.path.string();
  }
  return {};
}

bool Catalogue::HasText() const { return version_ < 2 || HasTextOf(database_, Takes()); }

bool Catalogue::HasSoundTextIndex() const {
  return version_ < 2 || internal::HasSoundTextIndex(database_);
}

void RemoveSegments(const fs::path& library, std::span<const std::int64_t> segments) {
  for (const std::int64_t segment : segments) {
    std::error_code ignored;
    fs::remove(SegmentPath(library, segment), ignored);
  }
}

std::vector<fs::path> FindLeftovers(const fs::path& library, const Catalogue& catalogue) {
  std::set<fs::path> known;
  for (const std::int64_t each : catalogue.NamedSegments())
    known.insert(SegmentPath(library, each));
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

void RemoveLeftovers(const fs::path& library, const Catalogue& catalogue) {
  for (const fs::path& leftover : FindLeftovers(library, catalogue)) {
    std::error_code ignored;  // Another attempt will be made.
    fs::remove(leftover, ignored);
  }
}

}  // namespace kinebase::internal
