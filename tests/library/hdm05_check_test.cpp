#include "kinebase/library/hdm05_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "kinebase/core/error.h"
#include "kinebase/formats/asf.h"
#include "kinebase/motion/motion_file.h"
#include "motion/figure.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr auto kAmc = Hdm05Format::kAmc;
constexpr auto kC3d = Hdm05Format::kC3d;

// A motion of so many frames; the check does not care which.
void WriteAmc(const fs::path& path, int frames) {
  std::string text = ":FULLY-SPECIFIED\n:DEGREES\n";
  for (int i = 1; i <= frames; ++i) text += std::to_string(i) + "\nroot 0 17 0 0 0 0\n";
  test::WriteText(path, text);
}

void WriteSkeleton(const fs::path& path) { test::WriteText(path, FormatAsf(test::FigureAsf())); }

// Files of one kind, by name.
std::vector<std::string> NamesOf(const Hdm05Report& report, Hdm05FindingKind kind) {
  std::vector<std::string> names;
  for (const Hdm05Finding* finding : report.FindingsOf(kind)) {
    names.push_back(finding->file.filename().string());
  }
  return names;
}

std::string MessageOf(const Hdm05Report& report, Hdm05FindingKind kind) {
  const auto findings = report.FindingsOf(kind);
  return findings.size() == 1 ? findings[0]->message : "";
}

const Hdm05ClassStatus& StatusOf(const Hdm05Report& report, std::string_view name) {
  for (const Hdm05ClassStatus& status : report.classes) {
    if (status.motion_class->name == name) return status;
  }
  throw std::out_of_range(std::string(name));
}

// Actor dg: two takes as documented, one too short, one broken, one that HDM05 does not have.
void WritePartialCopy(const fs::path& root) {
  const fs::path takes = root / "HDM05_amc" / "dg";
  WriteSkeleton(takes / "HDM_dg.asf");
  WriteAmc(takes / "HDM_dg_06-03_01_120.amc", 331);
  WriteAmc(takes / "HDM_dg_06-03_02_120.amc", 284);
  test::WriteText(takes / "HDM_dg_06-03_03_120.amc", "1\nroot\n");
  WriteAmc(takes / "HDM_dg_06-03_04_120.amc", 99);
  WriteAmc(takes / "HDM_dg_06-03_05_120.amc", 50);
  WriteAmc(takes / "other_01.amc", 50);
  test::WriteText(takes / "HDM_dg_06-03_01_120.amc.MAT", "x");
}

TEST(Hdm05Check, FindsWhatIsMissingExtraTooShortAndBroken) {
  const test::TemporaryFolder folder;
  WritePartialCopy(folder.path());
  const Hdm05Report report = CheckHdm05(folder.path());
  EXPECT_EQ(report.folder, folder.path());
  EXPECT_EQ(report.TakesFound(kAmc), 3);
  EXPECT_EQ(report.TakesFound(kAmc, "dg", 6), 3);
  EXPECT_EQ(report.TakesFound(kAmc, "dg", 7), 0);
  EXPECT_EQ(report.TakesFound(kAmc, "tr"), 0);
  EXPECT_EQ(report.TakesFound(kC3d), 0);
  EXPECT_EQ(report.readable_count, 4);                      // With the skeleton.
  EXPECT_THAT(report.MissingTakes(kAmc), SizeIs(326 - 4));  // The broken one is there.
  EXPECT_THAT(report.MissingTakes(kC3d), SizeIs(326));
  EXPECT_THAT(report.MissingSkeletons(), IsEmpty());

  EXPECT_THAT(NamesOf(report, Hdm05FindingKind::kWrongFrameCount),
              ElementsAre("HDM_dg_06-03_02_120.amc"));
  EXPECT_EQ(report.findings[1].expected_frames, 285);
  EXPECT_EQ(report.findings[1].found_frames, 284);
  EXPECT_EQ(MessageOf(report, Hdm05FindingKind::kWrongFrameCount), "284 frames; HDM05 has 285");
  EXPECT_THAT(NamesOf(report, Hdm05FindingKind::kUnreadable),
              ElementsAre("HDM_dg_06-03_03_120.amc"));
  EXPECT_THAT(MessageOf(report, Hdm05FindingKind::kUnreadable),
              HasSubstr("HDM_dg_06-03_03_120.amc:2"));
  EXPECT_THAT(NamesOf(report, Hdm05FindingKind::kExtra), ElementsAre("HDM_dg_06-03_05_120.amc"));
  EXPECT_THAT(report.findings, SizeIs(3));
  EXPECT_TRUE(report.HasFaults());
}

