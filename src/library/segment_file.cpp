#include "kinebase/library/segment_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/features/feature_set.h"
#include "kinebase/motion/standard_skeleton.h"
#include "kinebase/search/run_lists.h"
#include "library/checksum.h"

static_assert(std::endian::native == std::endian::little, "segment files are read in place");

namespace kinebase {
namespace {

using internal::Checksum;

constexpr std::string_view kMagic = "\x89KBSEG\r\n";
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kFirstWithLists = 2;
constexpr std::uint64_t kAlignment = 64;
constexpr std::uint64_t kHeaderBytes = 64;
constexpr std::uint64_t kRowBytes = 64;
constexpr std::uint64_t kChecksumOffset = 56;
constexpr std::uint64_t kListHeaderBytes = 16;
constexpr std::uint64_t kPoseHeaderBytes = 32;
constexpr std::uint64_t kPoseBytes = kPackedPoseBytes;

std::uint64_t Aligned(std::uint64_t offset) {
  return (offset + kAlignment - 1) / kAlignment * kAlignment;
}

std::uint64_t PoseBlockBytes(std::uint64_t columns) {
  return kPoseHeaderBytes + kPoseBytes * columns;
}

template <typename Number>
void Put(std::string& bytes, std::uint64_t offset, Number number) {
  std::memcpy(bytes.data() + offset, &number, sizeof(number));
}

template <typename Number>
Number Get(std::string_view bytes, std::uint64_t offset) {
  Number number{};
  std::memcpy(&number, bytes.data() + offset, sizeof(number));
  return number;
}

std::string_view AsBytes(const FeatureMatrix& features) {
  return {reinterpret_cast<const char*>(features.columns.data()),
          features.columns.size() * sizeof(std::uint64_t)};
}

std::string FormatPoses(const PackedPoses& poses) {
  std::string bytes(kPoseHeaderBytes, '\0');
  for (std::size_t axis = 0; axis < poses.offset_cm.size(); ++axis) {
    Put(bytes, axis * sizeof(double), poses.offset_cm[axis]);
  }
  Put(bytes, poses.offset_cm.size() * sizeof(double), poses.step_cm);
  return bytes.append(reinterpret_cast<const char*>(poses.values.data()),
                      poses.values.size() * sizeof(std::uint16_t));
}

std::string FormatLists(const FeatureMatrix& features) {
  const std::string lists = FormatRunLists(features);
  std::string bytes(kListHeaderBytes, '\0');
  Put(bytes, 0, std::uint64_t{lists.size()});
  Put(bytes, sizeof(std::uint64_t), Checksum(lists));
  return bytes.append(lists);
}

void CheckTakes(std::span<const SegmentTake> takes) {
  for (const SegmentTake& take : takes) {
    const FeatureMatrix& features = take.features;
    if (features.rate_hz != takes.front().features.rate_hz ||
        features.feature_count != takes.front().features.feature_count) {
      throw Error(ErrorCode::kInvalidArgument,
                  "takes of one segment need the same features at the same rate");
    }
    if (take.poses && take.poses->values.size() !=
                          features.columns.size() * std::size_t{3} * kStandardJointCount) {
      throw Error(ErrorCode::kInvalidArgument, "a take needs as many poses as columns");
    }
  }
}

// Adds a block at the next aligned place and says where that is.
std::uint64_t Append(std::string& bytes, std::string_view block) {
  bytes.resize(Aligned(bytes.size()), '\0');
  const std::uint64_t offset = bytes.size();
  bytes.append(block);
  return offset;
}

}  // namespace

std::string FormatSegment(std::span<const SegmentTake> takes, std::uint64_t feature_set_hash) {
  if (takes.empty()) throw Error(ErrorCode::kInvalidArgument, "a segment needs a take");
  CheckTakes(takes);
  const std::uint64_t table_end = kHeaderBytes + kRowBytes * takes.size();
  std::string bytes(table_end, '\0');
  for (std::size_t i = 0; i < takes.size(); ++i) {
    const SegmentTake& take = takes[i];
    const std::uint64_t row = kHeaderBytes + kRowBytes * i;
    Put(bytes, row, take.content);
    Put(bytes, row + 16, std::uint64_t{take.features.columns.size()});
    const std::string_view words = AsBytes(take.features);
    Put(bytes, row + 24, Append(bytes, words));
    Put(bytes, row + 32, Checksum(words));
    Put(bytes, row + 56, Append(bytes, FormatLists(take.features)));
    if (!take.poses) continue;
    const std::string poses = FormatPoses(*take.poses);
    Put(bytes, row + 40, Append(bytes, poses));
    Put(bytes, row + 48, Checksum(poses));
  }
  std::ranges::copy(kMagic, bytes.begin());
  Put(bytes, 8, kVersion);
  Put(bytes, 12, static_cast<std::uint32_t>(takes.front().features.feature_count));
  Put(bytes, 16, std::uint64_t{bytes.size()});
  Put(bytes, 24, std::uint64_t{takes.size()});
  Put(bytes, 32, feature_set_hash);
  Put(bytes, 40, takes.front().features.rate_hz);
  const std::string_view written = bytes;
  Put(bytes, kChecksumOffset,
      Checksum(std::string(written.substr(0, kChecksumOffset))
                   .append(written.substr(kHeaderBytes, table_end - kHeaderBytes))));
  return bytes;
}

SegmentReader::SegmentReader(std::string_view bytes, std::filesystem::path file)
    : bytes_(bytes), file_(std::move(file)) {
  ReadHeader();
}

void SegmentReader::ReadHeader() {
  const auto refuse = [&](std::string message, std::int64_t byte) {
    throw Error(ErrorCode::kMalformedFile, std::move(message), {.file = file_, .byte = byte});
  };
  if (!bytes_.starts_with(kMagic)) refuse("is no segment file of Kinebase", 0);
  if (bytes_.size() < kHeaderBytes) refuse("is cut off in its header", std::ssize(bytes_));
  version_ = Get<std::uint32_t>(bytes_, 8);
  if (version_ > kVersion) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("is a segment of version {}; this Kinebase reads up to {}: use a newer "
                            "one",
                            version_, kVersion),
                {.file = file_, .byte = 8});
  }
  const auto size = Get<std::uint64_t>(bytes_, 16);
  if (size != bytes_.size()) {
    refuse(fmt::format("has {} bytes, but its header says {}", bytes_.size(), size), 16);
  }
  const auto takes = Get<std::uint64_t>(bytes_, 24);
  if (takes == 0 || takes > (bytes_.size() - kHeaderBytes) / kRowBytes) {
    refuse(fmt::format("cannot hold {} takes", takes), 24);
  }
  const std::string_view table = bytes_.substr(kHeaderBytes, kRowBytes * takes);
  if (Checksum(std::string(bytes_.substr(0, kChecksumOffset)).append(table)) !=
      Get<std::uint64_t>(bytes_, kChecksumOffset)) {
    refuse("is damaged: the checksum of its header is another", kChecksumOffset);
  }
  feature_count_ =
      static_cast<int>(std::min<std::uint32_t>(Get<std::uint32_t>(bytes_, 12), kMaxFeatures + 1));
  feature_set_hash_ = Get<std::uint64_t>(bytes_, 32);
  rate_hz_ = Get<double>(bytes_, 40);
  if (feature_count_ < 1 || feature_count_ > kMaxFeatures) refuse("has no such features", 12);
  if (!std::isfinite(rate_hz_) || rate_hz_ <= 0) refuse("has no such rate", 40);
  ReadTable(takes);
}

