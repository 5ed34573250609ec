#include "kinebase/library/library_compaction.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/folder_flush.h"
#include "kinebase/core/output_file.h"
#include "kinebase/core/parallel.h"
#include "kinebase/library/segment_file.h"
#include "kinebase/library/take_library.h"
#include "library/catalogue.h"
#include "library/catalogue_schema.h"
#include "library/catalogue_text.h"
#include "library/damage.h"
#include "library/library_layout.h"
#include "library/library_lock.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::Catalogue;
using internal::FileBytes;
using internal::SqliteDatabase;
using internal::SqliteTransaction;

// Where the features of a take are: segment and slot.
using Location = std::pair<std::int64_t, int>;

std::int64_t LibraryBytes(const fs::path& library) {
  std::int64_t bytes = FileBytes(internal::CatalogueFile(library));
  std::error_code unreachable;
  for (const auto& entry : fs::directory_iterator(internal::SegmentFolder(library), unreachable)) {
    bytes += FileBytes(entry.path());
  }
  return bytes;
}

// A segment file with what of it is in use.
struct OldSegment {
  std::int64_t number = 0;
  std::vector<int> slots;  // In use, ascending.
  bool has_dead = false;
  bool is_small = false;
};

// Segments whose takes may stand in one file.
using GroupKey = std::tuple<std::uint64_t, double, int>;  // Feature set, rate, features a word.

// A new segment file to be written.
struct NewSegment {
  std::uint64_t feature_set_hash = 0;
  std::vector<Location> from;
  std::int64_t bytes = 0;
};

SegmentTake ReadSlot(const SegmentReader& segment, int slot) {
  const auto columns = segment.Columns(slot);
  SegmentTake take{.content = segment.Content(slot),
                   .features = {.rate_hz = segment.rate_hz(),
                                .feature_count = segment.feature_count(),
                                .columns = {columns.begin(), columns.end()}}};
  if (segment.HasPoses(slot)) take.poses = segment.Poses(slot);
  return take;
}

// About what a take adds to a segment file.
std::int64_t SlotBytes(const SegmentReader& segment, int slot) {
  constexpr std::int64_t kRowAndGaps = 128;
  constexpr std::int64_t kWord = 8;
  const std::int64_t column = segment.HasPoses(slot) ? kWord + kPackedPoseBytes : kWord;
  return kRowAndGaps + column * segment.ColumnCount(slot);
}

class Compactor {
 public:
  Compactor(const fs::path& library, const CompactOptions& options)
      : library_(library),
        options_(options),
        catalogue_(library, SqliteDatabase::Access::kCreate),
        takes_(catalogue_.Takes()) {
    for (std::size_t i = 0; i < takes_.size(); ++i) {
      for (const StoredFeatures& features : takes_[i].features) {
        users_[{features.segment, features.slot}].push_back(i);
      }
    }
  }

  CompactReport Compact() {
    report_.bytes_before = LibraryBytes(library_);
    report_.segments_before = std::ssize(catalogue_.Segments());
    internal::RemoveLeftovers(library_, catalogue_);
    NameDamagedRows();
    // What damaged rows say is not known: what seems to be free may be theirs.
    const std::vector<NewSegment> plan =
        report_.failures.empty() ? Plan() : std::vector<NewSegment>();
    for (std::size_t i = 0; i < plan.size(); ++i) {
      Report(i, plan.size());
      Write(plan[i]);
    }
    Report(plan.size(), plan.size());
    TidyCatalogue();
    report_.segments_after = std::ssize(catalogue_.Segments());
    report_.bytes_after = LibraryBytes(library_);
    return std::move(report_);
  }

 private:
  void Report(std::size_t done, std::size_t total) const {
    if (!options_.progress || options_.progress("compacting", done, total)) return;
    throw Error(ErrorCode::kCancelled, "cancelled");
  }

  void NameDamagedRows() {
    for (const StoredTake& take : takes_) {
      try {
        internal::CheckTakeRow(take, library_);
      } catch (const Error& error) {
        report_.failures.push_back({take.path, error});
      }
    }
    const std::int64_t orphans = catalogue_.CountOrphans();
    if (orphans == 0) return;
    const fs::path& file = catalogue_.database().file();
    report_.failures.push_back(
        {file,
         {ErrorCode::kMalformedFile,
          fmt::format("has {} rows that belong to no take; {}", orphans, internal::kDamageRemedy),
          {.file = file}}});
  }