TEST(Hdm05Check, FindsNoFaultInACopyThatIsOnlyPartial) {
  const test::TemporaryFolder folder;
  WriteAmc(folder.path() / "HDM_dg_06-03_04_120.amc", 99);
  WriteAmc(folder.path() / "HDM_dg_squat1Reps_025_120.amc", 40);
  WriteAmc(folder.path() / "HDM_xx_squat1Reps_025_120.amc", 40);
  const Hdm05Report report = CheckHdm05(folder.path());
  EXPECT_FALSE(report.HasFaults());
  EXPECT_THAT(report.MissingSkeletons(), ElementsAre("dg"));
}

TEST(Hdm05Check, CannotJudgeLengthsThatAreNotDocumented) {
  const test::TemporaryFolder folder;
  WriteAmc(folder.path() / "HDM_mm_01-02_01_120.amc", 7);
  const Hdm05Report report = CheckHdm05(folder.path());
  EXPECT_EQ(report.TakesFound(kAmc, "mm", 1), 1);
  EXPECT_THAT(report.findings, IsEmpty());
}

TEST(Hdm05Check, KnowsClassesThatAreCompleteForAllOrForAnActor) {
  const test::TemporaryFolder folder;
  const fs::path clips = folder.path() / "HDM05_cut_amc";
  // Two of dg and one of tr are all that there are.
  for (const char* name : {"dg_cartwheelRHandStart1Reps_001", "dg_cartwheelRHandStart1Reps_002",
                           "tr_cartwheelRHandStart1Reps_003", "bd_jogRightCircle4StepsLstart_001",
                           "tr_cartwheelLHandStart2Reps_004"}) {
    WriteAmc(clips / (std::string("HDM_") + name + "_120.amc"), 30);
  }
  const Hdm05Report report = CheckHdm05(folder.path());
  const std::size_t dg = *Hdm05().FindActor("dg");
  const Hdm05ClassStatus& right = StatusOf(report, "cartwheelRHandStart1Reps");
  EXPECT_TRUE(right.complete(kAmc));
  EXPECT_FALSE(right.complete(kC3d));
  EXPECT_EQ(right.found(kAmc, dg), 2);
  const Hdm05ClassStatus& jog = StatusOf(report, "jogRightCircle4StepsLstart");
  EXPECT_FALSE(jog.complete(kAmc));
  EXPECT_EQ(jog.found(kAmc), 1);
  EXPECT_EQ(StatusOf(report, "cartwheelLHandStart2Reps").found(kAmc), 1);
  EXPECT_EQ(report.ClipsFound(kAmc), 5);
  EXPECT_EQ(report.ClipsFound(kAmc, dg), 2);
  const auto missing = report.MissingClips(kAmc);
  EXPECT_THAT(missing, SizeIs(2343 - 5));
  EXPECT_THAT(missing, testing::Contains("HDM_bd_jogRightCircle4StepsLstart_002"));
  EXPECT_THAT(missing, testing::Not(testing::Contains("HDM_bd_jogRightCircle4StepsLstart_001")));
}