void SegmentReader::ReadTable(std::uint64_t take_count) {
  const std::uint64_t size = bytes_.size();
  const auto fits = [&](std::uint64_t offset, std::uint64_t bytes) {
    return offset % kAlignment == 0 && offset <= size && bytes <= size - offset;
  };
  rows_.reserve(take_count);
  for (std::uint64_t i = 0; i < take_count; ++i) {
    const std::uint64_t offset = kHeaderBytes + kRowBytes * i;
    const TakeRow row{
        .content = Get<ContentKey>(bytes_, offset),
        .columns = Get<std::uint64_t>(bytes_, offset + 16),
        .words = Get<std::uint64_t>(bytes_, offset + 24),
        .words_checksum = Get<std::uint64_t>(bytes_, offset + 32),
        .poses = Get<std::uint64_t>(bytes_, offset + 40),
        .poses_checksum = Get<std::uint64_t>(bytes_, offset + 48),
        .lists = version_ < kFirstWithLists ? 0 : Get<std::uint64_t>(bytes_, offset + 56)};
    const bool is_possible = row.columns <= std::numeric_limits<std::int32_t>::max() &&
                             fits(row.words, row.columns * sizeof(std::uint64_t)) &&
                             (row.poses == 0 || fits(row.poses, PoseBlockBytes(row.columns))) &&
                             (row.lists == 0 || fits(row.lists, kListHeaderBytes));
    if (!is_possible) {
      throw Error(ErrorCode::kMalformedFile,
                  fmt::format("take {} of its table lies outside of the file", i + 1),
                  {.file = file_, .byte = static_cast<std::int64_t>(offset)});
    }
    rows_.push_back(row);
  }
}

