#include "kinebase/library/take_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "kinebase/library/library_upkeep.h"
#include "library/made_up_takes.h"

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
    const TakeBatch batch = TakeLibrary(takes_.library()).Load(MadeUpTakes::Options().features, 30);
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

TEST_F(DamagedLibrary, OfANewerVersionIsRefusedWithAWord) {
  const fs::path catalogue = takes_.library() / "catalogue.sqlite";
  std::string bytes = test::ReadText(catalogue);
  bytes[63] = 2;  // The last byte of SQLite's user version.
  test::WriteText(catalogue, bytes);
  const Error error = ErrorOf([&] { TakeLibrary opened(takes_.library()); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), HasSubstr("version 2"));
  EXPECT_EQ(ErrorOf([&] { takes_.Import(); }).code(), ErrorCode::kMismatch);
}

TEST(TakeLibrary, IsAsItWasWhenItWasOpened) {
  const MadeUpTakes takes;
  takes.Import();
  const FeatureSet features = MadeUpTakes::Options().features;
  const TakeLibrary library(takes.library());
  const TakeBatch before = library.Load(features, 30);
  RemoveTakes(takes.library(), {.names = {takes.folder()}});
  EXPECT_FALSE(fs::exists(takes.Segment(1)));
  const TakeBatch after = library.Load(features, 30);
  ASSERT_THAT(after.takes, SizeIs(3));
  EXPECT_EQ(after.takes[2].features.columns, before.takes[2].features.columns);
  EXPECT_THAT(TakeLibrary(takes.library()).takes(), IsEmpty());
}

TEST(TakeLibrary, SaysWhatItLacks) {
  const MadeUpTakes takes(1);
  const auto load = [&](const FeatureSet& features, const TakeFilter& filter, bool with_poses) {
    return std::string(ErrorOf([&] {
                         (void)TakeLibrary(takes.library()).Load(features, 30, filter, with_poses);
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
  takes.Import();
  const fs::path list = takes.folder() / "list.csv";
  test::WriteText(list, FormatTakeList(TakeLibrary(takes.library()).takes()));
  std::vector<TakeFailure> failures;
  const auto sources = ListedSources(list, {}, failures);
  EXPECT_THAT(failures, IsEmpty());
  ASSERT_THAT(sources, SizeIs(2));
  EXPECT_EQ(sources[0].class_name, "wave");
  EXPECT_EQ(ImportTakes(takes.library(), sources, MadeUpTakes::Options()).unchanged, 2);
}

}  // namespace
}  // namespace kinebase