  [[nodiscard]] fs::path PathOf(std::int64_t segment) const {
    return internal::SegmentPath(library_, segment);
  }

  // Errors  MalformedFile if the segment has not what the catalogue says of a take.
  void CheckHolds(const SegmentReader& segment, const Location& place, std::size_t take) const {
    const auto& features = takes_[take].features;
    const bool holds = std::ranges::any_of(features, [&](const StoredFeatures& each) {
      return Location(each.segment, each.slot) == place &&
             internal::HoldsFeatures(segment, each, takes_[take].content);
    });
    if (holds) return;
    throw Error(ErrorCode::kMalformedFile,
                "does not hold " + takes_[take].path.string() + " as the catalogue says",
                {.file = PathOf(place.first)});
  }

  // The slots in use of a segment, by its table.
  // Errors  For the first that is not there: then the file is left as it is.
  [[nodiscard]] std::vector<int> UsedSlots(std::int64_t number,
                                           const SegmentReader& segment) const {
    std::vector<int> slots;
    for (auto user = users_.lower_bound({number, std::numeric_limits<int>::min()});
         user != users_.end() && user->first.first == number; ++user) {
      for (const std::size_t i : user->second) CheckHolds(segment, user->first, i);
      slots.push_back(user->first.second);
    }
    return slots;
  }

  // Errors  For the first take whose bytes cannot be read.
  void CheckReadable(const OldSegment& old) const {
    const SegmentFile file(PathOf(old.number));
    for (const int slot : old.slots) {
      (void)file.reader().Columns(slot);
      if (file.reader().HasPoses(slot)) (void)file.reader().Poses(slot);
    }
  }