TEST(Hdm05Check, SaysWhyAFileIsExtra) {
  const test::TemporaryFolder folder;
  WriteAmc(folder.path() / "HDM_bd_squat1Reps_001_120.amc", 10);
  const auto why = [&](const std::string& name) {
    const fs::path path = folder.path() / name;
    test::WriteText(path, "x");
    const Hdm05Report report = CheckHdm05(folder.path());
    fs::remove(path);
    EXPECT_FALSE(report.HasFaults());
    return MessageOf(report, Hdm05FindingKind::kExtra);
  };
  EXPECT_THAT(why("HDM_bd_squat1Reps_013_120.amc"), HasSubstr("001 to 012 of squat1Reps"));
  EXPECT_THAT(why("HDM_mm_turnRight_001_120.amc"), HasSubstr("no clip of turnRight by actor mm"));
  EXPECT_THAT(why("HDM_bd_flying_001_120.amc"), HasSubstr("no motion class 'flying'"));
  EXPECT_THAT(why("HDM_xx_squat1Reps_001_120.c3d"), HasSubstr("no actor 'xx'"));
  EXPECT_THAT(why("HDM_bd_09-01_01_120.amc"), HasSubstr("no take '09-01_01' of actor bd"));
  EXPECT_THAT(why("HDM_bd_01-01_01_60.amc"), HasSubstr("120 Hz"));
  EXPECT_THAT(why("HDM_notes.amc"), HasSubstr("HDM_{actor}_{part}-{scene}_{take}_120"));
  EXPECT_THAT(why("HDM_xx.asf"), HasSubstr("no such skeleton"));
  EXPECT_THAT(why("HDM_xx_25.avi"), HasSubstr("no such video"));
}

TEST(Hdm05Check, TakesNamesInAnyCaseAndWithoutRate) {
  const test::TemporaryFolder folder;
  WriteAmc(folder.path() / "hdm_DG_06-03_04_120.AMC", 99);
  WriteAmc(folder.path() / "a" / "HDM_dg_06-03_01.amc", 331);
  WriteAmc(folder.path() / "b" / "HDM_BD_SQUAT1REPS_001_120.amc", 20);
  WriteSkeleton(folder.path() / "HDM_DG.ASF");
  test::WriteText(folder.path() / "video" / "HDM_bd_01-01_01_25.AVI", "x");
  const Hdm05Report report = CheckHdm05(folder.path());
  EXPECT_EQ(report.TakesFound(kAmc, "dg"), 2);
  EXPECT_EQ(report.ClipsFound(kAmc), 1);
  EXPECT_THAT(report.MissingSkeletons(), ElementsAre("bd"));
  EXPECT_EQ(report.videos[0], Hdm05Presence::kFound);
  EXPECT_THAT(report.findings, IsEmpty());
}

TEST(Hdm05Check, PointsOutKnownDefects) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> defective = {"HDM_dg_03-04_02_120.amc", "HDM_dg_03-09_01_120.amc",
                                              "HDM_dg_rotateArmsBothForward1Reps_010_120.amc",
                                              "HDM_tr_sitDownKneelTieShoes_015_120.amc"};
  WriteAmc(folder.path() / defective[0], 6307);
  WriteAmc(folder.path() / defective[1], 5314);
  WriteAmc(folder.path() / defective[2], 10);
  WriteAmc(folder.path() / defective[3], 10);
  WriteAmc(folder.path() / "HDM_dg_03-04_01_120.amc", 7101);
  WriteAmc(folder.path() / "HDM_dg_rotateArmsBothForward1Reps_009_120.amc", 10);
  WriteAmc(folder.path() / "HDM_bk_rotateArmsBothForward1Reps_008_120.amc", 10);
  const Hdm05Report report = CheckHdm05(folder.path());
  EXPECT_THAT(NamesOf(report, Hdm05FindingKind::kKnownDefect),
              testing::UnorderedElementsAreArray(defective));
  EXPECT_THAT(report.findings, SizeIs(4));
  EXPECT_FALSE(report.HasFaults());
}

