#include "kinebase/library/library_compaction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "kinebase/library/library_upkeep.h"
#include "kinebase/library/take_library.h"
#include "kinebase/search/run_lists.h"
#include "library/made_up_takes.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using test::ExecuteSql;
using test::MadeUpTakes;
using testing::IsEmpty;
using testing::SizeIs;

// Six takes, two a segment.
class CompactedLibrary : public testing::Test {
 protected:
  CompactedLibrary() {
    ImportOptions options = MadeUpTakes::Options();
    options.takes_per_batch = 2;
    options.with_poses = true;
    takes_.Import(options);
    before_ = Contents();
    fs::copy(takes_.library() / "segments", kept_.path() / "segments");
  }

  struct Content {
    std::vector<std::uint64_t> columns;
    std::vector<Eigen::Vector3d> places;

    friend bool operator==(const Content&, const Content&) = default;
  };

  [[nodiscard]] std::map<std::string, Content> Contents() const {
    const TakeLibrary library(takes_.library());
    const std::uint64_t hash = MadeUpTakes::Options().features.hash;
    std::map<std::string, Content> contents;
    for (const StoredTake& take : library.takes()) {
      const auto columns = library.Columns(take, hash, 30);
      Content& content = contents[take.path.filename().string()];
      content.columns.assign(columns.begin(), columns.end());
      const JointTrajectories poses = library.Poses(take, hash, 30);
      content.places.reserve(static_cast<std::size_t>(poses.frame_count()));
      for (int i = 0; i < poses.frame_count(); ++i) content.places.emplace_back(poses.at(i, 3));
    }
    return contents;
  }

  // What is left of the takes is what it was, and nothing else lies about.
  void ExpectAsBefore(std::size_t takes, std::size_t segments) const {
    const auto now = Contents();
    EXPECT_THAT(now, SizeIs(takes));
    for (const auto& [name, content] : now) EXPECT_EQ(content, before_.at(name)) << name;
    const VerifyReport report = VerifyLibrary(takes_.library());
    EXPECT_THAT(report.damaged, IsEmpty());
    EXPECT_THAT(report.leftovers, IsEmpty());
    EXPECT_FALSE(report.words_are_damaged);
    EXPECT_THAT(TakeLibrary(takes_.library()).segments(), SizeIs(segments));
    EXPECT_EQ(static_cast<std::size_t>(std::distance(
                  fs::directory_iterator(takes_.library() / "segments"), fs::directory_iterator())),
              segments);
  }

  [[nodiscard]] std::int64_t BytesOnDisk() const {
    auto bytes = static_cast<std::int64_t>(fs::file_size(takes_.library() / "catalogue.sqlite"));
    for (const auto& entry : fs::directory_iterator(takes_.library() / "segments")) {
      bytes += static_cast<std::int64_t>(entry.file_size());
    }
    return bytes;
  }

  // Puts the catalogue and the segments back that stood in it at the beginning.
  void Restore(const std::string& catalogue) const {
    fs::remove_all(takes_.library() / "segments");
    fs::copy(kept_.path() / "segments", takes_.library() / "segments");
    test::WriteText(takes_.library() / "catalogue.sqlite", catalogue);
  }

  MadeUpTakes takes_{6};
  test::TemporaryFolder kept_;
  std::map<std::string, Content> before_;
};

TEST_F(CompactedLibrary, JoinsSmallSegments) {
  const std::int64_t bytes = BytesOnDisk();
  const CompactReport report = CompactLibrary(takes_.library());
  EXPECT_EQ(report.segments_before, 3);
  EXPECT_EQ(report.segments_after, 1);
  EXPECT_EQ(report.bytes_before, bytes);
  EXPECT_EQ(report.bytes_after, BytesOnDisk());
  EXPECT_THAT(report.failures, IsEmpty());
  ExpectAsBefore(6, 1);
  // A second time there is nothing to do.
  const auto written = fs::last_write_time(takes_.Segment(4));
  EXPECT_EQ(CompactLibrary(takes_.library()).segments_after, 1);
  EXPECT_EQ(fs::last_write_time(takes_.Segment(4)), written);
}

