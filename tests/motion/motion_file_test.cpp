#include "kinebase/motion/motion_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"
#include "motion/figure.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view kFrames = "1\nroot 0 0 0 0 0 0\n2\nroot 0 0 0 0 0 0\n";

std::string FigureText() { return FormatAsf(test::FigureAsf()); }

struct NamedTake {
  const char* file;
  const char* actor;
  const char* class_name;
  const char* take;
  double rate_hz;
};

TEST(TakeName, SaysWhatTheConventionsSay) {
  for (const NamedTake& expected :
       {NamedTake{"HDM_bd_03-02_01_120.amc", "bd", "", "03-02_01", 120},
        NamedTake{"a/b/HDM_mm_squat1Reps_013_120.AMC", "mm", "squat1Reps", "013", 120},
        NamedTake{"HDM_tr_01-01_01_60.c3d", "tr", "", "01-01_01", 60},
        NamedTake{"HDM_tr_05-01_02.amc", "tr", "", "05-01_02", 0},
        NamedTake{"05_01.amc", "05", "", "01", 120},
        NamedTake{"131_04_FORCE-ALL-JOINTS-BE-3DOF.amc", "131", "", "04", 120},
        NamedTake{"HDM_tr_jump_001_99999999.amc", "tr", "jump", "001", 0},
        NamedTake{"HDM_tr_jump_001_fast.amc", "tr", "jump", "001", 0},
        NamedTake{"backflip.amc", "", "", "", 0}, NamedTake{"my_own_take.amc", "", "", "", 0},
        NamedTake{"_.amc", "", "", "", 0}, NamedTake{"", "", "", "", 0},
        NamedTake{"05_x.amc", "", "", "", 0}}) {
    const TakeName name = ParseTakeName(expected.file);
    EXPECT_EQ(name.actor, expected.actor) << expected.file;
    EXPECT_EQ(name.class_name, expected.class_name) << expected.file;
    EXPECT_EQ(name.take, expected.take) << expected.file;
    EXPECT_EQ(name.rate_hz, expected.rate_hz) << expected.file;
  }
}

// Whether the skeleton at `skeleton` is found for the motion at `motion`, both below a new folder.
bool IsFound(const fs::path& skeleton, const fs::path& motion) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / skeleton, "x");
  fs::create_directories((folder.path() / motion).parent_path());
  try {
    EXPECT_EQ(FindSkeleton(folder.path() / motion), folder.path() / skeleton);
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kNotFound);
    return false;
  }
}

TEST(FindSkeleton, LooksForTheStemAndItsPrefixes) {
  EXPECT_TRUE(IsFound("HDM_tr.asf", "HDM_tr_05-01_01_120.amc"));
  EXPECT_TRUE(IsFound("05.asf", "05_01.amc"));
  EXPECT_TRUE(IsFound("take.asf", "take.amc"));
  EXPECT_TRUE(IsFound("take.ASF", "take.amc"));
  EXPECT_FALSE(IsFound("HDM_t.asf", "HDM_tr_05-01_01_120.amc"));
  EXPECT_FALSE(IsFound("HDM_bd.asf", "HDM_tr_05-01_01_120.amc"));
  EXPECT_FALSE(IsFound("0.asf", "05_01.amc"));
}

TEST(FindSkeleton, LooksUpToThreeFoldersFurtherUp) {
  EXPECT_TRUE(IsFound("a.asf", "1/a.amc"));
  EXPECT_TRUE(IsFound("a.asf", "1/2/3/a.amc"));
  EXPECT_FALSE(IsFound("a.asf", "1/2/3/4/a.amc"));
  EXPECT_TRUE(IsFound("asf/a.asf", "a.amc"));
  EXPECT_TRUE(IsFound("skeletons/a.asf", "1/2/3/a.amc"));
  EXPECT_FALSE(IsFound("asf/a.asf", "1/2/3/4/a.amc"));
  EXPECT_FALSE(IsFound("other/a.asf", "a.amc"));
}

TEST(FindSkeleton, PrefersTheNearestAndThenTheLongestName) {
  const test::TemporaryFolder folder;
  const fs::path take = folder.path() / "takes" / "HDM_tr_jump_001_120.amc";
  for (const char* name : {"HDM_tr_jump_001_120.asf", "takes/HDM.asf", "takes/HDM_tr.asf"}) {
    test::WriteText(folder.path() / name, "x");
  }
  EXPECT_EQ(FindSkeleton(take).filename(), "HDM_tr.asf");
  test::WriteText(folder.path() / "takes" / "HDM_tr_jump_001_120.asf", "x");
  EXPECT_EQ(FindSkeleton(take), folder.path() / "takes" / "HDM_tr_jump_001_120.asf");
}

TEST(FindSkeleton, NamesWhatItLookedForAndTheOption) {
  const test::TemporaryFolder folder;
  const Error error = test::ErrorOf([&] { (void)FindSkeleton(folder.path() / "05_01.amc"); });
  EXPECT_EQ(error.code(), ErrorCode::kNotFound);
  EXPECT_THAT(error.what(), HasSubstr("05_01.asf, 05.asf"));
  EXPECT_THAT(error.what(), HasSubstr("--skeleton"));
  EXPECT_EQ(test::ErrorOf([] { (void)FindSkeleton(""); }).code(), ErrorCode::kNotFound);
}

