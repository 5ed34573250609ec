#include "kinebase/library/take_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "kinebase/library/library_upkeep.h"
#include "kinebase/library/segment_file.h"
#include "kinebase/library/take_library.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_editing.h"
#include "library/catalogue.h"
#include "library/made_up_takes.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using test::MadeUpTakes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<ImportState> StatesOf(const MadeUpTakes& takes, ImportOptions options) {
  std::vector<ImportState> states;
  options.on_durable = [&](const ImportedTake& take) { states.push_back(take.state); };
  takes.Import(options);
  return states;
}

std::vector<std::string> FilesBelow(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

TEST(Import, GivesTheFeaturesThatTheFilesHave) {
  const MadeUpTakes takes;
  ImportOptions options = MadeUpTakes::Options();
  options.with_poses = true;
  const ImportReport report = takes.Import(options);
  EXPECT_EQ(report.added, 3);
  EXPECT_EQ(report.frames, 40 + 70 + 100);
  const TakeLibrary library(takes.library());
  ASSERT_THAT(library.takes(), SizeIs(3));
  const TakeBatch batch = test::LoadAll(library, options.features, 30);
  for (std::size_t i = 0; i < 3; ++i) {
    const TakeFeatures file = LoadTakeFeatures({takes.files()[i]}, options.features, 30, {});
    const StoredTake& stored = library.takes()[i];
    EXPECT_EQ(stored.path, fs::canonical(takes.files()[i]));
    EXPECT_EQ(stored.format, "ASF/AMC");
    EXPECT_EQ(stored.name.actor, "xx");
    EXPECT_EQ(stored.name.class_name, "wave");
    EXPECT_EQ(stored.rate_hz, 120);
    EXPECT_EQ(stored.frame_count, file.frame_count);
    EXPECT_EQ(batch.takes[i].features.columns, file.features.columns);
    EXPECT_EQ(batch.takes[i].frame_count, file.frame_count);
    // In place, and as many as in the file.
    EXPECT_EQ(library.Columns(stored, options.features.hash, 30).size(),
              file.features.columns.size());

    Diagnostics ignored;
    const JointTrajectories truth =
        ResampleTrajectories(StandardJoints(LoadRecording(takes.files()[i]), ignored), 30);
    const JointTrajectories played = library.Poses(stored, options.features.hash, 30);
    ASSERT_EQ(played.frame_count(), truth.frame_count());
    for (std::size_t j = 0; j < truth.positions_cm.size(); ++j) {
      EXPECT_LE((played.positions_cm[j] - truth.positions_cm[j]).cwiseAbs().maxCoeff(), 0.01);
    }
  }
}

TEST(Import, IsNoWorkTheSecondTime) {
  using enum ImportState;
  const MadeUpTakes takes;
  EXPECT_THAT(StatesOf(takes, MadeUpTakes::Options()), ElementsAre(kAdded, kAdded, kAdded));
  const auto files = FilesBelow(takes.library() / "segments");
  EXPECT_THAT(StatesOf(takes, MadeUpTakes::Options()),
              ElementsAre(kUnchanged, kUnchanged, kUnchanged));
  EXPECT_EQ(FilesBelow(takes.library() / "segments"), files);
}

// Of a take of version 1 nobody knows where it came from, until its file is imported again.
TEST(Import, NotesWhatVersion1DidNot) {
  const MadeUpTakes takes(1);
  takes.Import();
  const StoredTake noted = TakeLibrary(takes.library()).takes().front();
  {
    StoredTake of_version_1 = noted;
    of_version_1.skeleton = {};
    of_version_1.origin = {};
    internal::Catalogue catalogue(takes.library(), internal::SqliteDatabase::Access::kCreate);
    internal::SqliteTransaction transaction(catalogue.database(),
                                            internal::SqliteTransaction::Kind::kWrite);
    catalogue.PutTake(of_version_1);
    transaction.Commit();
  }
  EXPECT_EQ(takes.Import().updated, 1);
  const StoredTake again = TakeLibrary(takes.library()).takes().front();
  EXPECT_EQ(again.skeleton, noted.skeleton);
  EXPECT_EQ(again.origin.file_bytes, noted.origin.file_bytes);
  EXPECT_EQ(again.features, noted.features);
  EXPECT_EQ(takes.Import().unchanged, 1);
}

TEST(Import, ReadsAgainWhatChangedAndNothingElse) {
  using enum ImportState;
  const MadeUpTakes takes;
  takes.Import();
  test::WriteMadeUpTake(takes.files()[1], 77, 44);
  EXPECT_THAT(StatesOf(takes, MadeUpTakes::Options()),
              ElementsAre(kUnchanged, kUpdated, kUnchanged));
  EXPECT_EQ(TakeLibrary(takes.library()).takes()[1].frame_count, 44);

  // The skeleton is part of what a take is read from; so is how it is read.
  const fs::path skeleton = takes.folder() / "HDM_xx.asf";
  test::WriteText(skeleton, test::ReadText(skeleton) + "# changed\n");
  EXPECT_THAT(StatesOf(takes, MadeUpTakes::Options()), ElementsAre(kUpdated, kUpdated, kUpdated));
  ImportOptions slower = MadeUpTakes::Options();
  slower.load.source_rate_hz = 60;
  EXPECT_THAT(StatesOf(takes, slower), ElementsAre(kUpdated, kUpdated, kUpdated));
  // No segment is kept that no take needs: the first two are gone.
  EXPECT_THAT(FilesBelow(takes.library() / "segments"), SizeIs(1));
  EXPECT_THAT(VerifyLibrary(takes.library()).leftovers, IsEmpty());
}

TEST(Import, AddsPosesAndFurtherFeatureSetsToWhatIsThere) {
  using enum ImportState;
  const MadeUpTakes takes(2);
  takes.Import();
  ImportOptions options = MadeUpTakes::Options();
  options.with_poses = true;
  EXPECT_THAT(StatesOf(takes, options), ElementsAre(kUpdated, kUpdated));
  EXPECT_THAT(StatesOf(takes, MadeUpTakes::Options()), ElementsAre(kUnchanged, kUnchanged));
  options.features = LoadFeatureSet("paper");
  options.with_poses = false;
  EXPECT_THAT(StatesOf(takes, options), ElementsAre(kUpdated, kUpdated));
  EXPECT_THAT(StatesOf(takes, options), ElementsAre(kUnchanged, kUnchanged));
  const TakeLibrary library(takes.library());
  ASSERT_THAT(library.feature_sets(), SizeIs(2));
  EXPECT_EQ(library.feature_sets()[0].name, "bonn");
  EXPECT_EQ(library.feature_sets()[1].takes, 2);
  EXPECT_EQ(test::LoadAll(library, options.features, 30).takes[0].features.columns,
            LoadTakeFeatures({takes.files()[0]}, options.features, 30, {}).features.columns);
  EXPECT_TRUE(library.takes()[0].features[0].has_poses || library.takes()[0].features[1].has_poses);
}

TEST(Import, KeepsTheSameBytesUnderTwoNamesOnce) {
  const MadeUpTakes takes(1);
  takes.Import();
  const fs::path copy = takes.folder() / "HDM_xx_jump_009_120.amc";
  fs::copy_file(takes.files()[0], copy);
  ImportTakes(takes.library(), std::vector<ImportSource>{{.file = copy}}, MadeUpTakes::Options());
  EXPECT_THAT(FilesBelow(takes.library() / "segments"), SizeIs(1));
  const TakeLibrary library(takes.library());
  ASSERT_THAT(library.takes(), SizeIs(2));
  EXPECT_EQ(library.takes()[0].name.class_name, "jump");
  EXPECT_EQ(library.takes()[0].features, library.takes()[1].features);
  // And goes on to have it when the first is removed.
  RemoveTakes(takes.library(), {.names = {takes.files()[0]}});
  EXPECT_THAT(
      test::LoadAll(TakeLibrary(takes.library()), MadeUpTakes::Options().features, 30).failures,
      IsEmpty());
}

TEST(Import, KeepsTheSameBytesOfOneBatchOnce) {
  const MadeUpTakes takes(2);
  const fs::path copy = takes.folder() / "HDM_xx_jump_009_120.amc";
  const fs::path other = takes.folder() / "HDM_yy_jump_009_120.amc";
  fs::copy_file(takes.files()[0], copy);
  fs::copy_file(takes.files()[0], other);
  fs::copy_file(takes.folder() / "HDM_xx.asf", takes.folder() / "HDM_yy.asf");
  std::vector<ImportSource> sources = takes.Sources();
  sources.push_back({.file = copy});
  sources.push_back({.file = other});
  ImportOptions options = MadeUpTakes::Options();
  std::vector<std::size_t> heard;
  options.progress = [&](std::string_view, std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 4U);
    heard.push_back(done);
    return true;
  };
  EXPECT_EQ(ImportTakes(takes.library(), sources, options).added, 4);
  EXPECT_TRUE(std::ranges::is_sorted(heard));
  EXPECT_EQ(heard.back(), 4U);
  EXPECT_EQ(SegmentFile(takes.Segment(1)).reader().take_count(), 2);
  const TakeLibrary library(takes.library());
  const TakeBatch batch = test::LoadAll(library, options.features, 30);
  ASSERT_THAT(batch.takes, SizeIs(4));
  for (const TakeFeatures& take : batch.takes) {
    EXPECT_EQ(take.features.columns,
              LoadTakeFeatures({take.path}, options.features, 30, {}).features.columns);
  }
  EXPECT_EQ(library.takes()[0].name.class_name, "jump");
  EXPECT_EQ(library.takes()[3].name.actor, "yy");
  EXPECT_THAT(VerifyLibrary(takes.library()).damaged, IsEmpty());
}

