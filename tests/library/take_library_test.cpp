#include "kinebase/library/take_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kinebase/library/library_upkeep.h"
#include "library/made_up_takes.h"
#include "library/sqlite_database.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using test::ErrorOf;
using test::MadeUpTakes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class DamagedLibrary : public testing::Test {
 protected:
  DamagedLibrary() {
    ImportOptions options = MadeUpTakes::Options();
    options.takes_per_batch = 2;
    takes_.Import(options);  // Takes 1 and 2 are in the first segment, 3 in the second.
  }

  [[nodiscard]] std::vector<std::string> DamagedNames() const {
    std::vector<std::string> names;
    for (const TakeFailure& failure : VerifyLibrary(takes_.library()).damaged) {
      EXPECT_THAT(failure.error.what(), HasSubstr(takes_.Segment(1).string()));
      EXPECT_THAT(failure.error.what(), HasSubstr("--damaged"));
      names.push_back(failure.path.filename().string());
    }
    return names;
  }

  // Verifying and searching agree, and the others stay as they were.
  void ExpectDamaged(const std::vector<std::string>& names) const {
    EXPECT_EQ(DamagedNames(), names);
    const TakeBatch batch =
        test::LoadAll(TakeLibrary(takes_.library()), MadeUpTakes::Options().features, 30);
    EXPECT_THAT(batch.failures, SizeIs(names.size()));
    EXPECT_THAT(batch.takes, SizeIs(3 - names.size()));
    for (const TakeFeatures& take : batch.takes) {
      EXPECT_EQ(
          take.features.columns,
          LoadTakeFeatures({take.path}, MadeUpTakes::Options().features, 30, {}).features.columns);
    }
  }

  MadeUpTakes takes_;
};

TEST_F(DamagedLibrary, WithAChangedWordLosesThatTakeOnly) {
  test::Spoil(takes_.Segment(1), 64 + 2 * 64 + 3);
  ExpectDamaged({"HDM_xx_wave_001_120.amc"});
}

TEST_F(DamagedLibrary, WithAChangedHeaderLosesTheTakesOfTheSegment) {
  test::Spoil(takes_.Segment(1), 33);
  ExpectDamaged({"HDM_xx_wave_001_120.amc", "HDM_xx_wave_002_120.amc"});
}

TEST_F(DamagedLibrary, WithACutOffSegmentLosesItsTakes) {
  fs::resize_file(takes_.Segment(1), fs::file_size(takes_.Segment(1)) - 1);
  ExpectDamaged({"HDM_xx_wave_001_120.amc", "HDM_xx_wave_002_120.amc"});
}

TEST_F(DamagedLibrary, WithAMissingOrForeignSegmentLosesItsTakes) {
  fs::remove(takes_.Segment(1));
  ExpectDamaged({"HDM_xx_wave_001_120.amc", "HDM_xx_wave_002_120.amc"});
  fs::copy_file(takes_.Segment(2), takes_.Segment(1));
  ExpectDamaged({"HDM_xx_wave_001_120.amc", "HDM_xx_wave_002_120.amc"});
}

TEST_F(DamagedLibrary, IsMendedByRemovingAndImportingAgain) {
  test::Spoil(takes_.Segment(1), 64 + 2 * 64 + 3);
  EXPECT_THAT(RemoveTakes(takes_.library(), {.damaged = true}),
              ElementsAre(fs::canonical(takes_.files()[0])));
  EXPECT_EQ(takes_.Import().added, 1);
  ExpectDamaged({});
  EXPECT_THAT(RemoveTakes(takes_.library(), {.damaged = true}), IsEmpty());
}

// What cannot be read here and now may be sound, and is not removed.
TEST_F(DamagedLibrary, IsNotOneWhoseSegmentsCannotBeRead) {
  const fs::path segment = takes_.Segment(1);
  const fs::path folder = segment.parent_path();
  const auto expect_kept = [&](ErrorCode code, const std::string& remedy) {
    const Error refused = ErrorOf([&] { RemoveTakes(takes_.library(), {.damaged = true}); });
    EXPECT_EQ(refused.code(), code);
    EXPECT_THAT(refused.what(), testing::AllOf(HasSubstr(segment.string()), HasSubstr(remedy),
                                               testing::Not(HasSubstr("--damaged"))));
    EXPECT_THAT(TakeLibrary(takes_.library()).takes(), SizeIs(3));
    EXPECT_THAT(VerifyLibrary(takes_.library()).damaged, testing::Not(IsEmpty()));
  };
  const std::string bytes = test::ReadText(segment);
  std::string newer = bytes;
  newer[8] = 3;
  test::WriteText(segment, newer);
  expect_kept(ErrorCode::kMismatch, "use a newer one");

  fs::remove(segment);
  fs::create_directory(segment);  // The system refuses to read it, to every user.
  expect_kept(ErrorCode::kIoFailure, "permissions");
  fs::remove(segment);

  test::WriteText(segment, bytes);
  const fs::path away = takes_.library() / "away";
  fs::rename(folder, away);  // As on a disk that is not there.
  expect_kept(ErrorCode::kIoFailure, "permissions");
  fs::rename(away, folder);
  ExpectDamaged({});
}