// A take of the made-up figure.
struct Take {
  Take(const char* name, std::string_view header, std::string_view frames = kFrames)
      : path(folder.path() / name) {
    test::WriteText(path, std::string(header) + std::string(frames));
    test::WriteText(folder.path() / "figure.asf", FigureText());
    options.skeleton = folder.path() / "figure.asf";
  }

  test::TemporaryFolder folder;
  fs::path path;
  LoadOptions options;
};

double RateOf(const char* name, std::string_view header, double source_rate_hz = 0) {
  Take take(name, header);
  take.options.source_rate_hz = source_rate_hz;
  return LoadRecording(take.path, take.options).motion.rate_hz;
}

TEST(LoadRecording, TakesTheRateFromOptionCommentNameOrDefault) {
  EXPECT_EQ(RateOf("HDM_tr_jump_001_60.amc", ""), 60);
  EXPECT_EQ(RateOf("05_01.amc", ""), 120);
  EXPECT_EQ(RateOf("jump.amc", ""), 120);
  EXPECT_EQ(RateOf("jump.amc", "", 25), 25);
  EXPECT_EQ(RateOf("HDM_tr_jump_001_60.amc", "", 25), 25);
  EXPECT_EQ(RateOf("jump.amc", "# exported at 59.94 fps\n"), 59.94);
  EXPECT_EQ(RateOf("jump.amc", "#Frame Rate: 30\n"), 30);
  EXPECT_EQ(RateOf("jump.amc", "# take 7, 3 people, 60HZ.\n"), 60);
  EXPECT_EQ(RateOf("jump.amc", "# rate=240\n", 25), 25);
}

TEST(LoadRecording, RefusesRatesThatNoRecordingHas) {
  for (const double rate_hz : {1e-3, -30.0, 1e300}) {
    EXPECT_EQ(test::ErrorOf([&] { (void)RateOf("jump.amc", "", rate_hz); }).code(),
              ErrorCode::kInvalidArgument);
  }
}

TEST(LoadRecording, DoesNotBelieveEveryRateOfAComment) {
  for (const char* comment : {"# 0 fps\n", "# 0.0000001 fps\n", "# 99999999999999999999 hz\n",
                              "# separate 30 people\n", "# rate: unknown\n", ":rate 30\n"}) {
    EXPECT_EQ(RateOf("jump.amc", comment), 120) << comment;
  }
}

TEST(LoadRecording, FindsTheRateInALongComment) {
  for (const char* filler : {" ", "x", "7", "fps ", "rate:"}) {
    std::string comment = "# ";
    for (int i = 0; i < 50'000; ++i) comment += filler;
    EXPECT_EQ(RateOf("jump.amc", comment + " frame_rate : 30.\n"), 30) << filler;
  }
}

TEST(LoadRecording, SaysWhenTheRateIsAGuess) {
  const Take guess("jump.amc", "");
  const auto guessed = LoadRecording(guess.path, guess.options).diagnostics;
  ASSERT_EQ(guessed.size(), 2);  // The other: bones without values.
  EXPECT_THAT(guessed[0].message + guessed[1].message, HasSubstr("--source-rate"));
  const Take named("HDM_tr_jump_001_120.amc", "");
  EXPECT_EQ(LoadRecording(named.path, named.options).diagnostics.size(), 1);
}

TEST(LoadRecording, SaysWhatItRead) {
  const Take take("HDM_tr_jump_001_120.amc", ":DEGREES\n", "7\nroot 0 1 0 0 0 0\n");
  const Recording loaded = LoadRecording(take.path, take.options);
  EXPECT_EQ(loaded.format, "ASF/AMC");
  EXPECT_EQ(loaded.skeleton_path, take.options.skeleton);
  EXPECT_EQ(loaded.name.class_name, "jump");
  EXPECT_EQ(loaded.units, "inch / 0.45");
  EXPECT_EQ(loaded.up_axis, "Y");
  EXPECT_EQ(loaded.motion.first_frame, 7);
  EXPECT_EQ(loaded.motion.frame_count, 1);
}

TEST(LoadRecording, RefusesACutOffFileWhenStrict) {
  Take take("jump.amc", "", "1\nroot 0 0 0 0 0 0\n2\nroot 0 0");
  EXPECT_EQ(LoadRecording(take.path, take.options).motion.frame_count, 1);
  take.options.strict = true;
  EXPECT_EQ(test::ErrorOf([&] { (void)LoadRecording(take.path, take.options); }).code(),
            ErrorCode::kMalformedFile);
}

TEST(LoadRecording, NamesTheFileThatIsToBlame) {
  const Take bad_motion("jump.amc", "", "1\nroot 0\n");
  const Error motion =
      test::ErrorOf([&] { (void)LoadRecording(bad_motion.path, bad_motion.options); });
  EXPECT_EQ(motion.place().file, bad_motion.path);
  EXPECT_EQ(motion.place().line, 2);
  const Take take("jump.amc", "");
  test::WriteText(take.options.skeleton, "nothing");
  const Error skeleton = test::ErrorOf([&] { (void)LoadRecording(take.path, take.options); });
  EXPECT_EQ(skeleton.place().file, take.options.skeleton);
  EXPECT_EQ(skeleton.place().line, 1);
}

TEST(LoadRecording, RefusesWhatItCannotRead) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "take.xyz", "x");
  test::WriteText(folder.path() / "alone.amc", kFrames);
  fs::create_directory(folder.path() / "folder.amc");
  fs::create_symlink("loop.amc", folder.path() / "loop.amc");
  const auto code = [&](const fs::path& path) {
    return test::ErrorOf([&] { (void)LoadRecording(path); }).code();
  };
  EXPECT_EQ(code(folder.path() / "none.amc"), ErrorCode::kNotFound);
  EXPECT_EQ(code(""), ErrorCode::kNotFound);
  EXPECT_EQ(code(folder.path() / "take.xyz"), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code(folder.path() / "alone.amc"), ErrorCode::kNotFound);
  EXPECT_EQ(code(folder.path() / "folder.amc"), ErrorCode::kIoFailure);
  EXPECT_EQ(code(folder.path() / "loop.amc"), ErrorCode::kNotFound);
  EXPECT_EQ(code(std::string(5000, 'a') + ".amc"), ErrorCode::kNotFound);
}

