// The catalogue of a library: which takes there are and where their features are. Internal.
//
//   takes     id, path, content, format, actor, class, take, rate_hz, frames; from version 2 on
//             description, skeleton, skeleton_key, how it came here, checksum (row_checksum.h)
//   features  take, feature_set, rate_hz, segment, slot, poses: where in which segment file
//   segments  id, bytes: the segment files that count; others are leftovers
//   feature_sets  hash, name
//   labels    take, label, first_frame, last_frame: from 1; 0 and 0 for the whole take
//   take_text the words by which takes are found (catalogue_text.h)
//   templates, annotations: library/library_templates.h, library/library_annotations.h
//
// Names of files are stored byte by byte. Hashes are SQLite's signed numbers of 64 bits; the key of
// a content is 32 hexadecimal digits. PRAGMA user_version is the version; application_id is "KINE".
// catalogue_schema.h has the tables of each version. Who writes brings a catalogue of version 1 to
// version 2 first, in one transaction; who reads leaves it as it is. A rollback journal (and no
// write-ahead log), for a library is then one file at rest, works on any file system, and a reader
// keeps a segment from being removed by its short transaction.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinebase/library/take_library.h"
#include "library/sqlite_database.h"

namespace kinebase::internal {

// For a folder whose catalogue is missing or empty: what a library holds is written after its
// catalogue, so segments there are all that is left of one, or somebody else's.
// Errors  MalformedFile if there are any, saying what to do.
void CheckHasNoLostSegments(const std::filesystem::path& library);

// Errors  NotFound if the folder has none; those of CheckHasNoLostSegments.
void CheckIsLibrary(const std::filesystem::path& library);

class Catalogue {
 public:
  // kCreate makes what is missing, also of an older version, and is for whoever holds the lock.
  // Errors  Of all members: those of SqliteDatabase. Here also Mismatch for a newer version, and
  //         for a database of another program; those of CheckHasNoLostSegments.
  Catalogue(const std::filesystem::path& library, SqliteDatabase::Access access);

  [[nodiscard]] const SqliteDatabase& database() const { return database_; }
  [[nodiscard]] std::int64_t version() const { return version_; }  // 0: no tables yet.

  // Inside of one transaction, where several answers are to fit together.
  // Errors  Also MalformedFile where numbers run out, and in version 1, which has no checksums,
  //         for a take without frames or a rate.
  [[nodiscard]] std::vector<StoredTake> Takes() const;  // By path.
  [[nodiscard]] std::vector<StoredFeatureSet> FeatureSets() const;
  [[nodiscard]] std::vector<std::int64_t> Segments() const;
  [[nodiscard]] std::vector<std::int64_t> NamedSegments() const;  // Also those of features alone.
  [[nodiscard]] std::int64_t SegmentBytes() const;
  [[nodiscard]] std::int64_t NextSegment() const;
  // Ids of takes, ascending, as internal::FindText. Where words are missing, as all are in version
  // 1, they are made for this connection.
  [[nodiscard]] std::vector<std::int64_t> FindText(std::string_view query) const;

  // Inside of a transaction that writes.
  void AddFeatureSet(const FeatureSet& features);
  void AddSegment(std::int64_t segment, std::int64_t bytes);
  // Adds it, or replaces the one of its path, with labels, words and checksum; its annotations
  // stay.
  void PutTake(const StoredTake& take);
  void MoveFeatures(const StoredTake& take);  // Only where the features of one that is there are.
  void RemoveTake(std::int64_t id);
  // Their numbers. None while there are damaged rows: what they say of segments is not known.
  [[nodiscard]] std::vector<std::int64_t> DropUnusedSegments();

  // Rows of features, labels and annotations whose take is not there.
  [[nodiscard]] std::int64_t CountOrphans() const;
  void RemoveOrphans();
  [[nodiscard]] bool HasDamagedRows() const;  // Orphans, or takes that are not intact.

  // What is wrong with the file as a whole; empty: nothing. Cost  O(bytes of the file).
  [[nodiscard]] std::string Check() const;
  // As HasTextOf and HasSoundTextIndex; true where there is no table of words yet.
  [[nodiscard]] bool HasText() const;
  [[nodiscard]] bool HasSoundTextIndex() const;

 private:
  void Upgrade();
  void MakeMissingText();
  [[nodiscard]] std::vector<StoredTake> TakeRows() const;  // Without labels and features.

  SqliteDatabase database_;
  std::int64_t version_ = 0;  // 0: empty, as a crash right after its making leaves it.
};

// Files of segments that a transaction dropped; what cannot be removed is a leftover.
void RemoveSegments(const std::filesystem::path& library, std::span<const std::int64_t> segments);

// Segment files that the catalogue does not name, and unfinished ones.
[[nodiscard]] std::vector<std::filesystem::path> FindLeftovers(const std::filesystem::path& library,
                                                               const Catalogue& catalogue);
// Those that can be removed. Under the lock.
void RemoveLeftovers(const std::filesystem::path& library, const Catalogue& catalogue);

}  // namespace kinebase::internal