TEST_F(CompactedLibrary, GivesBackTheRoomOfRemovedTakes) {
  RemoveTakes(takes_.library(), {.names = {takes_.files()[0], takes_.files()[3]}});
  const CompactReport report = CompactLibrary(takes_.library());
  EXPECT_LT(report.bytes_after, report.bytes_before);
  ExpectAsBefore(4, 1);
  // Exactly the bytes of the four takes: header, rows, words, poses and lists, each at a multiple
  // of 64.
  const int feature_count = MadeUpTakes::Options().features.feature_count();
  std::uintmax_t expected = 64 + 4 * 64;
  for (const auto& [name, content] : Contents()) {
    const std::size_t columns = content.columns.size();
    const std::size_t lists = FormatRunLists({30, feature_count, content.columns}).size();
    for (const std::size_t block : {8 * columns, 32 + 144 * columns, 16 + lists}) {
      expected = (expected + 63) / 64 * 64 + block;
    }
  }
  EXPECT_NEAR(static_cast<double>(fs::file_size(takes_.Segment(4))), static_cast<double>(expected),
              63);
}

TEST_F(CompactedLibrary, KeepsToTheSizeThatIsAskedFor) {
  const auto largest = static_cast<std::int64_t>(fs::file_size(takes_.Segment(3)));
  RemoveTakes(takes_.library(), {.names = {takes_.files()[5]}});
  CompactLibrary(takes_.library(), {.segment_bytes = largest});
  for (const auto& entry : fs::directory_iterator(takes_.library() / "segments")) {
    EXPECT_LE(static_cast<std::int64_t>(entry.file_size()), largest);
  }
  EXPECT_EQ(Contents().size(), 5U);
  EXPECT_THAT(VerifyLibrary(takes_.library()).damaged, IsEmpty());
}

TEST_F(CompactedLibrary, ReadersGoOnWithWhatTheyOpened) {
  const TakeLibrary reader(takes_.library());
  CompactLibrary(takes_.library());
  EXPECT_FALSE(fs::exists(takes_.Segment(1)));
  for (const StoredTake& take : reader.takes()) {
    const auto columns = reader.Columns(take, MadeUpTakes::Options().features.hash, 30);
    EXPECT_EQ(std::vector(columns.begin(), columns.end()),
              before_.at(take.path.filename().string()).columns);
  }
}

TEST_F(CompactedLibrary, LeavesWhatIsDamagedForSomebodyToLookAt) {
  RemoveTakes(takes_.library(), {.names = {takes_.files()[1]}});
  test::Spoil(takes_.Segment(1), 64 + 2 * 64 + 3);
  const CompactReport report = CompactLibrary(takes_.library());
  ASSERT_THAT(report.failures, SizeIs(1));
  EXPECT_EQ(report.failures[0].path, takes_.Segment(1));
  EXPECT_THAT(report.failures[0].error.what(),
              ::testing::HasSubstr("library remove LIBRARY --damaged"));
  EXPECT_EQ(report.segments_after, 2);
  EXPECT_THAT(VerifyLibrary(takes_.library()).damaged, SizeIs(1));
  EXPECT_THAT(RemoveTakes(takes_.library(), {.damaged = true}), SizeIs(1));
  ExpectAsBefore(4, 1);
}

TEST_F(CompactedLibrary, KeepsFeaturesThatSeveralTakesShare) {
  const fs::path twin = takes_.folder() / "twin" / "HDM_xx_wave_007_120.amc";
  test::WriteText(twin, test::ReadText(takes_.files()[2]));
  ImportOptions options = MadeUpTakes::Options();
  options.with_poses = true;
  ImportTakes(takes_.library(), std::vector<ImportSource>{{.file = twin}}, options);
  before_["HDM_xx_wave_007_120.amc"] = before_.at("HDM_xx_wave_003_120.amc");
  RemoveTakes(takes_.library(), {.names = {takes_.files()[2], takes_.files()[3]}});
  CompactLibrary(takes_.library());
  ExpectAsBefore(5, 1);
}