  // Without segments of which something cannot be read: these are left as they are.
  void LeaveUnreadable(std::vector<OldSegment>& group) {
    std::vector<std::optional<Error>> errors(group.size());
    ParallelFor(group.size(), options_.threads, "checking", options_.progress, [&](std::size_t i) {
      try {
        CheckReadable(group[i]);
      } catch (const Error& error) {
        errors[i] = error;
      }
    });
    std::vector<OldSegment> readable;
    readable.reserve(group.size());
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (errors[i]) {
        report_.failures.push_back({PathOf(group[i].number), internal::WithRemedy(*errors[i])});
      } else {
        readable.push_back(std::move(group[i]));
      }
    }
    group = std::move(readable);
  }

  // Segments that may be written anew, by what may stand together. Only their tables are read.
  std::map<GroupKey, std::vector<OldSegment>> Candidates() {
    std::map<GroupKey, std::vector<OldSegment>> groups;
    for (const std::int64_t number : catalogue_.Segments()) {
      try {
        const SegmentFile file(PathOf(number));
        const SegmentReader& segment = file.reader();
        OldSegment old{.number = number, .slots = UsedSlots(number, segment)};
        old.has_dead = std::ssize(old.slots) < segment.take_count();
        old.is_small = FileBytes(PathOf(number)) < options_.segment_bytes / 2;
        if (!old.has_dead && !old.is_small) continue;
        groups[{segment.feature_set_hash(), segment.rate_hz(), segment.feature_count()}].push_back(
            std::move(old));
      } catch (const Error& error) {
        report_.failures.push_back({PathOf(number), internal::WithRemedy(error)});
      }
    }
    return groups;
  }

  std::vector<NewSegment> Plan() {
    std::vector<NewSegment> plan;
    for (auto& [key, group] : Candidates()) {
      if (!IsWorthwhile(std::get<0>(key), group)) continue;
      LeaveUnreadable(group);
      if (!IsWorthwhile(std::get<0>(key), group)) continue;
      std::ranges::move(Pack(std::get<0>(key), group), std::back_inserter(plan));
    }
    return plan;
  }

  // Whether a group gets any smaller by being written anew.
  [[nodiscard]] bool IsWorthwhile(std::uint64_t feature_set_hash,
                                  std::span<const OldSegment> group) const {
    return std::ranges::any_of(group, &OldSegment::has_dead) ||
           Pack(feature_set_hash, group).size() < group.size();
  }

  [[nodiscard]] std::vector<NewSegment> Pack(std::uint64_t feature_set_hash,
                                             std::span<const OldSegment> group) const {
    std::vector<NewSegment> packed;
    for (const OldSegment& old : group) {
      const SegmentFile file(PathOf(old.number));
      for (const int slot : old.slots) {
        const std::int64_t bytes = SlotBytes(file.reader(), slot);
        if (packed.empty() || packed.back().bytes + bytes > options_.segment_bytes) {
          packed.push_back({.feature_set_hash = feature_set_hash});
        }
        packed.back().from.emplace_back(old.number, slot);
        packed.back().bytes += bytes;
      }
    }
    return packed;
  }

  // As an import: first the file, down to the disk; then, in one transaction, that its takes are in
  // it; then the files that no take needs any more go.
  void Write(const NewSegment& segment) {
    const std::int64_t number = catalogue_.NextSegment();
    const std::string bytes = FormatSegment(ReadTakes(segment.from), segment.feature_set_hash);
    WriteFile(PathOf(number), bytes, Overwrite::kNo);
    FlushFolder(internal::SegmentFolder(library_));
    SqliteTransaction transaction(catalogue_.database(), SqliteTransaction::Kind::kWrite);
    catalogue_.AddSegment(number, std::ssize(bytes));
    for (const std::size_t i : Move(segment.from, number)) catalogue_.MoveFeatures(takes_[i]);
    const std::vector<std::int64_t> dropped = catalogue_.DropUnusedSegments();
    transaction.Commit();
    internal::RemoveSegments(library_, dropped);
  }

  [[nodiscard]] std::vector<SegmentTake> ReadTakes(std::span<const Location> from) const {
    std::vector<SegmentTake> takes;
    takes.reserve(from.size());
    std::optional<SegmentFile> file;
    std::int64_t open = 0;
    for (const auto& [number, slot] : from) {
      if (!file || open != number) file.emplace(PathOf(number));
      open = number;
      takes.push_back(ReadSlot(file->reader(), slot));
    }
    return takes;
  }

  // Tells the takes that their features come to stand in segment `number`, in the order of `from`.
  std::set<std::size_t> Move(std::span<const Location> from, std::int64_t number) {
    std::set<std::size_t> moved;
    for (std::size_t slot = 0; slot < from.size(); ++slot) {
      for (const std::size_t i : users_.at(from[slot])) {
        for (StoredFeatures& features : takes_[i].features) {
          if (Location(features.segment, features.slot) != from[slot]) continue;
          features.segment = number;
          features.slot = static_cast<int>(slot);
        }
        moved.insert(i);
      }
    }
    return moved;
  }

  void TidyCatalogue() {
    SqliteTransaction transaction(catalogue_.database(), SqliteTransaction::Kind::kWrite);
    if (!catalogue_.HasText() || !catalogue_.HasSoundTextIndex()) {
      catalogue_.database().Execute("DROP TABLE IF EXISTS take_text");
      internal::MakeTextTable(catalogue_.database(), "main");
      internal::FillText(catalogue_.database(), takes_);
    }
    // What changes have left of the index becomes one piece; a command in the form of a row.
    catalogue_.database().Execute("INSERT INTO take_text(take_text) VALUES('optimize')");
    const std::vector<std::int64_t> dropped = catalogue_.DropUnusedSegments();
    transaction.Commit();
    internal::RemoveSegments(library_, dropped);
    if (catalogue_.database().Number("PRAGMA freelist_count") > 0) {
      catalogue_.database().Execute("VACUUM");
    }
  }

  fs::path library_;
  const CompactOptions& options_;
  Catalogue catalogue_;
  std::vector<StoredTake> takes_;
  std::map<Location, std::vector<std::size_t>> users_;  // Which takes have their features where.
  CompactReport report_;
};

}  // namespace

CompactReport CompactLibrary(const fs::path& library, const CompactOptions& options) {
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  return Compactor(library, options).Compact();
}

}  // namespace kinebase