TEST_F(DamagedLibrary, WithADamagedCatalogueSaysSo) {
  const fs::path catalogue = takes_.library() / "catalogue.sqlite";
  const std::string good = test::ReadText(catalogue);
  test::WriteText(catalogue, std::string(4096, 'x'));
  EXPECT_EQ(ErrorOf([&] { (void)VerifyLibrary(takes_.library()); }).code(),
            ErrorCode::kMalformedFile);
  EXPECT_EQ(ErrorOf([&] { TakeLibrary opened(takes_.library()); }).code(),
            ErrorCode::kMalformedFile);
  // A page in the middle: SQLite's own check finds it.
  std::string bad = good;
  bad.replace(4096, 200, 200, '\x55');
  test::WriteText(catalogue, bad);
  EXPECT_EQ(ErrorOf([&] { (void)VerifyLibrary(takes_.library()); }).code(),
            ErrorCode::kMalformedFile);
}

// Numbers that no import writes; places of hits are computed from them.
TEST_F(DamagedLibrary, WithImpossibleTakesInItsCatalogueLosesThese) {
  const fs::path catalogue = takes_.library() / "catalogue.sqlite";
  const std::string good = test::ReadText(catalogue);
  for (const std::string change : {"frames = -5", "frames = 0", "frames = 9223372036854775807",
                                   "rate_hz = 9e999", "rate_hz = 0", "rate_hz = -120.0"}) {
    SCOPED_TRACE(change);
    test::WriteText(catalogue, good);
    internal::SqliteDatabase(catalogue, internal::SqliteDatabase::Access::kCreate)
        .Execute(("UPDATE takes SET " + change + " WHERE path LIKE '%wave_002%'").c_str());
    const TakeLibrary library(takes_.library());
    ASSERT_THAT(library.takes(), SizeIs(3));
    EXPECT_EQ(library.takes()[1].frame_count, 0);
    for (const auto& failures :
         {VerifyLibrary(takes_.library()).damaged, takes_.Import().failures,
          test::LoadAll(library, MadeUpTakes::Options().features, 30).failures}) {
      ASSERT_THAT(failures, SizeIs(1));
      EXPECT_THAT(failures[0].error.what(),
                  testing::AllOf(HasSubstr("wave_002_120.amc"), HasSubstr("--damaged")));
    }
  }
  EXPECT_THAT(RemoveTakes(takes_.library(), {.damaged = true}), SizeIs(1));
  EXPECT_EQ(takes_.Import().added, 1);
}