TEST(Hdm05Check, ReportsWhatIsCutOff) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "HDM_bd_squat1Reps_001_120.amc",
                  "1\nroot 0 17 0 0 0 0\nneck 1\n2\nroot 0 17 0 0 0 0\n");
  const Hdm05Report report = CheckHdm05(folder.path());
  EXPECT_THAT(NamesOf(report, Hdm05FindingKind::kDamaged),
              ElementsAre("HDM_bd_squat1Reps_001_120.amc"));
  EXPECT_THAT(MessageOf(report, Hdm05FindingKind::kDamaged), HasSubstr("cut off"));
  EXPECT_TRUE(report.HasFaults());
}

TEST(Hdm05Check, PrefersTheReadableOneOfTwoCopiesOfAFile) {
  const test::TemporaryFolder folder;
  const std::string name = "HDM_dg_06-03_04_120.amc";
  WriteAmc(folder.path() / "a" / name, 99);
  test::WriteText(folder.path() / "b" / name, "");
  for (const char* place : {"a", "b"}) WriteSkeleton(folder.path() / place / "HDM_dg.asf");
  const Hdm05Report report = CheckHdm05(folder.path());
  EXPECT_EQ(report.TakesFound(kAmc), 1);
  EXPECT_THAT(NamesOf(report, Hdm05FindingKind::kUnreadable), ElementsAre(name));
  EXPECT_THAT(NamesOf(report, Hdm05FindingKind::kDuplicate), ElementsAre(name));
  EXPECT_THAT(MessageOf(report, Hdm05FindingKind::kDuplicate),
              HasSubstr((folder.path() / "a" / name).string()));
}

TEST(Hdm05Check, ListsABrokenC3dAndABrokenSkeleton) {
  const test::TemporaryFolder folder;
  WriteAmc(folder.path() / "HDM_dg_06-03_04_120.amc", 99);
  test::WriteText(folder.path() / "HDM_dg_06-03_04_120.c3d", "not a C3D");
  test::WriteText(folder.path() / "HDM_dg.asf", "not an ASF");
  const Hdm05Report report = CheckHdm05(folder.path());
  EXPECT_THAT(NamesOf(report, Hdm05FindingKind::kUnreadable),
              ElementsAre("HDM_dg.asf", "HDM_dg_06-03_04_120.c3d"));
  EXPECT_EQ(report.TakesFound(kC3d), 0);
  EXPECT_THAT(report.MissingTakes(kC3d), SizeIs(325));
  EXPECT_THAT(report.MissingSkeletons(), IsEmpty());  // It is there.
}

TEST(Hdm05Check, SaysWhereThereIsNothingToCheck) {
  const test::TemporaryFolder folder;
  const auto error = [](const fs::path& path) {
    return test::ErrorOf([&] { (void)CheckHdm05(path); });
  };
  EXPECT_EQ(error(folder.path() / "none").code(), ErrorCode::kNotFound);
  EXPECT_EQ(error(folder.path()).code(), ErrorCode::kNotFound);
  WriteAmc(folder.path() / "05_01.amc", 10);
  WriteAmc(folder.path() / "HDM_xx_squat1Reps_001_120.amc", 10);
  EXPECT_EQ(error(folder.path()).code(), ErrorCode::kNotFound);
  EXPECT_THAT(error(folder.path()).what(), HasSubstr("HDM_bd_squat1Reps_001_120"));
  const Error file = error(folder.path() / "05_01.amc");
  EXPECT_EQ(file.code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(file.what(), HasSubstr("is no folder"));
}

TEST(Hdm05Check, GivesTheSameWhateverTheNumberOfThreads) {
  const test::TemporaryFolder folder;
  WritePartialCopy(folder.path());
  const Hdm05Report one = CheckHdm05(folder.path(), 1);
  const Hdm05Report four = CheckHdm05(folder.path(), 4);
  ASSERT_EQ(one.findings.size(), four.findings.size());
  for (std::size_t i = 0; i < one.findings.size(); ++i) {
    EXPECT_EQ(one.findings[i].file, four.findings[i].file);
    EXPECT_EQ(one.findings[i].message, four.findings[i].message);
  }
}

TEST(Hdm05Check, ReportsProgressAndCanBeCancelled) {
  const test::TemporaryFolder folder;
  WritePartialCopy(folder.path());
  std::size_t last = 0;
  (void)CheckHdm05(folder.path(), 2, [&](std::string_view, std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 5U);  // Four takes and the skeleton.
    EXPECT_EQ(done, last + 1);
    last = done;
    return true;
  });
  EXPECT_EQ(last, 5U);
  const auto cancel = [](std::string_view, std::size_t, std::size_t) { return false; };
  EXPECT_EQ(test::ErrorOf([&] { (void)CheckHdm05(folder.path(), 1, cancel); }).code(),
            ErrorCode::kCancelled);
}

