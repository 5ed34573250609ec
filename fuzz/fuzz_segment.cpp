// Any bytes as a segment file, as they are and with checksums that fit, which chance would never
// find: what is read is the same after writing and reading it, what is not is one kinebase::Error.

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/library/segment_file.h"
#include "kinebase/search/run_lists.h"

namespace {

using kinebase::SegmentReader;

void Check(bool holds) {
  if (!holds) std::abort();
}

// Bytes at an address as the reader asks for.
class AlignedBytes {
 public:
  explicit AlignedBytes(std::string_view bytes)
      : words_(bytes.size() / sizeof(std::uint64_t) + 1), size_(bytes.size()) {
    std::ranges::copy(bytes, reinterpret_cast<char*>(words_.data()));
  }
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(words_.data()), size_};
  }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t size_;
};

// Lists of any bytes find stretches of the recording, by place, or are refused.
void TryLists(const std::string& bytes, int features, int columns) {
  try {
    const kinebase::RunLists lists(bytes, features, columns);
    for (const int misses : {0, 1}) {
      int end = 0;
      for (const auto& run : lists.Find({.tested = 1, .ones = 1, .misses = misses}, 0)) {
        Check(end <= run.first && run.first <= run.last && run.last < columns);
        end = run.last + 1;
      }
    }
  } catch (const kinebase::Error& error) {
    Check(error.code() == kinebase::ErrorCode::kMalformedFile);
  }
}

std::vector<kinebase::SegmentTake> ReadAll(const SegmentReader& segment) {
  std::vector<kinebase::SegmentTake> takes;
  for (int i = 0; i < segment.take_count(); ++i) {
    const auto columns = segment.Columns(i);
    Check(std::ssize(columns) == segment.ColumnCount(i));
    kinebase::SegmentTake& take = takes.emplace_back();
    take.content = segment.Content(i);
    take.features = {.rate_hz = segment.rate_hz(),
                     .feature_count = segment.feature_count(),
                     .columns = {columns.begin(), columns.end()}};
    if (segment.HasPoses(i)) take.poses = segment.Poses(i);
    TryLists(segment.RunListsOf(i), segment.feature_count(), segment.ColumnCount(i));
  }
  return takes;
}

void TryText(std::string_view text) {
  const AlignedBytes aligned(text);
  try {
    const SegmentReader segment(aligned.text(), "fuzz.segment");
    const auto takes = ReadAll(segment);
    const std::string written = kinebase::FormatSegment(takes, segment.feature_set_hash());
    const AlignedBytes again(written);
    const SegmentReader rewritten(again.text(), "again");
    Check(rewritten.feature_set_hash() == segment.feature_set_hash());
    Check(kinebase::FormatSegment(ReadAll(rewritten), segment.feature_set_hash()) == written);
  } catch (const kinebase::Error& error) {
    Check(error.code() == kinebase::ErrorCode::kMalformedFile ||
          error.code() == kinebase::ErrorCode::kMismatch);
    Check(std::string_view(error.what()).starts_with("fuzz.segment"));
  }
}

std::uint64_t Get(const std::string& bytes, std::size_t offset) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data() + offset, sizeof(number));
  return number;
}

void Put(std::string& bytes, std::size_t offset, std::uint64_t number) {
  std::memcpy(bytes.data() + offset, &number, sizeof(number));
}

// A checksum for a block that lies within the file; others are refused whatever theirs is.
void MendBlock(std::string& bytes, std::size_t row, std::size_t field, std::uint64_t size) {
  const std::uint64_t offset = Get(bytes, row + field);
  if (offset > bytes.size() || size > bytes.size() - offset) return;
  Put(bytes, row + field + 8, XXH3_64bits(bytes.data() + offset, size));
}

// The same for the lists, whose checksum is in front of them.
void MendLists(std::string& bytes, std::size_t row) {
  constexpr std::uint64_t kListHeader = 16;
  const std::uint64_t offset = Get(bytes, row + 56);
  if (offset > bytes.size() || kListHeader > bytes.size() - offset) return;
  const std::uint64_t size = Get(bytes, offset);
  if (size > bytes.size() - offset - kListHeader) return;
  Put(bytes, offset + 8, XXH3_64bits(bytes.data() + offset + kListHeader, size));
}

std::string Mended(std::string bytes) {
  constexpr std::size_t kHeader = 64;
  constexpr std::size_t kRow = 64;
  if (bytes.size() < kHeader) return bytes;
  Put(bytes, 16, bytes.size());
  const std::size_t takes =
      std::min<std::uint64_t>(Get(bytes, 24), (bytes.size() - kHeader) / kRow);
  for (std::size_t i = 0; i < takes; ++i) {
    const std::size_t row = kHeader + kRow * i;
    const std::uint64_t columns = std::min<std::uint64_t>(Get(bytes, row + 16), bytes.size());
    MendBlock(bytes, row, 24, 8 * columns);
    MendBlock(bytes, row, 40, 32 + 144 * columns);
    MendLists(bytes, row);
  }
  const std::string covered = bytes.substr(0, 56) + bytes.substr(kHeader, kRow * takes);
  Put(bytes, 56, XXH3_64bits(covered.data(), covered.size()));
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  TryText(text);
  TryText(Mended(std::string(text)));
  return 0;
}
