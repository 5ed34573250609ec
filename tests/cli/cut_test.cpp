// cut, sort and rename as scripts see them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "fmt/format.h"
#include "kinebase/synth/synthetic_motion.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::SizeIs;

// One made-up actor with a long take of four motions and its cut file.
class TakesToCut : public ::testing::Test {
 protected:
  TakesToCut() {
    WriteSyntheticLibrary(library(), {.actors = 1,
                                      .repetitions = 0,
                                      .clips_per_take = 4,
                                      .classes = {"squat1Reps", "grabHighR"},
                                      .threads = 1});
  }

  [[nodiscard]] fs::path library() const { return folder_.path() / "library"; }
  [[nodiscard]] fs::path clips() const { return folder_.path() / "clips"; }
  [[nodiscard]] fs::path cuts() const { return library() / "takes.cuts.txt"; }
  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }

  [[nodiscard]] ProgramResult Cut(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"cut", cuts(), "--in", library(), "--out", clips()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(TakesToCut, GiveClipsThatShowTheSameJoints) {
  const ProgramResult result = Cut({"--json", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const auto json = result.Json();
  EXPECT_THAT(FieldsOf(json), ElementsAre("clips:array", "skeletons:array", "dry_run:boolean"));
  EXPECT_EQ(json["skeletons"], nlohmann::ordered_json::array({(clips() / "SYN_sa.asf").string()}));
  const CsvTable truth = ReadCsv(library() / "takes.truth.csv");
  ASSERT_EQ(json["clips"].size(), truth.rows.size());
  for (std::size_t i = 0; i < truth.rows.size(); ++i) {
    const auto& clip = json["clips"][i];
    EXPECT_THAT(FieldsOf(clip), ElementsAre("file:string", "source:string", "first_frame:integer",
                                            "last_frame:integer", "state:string"));
    EXPECT_EQ(clip["state"], "new");
    const std::string first = truth.rows[i][truth.Column("first_frame")];
    const std::string last = truth.rows[i][truth.Column("last_frame")];
    EXPECT_EQ(std::to_string(clip["first_frame"].get<int>()), first);
    EXPECT_EQ(std::to_string(clip["last_frame"].get<int>()), last);
    const std::string take = clip["source"];
    EXPECT_EQ(RunKinebase({"joints", clip["file"], "--quiet"}).out,
              RunKinebase({"joints", fmt::format("{}:{}-{}", take, first, last), "--quiet"}).out);
  }
}

TEST_F(TakesToCut, CanBeTriedAndCutTwice) {
  const ProgramResult tried = Cut({"--dry-run"});
  EXPECT_EQ(tried.exit_code, 0);
  EXPECT_THAT(tried.err, HasSubstr("4 clips: 4 new; nothing was written"));
  EXPECT_FALSE(fs::exists(clips()));
  EXPECT_EQ(tried.out, Cut().out);
  const auto names = NamesBelow(clips());
  EXPECT_THAT(names, SizeIs(5));
  const ProgramResult again = Cut();
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, HasSubstr("4 clips: 0 new, 4 unchanged"));
  EXPECT_THAT(again.out, HasSubstr("unchanged"));
  EXPECT_EQ(NamesBelow(clips()), names);
}

TEST_F(TakesToCut, ListWhatFailedAndDoTheRest) {
  WriteText(cuts(), ReadText(cuts()) +
                        "\"takes\\SYN_sa_01-01_01_120.amc\" 1 999999 far\n"
                        "\"takes\\SYN_zz.amc\" 1 2 nobody\n\"takes\\x.amc\" 1 2 ../up\n");
  const ProgramResult result = Cut({"--json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.ErrorLines(),
              IsSupersetOf({HasSubstr("takes.cuts.txt:7: frames 1 to 999999 are asked for"),
                            HasSubstr("takes.cuts.txt:8: no take 'takes/SYN_zz'"),
                            HasSubstr("takes.cuts.txt:9: clip '../up' leaves its folder")}));
  const auto json = result.Json();
  EXPECT_EQ(json["clips"].size(), 4);
  ASSERT_EQ(json["failed"].size(), 3);
  for (const auto& failed : json["failed"]) {
    EXPECT_THAT(FieldsOf(failed), ElementsAre("file:string", "message:string"));
  }
  EXPECT_THAT(NamesBelow(folder()), Not(Contains("up.amc")));
}

TEST_F(TakesToCut, AreNotReplacedWithoutForce) {
  (void)Cut();
  const std::string clip = clips() / NamesBelow(clips()).back();
  WriteText(clip, "mine");
  const ProgramResult refused = Cut();
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr(clip + ": exists already"), HasSubstr("--force")));
  EXPECT_EQ(ReadText(clip), "mine");
  const ProgramResult forced = Cut({"--force"});
  EXPECT_EQ(forced.exit_code, 0);
  EXPECT_THAT(forced.out, HasSubstr("replaced"));
  EXPECT_NE(ReadText(clip), "mine");
}

TEST_F(TakesToCut, AreTakenWithoutQuotesOnRequest) {
  std::string text = ReadText(cuts());
  std::erase(text, '"');
  WriteText(cuts(), text);
  ExpectOneError(Cut(), 1, {"takes.cuts.txt:3: ", "4 from here on look like cuts", "--unquoted"});
  EXPECT_EQ(Cut({"--unquoted"}).exit_code, 0);
  EXPECT_THAT(NamesBelow(clips()), SizeIs(5));
  WriteText(cuts(), text + "\"takes\\SYN_sa_01-01_01_120.amc\" 1 9 more\n");
  const ProgramResult partly = Cut();
  EXPECT_EQ(partly.exit_code, 0);
  EXPECT_THAT(partly.err, HasSubstr("4 lines that look like cuts without quotes"));
}

TEST_F(TakesToCut, EndInOneErrorIfNothingCanBeCut) {
  ExpectOneError(RunKinebase({"cut", "nowhere.txt", "--in", library(), "--out", clips()}), 1,
                 {"nowhere.txt: does not exist"});
  ExpectOneError(RunKinebase({"cut", cuts(), "--in", "nowhere", "--out", clips()}), 1,
                 {"nowhere: is no folder"});
  const ProgramResult result = RunKinebase({"cut", cuts(), "--in", folder(), "--out", clips()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.ErrorLines(), SizeIs(4));
  EXPECT_FALSE(fs::exists(clips()));
}

TEST_F(TakesToCut, AreSortedAndRenamedAndStillRead) {
  (void)Cut();
  const std::string folder = clips();
  const ProgramResult tried = RunKinebase({"sort", folder, "--dry-run", "--json", "--quiet"});
  EXPECT_EQ(tried.exit_code, 0);
  const auto plan = tried.Json();
  EXPECT_THAT(FieldsOf(plan), ElementsAre("moves:array", "left:array", "dry_run:boolean"));
  EXPECT_TRUE(plan["dry_run"].get<bool>());
  ASSERT_EQ(plan["moves"].size(), 4);
  for (const auto& move : plan["moves"]) {
    EXPECT_THAT(FieldsOf(move), ElementsAre("from:string", "to:string"));
    EXPECT_TRUE(fs::exists(move["from"].get<std::string>()));
    EXPECT_FALSE(fs::exists(move["to"].get<std::string>()));
  }

  const ProgramResult sorted = RunKinebase({"sort", folder});
  EXPECT_EQ(sorted.exit_code, 0);
  EXPECT_THAT(sorted.err, HasSubstr("4 files moved"));
  for (const auto& move : plan["moves"]) {
    EXPECT_FALSE(fs::exists(move["from"].get<std::string>()));
    EXPECT_TRUE(fs::exists(move["to"].get<std::string>()));
  }
  EXPECT_THAT(NamesBelow(clips()), IsSupersetOf({"SYN_sa.asf", "squat1Reps", "grabHighR"}));
  const ProgramResult again = RunKinebase({"sort", folder});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.out, "");
  EXPECT_THAT(again.err, HasSubstr("0 files moved"));

  const std::string table = this->folder() / "names.csv";
  WriteText(table, "old,new\nsquat1Reps/SYN_sa_squat1Reps_001_120,squat1Reps/SYN_sa_down_1\n");
  const auto rename = RunKinebase({"rename", folder, "--table", table, "--json", "--quiet"});
  EXPECT_EQ(rename.exit_code, 0) << rename.err;
  EXPECT_EQ(rename.Json()["moves"][0]["to"].get<std::string>(),
            clips() / "squat1Reps/SYN_sa_down_1.amc");
  EXPECT_EQ(RunKinebase({"rename", folder, "--table", table}).exit_code, 0);
  const ProgramResult info = RunKinebase({"info", folder, "--json"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(info.Json()["files"].size(), 4);
}

TEST_F(TakesToCut, AreNotMovedIfAnythingIsInTheWay) {
  (void)Cut();
  const std::string clip = NamesBelow(clips()).back();
  WriteText(clips() / "squat1Reps" / clip, "mine");
  WriteText(clips() / "grabHighR", "a file");
  const auto before = NamesBelow(clips());
  const ProgramResult sorted = RunKinebase({"sort", clips(), "--quiet"});
  EXPECT_EQ(sorted.exit_code, 1);
  EXPECT_EQ(sorted.out, "");
  EXPECT_THAT(sorted.err, AllOf(HasSubstr(clip + ": exists already"), HasSubstr("is a file")));
  const std::string table = folder() / "names.csv";
  WriteText(table, "old,new\n" + clip + ",a.amc\nnobody.amc,b.amc\n");
  ExpectOneError(RunKinebase({"rename", clips(), "--table", table, "--quiet"}), 1,
                 {"names.csv:3: no 'nobody.amc'"});
  EXPECT_EQ(NamesBelow(clips()), before);
}

TEST_F(TakesToCut, AreWronglyUsedInTheseWays) {
  for (const auto& [arguments, part] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"cut", "a.txt", "--out", "b"}, "--in is required"},
           {{"cut", "a.txt", "--in", "b"}, "--out is required"},
           {{"cut", "--in", "a", "--out", "b"}, "CUTS is required"},
           {{"cut", "a.txt", "--in", "a", "--out", "b", "--type", "bvh"}, "amc, c3d"},
           {{"sort"}, "FOLDER is required"},
           {{"sort", "a", "--start", "0"}, "a position from 1"},
           {{"sort", "a", "--delimiter", "-"}, "--delimiter requires --start"},
           {{"rename", "a"}, "--table is required"},
       }) {
    ExpectOneError(RunKinebase(arguments), 2, {part});
  }
}

