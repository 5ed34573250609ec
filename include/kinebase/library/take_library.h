// A library on disk: many takes in one folder, read once and searched ever after.
//
// library/take_import.h puts takes in, library/library_upkeep.h checks and removes them;
// docs/design/library.md says how a library is laid out and why a crash does it no harm.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "kinebase/library/segment_file.h"
#include "kinebase/library/takes.h"

namespace kinebase {

// Where the features of a take are, as one set has them at one rate.
struct StoredFeatures {
  std::uint64_t feature_set_hash = 0;
  double rate_hz = 0;
  std::int64_t segment = 0;  // Number of the segment file.
  int slot = 0;              // Take of the segment.
  bool has_poses = false;

  friend bool operator==(const StoredFeatures&, const StoredFeatures&) = default;
};

// A key word of a take, or of a stretch of it.
struct StoredLabel {
  std::string text;
  std::int64_t first_frame = 0;  // From 1, inclusive; 0: the take as a whole.
  std::int64_t last_frame = 0;

  friend auto operator<=>(const StoredLabel&, const StoredLabel&) = default;
};

// The file that a skeleton was read from, where it is not the motion's own.
struct StoredSkeleton {
  std::filesystem::path path;  // Empty: the format has none, or nobody noted it.
  ContentKey key = {};         // Of its bytes: takes of one skeleton have the same.

  friend bool operator==(const StoredSkeleton&, const StoredSkeleton&) = default;
};

// How a take came to be in the library. Unknown (0, empty) for libraries of version 1.
struct TakeOrigin {
  std::int64_t imported_s = 0;   // Seconds since 1970, UTC.
  std::int64_t file_time_s = 0;  // When the file was last changed, likewise.
  std::int64_t file_bytes = 0;
  std::string program;  // "kinebase 0.1.0".
  std::string options;  // Of reading, as the command line has them; empty: none were given.

  friend bool operator==(const TakeOrigin&, const TakeOrigin&) = default;
};

// 32 hexadecimal digits; "" for none.
[[nodiscard]] std::string KeyText(const ContentKey& key);

// What the catalogue knows of a take.
struct StoredTake {
  std::int64_t id = 0;
  std::filesystem::path path;  // Of the file that it was read from; absolute.
  ContentKey content = {};
  std::string format;  // "ASF/AMC".
  TakeName name;       // By the file's name, or a list of clips. Its rate is not kept.
  double rate_hz = 0;  // Of the file.
  std::int64_t frame_count = 0;
  std::string description;
  StoredSkeleton skeleton;
  TakeOrigin origin;
  std::vector<StoredLabel> labels;       // In their order.
  std::vector<StoredFeatures> features;  // At least one.
  // Whether all this is what was written, by its checksum. If not, nothing of it is to be relied
  // on; there are then 0 frames at 1 Hz, so that nobody counts with them.
  bool is_intact = true;
};

// Which takes are meant: those that each of these accepts. What is empty accepts all; of several
// names one will do.
struct TakeFilter {
  std::vector<std::string> actors;
  std::vector<std::string> classes;
  std::vector<std::string> labels;   // Of the take or a stretch of it.
  std::vector<std::string> formats;  // "ASF/AMC", or a part of it, in any case: "amc".
  // Words that all have to be in the names of file, class, actor and skeleton, in labels or the
  // description, in any case; the beginning of a word will do.
  std::string text;

  // But for the text, which TakeLibrary::Choose looks up.
  [[nodiscard]] bool Accepts(const StoredTake& take) const;

  friend bool operator==(const TakeFilter&, const TakeFilter&) = default;
};

// A set of features that takes of a library have.
struct StoredFeatureSet {
  std::uint64_t hash = 0;
  std::string name;
  double rate_hz = 0;
  std::int64_t takes = 0;