TEST(SaveRecording, WritesWhatLoadRecordingReads) {
  const test::TemporaryFolder folder;
  const Recording recording{.motion = test::SmoothMotion(test::FigureSkeleton(), 3, 12, 120)};
  Diagnostics diagnostics;
  const fs::path path = folder.path() / "new" / "HDM_xx_made_001_120.amc";
  SaveRecording(recording, path, {}, diagnostics);
  EXPECT_THAT(diagnostics, IsEmpty());
  const Recording loaded = LoadRecording(path, {.strict = true});
  EXPECT_LE(
      test::LargestDistance(ForwardKinematics(loaded.motion), ForwardKinematics(recording.motion)),
      1e-9);
  EXPECT_EQ(loaded.skeleton_path, folder.path() / "new" / "HDM_xx_made_001_120.asf");
  EXPECT_EQ(test::ErrorOf([&] { SaveRecording(recording, path, {}, diagnostics); }).code(),
            ErrorCode::kAlreadyExists);
  SaveRecording(recording, path, {.overwrite = Overwrite::kYes}, diagnostics);
  EXPECT_EQ(test::ErrorOf([&] {
              SaveRecording(recording, folder.path() / "a.xyz", {}, diagnostics);
            }).code(),
            ErrorCode::kInvalidArgument);
}

TEST(SaveRecording, KeepsTheRate) {
  const test::TemporaryFolder folder;
  const Recording recording{.motion = test::SmoothMotion(test::FigureSkeleton(), 3, 12, 59.94)};
  Diagnostics diagnostics;
  SaveRecording(recording, folder.path() / "made.amc", {}, diagnostics);
  EXPECT_EQ(LoadRecording(folder.path() / "made.amc").motion.rate_hz, 59.94);
}

TEST(SaveRecording, KeepsTheRateOfARecordWhoseNewNameDoesNotTellIt) {
  const test::TemporaryFolder folder;
  const Recording recording{.motion = test::SmoothMotion(test::FigureSkeleton(), 3, 12, 60)};
  Diagnostics diagnostics;
  const AcclaimRecord record{.asf = ToAsf(*recording.motion.skeleton),
                             .amc = {ToAmc(recording.motion, diagnostics)}};
  test::WriteText(folder.path() / "a_b_60.asf", FormatAsf(record.asf));
  AmcMotion amc = record.amc;
  amc.header = {":DEGREES"};
  test::WriteText(folder.path() / "HDM_a_b_1_60.amc", FormatAmc(amc));
  const Recording named =
      LoadRecording(folder.path() / "HDM_a_b_1_60.amc", {.skeleton = folder.path() / "a_b_60.asf"});
  ASSERT_EQ(named.rate_hz(), 60);
  SaveRecording(named, folder.path() / "other.amc", {}, diagnostics);
  EXPECT_EQ(LoadRecording(folder.path() / "other.amc").rate_hz(), 60);
  SaveRecording(named, folder.path() / "HDM_a_b_2_60.amc", {}, diagnostics);
  EXPECT_EQ(test::ReadText(folder.path() / "HDM_a_b_2_60.amc"),
            test::ReadText(folder.path() / "HDM_a_b_1_60.amc"));
}

TEST(MotionFormats, AreFoundByExtensionInAnyCase) {
  EXPECT_EQ(FindMotionFormat("a.AmC"), &MotionFormats().front());
  EXPECT_EQ(FindMotionFormat("amc"), nullptr);
  EXPECT_EQ(FindMotionFormat(".amc"), nullptr);
  EXPECT_EQ(FindMotionFormat(""), nullptr);
}

}  // namespace
}  // namespace kinebase