TEST_F(DamagedLibrary, WhoseNumbersHaveRunOutTakesNoMore) {
  const fs::path catalogue = takes_.library() / "catalogue.sqlite";
  for (const char* last : {"9223372036854775807", "-7"}) {
    internal::SqliteDatabase(catalogue, internal::SqliteDatabase::Access::kCreate)
        .Execute(
            ("UPDATE sqlite_sequence SET seq = " + std::string(last) + " WHERE name = 'segments'")
                .c_str());
    test::WriteMadeUpTake(takes_.files()[1], 77, 44);
    const Error error = ErrorOf([&] { takes_.Import(); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    EXPECT_THAT(error.what(), HasSubstr(last));
  }
}

TEST_F(DamagedLibrary, OfANewerVersionIsRefusedWithAWord) {
  const fs::path catalogue = takes_.library() / "catalogue.sqlite";
  std::string bytes = test::ReadText(catalogue);
  bytes[63] = 3;  // The last byte of SQLite's user version.
  test::WriteText(catalogue, bytes);
  const Error error = ErrorOf([&] { TakeLibrary opened(takes_.library()); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), HasSubstr("version 3"));
  EXPECT_EQ(ErrorOf([&] { takes_.Import(); }).code(), ErrorCode::kMismatch);
}

TEST(TakeLibrary, IsAsItWasWhenItWasOpened) {
  const MadeUpTakes takes;
  takes.Import();
  const FeatureSet features = MadeUpTakes::Options().features;
  const TakeLibrary library(takes.library());
  const TakeBatch before = test::LoadAll(library, features, 30);
  RemoveTakes(takes.library(), {.names = {takes.folder()}});
  EXPECT_FALSE(fs::exists(takes.Segment(1)));
  const TakeBatch after = test::LoadAll(library, features, 30);
  ASSERT_THAT(after.takes, SizeIs(3));
  EXPECT_EQ(after.takes[2].features.columns, before.takes[2].features.columns);
  EXPECT_THAT(TakeLibrary(takes.library()).takes(), IsEmpty());
}

TEST(TakeLibrary, SaysWhatItLacks) {
  const MadeUpTakes takes(1);
  const auto load = [&](const FeatureSet& features, const TakeFilter& filter, bool with_poses) {
    return std::string(ErrorOf([&] {
                         (void)test::LoadAll(TakeLibrary(takes.library()), features, 30, filter,
                                             with_poses);
                       }).what());
  };
  const FeatureSet bonn = LoadFeatureSet("bonn");
  EXPECT_THAT(ErrorOf([&] { TakeLibrary opened(takes.library()); }).what(),
              HasSubstr("kinebase import"));
  takes.Import();
  EXPECT_THAT(load(LoadFeatureSet("paper"), {}, false), HasSubstr("'paper' at 30 Hz"));
  EXPECT_THAT(load(bonn, {}, true), HasSubstr("--poses"));
  EXPECT_THAT(load(bonn, {.actors = {"yy"}}, false), HasSubstr("actor 'yy'; there are: xx"));
  EXPECT_THAT(load(bonn, {.classes = {"run"}}, false), HasSubstr("class 'run'; there are: wave"));
  RemoveTakes(takes.library(), {.filter = {.actors = {"xx"}}});
  EXPECT_THAT(load(bonn, {}, false), HasSubstr("holds no takes"));
  const fs::path plain = test::WriteMadeUpTake(takes.folder() / "HDM_xx.amc", 9, 50);
  ImportTakes(takes.library(), std::vector<ImportSource>{{.file = plain}}, MadeUpTakes::Options());
  EXPECT_THAT(load(bonn, {.classes = {"walk"}}, false),
              testing::EndsWith("has no take of class 'walk': it knows no class of any take"));
}

TEST(RemoveTakes, TakesPathsFoldersAndNames) {
  const MadeUpTakes takes(4);
  takes.Import();
  const auto remove = [&](const fs::path& name) {
    return RemoveTakes(takes.library(), {.names = {name}}).size();
  };
  EXPECT_EQ(remove("HDM_xx_wave_002_120.amc"), 1U);
  EXPECT_EQ(remove(takes.files()[0]), 1U);
  EXPECT_EQ(ErrorOf([&] { (void)remove(takes.files()[0]); }).code(), ErrorCode::kNotFound);
  EXPECT_EQ(ErrorOf([&] { (void)remove(takes.folder() / "HDM_xx_wave_00"); }).code(),
            ErrorCode::kNotFound);
  EXPECT_EQ(remove(takes.folder() / ""), 2U);
  EXPECT_EQ(ErrorOf([&] { RemoveTakes(takes.library(), {}); }).code(), ErrorCode::kInvalidArgument);
}

TEST(FormatTakeList, IsAListOfClipsThatCanBeImported) {
  const MadeUpTakes takes(2);
  const fs::path classless = takes.folder() / "HDM_xx.amc";
  test::WriteMadeUpTake(classless, 9, 50);
  takes.Import();
  ImportTakes(takes.library(), std::vector<ImportSource>{{.file = classless}},
              MadeUpTakes::Options());
  // Somewhere else, beside another file of the same name.
  const test::TemporaryFolder elsewhere;
  const fs::path list = elsewhere.path() / "list.csv";
  test::WriteText(elsewhere.path() / classless.filename(), "another");
  test::WriteText(list, FormatTakeList(TakeLibrary(takes.library()).takes()));
  std::vector<TakeFailure> failures;
  const auto sources = ListedSources(list, {}, failures);
  EXPECT_THAT(failures, IsEmpty());
  ASSERT_THAT(sources, SizeIs(3));
  EXPECT_EQ(sources[0].file, fs::canonical(classless));
  EXPECT_EQ(sources[0].class_name, "");
  EXPECT_EQ(sources[1].class_name, "wave");
  EXPECT_EQ(ImportTakes(takes.library(), sources, MadeUpTakes::Options()).unchanged, 3);
  // To learn from it, each clip needs a class.
  EXPECT_THAT(ErrorOf([&] { (void)ClipsOfClass(list, "wave", {}, {}); }).what(),
              HasSubstr("list.csv:2: a clip without a class"));
  test::WriteText(list, FormatTakeList(std::span(TakeLibrary(takes.library()).takes()).subspan(1)));
  EXPECT_THAT(ClipsOfClass(list, "wave", {}, {}), SizeIs(2));
}

}  // namespace
}  // namespace kinebase