TEST(Import, SharesNoDamagedFeatures) {
  const MadeUpTakes takes(1);
  takes.Import();
  test::Spoil(takes.Segment(1), 64 + 64 + 3);
  const fs::path copy = takes.folder() / "HDM_xx_jump_009_120.amc";
  fs::copy_file(takes.files()[0], copy);
  ImportTakes(takes.library(), std::vector<ImportSource>{{.file = copy}}, MadeUpTakes::Options());
  const VerifyReport report = VerifyLibrary(takes.library());
  ASSERT_THAT(report.damaged, SizeIs(1));
  EXPECT_EQ(report.damaged[0].path, fs::canonical(takes.files()[0]));
  EXPECT_THAT(
      test::LoadAll(TakeLibrary(takes.library()), MadeUpTakes::Options().features, 30).takes,
      SizeIs(1));
}

// AMC has no field for its rate: the same bytes under another name are another motion.
TEST(Import, KnowsThatNamesTellRates) {
  const MadeUpTakes takes(1);
  const std::string bytes = test::ReadText(takes.files()[0]);
  test::WriteText(takes.files()[0], bytes.substr(bytes.find(":FULLY-SPECIFIED")));
  takes.Import();
  const fs::path slower = takes.folder() / "HDM_xx_wave_001_060.amc";
  fs::copy_file(takes.files()[0], slower);
  ImportTakes(takes.library(), std::vector<ImportSource>{{.file = slower}}, MadeUpTakes::Options());
  const FeatureSet features = MadeUpTakes::Options().features;
  const TakeLibrary library(takes.library());
  ASSERT_THAT(library.takes(), SizeIs(2));
  EXPECT_EQ(library.takes()[0].rate_hz, 60);
  const TakeBatch batch = test::LoadAll(library, features, 30);
  ASSERT_THAT(batch.takes, SizeIs(2));
  for (const TakeFeatures& take : batch.takes) {
    EXPECT_EQ(take.features.columns,
              LoadTakeFeatures({take.path}, features, 30, {}).features.columns)
        << take.path;
  }
}

