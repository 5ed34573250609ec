#include "kinebase/library/takes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_editing.h"
#include "motion/figure.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Motion Smooth(unsigned seed, int frames) {
  return test::SmoothMotion(test::FigureSkeleton(), seed, frames, 120);
}

// A made-up take; several may share one skeleton.
fs::path WriteTake(const fs::path& path, unsigned seed = 1, int frames = 20) {
  Diagnostics ignored;
  const Motion motion = Smooth(seed, frames);
  test::WriteText(path, FormatAmc(ToAmc(motion, ignored)));
  return path;
}

void WriteSkeleton(const fs::path& path) { test::WriteText(path, FormatAsf(test::FigureAsf())); }

std::vector<std::string> NamesBelow(const fs::path& folder, const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const auto& file : files) names.push_back(file.lexically_relative(folder).generic_string());
  return names;
}

TEST(FindMotionFiles, SearchesFoldersAndSorts) {
  const test::TemporaryFolder folder;
  for (const char* name : {"b.amc", "a/z.AMC", "a/b/c.amc", "readme.txt", "b.asf", "amc"}) {
    test::WriteText(folder.path() / name, "x");
  }
  fs::create_directory(folder.path() / "empty.amc");
  const auto files = FindMotionFiles(std::vector{folder.path()});
  EXPECT_THAT(NamesBelow(folder.path(), files), ElementsAre("a/b/c.amc", "a/z.AMC", "b.amc"));
}

TEST(FindMotionFiles, TakesAFileOnceHoweverItIsNamed) {
  const test::TemporaryFolder folder;
  const fs::path& root = folder.path();
  test::WriteText(root / "a" / "x.amc", "x");
  test::WriteText(root / "y.amc", "x");
  fs::create_symlink(root / "y.amc", root / "a" / "link.amc");
  const auto files =
      FindMotionFiles(std::vector{root / "y.amc", root / "a", root / "a" / ".." / "y.amc", root});
  EXPECT_EQ(files.size(), 2);
  EXPECT_EQ(files.front(), root / "y.amc");
}

TEST(FindMotionFiles, SurvivesLinksThatGoRoundAndLinksThatLeadNowhere) {
  const test::TemporaryFolder folder;
  const fs::path& root = folder.path();
  test::WriteText(root / "a" / "x.amc", "x");
  fs::create_directory_symlink(root, root / "a" / "round");
  fs::create_directory_symlink(root / "a", root / "again");
  fs::create_symlink("loop.amc", root / "loop.amc");
  fs::create_symlink(root / "nowhere", root / "dangling.amc");
  EXPECT_EQ(FindMotionFiles(std::vector{root}).size(), 1);
}