TEST(SortOptions, SayWhereTheFoldersNameStands) {
  const TemporaryFolder folder;
  WriteText(folder.path() / "take-walk-1.c3d", "");
  const auto target = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"sort", folder.path(), "--dry-run", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto json = RunKinebase(arguments).Json();
    return json["moves"].empty() ? "" : json["moves"][0]["to"].get<std::string>();
  };
  EXPECT_EQ(target({}), "");
  EXPECT_EQ(target({"--start", "take-", "--delimiter", "-"}),
            folder.path() / "walk/take-walk-1.c3d");
  EXPECT_EQ(target({"--start", "6", "--delimiter", "-"}), folder.path() / "walk/take-walk-1.c3d");
  EXPECT_EQ(target({"--start", "6"}), folder.path() / "walk-1/take-walk-1.c3d");
}

TEST(RealRecordings, AreCutAsTheirSegmentsSay) {
  KINEBASE_NEEDS_TEST_DATA();
  const TemporaryFolder folder;
  WriteText(folder.path() / "cuts.txt",
            "\"HDM05\\HDM05_amc\\bd\\HDM_bd_05-01_01_120.amc\" 4131 4175 HDM_bd_clap1Reps_001_120\n"
            "\"HDM05\\HDM05_amc\\bd\\HDM_bd_05-01_01_120.amc\" 4131 4309 "
            "HDM_bd_clap5Reps_001_120\n");
  const std::string clips = folder.path() / "clips";
  const ProgramResult result =
      RunKinebase({"cut", folder.path() / "cuts.txt", "--in", TestData("data/hdm05/take_c3d"),
                   "--out", clips, "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(RunKinebase({"sort", clips, "--quiet"}).exit_code, 0);
  const auto info = RunKinebase({"info", clips + "/clap5Reps", "--json", "--quiet"}).Json();
  ASSERT_EQ(info["files"].size(), 1);
  EXPECT_EQ(info["files"][0]["frames"], 179);
  EXPECT_EQ(info["files"][0]["first_frame"], 4131);
  EXPECT_EQ(info["files"][0]["class"], "clap5Reps");
}

}  // namespace
}  // namespace kinebase::test