TEST(Import, GoesOnAfterABadFile) {
  const MadeUpTakes takes;
  test::WriteText(takes.files()[1], "no motion");
  const ImportReport report = takes.Import();
  EXPECT_EQ(report.added, 2);
  ASSERT_THAT(report.failures, SizeIs(1));
  EXPECT_EQ(report.failures[0].path, takes.files()[1]);
  EXPECT_THAT(TakeLibrary(takes.library()).takes(), SizeIs(2));
}

TEST(Import, TakesClassesAndActorsFromAList) {
  const MadeUpTakes takes(2);
  const fs::path list = takes.folder() / "clips.csv";
  test::WriteText(list, "file,class,actor\nHDM_xx_wave_001_120.amc,greet,bd\nnone.amc,greet,bd\n");
  std::vector<TakeFailure> failures;
  const auto sources = ListedSources(list, {}, failures);
  ASSERT_THAT(sources, SizeIs(1));
  ASSERT_THAT(failures, SizeIs(1));
  EXPECT_EQ(failures[0].error.place().line, 3);
  takes.Import();
  const ImportReport report = ImportTakes(takes.library(), sources, MadeUpTakes::Options());
  EXPECT_EQ(report.updated, 1);
  // Later imports without the list leave what it said, also of contents that change.
  test::WriteMadeUpTake(takes.files()[0], 5, 50);
  takes.Import();
  const TakeLibrary library(takes.library());
  EXPECT_EQ(library.takes()[0].name.class_name, "greet");
  EXPECT_EQ(library.takes()[0].name.actor, "bd");
  EXPECT_EQ(library.takes()[1].name.class_name, "wave");
}

