// kinebase hdm05: a known database by its words, and a copy compared with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

void WriteAmc(const fs::path& path, int frames) {
  std::string text = ":FULLY-SPECIFIED\n:DEGREES\n";
  for (int i = 1; i <= frames; ++i) text += std::to_string(i) + "\nroot 0 17 0 0 0 0\n";
  WriteText(path, text);
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Hdm05TakesCommand, FindsTakesByTheWordsOfTheirScript) {
  const ProgramResult result =
      RunKinebase({"hdm05", "takes", "grab", "item", "from", "shelf", "--actor", "bd"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const auto lines = Lines(result.out);
  ASSERT_EQ(lines.size(), 5U);  // Titles, two takes of either scene.
  EXPECT_THAT(lines[1],
              ::testing::AllOf(HasSubstr("HDM_bd_02-02_01"), HasSubstr("6324"),
                               HasSubstr("2-2 Shelf (while walking)"), HasSubstr("2, 8, 14")));
}

TEST(Hdm05TakesCommand, HasTheDocumentedFields) {
  const auto json =
      RunKinebase({"hdm05", "takes", "--part", "3", "--actor", "dg", "--json"}).Json();
  EXPECT_THAT(FieldsOf(json), ElementsAre("takes:array"));
  ASSERT_EQ(json["takes"].size(), 22U);
  for (const auto& take : json["takes"]) {
    EXPECT_THAT(FieldsOf(take),
                ElementsAre("take:string", "actor:string", "part:integer", "scene:integer",
                            "number:integer", "frames:integer", "title:string", "steps:array",
                            "description:string", "comment:string"));
    EXPECT_EQ(take["part"], 3);
    EXPECT_EQ(take["actor"], "dg");
  }
}

TEST(Hdm05TakesCommand, ListsAllTakesWithTheirFrames) {
  const auto json = RunKinebase({"hdm05", "takes", "--json"}).Json();
  EXPECT_EQ(json["takes"].size(), 326U);
  int frames = 0;
  int unknown = 0;
  for (const auto& take : json["takes"]) {
    unknown += take["frames"].is_null() ? 1 : 0;
    frames += take["frames"].is_null() ? 0 : take["frames"].get<int>();
  }
  EXPECT_EQ(frames, 1525949);
  EXPECT_EQ(unknown, 2);
}

TEST(Hdm05ScenesCommand, ShowsTheScriptStepByStep) {
  const ProgramResult all = RunKinebase({"hdm05", "scenes"});
  EXPECT_EQ(all.exit_code, 0);
  EXPECT_THAT(
      all.out,
      HasSubstr("Part 1: Walking, running, jumping\n1-1 Walking, 16 takes\n   1  walk 5 steps\n"));
  const auto json = RunKinebase({"hdm05", "scenes", "cartwheel", "--json"}).Json();
  ASSERT_EQ(json["scenes"].size(), 1U);
  const auto& scene = json["scenes"][0];
  EXPECT_THAT(FieldsOf(scene),
              ElementsAre("part:integer", "part_title:string", "scene:integer", "title:string",
                          "steps:array", "found_steps:array", "takes:array"));
  EXPECT_THAT(FieldsOf(scene["steps"][3]),
              ElementsAre("step:integer", "text:string", "classes:array"));
  EXPECT_EQ(scene["found_steps"], nlohmann::json({4}));
  EXPECT_EQ(scene["takes"].size(), 15U);
}

TEST(Hdm05ClassesCommand, CountsClipsOfEachActor) {
  const auto json = RunKinebase({"hdm05", "classes", "--json"}).Json();
  ASSERT_EQ(json["classes"].size(), 130U);
  int clips = 0;
  for (const auto& motion_class : json["classes"]) {
    EXPECT_THAT(FieldsOf(motion_class),
                ElementsAre("class:string", "clips:integer", "actors:object", "description:string",
                            "comment:string"));
    int sum = 0;
    for (const auto& [actor, count] : motion_class["actors"].items()) sum += count.get<int>();
    EXPECT_EQ(sum, motion_class["clips"]);
    clips += sum;
  }
  EXPECT_EQ(clips, 2343);
  EXPECT_EQ(Lines(RunKinebase({"hdm05", "classes", "squat"}).out).size(), 3U);
}

TEST(Hdm05VideosCommand, LeavesEmptyWhatIsLost) {
  const auto json = RunKinebase({"hdm05", "videos", "--json"}).Json();
  ASSERT_EQ(json["videos"].size(), 102U);
  EXPECT_THAT(FieldsOf(json["videos"][0]),
              ElementsAre("video:string", "take:string", "first_frame:integer",
                          "last_frame:integer", "comment:string"));
  int lost = 0;
  for (const auto& video : json["videos"]) lost += video["last_frame"].is_null() ? 1 : 0;
  EXPECT_GT(lost, 0);
  EXPECT_EQ(Lines(RunKinebase({"hdm05", "videos"}).out).size(), 103U);
}

TEST(Hdm05Command, SaysThatNothingHasTheWords) {
  for (const char* what : {"takes", "scenes", "classes"}) {
    const ProgramResult result = RunKinebase({"hdm05", what, "grab", "xylophone"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("has all of these words: grab xylophone"));
    EXPECT_EQ(RunKinebase({"hdm05", what, "xylophone", "--json"}).Json()[what].size(), 0U);
  }
}

TEST(Hdm05Command, RefusesWrongUsage) {
  ExpectOneError(RunKinebase({"hdm05"}), 2, {"hdm05 needs a command: check, takes, scenes"});
  ExpectOneError(RunKinebase({"hdm05", "check"}), 2, {"FOLDER is required"});
  ExpectOneError(RunKinebase({"hdm05", "takes", "--actor", "xx"}), 2, {"--actor", "bd, bk", "xx"});
  ExpectOneError(RunKinebase({"hdm05", "takes", "--part", "9"}), 2, {"--part", "1 to 8", "'9'"});
}

// The folder of a partial copy: a take as documented, one cut short, one that is broken, one that
// HDM05 does not have, all clips of a class.
void WritePartialCopy(const fs::path& root) {
  WriteAmc(root / "HDM_dg_06-03_01_120.amc", 331);
  WriteAmc(root / "HDM_dg_06-03_02_120.amc", 284);
  WriteText(root / "HDM_dg_06-03_03_120.amc", "1\nroot\n");
  WriteAmc(root / "HDM_dg_06-03_05_120.amc", 50);
  WriteAmc(root / "HDM_bd_walkRightCircle4StepsLstart_001_120.amc", 50);
}

TEST(Hdm05CheckCommand, ListsWhatDiffersAndEndsWithThree) {
  const TemporaryFolder folder;
  WritePartialCopy(folder.path());
  const ProgramResult result = RunKinebase({"hdm05", "check", folder.path()});
  EXPECT_EQ(result.exit_code, 3);
  ASSERT_EQ(result.ErrorLines().size(), 1U);
  EXPECT_THAT(result.err, HasSubstr("HDM_dg_06-03_03_120.amc:2"));
  for (const char* part :
       {"takes      2 of 326 as AMC, 0 as C3D", "clips      1 of 2343 as AMC",
        "HDM_bd.asf, HDM_dg.asf", "classes as AMC: 1 complete, 0 incomplete, 129 not there",
        "takes missing as AMC: 323", "wrong frame count: 1", "284 frames; HDM05 has 285",
        "unreadable: 1", "extra: 1", "HDM_dg_06-03_05_120.amc: HDM05 has no take"}) {
    EXPECT_THAT(result.out, HasSubstr(part));
  }
  EXPECT_THAT(result.out, Not(HasSubstr("missing as C3D")));  // There is none to be missed.
}

TEST(Hdm05CheckCommand, HasTheDocumentedFields) {
  const TemporaryFolder folder;
  WritePartialCopy(folder.path());
  const ProgramResult result = RunKinebase({"hdm05", "check", folder.path(), "--json"});
  EXPECT_EQ(result.exit_code, 3);
  const auto json = result.Json();
  EXPECT_THAT(
      FieldsOf(json),
      ElementsAre("folder:string", "as_documented:boolean", "takes:object", "clips:object",
                  "videos:object", "actors:array", "classes:array", "missing:object",
                  "wrong_frame_count:array", "damaged:array", "extra:array", "duplicates:array",
                  "known_defects:array", "elapsed_s:number", "failed:array"));
  EXPECT_EQ(json["as_documented"], false);
  EXPECT_THAT(FieldsOf(json["takes"]),
              ElementsAre("expected:integer", "amc:integer", "c3d:integer"));
  EXPECT_EQ(json["takes"]["amc"], 2);
  EXPECT_EQ(json["clips"]["amc"], 1);
  EXPECT_THAT(FieldsOf(json["actors"][2]),
              ElementsAre("actor:string", "name:string", "skeleton:boolean", "takes:object",
                          "parts:array", "clips:object"));
  EXPECT_EQ(json["actors"][2]["actor"], "dg");
  EXPECT_EQ(json["actors"][2]["takes"]["expected"], 77);
  EXPECT_EQ(json["classes"].size(), 130U);
  EXPECT_EQ(json["missing"]["amc"]["takes"].size(), 323U);
  EXPECT_EQ(json["missing"]["skeletons"], nlohmann::json({"bd", "dg"}));
  EXPECT_THAT(
      FieldsOf(json["wrong_frame_count"][0]),
      ElementsAre("file:string", "message:string", "expected_frames:integer", "frames:integer"));
  EXPECT_EQ(json["wrong_frame_count"][0]["expected_frames"], 285);
  EXPECT_THAT(FieldsOf(json["failed"][0]), ElementsAre("file:string", "message:string"));
}

TEST(Hdm05CheckCommand, ListsAllThatIsMissingOnRequest) {
  const TemporaryFolder folder;
  WriteAmc(folder.path() / "HDM_dg_06-03_01_120.amc", 331);
  const ProgramResult brief = RunKinebase({"hdm05", "check", folder.path()});
  const ProgramResult full = RunKinebase({"hdm05", "check", folder.path(), "--missing"});
  EXPECT_EQ(brief.exit_code, 0);
  EXPECT_EQ(full.exit_code, 0);
  EXPECT_THAT(brief.out, HasSubstr("--missing lists all"));
  EXPECT_THAT(brief.out, HasSubstr("all that is there is as documented"));
  EXPECT_LT(Lines(brief.out).size(), 40U);
  EXPECT_GT(Lines(full.out).size(), 325U + 2343U);
  EXPECT_THAT(full.out, HasSubstr("  HDM_tr_walkRightCrossFront3Steps_013\n"));
}

TEST(Hdm05CheckCommand, CannotCheckWhereNothingIsUsable) {
  const TemporaryFolder folder;
  ExpectOneError(RunKinebase({"hdm05", "check", folder.path() / "none"}), 1, {"does not exist"});
  ExpectOneError(RunKinebase({"hdm05", "check", folder.path()}), 1,
                 {"holds no file of HDM05", "HDM_bd_01-01_01_120.amc"});
  WriteText(folder.path() / "HDM_dg_06-03_03_120.amc", "1\nroot\n");
  ExpectOneError(RunKinebase({"hdm05", "check", folder.path()}), 1, {"HDM_dg_06-03_03_120.amc:2"});
}

TEST(Hdm05CheckCommand, FindsTheRealRecordingsAsDocumented) {
  KINEBASE_NEEDS_TEST_DATA();
  const ProgramResult result = RunKinebase({"hdm05", "check", TestData("data/hdm05"), "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto json = result.Json();
  EXPECT_EQ(json["as_documented"], true);
  EXPECT_EQ(json["takes"]["c3d"], 2);
  EXPECT_EQ(json["clips"]["amc"], 146);
}

}  // namespace
}  // namespace kinebase::test
