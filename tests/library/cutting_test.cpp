#include "kinebase/library/cutting.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>

#include "kinebase/motion/motion_file.h"
#include "library/counting_takes.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

// Files are at most so long while it lives: what writing meets on a full disk.
class ShortDisk {
 public:
  explicit ShortDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  ~ShortDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  ShortDisk(const ShortDisk&) = delete;
  ShortDisk& operator=(const ShortDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

// A folder with takes laid out as in HDM05.
class Cutting : public testing::Test {
 protected:
  [[nodiscard]] fs::path in() const { return folder_.path() / "in"; }
  [[nodiscard]] fs::path out() const { return folder_.path() / "out"; }
  [[nodiscard]] fs::path Amc(const std::string& stem) const {
    return in() / "HDM05" / "HDM05_amc" / "bd" / (stem + ".amc");
  }
  [[nodiscard]] fs::path C3d(const std::string& stem) const {
    return in() / "HDM05" / "HDM05_c3d" / "bd" / (stem + ".c3d");
  }

  void WriteTake(const std::string& stem, int frames) const {
    test::WriteCountingAmc(Amc(stem), frames);
    test::WriteCountingC3d(C3d(stem), frames);
    test::WriteText(Amc("x").parent_path() / "HDM_bd.asf", test::kUpperAsf);
  }

  static CutList List(std::string_view text) { return ParseCutList(text, "cuts.txt"); }

  [[nodiscard]] CutReport Cut(std::string_view text, CutOptions options = {}) const {
    if (options.in.empty()) options.in = in();
    if (options.out.empty()) options.out = out();
    return CutClips(List(text), options);
  }

  // Everything below a folder with its contents.
  static std::map<std::string, std::string> Contents(const fs::path& folder) {
    std::map<std::string, std::string> contents;
    if (!fs::exists(folder)) return contents;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      contents[fs::relative(entry.path(), folder)] =
          entry.is_regular_file() ? test::ReadText(entry.path()) : "";
    }
    return contents;
  }
  static std::vector<std::string> Names(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& [name, contents] : Contents(folder)) names.push_back(name);
    return names;
  }

  test::TemporaryFolder folder_;
};

// The frames that a clip shows, and whether its other values are those of the take.
void ExpectFrames(const fs::path& amc_file, std::int64_t first, std::int64_t last) {
  const AmcMotion clip = ReadAmc(amc_file);
  ASSERT_EQ(clip.frame_count(), last - first + 1) << amc_file;
  for (std::size_t i = 0; i < clip.frame_count(); ++i) {
    const auto frame = static_cast<double>(first) + static_cast<double>(i);
    EXPECT_THAT(clip.Frame(i),
                ElementsAre(0, frame, -1.27222e-014, 10, 20.25, 30, frame + .125, 0, .5));
    EXPECT_EQ(clip.frame_numbers[i], static_cast<std::int64_t>(i) + 1);
  }
}

void ExpectFramesOfC3d(const fs::path& file, std::int64_t first, std::int64_t last) {
  const C3dRecording clip = ReadC3d(file);
  ASSERT_EQ(clip.frame_count, last - first + 1) << file;
  for (std::size_t i = 0; i < clip.frame_count; ++i) {
    const auto frame = static_cast<float>(first) + static_cast<float>(i);
    EXPECT_EQ(clip.point(i, 0), (C3dPoint{frame, 1.5F, -2, 0}));
    EXPECT_EQ(clip.point(i, 1), (C3dPoint{-frame, .25F, 3, 1}));
    EXPECT_EQ(clip.analog[2 * i], frame);
    EXPECT_EQ(clip.analog[2 * i + 1], frame + .5F);
  }
}

struct DocumentedCut {
  std::string take;
  int first = 0;
  int last = 0;
  std::string clip;
};

const std::vector<DocumentedCut> kDocumentedCuts = {
    {"HDM_bd_01-05_02_120", 3506, 3907, "HDM_bd_staircaseUp3Rstart_001_120"},
    {"HDM_bd_01-05_03_120", 3673, 4116, "HDM_bd_staircaseUp3Rstart_002_120"},
    {"HDM_bd_01-05_04_120", 3573, 3953, "HDM_bd_staircaseUp3Rstart_003_120"},
    {"HDM_bd_01-05_05_120", 3558, 3913, "HDM_bd_staircaseUp3Rstart_004_120"},
    {"HDM_bd_01-06_01_120", 781, 1085, "HDM_bd_staircaseUp3Rstart_005_120"},
    {"HDM_bd_01-06_02_120", 781, 971, "HDM_bd_staircaseUp3Rstart_006_120"},
};