TEST(FindMotionFiles, SaysWhichPathIsWrongAndWhatItLookedFor) {
  const test::TemporaryFolder folder;
  const fs::path& root = folder.path();
  test::WriteText(root / "x.txt", "x");
  fs::create_directory(root / "empty");
  fs::create_symlink("loop.amc", root / "loop.amc");
  const auto error = [](const fs::path& path) {
    return test::ErrorOf([&] { (void)FindMotionFiles(std::vector{path}); });
  };
  EXPECT_EQ(error(root / "none").code(), ErrorCode::kNotFound);
  EXPECT_EQ(error(root / "loop.amc").code(), ErrorCode::kNotFound);
  EXPECT_EQ(error(std::string(5000, 'a')).code(), ErrorCode::kNotFound);
  EXPECT_EQ(error("").code(), ErrorCode::kNotFound);
  EXPECT_EQ(error(root / "empty").code(), ErrorCode::kNotFound);
  EXPECT_THAT(error(root / "empty").what(), HasSubstr(".amc"));
  EXPECT_EQ(error(root / "x.txt").code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(error(root / "x.txt").what(), HasSubstr(".amc (ASF/AMC)"));
}

TEST(FindMotionFiles, GivesNothingForNothing) {
  EXPECT_THAT(FindMotionFiles(std::vector<fs::path>{}), IsEmpty());
}

TEST(TakeStretch, IsAFileOrSomeOfItsFrames) {
  const TakeStretch whole = ParseTakeStretch("a/take.amc");
  EXPECT_EQ(whole.file, "a/take.amc");
  EXPECT_EQ(whole.first_frame, 0);
  const TakeStretch some = ParseTakeStretch("a:b/take.amc:120-480");
  EXPECT_EQ(some.file, "a:b/take.amc");
  EXPECT_EQ(some.first_frame, 120);
  EXPECT_EQ(some.last_frame, 480);
  EXPECT_EQ(ParseTakeStretch("t.amc:7-7").last_frame, 7);
  for (const char* text : {"t.amc:7", "t.amc:", "t.amc:-7", "t.amc:7-", "t.amc:a-b", "t:1-2.amc",
                           "t.amc:1-99999999999999999999", "t.amc:1-2-3"}) {
    EXPECT_EQ(ParseTakeStretch(text).file, text);
    EXPECT_EQ(ParseTakeStretch(text).first_frame, 0);
  }
}

TEST(TakeStretch, RefusesRangesThatMakeNoSense) {
  for (const char* text : {"t.amc:0-5", "t.amc:6-5", "t.amc:0-0"}) {
    const Error error = test::ErrorOf([&] { (void)ParseTakeStretch(text); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr(text));
  }
}

TEST(TakeStretch, TakesAnExistingFileWholeWhateverItsName) {
  const test::TemporaryFolder folder;
  const std::string name = (folder.path() / "t.amc:1-2").string();
  test::WriteText(name, "x");
  EXPECT_EQ(ParseTakeStretch(name).file, name);
  EXPECT_EQ(ParseTakeStretch(name).first_frame, 0);
  EXPECT_EQ(ParseTakeStretch(std::string(5000, 'a') + ":1-2").last_frame, 2);
}

TEST(CutToStretch, CountsTheFirstStoredFrameAsOne) {
  Recording take{.motion = Smooth(1, 10)};
  take.motion.first_frame = 100;
  const Recording cut = CutToStretch(take, {"t.amc", 3, 5});
  EXPECT_EQ(cut.frame_count(), 3);
  EXPECT_EQ(cut.first_frame(), 102);
  EXPECT_EQ(CutToStretch(take, {"t.amc"}).frame_count(), 10);
  const Error error = test::ErrorOf([&] { (void)CutToStretch(take, {"t.amc", 3, 11}); });
  EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
  EXPECT_STREQ(error.what(), "t.amc: frames 3 to 11 are asked for; it has 1 to 10");
}

TEST(LoadTakeFeatures, AreThoseOfTheStretch) {
  const test::TemporaryFolder folder;
  WriteSkeleton(folder.path() / "HDM_xx.asf");
  const fs::path path = WriteTake(folder.path() / "HDM_xx_wave_001_120.amc", 4, 50);
  const FeatureSet set = LoadFeatureSet("bonn");
  const TakeFeatures whole = LoadTakeFeatures({path}, set, 30, {});
  EXPECT_EQ(whole.path, path);
  EXPECT_EQ(whole.name.class_name, "wave");
  EXPECT_EQ(whole.rate_hz, 120);
  EXPECT_EQ(whole.frame_count, 50);
  EXPECT_EQ(whole.features.column_count(), 13);
  const Motion motion = LoadRecording(path).motion;
  EXPECT_EQ(whole.features.columns, ExtractFeatures(StandardJoints(motion), set).columns);
  const TakeFeatures part = LoadTakeFeatures({path, 11, 30}, set, 30, {});
  EXPECT_EQ(part.frame_count, 20);
  EXPECT_EQ(part.features.columns,
            ExtractFeatures(StandardJoints(CutMotion(motion, 10, 29)), set).columns);
}

// Takes 0 … 11 of which 3 is cut to nothing, 6 does not exist and 9 has a name too long to exist.
std::vector<TakeStretch> MixedTakes(const fs::path& folder) {
  WriteSkeleton(folder / "take.asf");
  std::vector<TakeStretch> stretches;
  for (unsigned i = 0; i < 12; ++i) {
    const fs::path path = folder / ("take_" + std::to_string(i) + ".amc");
    if (i != 6) WriteTake(path, i, 20 + static_cast<int>(i));
    stretches.push_back({path});
  }
  test::WriteText(stretches[3].file, "1\nroot\n");
  stretches[9].file = folder / (std::string(5000, 'x') + ".amc");
  return stretches;
}

TEST(LoadManyTakeFeatures, GoesOnAfterABadFile) {
  const test::TemporaryFolder folder;
  const auto stretches = MixedTakes(folder.path());
  const FeatureSet set = LoadFeatureSet("bonn");
  for (const int threads : {1, 4}) {
    const TakeBatch batch = LoadManyTakeFeatures(stretches, set, 30, {}, threads, {});
    ASSERT_EQ(batch.takes.size(), 9);
    ASSERT_EQ(batch.failures.size(), 3);
    EXPECT_EQ(batch.failures[0].path, stretches[3].file);
    EXPECT_EQ(batch.failures[0].error.code(), ErrorCode::kMalformedFile);
    EXPECT_EQ(batch.failures[1].error.code(), ErrorCode::kNotFound);
    EXPECT_EQ(batch.failures[2].path, stretches[9].file);
    EXPECT_TRUE(std::ranges::is_sorted(batch.takes, {}, &TakeFeatures::frame_count));
  }
}

TEST(LoadManyTakeFeatures, GivesTheSameWhateverTheNumberOfThreads) {
  const test::TemporaryFolder folder;
  const auto stretches = MixedTakes(folder.path());
  const FeatureSet set = LoadFeatureSet("paper");
  const TakeBatch one = LoadManyTakeFeatures(stretches, set, 30, {}, 1, {});
  const TakeBatch four = LoadManyTakeFeatures(stretches, set, 30, {}, 4, {});
  ASSERT_EQ(one.takes.size(), four.takes.size());
  for (std::size_t i = 0; i < one.takes.size(); ++i) {
    EXPECT_EQ(one.takes[i].path, four.takes[i].path);
    EXPECT_EQ(one.takes[i].features.columns, four.takes[i].features.columns);
    EXPECT_EQ(one.takes[i].diagnostics, four.takes[i].diagnostics);
  }
  for (std::size_t i = 0; i < one.failures.size(); ++i) {
    EXPECT_STREQ(one.failures[i].error.what(), four.failures[i].error.what());
  }
}

TEST(LoadManyTakeFeatures, ReportsProgressItemByItem) {
  const test::TemporaryFolder folder;
  const auto stretches = MixedTakes(folder.path());
  std::vector<std::size_t> done;
  (void)LoadManyTakeFeatures(stretches, LoadFeatureSet("bonn"), 30, {}, 4,
                             [&](std::string_view, std::size_t now, std::size_t total) {
                               EXPECT_EQ(total, stretches.size());
                               done.push_back(now);
                               return true;
                             });
  ASSERT_EQ(done.size(), stretches.size());
  for (std::size_t i = 0; i < done.size(); ++i) EXPECT_EQ(done[i], i + 1);
}

TEST(LoadManyTakeFeatures, CanBeCancelled) {
  const test::TemporaryFolder folder;
  const auto stretches = MixedTakes(folder.path());
  for (const int threads : {1, 4}) {
    std::size_t calls = 0;
    const Error error = test::ErrorOf([&] {
      (void)LoadManyTakeFeatures(stretches, LoadFeatureSet("bonn"), 30, {}, threads,
                                 [&](std::string_view, std::size_t done, std::size_t) {
                                   ++calls;
                                   return done < 2;
                                 });
    });
    EXPECT_EQ(error.code(), ErrorCode::kCancelled);
    EXPECT_LE(calls, 2 + static_cast<std::size_t>(threads));
  }
}

TEST(LoadManyTakeFeatures, GivesNothingForNothing) {
  const TakeBatch batch = LoadManyTakeFeatures({}, LoadFeatureSet("bonn"), 30, {}, 4, {});
  EXPECT_THAT(batch.takes, IsEmpty());
  EXPECT_THAT(batch.failures, IsEmpty());
}

// A list of clips beside two of them; the third is in a folder of its own.
class ClipList : public testing::Test {
 protected:
  ClipList() {
    test::WriteText(list_,
                    "file,class,actor\nx/a.amc,wave,bd\nb.amc,wave,tr\nc.amc,jump,tr\n"
                    "d.amc,lost,tr\n");
    for (const char* name : {"clips/deep/a.amc", "clips/b.amc", "more/c.amc", "more/a.amc"}) {
      test::WriteText(folder_.path() / name, "x");
    }
  }

  std::vector<std::string> Clips(const std::string& class_name,
                                 const std::vector<std::string>& actors = {},
                                 const std::vector<fs::path>& folders = {}) {
    std::vector<fs::path> files;
    for (const auto& clip : ClipsOfClass(list_, class_name, actors, folders)) {
      EXPECT_EQ(clip.first_frame, 0);
      files.push_back(clip.file);
    }
    return NamesBelow(folder_.path(), files);
  }

  Error Refusal(const std::string& class_name, const std::vector<std::string>& actors = {}) {
    return test::ErrorOf([&] { (void)Clips(class_name, actors); });
  }

  test::TemporaryFolder folder_;
  fs::path list_ = folder_.path() / "clips" / "list.csv";
};

TEST_F(ClipList, GivesTheClipsOfAClassAndOfSomeActors) {
  EXPECT_THAT(Clips("wave"), ElementsAre("clips/deep/a.amc", "clips/b.amc"));
  EXPECT_THAT(Clips("wave", {"tr"}), ElementsAre("clips/b.amc"));
  EXPECT_THAT(Clips("wave", {"tr", "bd"}), ElementsAre("clips/deep/a.amc", "clips/b.amc"));
}

TEST_F(ClipList, LooksInFurtherFoldersAfterItsOwn) {
  const std::vector<fs::path> more = {folder_.path() / "more"};
  EXPECT_THAT(Clips("jump", {}, more), ElementsAre("more/c.amc"));
  EXPECT_THAT(Clips("wave", {"bd"}, more), ElementsAre("clips/deep/a.amc"));
}

TEST_F(ClipList, NamesAFileThatIsNowhere) {
  const Error error = Refusal("lost");
  EXPECT_EQ(error.code(), ErrorCode::kNotFound);
  EXPECT_EQ(error.place().file, list_);
  EXPECT_EQ(error.place().line, 5);
  EXPECT_THAT(error.what(), HasSubstr("'d.amc'"));
  EXPECT_THAT(error.what(), HasSubstr("--in"));
}

TEST_F(ClipList, NamesTheClassesThatThereAre) {
  const Error error = Refusal("walk");
  EXPECT_EQ(error.code(), ErrorCode::kNotFound);
  EXPECT_THAT(error.what(), HasSubstr("jump, lost, wave"));
  EXPECT_THAT(Refusal("wave", {"mm"}).what(), HasSubstr("mm"));
  // One actor who is there does not hide another who is not.
  EXPECT_THAT(Refusal("wave", {"bd", "mm"}).what(), HasSubstr("'mm'; there are: bd, tr"));
}

TEST_F(ClipList, RefusesAListThatIsNone) {
  test::WriteText(list_, "path,class\nb.amc,wave\n");
  EXPECT_EQ(Refusal("wave").code(), ErrorCode::kMalformedFile);
  test::WriteText(list_, "file,class\nb.amc\n");
  EXPECT_EQ(Refusal("wave").place().line, 2);
  test::WriteText(list_, "file,class\nb.amc,wave\n");
  EXPECT_THAT(Clips("wave"), ElementsAre("clips/b.amc"));
  EXPECT_THAT(Refusal("wave", {"tr"}).what(), HasSubstr("no column 'actor'"));
  fs::remove(list_);
  EXPECT_EQ(Refusal("wave").code(), ErrorCode::kNotFound);
}

}  // namespace
}  // namespace kinebase
