// Libraries that older versions of Kinebase made are read for ever. Beside each lies what the
// program said of its recordings when it was made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "kinebase/core/csv.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/library_annotations.h"
#include "kinebase/library/library_compaction.h"
#include "kinebase/library/library_labels.h"
#include "kinebase/library/library_templates.h"
#include "kinebase/library/library_upkeep.h"
#include "kinebase/library/take_library.h"
#include "kinebase/search/run_lists.h"
#include "library/catalogue.h"
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
  explicit LibrarySample(const std::string& name = "library_v1") {
    fs::copy(samples_ / name, library(), fs::copy_options::recursive);
  }

  [[nodiscard]] fs::path library() const { return folder_.path() / "library"; }

  // "features" or "joints" of a take; all samples have the same takes.
  [[nodiscard]] CsvTable Truth(const StoredTake& take, const std::string& what) const {
    return test::ReadCsv(samples_ / "library_v1" /
                         (take.path.stem().string() + "." + what + ".csv"));
  }

 private:
  fs::path samples_ = fs::path(KINEBASE_SOURCE_DIR) / "tests" / "library" / "samples";
  test::TemporaryFolder folder_;
};

TEST_F(LibrarySample, OfVersion1IsReadAndNotChanged) {
  const std::string catalogue = test::ReadText(this->library() / "catalogue.sqlite");
  const TakeLibrary library(this->library());
  EXPECT_THAT(library.Choose({.formats = {"amc"}, .text = "squat"}), SizeIs(1));
  EXPECT_THAT(VerifyLibrary(this->library()).damaged, IsEmpty());
  EXPECT_THAT(ListTemplates(this->library()), IsEmpty());
  EXPECT_THAT(ListAnnotations(this->library(), {}).annotations, IsEmpty());
  EXPECT_EQ(test::ReadText(this->library() / "catalogue.sqlite"), catalogue);
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

// Version 1 has no checksums, by which it could be told that somebody else wrote this.
TEST_F(LibrarySample, OfVersion1WithImpossibleTakesIsRefused) {
  for (const char* change : {"frames = -5", "frames = 0", "rate_hz = 9e999", "rate_hz = 0"}) {
    internal::SqliteDatabase(library() / "catalogue.sqlite",
                             internal::SqliteDatabase::Access::kRead)
        .Execute(
            (std::string("UPDATE takes SET ") + change + " WHERE path LIKE '%squat%'").c_str());
    const Error error = test::ErrorOf([&] { TakeLibrary opened(library()); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile) << change;
    EXPECT_THAT(error.what(), testing::HasSubstr("restore it from a copy"));
  }
}

TEST_F(LibrarySample, OfVersion1BecomesVersion2WhenItIsChanged) {
  const auto before = TakeLibrary(library()).takes();
  ChangeLabels(library(), {.filter = {.classes = {"squat1Reps"}}}, {.add = {"gym"}});
  const TakeLibrary upgraded(library());
  ASSERT_THAT(upgraded.takes(), SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(upgraded.takes()[i].id, before[i].id);
    EXPECT_EQ(upgraded.takes()[i].path, before[i].path);
    EXPECT_EQ(upgraded.takes()[i].content, before[i].content);
    EXPECT_EQ(upgraded.takes()[i].features, before[i].features);
    EXPECT_EQ(upgraded.takes()[i].origin, TakeOrigin());  // What nobody noted stays unknown.
  }
  EXPECT_THAT(upgraded.Choose({.labels = {"gym"}, .text = "squat gym"}), SizeIs(1));
  EXPECT_THAT(upgraded.Choose({.text = "kick"}), SizeIs(1));
  const VerifyReport report = VerifyLibrary(library());
  EXPECT_THAT(report.damaged, IsEmpty());
  EXPECT_FALSE(report.words_are_damaged);
}

// Whoever began to read goes on with what version 1 has.
TEST_F(LibrarySample, OfVersion1IsReadWhileItBecomesVersion2) {
  const internal::Catalogue reader(library(), internal::SqliteDatabase::Access::kRead);
  ChangeLabels(library(), {}, {.add = {"gym"}});
  EXPECT_EQ(reader.version(), 1);
  EXPECT_THAT(reader.Takes(), SizeIs(2));
  EXPECT_THAT(reader.FindText("squat"), SizeIs(1));
  EXPECT_THAT(TakeLibrary(library()).Choose({.labels = {"gym"}}), SizeIs(2));
}

class LibrarySample2 : public LibrarySample {
 protected:
  LibrarySample2() : LibrarySample("library_v2") {}
};

// The same two takes, in two segments, with what version 2 keeps beside them.
TEST_F(LibrarySample2, IsRead) {
  const TakeLibrary library(this->library());
  ASSERT_THAT(library.takes(), SizeIs(2));
  const StoredTake& squat = library.takes()[1];
  EXPECT_EQ(squat.description, "bends the knees and rises");
  EXPECT_EQ(squat.skeleton.path, "/made-up/lib/asf/SYN_sa.asf");
  EXPECT_EQ(squat.skeleton.key, library.takes()[0].skeleton.key);
  EXPECT_EQ(squat.origin.program, "kinebase 0.1.0");
  EXPECT_GT(squat.origin.imported_s, 0);
  EXPECT_THAT(squat.labels, testing::ElementsAre(StoredLabel{"deep", 20, 90}, StoredLabel{"gym"}));
  EXPECT_THAT(library.Choose({.labels = {"gym"}, .text = "bends deep"}), SizeIs(1));
  for (const StoredTake& take : library.takes()) {
    const auto columns = library.Columns(take, take.features.front().feature_set_hash, 30);
    const CsvTable features = Truth(take, "features");
    ASSERT_EQ(columns.size(), features.rows.size());
    for (std::size_t column = 0; column < columns.size(); ++column) {
      for (std::size_t row = 0; row < 39; ++row) {
        EXPECT_EQ((columns[column] >> row) & 1U, features.rows[column][row + 1] == "1" ? 1U : 0U);
      }
    }
  }
}

TEST_F(LibrarySample2, HoldsATemplateAndAnAnnotation) {
  const MotionTemplate squat = LoadTemplate(library(), "squat1Reps");
  EXPECT_EQ(squat.matrix.feature_count, 39);
  const auto annotations = ListAnnotations(library(), {}).annotations;
  ASSERT_THAT(annotations, SizeIs(1));
  EXPECT_EQ(annotations[0].class_name, "squat1Reps");
  EXPECT_EQ(annotations[0].first_frame, 1);
  EXPECT_EQ(annotations[0].cost, 0.0125);
  EXPECT_EQ(annotations[0].feature_set_hash, squat.feature_set_hash);
}

TEST_F(LibrarySample2, IsSoundAndCanBeChanged) {
  const VerifyReport report = VerifyLibrary(library());
  EXPECT_THAT(report.damaged, IsEmpty());
  EXPECT_THAT(report.damaged_records, IsEmpty());
  EXPECT_FALSE(report.words_are_damaged);
  EXPECT_EQ(CompactLibrary(library()).segments_after, 1);
  EXPECT_THAT(RemoveTakes(library(), {.filter = {.labels = {"gym"}}}), SizeIs(1));
  EXPECT_THAT(VerifyLibrary(library()).damaged, IsEmpty());
}

TEST_F(LibrarySample, OfVersion1IsSoundAndCanBeChanged) {
  EXPECT_THAT(VerifyLibrary(library()).damaged, IsEmpty());
  EXPECT_THAT(RemoveTakes(library(), {.filter = {.classes = {"squat1Reps"}}}), SizeIs(1));
  EXPECT_THAT(TakeLibrary(library()).takes(), SizeIs(1));
}

}  // namespace
}  // namespace kinebase