TEST(Import, IsTheSameWhateverTheNumberOfThreads) {
  const MadeUpTakes takes(9);
  ImportOptions options = MadeUpTakes::Options();
  options.takes_per_batch = 4;
  takes.Import(options);
  std::map<std::string, std::string> one;
  for (int i = 1; i <= 3; ++i) one[takes.Segment(i)] = test::ReadText(takes.Segment(i));
  fs::remove_all(takes.library());
  options.threads = 4;
  takes.Import(options);
  for (const auto& [file, bytes] : one) EXPECT_EQ(test::ReadText(file), bytes) << file;
}

TEST(Import, CanBeCancelledAndKeepsWhatItReported) {
  const MadeUpTakes takes(6);
  ImportOptions options = MadeUpTakes::Options();
  options.takes_per_batch = 2;
  int reported = 0;
  options.on_durable = [&](const ImportedTake&) { ++reported; };
  options.progress = [](std::string_view, std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 6U);
    return done < 5;
  };
  EXPECT_EQ(test::ErrorOf([&] { takes.Import(options); }).code(), ErrorCode::kCancelled);
  EXPECT_EQ(reported, 4);
  EXPECT_THAT(TakeLibrary(takes.library()).takes(), SizeIs(4));
}

TEST(Import, LetsOthersReadAndNobodyElseWrite) {
  const MadeUpTakes takes(4);
  ImportOptions options = MadeUpTakes::Options();
  options.takes_per_batch = 2;
  int reported = 0;
  options.on_durable = [&](const ImportedTake& take) {
    ++reported;
    const TakeLibrary library(takes.library());
    EXPECT_THAT(library.takes(), SizeIs(reported <= 2 ? 2 : 4));
    EXPECT_TRUE(std::ranges::any_of(
        library.takes(), [&](const StoredTake& each) { return each.path == take.path; }));
    EXPECT_THAT(VerifyLibrary(takes.library()).damaged, IsEmpty());
    const Error error = test::ErrorOf([&] { takes.Import(); });
    EXPECT_EQ(error.code(), ErrorCode::kIoFailure);
    EXPECT_THAT(error.what(), HasSubstr("somebody else (process " + std::to_string(::getpid()) +
                                        ") is writing to this library"));
    EXPECT_THAT(test::ErrorOf([&] { RemoveTakes(takes.library(), {.names = {take.path}}); }).what(),
                HasSubstr("is writing to this library"));
  };
  takes.Import(options);
  EXPECT_EQ(reported, 4);
}

TEST(Import, RemovesWhatAnImportThatWasCutShortLeft) {
  const MadeUpTakes takes(1);
  takes.Import();
  test::WriteText(takes.library() / "segments" / "00000002.segment", "half of one");
  test::WriteText(takes.library() / "segments" / ".kinebase-1-0.tmp", "");
  test::WriteText(takes.library() / "segments" / "notes.txt", "of somebody");
  EXPECT_THAT(VerifyLibrary(takes.library()).leftovers, SizeIs(2));
  takes.Import();
  EXPECT_THAT(VerifyLibrary(takes.library()).leftovers, IsEmpty());
  EXPECT_THAT(FilesBelow(takes.library() / "segments"),
              testing::UnorderedElementsAre("00000001.segment", "notes.txt"));
}

TEST(Import, RefusesAFolderWithOtherThingsInIt) {
  const MadeUpTakes takes(1);
  const Error error =
      test::ErrorOf([&] { ImportTakes(takes.folder(), takes.Sources(), MadeUpTakes::Options()); });
  EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
  EXPECT_FALSE(fs::exists(takes.folder() / "segments"));
  EXPECT_EQ(test::ErrorOf([&] {
              ImportTakes(takes.files()[0], takes.Sources(), MadeUpTakes::Options());
            }).code(),
            ErrorCode::kIoFailure);
}