TEST_F(Cutting, MakesBothClipsOfEachLineOfTheDocumentedExample) {
  std::string text = "% motion class staircaseUp3Rstart\n";
  for (const auto& [take, first, last, clip] : kDocumentedCuts) {
    WriteTake(take, last + (first % 7));
    text += fmt::format("\"HDM05\\HDM05_amc\\bd\\{}.amc\"\t{}\t{}\t{}\n", take, first, last, clip);
  }
  const CutReport report = Cut(text);
  EXPECT_THAT(report.failures, IsEmpty());
  EXPECT_THAT(report.notes, IsEmpty());
  EXPECT_THAT(report.skeletons, ElementsAre(out() / "HDM_bd.asf"));
  ASSERT_EQ(report.clips.size(), 12);
  for (std::size_t i = 0; i < kDocumentedCuts.size(); ++i) {
    const auto& [take, first, last, name] = kDocumentedCuts[i];
    const CutClip& amc = report.clips[2 * i];
    const CutClip& c3d = report.clips[2 * i + 1];
    EXPECT_EQ(amc.file, out() / (name + ".amc"));
    EXPECT_EQ(c3d.file, out() / (name + ".c3d"));
    EXPECT_EQ(amc.source, Amc(take));
    EXPECT_EQ(c3d.source, C3d(take));
    EXPECT_EQ(amc.first_frame, first);
    EXPECT_EQ(amc.last_frame, last);
    EXPECT_EQ(amc.state, ClipState::kNew);
    ExpectFrames(amc.file, first, last);
    ExpectFramesOfC3d(c3d.file, first, last);
  }
  EXPECT_EQ(test::ReadText(out() / "HDM_bd.asf"), test::kUpperAsf);
  EXPECT_EQ(FindSkeleton(report.clips[0].file), out() / "HDM_bd.asf");
  EXPECT_THAT(Names(out()), SizeIs(13));
}

constexpr std::string_view kThreeCuts =
    "\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 5 9 HDM_bd_a_001_120\n"
    "\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 9 30 HDM_bd_a_002_120.amc\n"
    "\"HDM05\\HDM05_c3d\\bd\\HDM_bd_01-01_02_120.c3d\" 1 20 HDM_bd_b_001_120.C3D\n";

class ThreeCuts : public Cutting {
 protected:
  ThreeCuts() {
    WriteTake("HDM_bd_01-01_01_120", 30);
    WriteTake("HDM_bd_01-01_02_120", 20);
  }
};

TEST_F(ThreeCuts, DoNothingTheSecondTime) {
  (void)Cut(kThreeCuts);
  const auto before = Contents(out());
  std::map<std::string, fs::file_time_type> times;
  for (const std::string& name : Names(out())) times[name] = fs::last_write_time(out() / name);
  EXPECT_THAT(before, SizeIs(7));
  for (const auto overwrite : {Overwrite::kNo, Overwrite::kYes}) {
    const CutReport again = Cut(kThreeCuts, {.overwrite = overwrite});
    EXPECT_THAT(again.failures, IsEmpty());
    EXPECT_EQ(std::ranges::count(again.clips, ClipState::kUnchanged, &CutClip::state), 6);
    EXPECT_EQ(Contents(out()), before);
    for (const auto& [name, time] : times) EXPECT_EQ(fs::last_write_time(out() / name), time);
  }
}

