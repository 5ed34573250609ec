// A segment file holds feature words, and if wanted poses, of some takes. It is written once and
// never changed; library/take_library.h says which takes are in which.
//
// All numbers are little-endian, all blocks begin at multiples of 64 bytes with zeros between them,
// so that the words of a mapped file are read where they are. Checksums are XXH3, 64 bits.
//
//   offset  bytes
//        0      8  "\x89KBSEG\r\n": a transfer as text destroys it
//        8      4  version, 2; version 1 had no lists
//       12      4  features a word, 1 … 64
//       16      8  length of the file
//       24      8  takes
//       32      8  hash of the feature set
//       40      8  columns a second, a double
//       48      8  0
//       56      8  checksum of bytes 0 … 55 and of the table
//       64 64·takes  the table, a row a take:
//                     0  16  key of the contents that the take was read from
//                    16   8  columns
//                    24   8  offset of the words
//                    32   8  checksum of the words
//                    40   8  offset of the poses, 0 = none
//                    48   8  checksum of the poses
//                    56   8  offset of the lists, 0 = none (version 1)
//   then for each take
//      8·columns    the words: bit i = feature i (features/feature_matrix.h)
//      32 + 144·columns  the poses, if any: offset x, y, z and step, doubles in cm; then a 16-bit
//                   number for x, y, z of the 24 standard joints, column by column
//                   (library/packed_poses.h)
//      16 + n       the lists: n, the checksum of what follows, and n bytes of run-length inverted
//                   lists of the features (search/run_lists.h), some 1 to 2 bytes a column
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/mapped_file.h"
#include "kinebase/features/feature_matrix.h"
#include "kinebase/library/packed_poses.h"

namespace kinebase {

// Stands for the bytes that a take was read from, its skeleton's and the way of reading them: its
// format, the options and the rate that its name tells. XXH3, 128 bits.
using ContentKey = std::array<std::uint64_t, 2>;

struct SegmentTake {
  ContentKey content = {};
  FeatureMatrix features;
  std::optional<PackedPoses> poses;  // As many frames as the features have columns.
};

// The bytes of a segment file.
//
// takes   At least one; all with the same feature count and rate.
// Errors  InvalidArgument if they differ.
// Cost    O(bytes); the result is 8 bytes a column and the lists, 144 more with poses, and up to
//         256 a take.
[[nodiscard]] std::string FormatSegment(std::span<const SegmentTake> takes,
                                        std::uint64_t feature_set_hash);

// The bytes of a segment file, understood. Errors of all members: MalformedFile, naming the file
// and the byte.
class SegmentReader {
 public:
  // Checks header and table; the blocks are checked when they are asked for.
  //
  // bytes   Valid as long as the object lives, beginning at a multiple of 8.
  // file    For messages.
  // Errors  Also Mismatch for a newer version.
  SegmentReader(std::string_view bytes, std::filesystem::path file);

  [[nodiscard]] int take_count() const { return static_cast<int>(rows_.size()); }
  [[nodiscard]] std::uint64_t feature_set_hash() const { return feature_set_hash_; }
  [[nodiscard]] double rate_hz() const { return rate_hz_; }
  [[nodiscard]] int feature_count() const { return feature_count_; }
  [[nodiscard]] ContentKey Content(int take) const { return Row(take).content; }
  [[nodiscard]] bool HasPoses(int take) const { return Row(take).poses != 0; }
  [[nodiscard]] int ColumnCount(int take) const { return static_cast<int>(Row(take).columns); }

  // The words of a take where they are in the file, checked against their checksum.
  // Cost  O(columns), at the speed of memory.
  [[nodiscard]] std::span<const std::uint64_t> Columns(int take) const;

  // Errors  Also NotFound for a take that was stored without poses.
  [[nodiscard]] PackedPoses Poses(int take) const;

  // Where a take shows each feature: bytes for RunLists. Those of a version 1 segment are made of
  // the words.
  // They are what was written; CheckRunLists compares them with the words.
  // Cost  O(bytes of the lists), or of Columns and FormatRunLists.
  [[nodiscard]] std::string RunListsOf(int take) const;
  void CheckRunLists(int take) const;

 private:
  struct TakeRow {
    ContentKey content = {};
    std::uint64_t columns = 0;
    std::uint64_t words = 0;  // Offsets and checksums, as in the file.
    std::uint64_t words_checksum = 0;
    std::uint64_t poses = 0;
    std::uint64_t poses_checksum = 0;
    std::uint64_t lists = 0;
  };

  void ReadHeader();
  void ReadTable(std::uint64_t take_count);
  [[nodiscard]] const TakeRow& Row(int take) const { return rows_[static_cast<std::size_t>(take)]; }
  // A block after its checksum was compared.
  [[nodiscard]] std::string_view Block(std::uint64_t offset, std::uint64_t size,
                                       std::uint64_t checksum) const;

  std::string_view bytes_;
  std::filesystem::path file_;
  std::uint32_t version_ = 0;
  std::uint64_t feature_set_hash_ = 0;
  double rate_hz_ = 0;
  int feature_count_ = 0;
  std::vector<TakeRow> rows_;
};

// A segment file, mapped. Movable.
class SegmentFile {
 public:
  // Errors  Those of MappedFile and SegmentReader.
  explicit SegmentFile(const std::filesystem::path& file)
      : mapping_(file), reader_(mapping_.text(), file) {
    ReleaseMemory();  // A library opens all of its segments.
  }

  [[nodiscard]] const SegmentReader& reader() const { return reader_; }

  // Gives back the memory of what has been read; it is read again when somebody asks.
  void ReleaseMemory() const { mapping_.Release(mapping_.text()); }

 private:
  MappedFile mapping_;
  SegmentReader reader_;
};

}  // namespace kinebase