TEST(Hdm05Check, FindsTheRealRecordingsAsDocumented) {
  KINEBASE_NEEDS_TEST_DATA();
  const fs::path root = test::TestData("data/hdm05");
  const Hdm05Report report = CheckHdm05(root);
  for (const Hdm05Finding& finding : report.findings) {
    ADD_FAILURE() << finding.file << ": " << finding.message;
  }
  EXPECT_EQ(report.TakesFound(kAmc), 1);
  EXPECT_EQ(report.TakesFound(kC3d, "bd", 5), 1);
  EXPECT_EQ(report.TakesFound(kC3d, "dg", 6), 1);
  EXPECT_EQ(report.TakesFound(kC3d), 2);
  EXPECT_EQ(report.ClipsFound(kAmc), 146);
  EXPECT_THAT(report.MissingSkeletons(), IsEmpty());
  EXPECT_EQ(std::ranges::count(report.skeletons, Hdm05Presence::kFound), 3);

  // Of eight classes all clips by actors bd, bk and dg are there but one.
  const CsvTable clips = test::ReadCsv(root / "clips.csv");
  std::set<std::string> classes;
  for (const auto& row : clips.rows) classes.insert(row[clips.Column("class")]);
  EXPECT_THAT(classes, SizeIs(8));
  std::vector<std::string> missing = report.MissingClips(kAmc);
  std::erase_if(missing, [&](const std::string& clip) {
    const TakeName name = ParseTakeName(clip + "_120");
    return !classes.contains(name.class_name) || name.actor == "mm" || name.actor == "tr";
  });
  EXPECT_THAT(missing, ElementsAre("HDM_bk_sneak2StepsLStart_006"));
}

// The lists of clips name the take and its frames: they have to be in the catalogue's takes, and
// the take's scene has to ask for the class.
TEST(Hdm05Catalogue, HasTheSourcesOfTheRealClips) {
  KINEBASE_NEEDS_TEST_DATA();
  const CsvTable clips = test::ReadCsv(test::TestData("data/hdm05/clips.csv"));
  ASSERT_THAT(clips.rows, SizeIs(146));
  for (const auto& row : clips.rows) {
    const std::string source = row[clips.Column("source_take")];
    const Hdm05Take* take = Hdm05().FindTake(source.substr(0, source.rfind('_')));
    ASSERT_NE(take, nullptr) << source;
    EXPECT_LE(std::stoi(row[clips.Column("take_last_frame")]), *take->frame_count) << source;
    const Hdm05Scene* scene = Hdm05().FindScene(take->part, take->scene);
    ASSERT_NE(scene, nullptr) << source;
    EXPECT_TRUE(std::ranges::any_of(scene->steps, [&](const Hdm05Step& step) {
      return std::ranges::find(step.classes, row[clips.Column("class")]) != step.classes.end();
    })) << row[0];
  }
}

}  // namespace
}  // namespace kinebase