TEST_F(CompactedLibrary, KeepsSegmentsOfOtherFeaturesApart) {
  ImportOptions options = MadeUpTakes::Options();
  options.with_poses = true;
  options.rate_hz = 60;
  takes_.Import(options);
  CompactLibrary(takes_.library());
  ExpectAsBefore(6, 1 + 1);
}

// A flipped bit in a number makes sound words look like those of nobody.
TEST_F(CompactedLibrary, FreesNothingWhileARowIsDamaged) {
  const fs::path catalogue = takes_.library() / "catalogue.sqlite";
  const std::string good = test::ReadText(catalogue);
  for (const char* change :
       {"UPDATE features SET segment = 999 WHERE take = 5; ",
        "UPDATE features SET segment = 999 WHERE take IN (5, 6)",
        "UPDATE features SET slot = 0 WHERE take = 6",
        "UPDATE features SET take = 99 WHERE take = 5", "UPDATE segments SET id = 259 WHERE id = 3",
        "UPDATE takes SET class = 'x' WHERE id = 6"}) {
    SCOPED_TRACE(change);
    ExecuteSql(takes_.library(), change);
    EXPECT_FALSE(CompactLibrary(takes_.library()).failures.empty());
    RemoveDamagedRecords(takes_.library());
    test::WriteMadeUpTake(takes_.folder() / "HDM_xx_wave_007_120.amc", 9, 50);
    ImportTakes(takes_.library(),
                std::vector<ImportSource>{{.file = takes_.folder() / "HDM_xx_wave_007_120.amc"}},
                MadeUpTakes::Options());
    EXPECT_TRUE(fs::exists(takes_.Segment(3)));
    EXPECT_FALSE(RemoveTakes(takes_.library(), {.damaged = true}).empty());
    EXPECT_THAT(CompactLibrary(takes_.library()).failures, IsEmpty());
    EXPECT_THAT(VerifyLibrary(takes_.library()).damaged, IsEmpty());
    Restore(good);
  }
}

TEST_F(CompactedLibrary, CanBeCancelled) {
  for (const std::string_view stage : {"checking", "compacting"}) {
    const auto stop = [&](std::string_view what, std::size_t, std::size_t) {
      return what != stage;
    };
    EXPECT_EQ(test::ErrorOf([&] { CompactLibrary(takes_.library(), {.progress = stop}); }).code(),
              ErrorCode::kCancelled);
    ExpectAsBefore(6, 3);
  }
}

// Bytes are only looked at where something is to be gained by writing them anew.
TEST_F(CompactedLibrary, ReadsNoSegmentThatStaysAsItIs) {
  CompactLibrary(takes_.library());
  test::Spoil(takes_.Segment(4), fs::file_size(takes_.Segment(4)) - 1);
  EXPECT_THAT(CompactLibrary(takes_.library()).failures, IsEmpty());
  EXPECT_THAT(VerifyLibrary(takes_.library()).damaged, SizeIs(1));
}

TEST_F(CompactedLibrary, LosesWhatACrashLeft) {
  test::WriteText(takes_.library() / "segments" / "00000099.segment", "cut short");
  CompactLibrary(takes_.library());
  ExpectAsBefore(6, 1);
}

TEST_F(CompactedLibrary, GivesBackTheRoomOfTheCatalogue) {
  ExecuteSql(takes_.library(), "UPDATE takes SET description = hex(zeroblob(100000))");
  RemoveTakes(takes_.library(), {.damaged = true});
  const CompactReport report = CompactLibrary(takes_.library());
  EXPECT_EQ(report.segments_after, 0);
  EXPECT_GT(report.bytes_before - report.bytes_after, 6 * 100000);
}

}  // namespace
}  // namespace kinebase