TEST_F(ThreeCuts, SayWhereTheyComeFrom) {
  (void)Cut(kThreeCuts);
  EXPECT_THAT(ReadAmc(out() / "HDM_bd_a_002_120.amc").header,
              ElementsAre("#!made up",
                          "# cut from HDM05/HDM05_amc/bd/HDM_bd_01-01_01_120.amc frames 9-30 by "
                          "Kinebase",
                          ":FULLY-SPECIFIED", ":DEGREES"));
  const C3dRecording c3d = ReadC3d(out() / "HDM_bd_a_002_120.c3d");
  EXPECT_THAT(TextList(c3d, "KINEBASE", "SOURCE"),
              ElementsAre("HDM05/HDM05_c3d/bd/HDM_bd_01-01_01_120.c3d"));
  EXPECT_THAT(NumberList(c3d, "KINEBASE", "FIRST_FRAME"), ElementsAre(9));
  EXPECT_THAT(NumberList(c3d, "KINEBASE", "LAST_FRAME"), ElementsAre(30));
  // All that the take says beside is there still.
  EXPECT_THAT(TextList(c3d, "SUBJECTS", "NAMES"), ElementsAre("made up"));
  EXPECT_THAT(PointLabels(c3d), ElementsAre("LFHD", "RFHD"));
}

TEST_F(ThreeCuts, OfClipsSayBothOrigins) {
  (void)Cut(kThreeCuts);
  const CutReport report = Cut("\"HDM_bd_a_002_120.amc\" 2 3 HDM_bd_c_001_120\n",
                               {.in = out(), .out = folder_.path() / "again"});
  ASSERT_THAT(report.clips, SizeIs(2));
  ExpectFrames(report.clips[0].file, 10, 11);
  ExpectFramesOfC3d(report.clips[1].file, 10, 11);
  EXPECT_EQ(ReadAmc(report.clips[0].file).header[2],
            "# cut from HDM_bd_a_002_120.amc frames 2-3 by Kinebase");
  const C3dRecording c3d = ReadC3d(report.clips[1].file);
  EXPECT_THAT(TextList(c3d, "KINEBASE", "SOURCE"),
              ElementsAre("HDM05/HDM05_c3d/bd/HDM_bd_01-01_01_120.c3d", "HDM_bd_a_002_120.c3d"));
  EXPECT_THAT(NumberList(c3d, "KINEBASE", "FIRST_FRAME"), ElementsAre(9, 2));
  EXPECT_THAT(NumberList(c3d, "KINEBASE", "LAST_FRAME"), ElementsAre(30, 3));
}

TEST_F(ThreeCuts, AreMadeOfOneTypeOnRequest) {
  EXPECT_THAT(Cut(kThreeCuts, {.type = ClipType::kC3d}).clips, SizeIs(3));
  EXPECT_THAT(Names(out()),
              ElementsAre("HDM_bd_a_001_120.c3d", "HDM_bd_a_002_120.c3d", "HDM_bd_b_001_120.c3d"));
  EXPECT_THAT(Cut(kThreeCuts, {.type = ClipType::kAmc}).clips, SizeIs(3));
  EXPECT_THAT(Names(out()), SizeIs(7));
}

TEST_F(ThreeCuts, AreWhateverATakeHas) {
  fs::remove(C3d("HDM_bd_01-01_01_120"));
  fs::remove(Amc("HDM_bd_01-01_02_120"));
  const CutReport report = Cut(kThreeCuts);
  EXPECT_THAT(report.failures, IsEmpty());
  EXPECT_THAT(Names(out()), ElementsAre("HDM_bd.asf", "HDM_bd_a_001_120.amc",
                                        "HDM_bd_a_002_120.amc", "HDM_bd_b_001_120.c3d"));
  const CutReport strict = Cut(kThreeCuts, {.type = ClipType::kAmc});
  ASSERT_THAT(strict.failures, SizeIs(1));
  EXPECT_THAT(strict.failures[0].error.what(),
              AllOf(HasSubstr("cuts.txt:3: no take 'HDM05/HDM05_c3d/bd/HDM_bd_01-01_02_120'"),
                    HasSubstr("(.amc)")));
}

TEST_F(ThreeCuts, FindTheirTakesFromFoldersFurtherDown) {
  for (const fs::path& folder :
       {in() / "HDM05", in() / "HDM05" / "HDM05_amc", in() / "HDM05" / "HDM05_amc" / "bd"}) {
    SCOPED_TRACE(folder);
    const fs::path out = folder_.path() / folder.filename();
    const CutReport report = Cut(kThreeCuts, {.in = folder, .out = out});
    EXPECT_THAT(report.failures, IsEmpty());
    EXPECT_THAT(report.clips, SizeIs(folder.filename() == "HDM05" ? 6 : 3));
    ExpectFrames(out / "HDM_bd_b_001_120.amc", 1, 20);
  }
}

