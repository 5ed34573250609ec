// Libraries that older versions of Kinebase made are read for ever. Beside each lies what the
// program said of its recordings when it was made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "kinebase/core/csv.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/library_upkeep.h"
#include "kinebase/library/take_library.h"
#include "kinebase/search/run_lists.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;
using testing::SizeIs;

class LibrarySample : public testing::Test {
 protected:
  // A copy: SQLite may want to write beside it.
  explicit LibrarySample(const std::string& name = "library_v1")
      : sample_(fs::path(KINEBASE_SOURCE_DIR) / "tests" / "library" / "samples" / name) {
    fs::copy(sample_, library(), fs::copy_options::recursive);
  }

  [[nodiscard]] fs::path library() const { return folder_.path() / "library"; }

  // "features" or "joints" of a take.
  [[nodiscard]] CsvTable Truth(const StoredTake& take, const std::string& what) const {
    return test::ReadCsv(sample_ / (take.path.stem().string() + "." + what + ".csv"));
  }

 private:
  fs::path sample_;
  test::TemporaryFolder folder_;
};

TEST_F(LibrarySample, OfVersion1IsRead) {
  const TakeLibrary library(this->library());
  ASSERT_THAT(library.takes(), SizeIs(2));
  EXPECT_EQ(library.takes()[0].name.class_name, "kickRFront1Reps");
  EXPECT_EQ(library.takes()[0].name.actor, "sa");
  EXPECT_EQ(library.takes()[0].name.take, "001");
  EXPECT_EQ(library.takes()[0].path,
            "/made-up/lib/cut_amc/kickRFront1Reps/SYN_sa_kickRFront1Reps_001_120.amc");
  EXPECT_EQ(library.takes()[0].frame_count, 205);
  EXPECT_EQ(library.takes()[1].frame_count, 285);
  EXPECT_EQ(library.feature_sets()[0].name, "bonn");
  for (const StoredTake& take : library.takes()) {
    ASSERT_THAT(take.features, SizeIs(1));
    const StoredFeatures& stored = take.features.front();
    const auto columns = library.Columns(take, stored.feature_set_hash, 30);
    const CsvTable features = Truth(take, "features");
    ASSERT_EQ(columns.size(), features.rows.size());
    for (std::size_t column = 0; column < columns.size(); ++column) {
      for (std::size_t row = 0; row < 39; ++row) {
        EXPECT_EQ((columns[column] >> row) & 1U, features.rows[column][row + 1] == "1" ? 1U : 0U);
      }
    }
    // It holds no lists: they are made of the words.
    EXPECT_EQ(library.RunListsOf(take, stored.feature_set_hash, 30),
              FormatRunLists({30, 39, columns}));
    const JointTrajectories poses = library.Poses(take, stored.feature_set_hash, 30);
    ASSERT_EQ(static_cast<std::size_t>(poses.frame_count()), columns.size());
    const CsvTable joints = Truth(take, "joints");
    for (std::size_t i = 0; i < 72; ++i) {
      const double truth = *ParseDouble(joints.rows[0][i + 1]);
      EXPECT_NEAR(poses.at(0, static_cast<int>(i / 3))[static_cast<int>(i % 3)], truth, 0.005);
    }
  }
}

TEST_F(LibrarySample, OfVersion1IsSoundAndCanBeChanged) {
  EXPECT_THAT(VerifyLibrary(library()).damaged, IsEmpty());
  EXPECT_THAT(RemoveTakes(library(), {.filter = {.classes = {"squat1Reps"}}}), SizeIs(1));
  EXPECT_THAT(TakeLibrary(library()).takes(), SizeIs(1));
}

}  // namespace
}  // namespace kinebase