  friend bool operator==(const StoredFeatureSet&, const StoredFeatureSet&) = default;
};

// Whether a folder is a library, going by its catalogue.
[[nodiscard]] bool IsLibrary(const std::filesystem::path& folder);

// A library as it was when it was opened. What others add or remove meanwhile changes nothing of
// it: segment files do not change, and stay mapped when they are removed.
class TakeLibrary {
 public:
  // Errors  NotFound if the folder is no library; Mismatch for one of a newer version;
  //         MalformedFile if its catalogue is damaged; IoFailure.
  // Cost    O(takes).
  explicit TakeLibrary(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const std::vector<StoredTake>& takes() const { return takes_; }  // By path.
  [[nodiscard]] const std::vector<StoredFeatureSet>& feature_sets() const { return feature_sets_; }
  [[nodiscard]] std::int64_t segment_bytes() const { return segment_bytes_; }
  [[nodiscard]] std::vector<std::int64_t> segments() const;  // Their numbers.

  // The takes that the filter accepts, by path; may be none. Takes that are not intact are among
  // them whatever it asks for, as nobody knows whether it means them: using them fails.
  // Errors  NotFound for a name of the filter that no take has, naming those that there are, and
  //         for a text that is nowhere, where all takes are intact; with a text those of the
  //         constructor.
  [[nodiscard]] std::vector<const StoredTake*> Choose(const TakeFilter& filter) const;

  // The words of a take where they are in its segment file; valid as long as the library lives.
  // Errors  NotFound if the take has no such features; MalformedFile or NotFound if its segment is
  //         damaged or missing, or its row of the catalogue is damaged; IoFailure if it cannot be
  //         read, Mismatch if it is of a newer version: then it may be sound. Each names the
  //         segment and what to do.
  // Cost    O(columns), at the speed of memory: the checksum is compared.
  [[nodiscard]] std::span<const std::uint64_t> Columns(const StoredTake& take,
                                                       std::uint64_t feature_set_hash,
                                                       double rate_hz) const;

  // How many there are, from the segment's table.
  // Errors  As Columns, for a table that is damaged.
  [[nodiscard]] int ColumnCount(const StoredTake& take, std::uint64_t feature_set_hash,
                                double rate_hz) const;

  // Where the joints were, at the rate of the features; the error is that of PackPoses.
  // Errors  As Columns; NotFound for a take that was imported without poses.
  [[nodiscard]] JointTrajectories Poses(const StoredTake& take, std::uint64_t feature_set_hash,
                                        double rate_hz) const;

  // Where a take shows each feature: bytes for RunLists, as search/run_lists.h has them.
  // Errors  As Columns.
  // Cost    O(bytes of the lists), some 1 to 2 a column; that of making them where they are not
  //         stored.
  [[nodiscard]] std::string RunListsOf(const StoredTake& take, std::uint64_t feature_set_hash,
                                       double rate_hz) const;

  // Gives back the memory of what has been read of these takes' segments. It can still be read, and
  // comes from the disk again, or from the system's cache.
  void ReleaseMemory(std::span<const StoredTake* const> takes) const;

  // Reads all that there is of a take and compares checksums.
  // Errors  As Columns; MalformedFile if what the catalogue says of it is damaged.
  void Check(const StoredTake& take) const;

  // The takes that the filter leaves, by path.
  // Errors  Those of Choose; NotFound if no take is left; if none of them has these features, or
  //         poses where they are asked for, naming the way to get them.
  [[nodiscard]] std::vector<const StoredTake*> TakesWith(const FeatureSet& features, double rate_hz,
                                                         const TakeFilter& filter = {},
                                                         bool with_poses = false) const;

  // One of them, copied; poses are computed from stored ones: body sizes 1e-4.
  // Errors  As Columns and Poses.
  [[nodiscard]] TakeFeatures LoadTake(const StoredTake& take, const FeatureSet& features,
                                      double rate_hz, bool with_poses = false) const;

 private:
  // The entry of a take, and its segment.
  struct Location {
    const SegmentReader* segment = nullptr;
    int slot = 0;
  };
  [[nodiscard]] Location Find(const StoredTake& take, std::uint64_t feature_set_hash,
                              double rate_hz) const;
  std::filesystem::path folder_;
  std::vector<StoredTake> takes_;
  std::vector<StoredFeatureSet> feature_sets_;
  std::map<std::int64_t, std::variant<SegmentFile, Error>> segments_;
  std::int64_t segment_bytes_ = 0;
};

}  // namespace kinebase