TEST_F(ThreeCuts, FindTheirTakesInAnyCase) {
  fs::rename(in() / "HDM05", in() / "hdm05");
  const fs::path folder = in() / "hdm05" / "HDM05_amc" / "bd";
  fs::rename(folder / "HDM_bd_01-01_01_120.amc", folder / "HDM_BD_01-01_01_120.AMC");
  const CutReport report = Cut(kThreeCuts);
  EXPECT_THAT(report.failures, IsEmpty());
  EXPECT_EQ(report.clips[0].source, folder / "HDM_BD_01-01_01_120.AMC");
  ExpectFrames(out() / "HDM_bd_a_001_120.amc", 5, 9);
}

TEST_F(ThreeCuts, FindBothFilesOfATakeInOneFolder) {
  test::WriteCountingAmc(in() / "t" / "wave.amc", 9);
  test::WriteCountingC3d(in() / "t" / "wave.c3d", 9);
  EXPECT_THAT(Cut("\"t\\wave\" 2 3 x\n").clips, SizeIs(2));
}

TEST_F(ThreeCuts, WriteNothingWhenTried) {
  const CutReport report = Cut(kThreeCuts, {.dry_run = true});
  EXPECT_THAT(report.clips, SizeIs(6));
  EXPECT_THAT(report.skeletons, SizeIs(1));
  EXPECT_FALSE(fs::exists(out()));
  // What is wrong is found all the same.
  EXPECT_THAT(
      Cut("\"HDM_bd_01-01_01_120\" 5 31 x\n", {.in = Amc("x").parent_path(), .dry_run = true})
          .failures,
      SizeIs(1));
}

TEST_F(ThreeCuts, DoNotTouchAnotherFileOfThatNameWithoutForce) {
  test::WriteText(out() / "HDM_bd_a_002_120.amc", "mine");
  const CutReport report = Cut(kThreeCuts);
  ASSERT_THAT(report.failures, SizeIs(1));
  EXPECT_EQ(report.failures[0].file, out() / "HDM_bd_a_002_120.amc");
  EXPECT_EQ(report.failures[0].error.code(), ErrorCode::kAlreadyExists);
  EXPECT_THAT(report.failures[0].error.what(), HasSubstr("--force"));
  EXPECT_EQ(test::ReadText(out() / "HDM_bd_a_002_120.amc"), "mine");
  EXPECT_THAT(report.clips, SizeIs(5));

  const CutReport forced = Cut(kThreeCuts, {.overwrite = Overwrite::kYes});
  EXPECT_THAT(forced.failures, IsEmpty());
  EXPECT_EQ(std::ranges::count(forced.clips, ClipState::kReplaced, &CutClip::state), 1);
  ExpectFrames(out() / "HDM_bd_a_002_120.amc", 9, 30);
}

TEST_F(ThreeCuts, StopForNothingThatIsWrongWithOthers) {
  const std::string text = std::string(kThreeCuts) +
                           "\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 20 31 too_long\n"
                           "\"HDM05\\HDM05_amc\\bd\\HDM_bd_09-09_09_120.amc\" 1 2 missing\n"
                           "\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 7 6 backwards\n"
                           "\"..\\secret.amc\" 1 2 up\n"
                           "\"HDM05\\HDM05_amc\\bd\\broken.amc\" 1 2 broken\n";
  test::WriteText(Amc("broken"), ":DEGREES\n1\nroot one\n");
  const auto sources = Contents(in());
  const CutReport report = Cut(text);
  EXPECT_THAT(report.clips, SizeIs(6));
  std::vector<std::string> messages;
  messages.reserve(report.failures.size());
  for (const CutFailure& failure : report.failures) messages.emplace_back(failure.error.what());
  EXPECT_THAT(messages,
              UnorderedElementsAre(
                  AllOf(HasSubstr("cuts.txt:4: frames 20 to 31"), HasSubstr(".amc has 1 to 30")),
                  AllOf(HasSubstr("cuts.txt:4: frames 20 to 31"), HasSubstr(".c3d has 1 to 30")),
                  AllOf(HasSubstr("cuts.txt:5: no take"), HasSubstr(".amc or .c3d")),
                  HasSubstr("cuts.txt:6: frames 7 to 6"), HasSubstr("cuts.txt:7: take '../secret'"),
                  HasSubstr("broken.amc:3: ")));
  EXPECT_EQ(Contents(in()), sources);
  EXPECT_THAT(Names(out()), SizeIs(7));
}

