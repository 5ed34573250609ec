#include "kinebase/library/segment_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/motion/standard_skeleton.h"
#include "kinebase/search/run_lists.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;

// Bytes at an address as the reader asks for.
class AlignedBytes {
 public:
  explicit AlignedBytes(const std::string& bytes)
      : words_(bytes.size() / 8 + 1), size_(bytes.size()) {
    std::memcpy(words_.data(), bytes.data(), bytes.size());
  }
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(words_.data()), size_};
  }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t size_;
};

SegmentTake MakeTake(std::uint64_t seed, int columns, bool with_poses) {
  std::mt19937_64 random(seed);
  SegmentTake take{.content = {seed, ~seed}, .features = {.rate_hz = 30, .feature_count = 39}};
  for (int i = 0; i < columns; ++i) take.features.columns.push_back(random() >> 25U);
  if (!with_poses) return take;
  PackedPoses& poses = take.poses.emplace();
  poses.offset_cm = {-1.5, 0, 200};
  poses.step_cm = 0.25;
  for (int i = 0; i < columns * 72; ++i) {
    poses.values.push_back(static_cast<std::uint16_t>(random()));
  }
  return take;
}

std::vector<SegmentTake> ThreeTakes() {
  return {MakeTake(1, 17, false), MakeTake(2, 5, true), MakeTake(3, 0, true)};
}

constexpr std::uint64_t kSet = 0x0123456789ABCDEF;

TEST(SegmentFile, GivesBackWhatWasStored) {
  const std::vector<SegmentTake> takes = ThreeTakes();
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "a.segment", FormatSegment(takes, kSet));
  const SegmentFile file(folder.path() / "a.segment");
  const SegmentReader& segment = file.reader();
  ASSERT_EQ(segment.take_count(), 3);
  EXPECT_EQ(segment.feature_set_hash(), kSet);
  EXPECT_EQ(segment.rate_hz(), 30);
  EXPECT_EQ(segment.feature_count(), 39);
  for (int i = 0; i < 3; ++i) {
    const SegmentTake& take = takes[static_cast<std::size_t>(i)];
    EXPECT_EQ(segment.Content(i), take.content);
    EXPECT_EQ(segment.ColumnCount(i), take.features.column_count());
    EXPECT_THAT(segment.Columns(i), ElementsAreArray(take.features.columns));
    EXPECT_EQ(segment.HasPoses(i), take.poses.has_value());
    EXPECT_EQ(segment.RunListsOf(i), FormatRunLists(take.features));
  }
  EXPECT_EQ(segment.Poses(1), *takes[1].poses);
  EXPECT_EQ(test::ErrorOf([&] { (void)segment.Poses(0); }).code(), ErrorCode::kNotFound);
}

// The layout as the header describes it, read by hand.
TEST(SegmentFile, IsLaidOutAsDocumented) {
  const std::vector<SegmentTake> takes = ThreeTakes();
  const std::string bytes = FormatSegment(takes, kSet);
  const auto number = [&](std::size_t offset) {
    std::uint64_t value = 0;
    for (std::size_t i = 8; i-- > 0;) {
      value = value << 8U | static_cast<unsigned char>(bytes.at(offset + i));
    }
    return value;
  };
  EXPECT_EQ(bytes.substr(0, 8), "\x89KBSEG\r\n");
  EXPECT_EQ(number(8), 2 | std::uint64_t{39} << 32U);
  EXPECT_EQ(number(16), bytes.size());
  EXPECT_EQ(number(24), 3U);
  EXPECT_EQ(number(32), kSet);
  EXPECT_EQ(number(40), 0x403E000000000000U);  // 30.0
  EXPECT_EQ(number(64 + 64), 2U);              // Key of the second take, low half.
  EXPECT_EQ(number(64 + 64 + 16), 5U);         // Its columns.
  const std::uint64_t words = number(64 + 64 + 24);
  EXPECT_EQ(words % 64, 0U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(number(words + 8 * i), takes[1].features.columns[i]);
  }
  const std::uint64_t poses = number(64 + 64 + 40);
  EXPECT_EQ(poses % 64, 0U);
  EXPECT_EQ(number(poses + 24), 0x3FD0000000000000U);  // Step 0.25.
  EXPECT_EQ(number(poses + 32) & 0xFFFFU, takes[1].poses->values[0]);
  const std::uint64_t lists = number(64 + 64 + 56);
  EXPECT_EQ(lists % 64, 0U);
  const std::string expected = FormatRunLists(takes[1].features);
  EXPECT_EQ(number(lists), expected.size());
  EXPECT_EQ(bytes.substr(lists + 16, expected.size()), expected);
  std::size_t list_bytes = 0;
  for (const SegmentTake& take : takes) list_bytes += 16 + FormatRunLists(take.features).size();
  // Header and rows; words; heads and frames of poses; what eight blocks begin later for.
  EXPECT_LE(bytes.size(), list_bytes + 256 + 176 + (64 + 720) + 512);
}