std::string_view SegmentReader::Block(std::uint64_t offset, std::uint64_t size,
                                      std::uint64_t checksum) const {
  const std::string_view block = bytes_.substr(offset, size);
  if (Checksum(block) != checksum) {
    throw Error(ErrorCode::kMalformedFile,
                fmt::format("is damaged: the checksum of {} bytes from here is another", size),
                {.file = file_, .byte = static_cast<std::int64_t>(offset)});
  }
  return block;
}

std::span<const std::uint64_t> SegmentReader::Columns(int take) const {
  const TakeRow& row = Row(take);
  const std::string_view block =
      Block(row.words, row.columns * sizeof(std::uint64_t), row.words_checksum);
  return {reinterpret_cast<const std::uint64_t*>(block.data()), row.columns};
}

PackedPoses SegmentReader::Poses(int take) const {
  const TakeRow& row = Row(take);
  if (row.poses == 0) {
    throw Error(ErrorCode::kNotFound, "holds this take without poses", {.file = file_});
  }
  const std::string_view block = Block(row.poses, PoseBlockBytes(row.columns), row.poses_checksum);
  PackedPoses poses{.offset_cm = Get<std::array<double, 3>>(block, 0),
                    .step_cm = Get<double>(block, 3 * sizeof(double))};
  if (row.columns == 0) return poses;
  poses.values.resize(row.columns * 3 * kStandardJointCount);
  std::memcpy(poses.values.data(), block.data() + kPoseHeaderBytes, kPoseBytes * row.columns);
  return poses;
}

std::string SegmentReader::RunListsOf(int take) const {
  const TakeRow& row = Row(take);
  if (row.lists == 0) return FormatRunLists({rate_hz_, feature_count_, Columns(take)});
  const std::uint64_t first = row.lists + kListHeaderBytes;
  const auto size = Get<std::uint64_t>(bytes_, row.lists);
  if (size > bytes_.size() - first) {
    throw Error(ErrorCode::kMalformedFile, fmt::format("cannot hold {} bytes of lists here", size),
                {.file = file_, .byte = static_cast<std::int64_t>(row.lists)});
  }
  const auto checksum = Get<std::uint64_t>(bytes_, row.lists + sizeof(std::uint64_t));
  return std::string(Block(first, size, checksum));
}

void SegmentReader::CheckRunLists(int take) const {
  if (RunListsOf(take) == FormatRunLists({rate_hz_, feature_count_, Columns(take)})) return;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("has lists of take {} that are not those of its words", take + 1),
              {.file = file_, .byte = static_cast<std::int64_t>(Row(take).lists)});
}

}  // namespace kinebase