TEST_F(ThreeCuts, LoseNothingOnAFullDisk) {
  (void)Cut("\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 2 4 HDM_bd_a_002_120\n");
  const auto before = Contents(out());
  CutReport report;
  {
    // Room for the clips of a few frames, not for those of twenty: they need a block more.
    const ShortDisk disk(test::ReadText(out() / "HDM_bd_a_002_120.c3d").size());
    report = Cut(kThreeCuts, {.overwrite = Overwrite::kYes});
  }
  EXPECT_THAT(report.failures, testing::Not(IsEmpty()));
  for (const CutFailure& failure : report.failures) {
    EXPECT_EQ(failure.error.code(), ErrorCode::kIoFailure);
    EXPECT_THAT(failure.error.what(), HasSubstr("cannot write"));
    const std::string name = failure.file.filename();
    EXPECT_EQ(fs::exists(failure.file), before.contains(name));
    const bool is_as_before =
        !before.contains(name) || test::ReadText(failure.file) == before.at(name);
    EXPECT_TRUE(is_as_before) << name;
  }
  EXPECT_EQ(report.clips.size() + report.failures.size(), 6);
  for (const std::string& name : Names(out())) EXPECT_THAT(name, testing::Not(HasSubstr(".tmp")));
  EXPECT_THAT(Cut(kThreeCuts, {.overwrite = Overwrite::kYes}).failures, IsEmpty());
  ExpectFrames(out() / "HDM_bd_a_002_120.amc", 9, 30);
  ExpectFramesOfC3d(out() / "HDM_bd_b_001_120.c3d", 1, 20);
}

TEST_F(ThreeCuts, DoNotDependOnTheNumberOfThreads) {
  const CutReport one = Cut(kThreeCuts, {.out = folder_.path() / "one", .threads = 1});
  const CutReport four = Cut(kThreeCuts, {.out = folder_.path() / "four", .threads = 4});
  EXPECT_EQ(Contents(folder_.path() / "one"), Contents(folder_.path() / "four"));
  ASSERT_EQ(one.clips.size(), four.clips.size());
  for (std::size_t i = 0; i < one.clips.size(); ++i) {
    EXPECT_EQ(one.clips[i].source, four.clips[i].source);
    EXPECT_EQ(one.clips[i].file.filename(), four.clips[i].file.filename());
  }
}