TEST(SegmentFile, FindsEveryChangedByteOfHeaderTableAndBlocks) {
  const std::string good = FormatSegment(ThreeTakes(), kSet);
  const auto read_all = [](const std::string& bytes) {
    const AlignedBytes aligned(bytes);
    const SegmentReader segment(aligned.text(), "bad.segment");
    for (int i = 0; i < segment.take_count(); ++i) {
      (void)segment.Columns(i);
      (void)segment.RunListsOf(i);
      if (segment.HasPoses(i)) (void)segment.Poses(i);
    }
  };
  ASSERT_NO_THROW(read_all(good));
  int unnoticed = 0;
  for (std::size_t byte = 0; byte < good.size(); ++byte) {
    std::string bad = good;
    bad[byte] = static_cast<char>(bad[byte] ^ 0x10);
    try {
      read_all(bad);
      ++unnoticed;
      EXPECT_EQ(good[byte], '\0') << byte;  // Between two blocks.
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("bad.segment"));
    }
  }
  EXPECT_LE(unnoticed, 7 * 63);
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_EQ(test::ErrorOf([&] { read_all(good.substr(0, size)); }).code(),
              ErrorCode::kMalformedFile);
  }
}

TEST(SegmentFile, OfADamagedTakeLeavesTheOthersReadable) {
  const std::vector<SegmentTake> takes = ThreeTakes();
  std::string bytes = FormatSegment(takes, kSet);
  bytes[256] ^= 1;  // The first word after a header and three rows.
  const AlignedBytes aligned(bytes);
  const SegmentReader segment(aligned.text(), "bad.segment");
  const Error error = test::ErrorOf([&] { (void)segment.Columns(0); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.place().byte, 256);
  EXPECT_THAT(segment.Columns(1), ElementsAreArray(takes[1].features.columns));
}

TEST(SegmentFile, HasListsThatAreThoseOfItsWords) {
  const std::string bytes = FormatSegment(ThreeTakes(), kSet);
  const AlignedBytes aligned(bytes);
  const SegmentReader segment(aligned.text(), "a.segment");
  for (int i = 0; i < 3; ++i) EXPECT_NO_THROW(segment.CheckRunLists(i));
}

TEST(SegmentFile, OfANewerVersionIsRefusedWithAWord) {
  std::string bytes = FormatSegment(ThreeTakes(), kSet);
  bytes[8] = 3;
  const AlignedBytes aligned(bytes);
  const Error error = test::ErrorOf([&] { SegmentReader(aligned.text(), "new.segment"); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), HasSubstr("version 3"));
}

TEST(FormatSegment, RefusesTakesThatDoNotBelongTogether) {
  std::vector<SegmentTake> takes = ThreeTakes();
  EXPECT_EQ(test::ErrorOf([] { (void)FormatSegment({}, kSet); }).code(),
            ErrorCode::kInvalidArgument);
  takes[1].poses->values.pop_back();
  EXPECT_EQ(test::ErrorOf([&] { (void)FormatSegment(takes, kSet); }).code(),
            ErrorCode::kInvalidArgument);
  takes = ThreeTakes();
  takes[2].features.rate_hz = 60;
  EXPECT_EQ(test::ErrorOf([&] { (void)FormatSegment(takes, kSet); }).code(),
            ErrorCode::kInvalidArgument);
}

JointTrajectories RandomJoints(int frames, double extent_cm) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-extent_cm / 2, extent_cm / 2);
  JointTrajectories joints{.rate_hz = 30, .joint_count = kStandardJointCount};
  for (int i = 0; i < frames * kStandardJointCount; ++i) {
    joints.positions_cm.emplace_back(place(random), place(random) / 5, place(random));
  }
  return joints;
}

TEST(PackedPoses, AreOffByAtMostHalfAStep) {
  for (const double extent_cm : {1.0, 180.0, 1000.0, 1e6}) {
    const JointTrajectories joints = RandomJoints(50, extent_cm);
    const PackedPoses packed = PackPoses(joints);
    EXPECT_LE(packed.step_cm, extent_cm / 65535);
    const JointTrajectories back = UnpackPoses(packed, 30);
    ASSERT_EQ(back.frame_count(), 50);
    double worst = 0;
    for (std::size_t i = 0; i < joints.positions_cm.size(); ++i) {
      worst =
          std::max(worst, (joints.positions_cm[i] - back.positions_cm[i]).cwiseAbs().maxCoeff());
    }
    EXPECT_LE(worst, packed.step_cm * (0.5 + 1e-9));
    EXPECT_GE(worst, packed.step_cm * 0.4);  // 10,800 numbers come near it.
  }
}

TEST(PackedPoses, OfWhatDoesNotMoveAndOfWhatIsNoPlace) {
  JointTrajectories joints = RandomJoints(1, 0);
  EXPECT_EQ(UnpackPoses(PackPoses(joints), 30).positions_cm, joints.positions_cm);
  joints.positions_cm[3].y() = std::nan("");
  EXPECT_EQ(test::ErrorOf([&] { (void)PackPoses(joints); }).code(), ErrorCode::kInvalidArgument);
  EXPECT_EQ(test::ErrorOf([] { (void)PackPoses({}); }).code(), ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace kinebase