// Without their catalogue segments look like leftovers, and may be somebody's.
TEST(Import, KeepsSegmentsWhoseCatalogueIsGone) {
  const MadeUpTakes takes(1);
  takes.Import();
  const std::string bytes = test::ReadText(takes.Segment(1));
  const auto expect_refused = [&] {
    for (const auto& use : {std::function<void()>([&] { takes.Import(); }),
                            std::function<void()>([&] { (void)VerifyLibrary(takes.library()); }),
                            std::function<void()>([&] { TakeLibrary opened(takes.library()); })}) {
      const Error error = test::ErrorOf(use);
      EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
      EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("holds a file such as 00000001.segment"),
                                               HasSubstr("restore it from a copy")));
    }
    EXPECT_EQ(test::ReadText(takes.Segment(1)), bytes);
  };
  test::WriteText(takes.library() / "catalogue.sqlite", "");
  expect_refused();
  fs::remove(takes.library() / "catalogue.sqlite");
  expect_refused();
  EXPECT_FALSE(fs::exists(takes.library() / "catalogue.sqlite"));
}

TEST(Import, LeavesAStrangersFolderAsItIs) {
  const MadeUpTakes takes(1);
  test::WriteText(takes.library() / "segments" / "trip.segment", "of somebody");
  EXPECT_THAT(test::ErrorOf([&] { takes.Import(); }).what(), HasSubstr("such as trip.segment"));
  EXPECT_THAT(FilesBelow(takes.library()), ElementsAre("segments"));
  EXPECT_EQ(test::ReadText(takes.library() / "segments" / "trip.segment"), "of somebody");
}

// Takes that no file holds, made of one figure; counts how often they are.
class MadeSources {
 public:
  explicit MadeSources(const std::string& version) {
    for (unsigned i = 0; i < 3; ++i) {
      ImportSource source;
      source.file = "/nowhere/take_" + std::to_string(i);
      source.origin = version + ' ' + std::to_string(i);
      source.make = [this, i] {
        ++made_;
        Recording recording;
        recording.format = "made";
        recording.name.actor = "xx";
        recording.motion = test::SmoothMotion(test::FigureSkeleton(), i, 50, 120);
        return recording;
      };
      sources_.push_back(std::move(source));
    }
  }

  [[nodiscard]] const std::vector<ImportSource>& sources() const { return sources_; }
  [[nodiscard]] int made() const { return made_; }

 private:
  std::vector<ImportSource> sources_;
  std::atomic<int> made_ = 0;
};

TEST(Import, TakesWhatIsMadeInMemoryAsItTakesFiles) {
  const test::TemporaryFolder folder;
  const fs::path library = folder.path() / "library";
  const ImportOptions options = MadeUpTakes::Options();
  const MadeSources first("1");
  EXPECT_EQ(ImportTakes(library, first.sources(), options).added, 3);
  const TakeLibrary stored(library);
  ASSERT_THAT(stored.takes(), SizeIs(3));
  for (unsigned i = 0; i < 3; ++i) {
    const StoredTake& take = stored.takes()[i];
    EXPECT_EQ(take.path, "/nowhere/take_" + std::to_string(i));
    EXPECT_EQ(take.format, "made");
    EXPECT_EQ(take.name.actor, "xx");
    const FeatureMatrix truth = ExtractFeatures(
        StandardJoints(test::SmoothMotion(test::FigureSkeleton(), i, 50, 120)), options.features);
    EXPECT_TRUE(std::ranges::equal(stored.Columns(take, options.features.hash, 30), truth.columns));
  }
  // What has the same origin is not made again; another origin is other contents.
  const MadeSources again("1");
  EXPECT_EQ(ImportTakes(library, again.sources(), options).unchanged, 3);
  EXPECT_EQ(again.made(), 0);
  const MadeSources other("2");
  EXPECT_EQ(ImportTakes(library, other.sources(), options).updated, 3);
  EXPECT_EQ(other.made(), 3);
  EXPECT_THAT(VerifyLibrary(library).damaged, IsEmpty());
}

}  // namespace
}  // namespace kinebase