TEST_F(ThreeCuts, ReportSourceBySourceAndCanBeCancelledAndGoOn) {
  std::vector<std::size_t> done;
  const auto cancel_at = [&](std::size_t stop) {
    return [&, stop](std::string_view, std::size_t now, std::size_t total) {
      EXPECT_EQ(total, 4);
      done.push_back(now);
      return now < stop;
    };
  };
  const Error error =
      test::ErrorOf([&] { (void)Cut(kThreeCuts, {.threads = 1, .progress = cancel_at(2)}); });
  EXPECT_EQ(error.code(), ErrorCode::kCancelled);
  EXPECT_THAT(done, ElementsAre(1, 2));
  const auto finished = Contents(out());
  EXPECT_THAT(finished, testing::Not(IsEmpty()));
  done.clear();
  const CutReport report = Cut(kThreeCuts, {.threads = 1, .progress = cancel_at(9)});
  EXPECT_THAT(done, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(report.failures, IsEmpty());
  EXPECT_GT(std::ranges::count(report.clips, ClipState::kUnchanged, &CutClip::state), 0);
  for (const auto& [name, contents] : finished) EXPECT_EQ(Contents(out()).at(name), contents);
}

TEST_F(ThreeCuts, RefuseTwoClipsOfOneNameUnlessTheyAreTheSame) {
  const std::string line = "\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 5 9 x\n";
  EXPECT_THAT(Cut(line + line).clips, SizeIs(2));
  const CutReport report =
      Cut(line + "\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 5 10 x.amc\n");
  ASSERT_THAT(report.failures, SizeIs(2));
  EXPECT_THAT(report.failures[0].error.what(),
              AllOf(HasSubstr("cuts.txt:2: "), HasSubstr("already that of cuts.txt:1")));
  ExpectFrames(out() / "x.amc", 5, 9);
}

TEST_F(ThreeCuts, NeverReplaceATake) {
  const auto before = Contents(in());
  const CutReport report = Cut(
      "\"HDM_bd_01-01_01_120\" 5 9 HDM_bd_01-01_01_120\n",
      {.in = Amc("x").parent_path(), .out = Amc("x").parent_path(), .overwrite = Overwrite::kYes});
  EXPECT_THAT(report.clips, IsEmpty());
  ASSERT_THAT(report.failures, SizeIs(1));
  EXPECT_THAT(report.failures[0].error.what(), HasSubstr("would replace a take"));
  EXPECT_EQ(Contents(in()), before);
}

TEST_F(ThreeCuts, DoNotLeaveTheirFolderThroughALink) {
  const fs::path elsewhere = folder_.path() / "elsewhere";
  fs::create_directories(elsewhere);
  fs::create_directories(out());
  fs::create_directory_symlink(elsewhere, out() / "link");
  test::WriteText(elsewhere / "precious.amc", "mine");
  fs::create_symlink(elsewhere / "precious.amc", out() / "x.amc");
  const CutReport report =
      Cut("\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 5 9 link\\y\n"
          "\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 5 9 x\n",
          {.type = ClipType::kAmc, .overwrite = Overwrite::kYes});
  EXPECT_THAT(report.clips, IsEmpty());
  ASSERT_THAT(report.failures, SizeIs(2));
  EXPECT_THAT(report.failures[0].error.what(), HasSubstr("leads out of"));
  EXPECT_EQ(test::ReadText(elsewhere / "precious.amc"), "mine");
  EXPECT_THAT(Names(elsewhere), ElementsAre("precious.amc"));
}

TEST_F(ThreeCuts, GoIntoFoldersThatTheirNamesTell) {
  const CutReport report =
      Cut("\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 5 9 walk\\HDM_bd_a_001_120\n");
  EXPECT_THAT(report.failures, IsEmpty());
  EXPECT_THAT(Names(out()), ElementsAre("walk", "walk/HDM_bd.asf", "walk/HDM_bd_a_001_120.amc",
                                        "walk/HDM_bd_a_001_120.c3d"));
}

TEST_F(ThreeCuts, KeepFullStopsInNames) {
  (void)Cut("\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 5 9 HDM_bd_v1.5\n");
  EXPECT_THAT(Names(out()), ElementsAre("HDM_bd.asf", "HDM_bd_v1.5.amc", "HDM_bd_v1.5.c3d"));
}

TEST_F(ThreeCuts, HaveASkeletonThatIsFoundWhateverTheirNames) {
  (void)Cut("\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-01_01_120.amc\" 5 9 wave\n");
  EXPECT_THAT(Names(out()), ElementsAre("wave.amc", "wave.asf", "wave.c3d"));
  const Recording recording = LoadRecording(out() / "wave.amc");
  EXPECT_EQ(recording.skeleton_path, out() / "wave.asf");
  EXPECT_EQ(recording.frame_count(), 5);
}

TEST_F(ThreeCuts, TellTheRateThatOnlyTheirTakesNameTold) {
  const fs::path take = in() / "t" / "HDM_bd_01-01_01_100.amc";
  test::WriteCountingAmc(take, 9);
  test::WriteText(in() / "t" / "HDM_bd.asf", test::kUpperAsf);
  (void)Cut(
      "\"t\\HDM_bd_01-01_01_100\" 5 9 wave\n\"t\\HDM_bd_01-01_01_100\" 5 9 HDM_bd_a_001_100\n");
  EXPECT_EQ(LoadRecording(take).rate_hz(), 100);
  EXPECT_EQ(LoadRecording(out() / "wave.amc").rate_hz(), 100);
  EXPECT_EQ(LoadRecording(out() / "HDM_bd_a_001_100.amc").rate_hz(), 100);
  EXPECT_THAT(test::ReadText(out() / "wave.amc"), HasSubstr("frames 5-9 at 100 Hz by Kinebase"));
}

// Two people of one name in two folders: neither skeleton may take the other's place.
TEST_F(ThreeCuts, DoNotMixUpSkeletonsOfOneName) {
  const std::string other = std::string(test::kUpperAsf) + "# another\n";
  test::WriteCountingAmc(in() / "b" / "HDM_bd_02-01_01_120.amc", 9);
  test::WriteText(in() / "b" / "HDM_bd.asf", other);
  const std::string text =
      std::string(kThreeCuts) + "\"b\\HDM_bd_02-01_01_120\" 5 9 HDM_bd_d_001_120\n";
  for (int run = 0; run < 2; ++run) {
    EXPECT_THAT(Cut(text).failures, IsEmpty());
    EXPECT_EQ(test::ReadText(out() / "HDM_bd.asf"), test::kUpperAsf);
    EXPECT_EQ(test::ReadText(out() / "HDM_bd_d_001_120.asf"), other);
    EXPECT_THAT(Names(out()), SizeIs(9));
  }
  EXPECT_EQ(FindSkeleton(out() / "HDM_bd_a_001_120.amc"), out() / "HDM_bd.asf");
  EXPECT_EQ(FindSkeleton(out() / "HDM_bd_d_001_120.amc"), out() / "HDM_bd_d_001_120.asf");
}

TEST_F(ThreeCuts, GoWithoutSkeletonWhereThereIsNoneAndSaySo) {
  fs::remove(Amc("x").parent_path() / "HDM_bd.asf");
  const CutReport report = Cut(kThreeCuts);
  EXPECT_THAT(report.failures, IsEmpty());
  EXPECT_THAT(report.clips, SizeIs(6));
  ASSERT_THAT(report.notes, SizeIs(2));  // One a take.
  EXPECT_EQ(report.notes[0].file, Amc("HDM_bd_01-01_01_120"));
  EXPECT_THAT(
      report.notes[0].diagnostic.message,
      AllOf(HasSubstr("without skeleton"), HasSubstr("HDM_bd.asf"), HasSubstr("--skeleton")));
}

TEST_F(ThreeCuts, TakeTheSkeletonThatIsNamed) {
  test::WriteText(folder_.path() / "other.asf", "any text");
  const CutReport report = Cut(kThreeCuts, {.skeleton = folder_.path() / "other.asf"});
  EXPECT_EQ(test::ReadText(out() / "HDM_bd_a_001_120.asf"), "any text");
  EXPECT_THAT(report.skeletons, SizeIs(3));
  EXPECT_EQ(test::ErrorOf([&] { (void)Cut(kThreeCuts, {.skeleton = "nowhere.asf"}); }).code(),
            ErrorCode::kNotFound);
}

TEST_F(ThreeCuts, PassOnWhatWasOddAboutATake) {
  test::WriteText(Amc("HDM_bd_01-01_02_120"), test::CountingAmc(25) + "26\r\nroot 1 2");
  const CutReport report = Cut(kThreeCuts);
  EXPECT_THAT(report.failures, IsEmpty());
  ASSERT_THAT(report.notes, SizeIs(1));
  EXPECT_EQ(report.notes[0].file, Amc("HDM_bd_01-01_02_120"));
  EXPECT_THAT(report.notes[0].diagnostic.message, HasSubstr("cut off"));
  const CutReport strict = Cut(kThreeCuts, {.out = folder_.path() / "strict", .strict = true});
  EXPECT_THAT(strict.failures, SizeIs(1));
}

TEST_F(ThreeCuts, NeedFoldersThatAreFolders) {
  test::WriteText(folder_.path() / "file", "");
  EXPECT_EQ(test::ErrorOf([&] { (void)Cut(kThreeCuts, {.in = "nowhere"}); }).code(),
            ErrorCode::kNotFound);
  EXPECT_EQ(test::ErrorOf([&] { (void)Cut(kThreeCuts, {.out = folder_.path() / "file"}); }).code(),
            ErrorCode::kIoFailure);
}

// People count from the first stored frame, the file goes on counting as the take does.
TEST_F(Cutting, CountsFromTheFirstStoredFrameOfAC3d) {
  C3dRecording take = test::CountingC3d(202, 2925);
  SetEvents(take, std::vector<C3dEvent>{{.time_s = 2933.0 / 120, .label = "inside"},
                                        {.time_s = 3000.0 / 120, .label = "outside"}});
  test::WriteText(in() / "wave.c3d", FormatC3d(take));
  const CutReport report = Cut("\"wave\" 10 12 x\n");
  ASSERT_THAT(report.failures, IsEmpty());
  ExpectFramesOfC3d(out() / "x.c3d", 10, 12);
  const C3dRecording clip = ReadC3d(out() / "x.c3d");
  EXPECT_EQ(clip.first_frame, 2934);
  ASSERT_THAT(Events(clip), SizeIs(1));  // Frame 2934 is at 2933 / 120 s.
  EXPECT_EQ(Events(clip)[0].label, "inside");
  EXPECT_NEAR(Events(clip)[0].time_s, 2933.0 / 120, 1e-5);
}

TEST_F(Cutting, MakesTheSegmentsOfARealTake) {
  KINEBASE_NEEDS_TEST_DATA();
  const fs::path folder = test::TestData("data/hdm05/take_c3d");
  const CsvTable segments = test::ReadCsv(folder / "HDM_bd_05-01_01_120.segments.csv");
  std::string text;
  for (std::size_t i = 0; i < segments.rows.size(); ++i) {
    text += fmt::format("\"HDM05\\HDM05_amc\\bd\\{}.amc\" {} {} segment_{}\n",
                        segments.rows[i][segments.Column("take")],
                        segments.rows[i][segments.Column("first_frame_1based")],
                        segments.rows[i][segments.Column("last_frame_1based")], i);
  }
  const CutReport report = Cut(text, {.in = folder});
  EXPECT_THAT(report.failures, IsEmpty());
  ASSERT_EQ(report.clips.size(), segments.rows.size());
  const C3dRecording take = ReadC3d(folder / "HDM_bd_05-01_01_120.c3d");
  for (const CutClip& clip : report.clips) {
    SCOPED_TRACE(clip.file);
    C3dRecording cut = ReadC3d(clip.file);
    ASSERT_EQ(cut.frame_count, clip.last_frame - clip.first_frame + 1);
    EXPECT_EQ(cut.first_frame, clip.first_frame);
    EXPECT_EQ(PointLabels(cut), PointLabels(take));
    const auto expected =
        std::span(take.points)
            .subspan((clip.first_frame - 1) * take.point_count, cut.frame_count * take.point_count);
    EXPECT_TRUE(std::ranges::equal(cut.points, expected));
    EXPECT_NEAR(LoadRecording(clip.file).duration_s(), static_cast<double>(cut.frame_count) / 120,
                1e-9);
  }
}

// The same frames of one take: markers and skeleton stay together, although one file counts its
// frames from 2925. Joints from markers depend on the performer's size, which is measured over all
// frames; the fifty of the clip are enough for a hundredth of a millimetre.
TEST_F(Cutting, KeepsTheTwoFilesOfATakeInStep) {
  KINEBASE_NEEDS_TEST_DATA();
  const fs::path folder = test::TestData("data/hdm05/amc_c3d_pair");
  const CutReport report =
      Cut("\"HDM05\\HDM05_c3d\\dg\\HDM_dg_06-03_03_120.c3d\" 101 150 HDM_dg_x_001_120\n",
          {.in = folder});
  EXPECT_THAT(report.failures, IsEmpty());
  ASSERT_THAT(report.clips, SizeIs(2));
  Diagnostics ignored;
  for (const CutClip& clip : report.clips) {
    SCOPED_TRACE(clip.file);
    const Recording cut = LoadRecording(clip.file);
    const Recording whole = LoadRecording(clip.source);
    ASSERT_EQ(cut.frame_count(), 50);
    const JointTrajectories expected = StandardJoints(whole, ignored);
    const JointTrajectories joints = StandardJoints(cut, ignored);
    for (int frame = 0; frame < 50; ++frame) {
      EXPECT_LT(
          (joints.at(frame, StandardJoint::kRoot) - expected.at(100 + frame, StandardJoint::kRoot))
              .norm(),
          cut.has_skeleton() ? 1e-6 : 1e-3);
    }
    if (cut.has_skeleton()) continue;
    const std::size_t skipped = 100 * whole.markers.labels.size();
    for (std::size_t i = 0; i < cut.markers.states.size(); ++i) {
      EXPECT_EQ(cut.markers.states[i], whole.markers.states[skipped + i]);
      if (cut.markers.states[i] == MarkerState::kMissing) continue;
      EXPECT_EQ(cut.markers.positions_cm[i], whole.markers.positions_cm[skipped + i]);
    }
  }
}

}  // namespace
}  // namespace kinebase
