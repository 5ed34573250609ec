// sort and rename as people use them: tried first, run twice, and run where something is in the
// way. tests/library/file_moves_test.cpp has the plans themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class Moving : public ::testing::Test {
 protected:
  // Files whose text is their name.
  Moving() {
    for (const std::string name : {"HDM_bd_squat_001_120.amc", "HDM_bk_squat_002_120.c3d",
                                   "HDM_bk_walk_003_120.bvh", "other.trc", "notes.txt"}) {
      WriteText(clips() / name, name);
    }
  }
  [[nodiscard]] fs::path clips() const { return folder_.path() / "clips"; }
  [[nodiscard]] std::vector<std::string> Names() const { return NamesBelow(clips()); }

  [[nodiscard]] ProgramResult Sort(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"sort", clips()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }
  [[nodiscard]] ProgramResult Rename(const std::string& table,
                                     const std::vector<std::string>& more = {}) const {
    WriteText(folder_.path() / "names.csv", table);
    std::vector<std::string> arguments = {"rename", clips(), "--table",
                                          folder_.path() / "names.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Moving, IsTriedFirstAndThenDoneOnce) {
  const auto before = Names();
  const ProgramResult tried = Sort({"--dry-run"});
  EXPECT_EQ(tried.exit_code, 0);
  EXPECT_THAT(tried.err, AllOf(HasSubstr("3 files would be moved; nothing was, as asked"),
                               HasSubstr("1 file stays: no motion class in the name")));
  EXPECT_EQ(Names(), before);

  const ProgramResult sorted = Sort();
  EXPECT_EQ(sorted.exit_code, 0);
  EXPECT_EQ(sorted.out, tried.out);
  EXPECT_THAT(sorted.err, HasSubstr("3 files moved"));
  const auto after = Names();
  EXPECT_THAT(
      after, ElementsAre("notes.txt", "other.trc", "squat", "squat/HDM_bd_squat_001_120.amc",
                         "squat/HDM_bk_squat_002_120.c3d", "walk", "walk/HDM_bk_walk_003_120.bvh"));
  for (const std::string& name : after) {
    const fs::path file = clips() / name;
    if (!fs::is_regular_file(file)) continue;
    EXPECT_EQ(ReadText(file), file.filename());
  }

  const ProgramResult again = Sort();
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.out, "");
  EXPECT_THAT(again.err, HasSubstr("0 files moved"));
  EXPECT_EQ(Names(), after);
}

TEST_F(Moving, ListsInJsonWhatMovesAndWhatStays) {
  for (const bool dry : {true, false}) {
    const auto json = (dry ? Sort({"--dry-run", "--json", "-q"}) : Sort({"--json", "-q"})).Json();
    EXPECT_THAT(FieldsOf(json), ElementsAre("moves:array", "left:array", "dry_run:boolean"));
    EXPECT_EQ(json["dry_run"].get<bool>(), dry);
    ASSERT_EQ(json["moves"].size(), 3U);
    EXPECT_EQ(json["moves"][0]["from"], (clips() / "HDM_bd_squat_001_120.amc").string());
    EXPECT_EQ(json["moves"][0]["to"], (clips() / "squat/HDM_bd_squat_001_120.amc").string());
    EXPECT_EQ(json["left"], nlohmann::ordered_json::array({(clips() / "other.trc").string()}));
  }
}

TEST_F(Moving, GoesByAPositionOrAText) {
  EXPECT_EQ(Sort({"--start", "5"}).exit_code, 0);  // The actor: behind "HDM_".
  EXPECT_THAT(Names(),
              ElementsAre("bd", "bd/HDM_bd_squat_001_120.amc", "bk", "bk/HDM_bk_squat_002_120.c3d",
                          "bk/HDM_bk_walk_003_120.bvh", "notes.txt", "r", "r/other.trc"));
  const std::string bk = clips() / "bk";
  const ProgramResult text = RunKinebase({"sort", bk, "--start", "k_", "--delimiter", "_0"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(NamesBelow(bk), ElementsAre("squat", "squat/HDM_bk_squat_002_120.c3d", "walk",
                                          "walk/HDM_bk_walk_003_120.bvh"));
}

TEST_F(Moving, LeavesAllAsItIsIfOneIsInTheWay) {
  const std::string taken = clips() / "squat/HDM_bd_squat_001_120.amc";
  WriteText(taken, "precious");
  const auto before = Names();
  const ProgramResult sorted = Sort();
  EXPECT_EQ(sorted.exit_code, 1);
  EXPECT_EQ(sorted.out, "");
  EXPECT_THAT(sorted.err, AllOf(HasSubstr("error: " + taken + ": exists already"),
                                HasSubstr("nothing was moved")));
  EXPECT_EQ(Sort({"--dry-run"}).exit_code, 1);
  EXPECT_EQ(Names(), before);
  EXPECT_EQ(ReadText(taken), "precious");
}

TEST_F(Moving, RenamesOnceByATable) {
  const std::string table =
      "old,new\nother.trc,deep/mine.trc\nnotes.txt,read me.md\n"
      "HDM_bk_walk_003_120,HDM_bk_run_003_120\n";
  const auto before = Names();
  const ProgramResult tried = Rename(table, {"--dry-run"});
  EXPECT_EQ(tried.exit_code, 0);
  EXPECT_THAT(tried.err, HasSubstr("3 files would be moved"));
  EXPECT_EQ(Names(), before);
  const ProgramResult renamed = Rename(table);
  EXPECT_EQ(renamed.exit_code, 0);
  EXPECT_EQ(renamed.out, tried.out);
  const auto after = Names();
  EXPECT_THAT(after,
              ElementsAre("HDM_bd_squat_001_120.amc", "HDM_bk_run_003_120.bvh",
                          "HDM_bk_squat_002_120.c3d", "deep", "deep/mine.trc", "read me.md"));
  EXPECT_EQ(ReadText(clips() / "read me.md"), "notes.txt");
  const ProgramResult again = Rename(table);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, "");
  EXPECT_THAT(again.err, HasSubstr("0 files moved"));
  EXPECT_EQ(Names(), after);
}

TEST_F(Moving, SaysInWhichLineATableIsWrong) {
  const auto before = Names();
  for (const auto& [table, part] : std::vector<std::pair<std::string, std::string>>{
           {"", "names.csv: is empty"},
           {"from,to,why\na,b,c\n", "names.csv:1: has the columns from, to, why"},
           {"old,new\nother.trc\n", "names.csv:2: 1 fields; the header has 2"},
           {"old,new\nnobody.trc,x.trc\n", "names.csv:2: no 'nobody.trc' in"},
           {"old,new\nother.trc,notes.txt.trc\nother.trc,y.trc\n",
            "names.csv:3: 'other.trc' is renamed in line 2 already"},
           {"old,new\nnotes.txt,HDM_bk_walk_003_120.bvh\n",
            "'HDM_bk_walk_003_120.bvh' exists already"},
           {"old,new\nother.trc,../up.trc\n", "names.csv:2: new name '../up.trc' leaves"},
           {"old,new\nother.trc,other.c3d\n", "renaming does not convert"},
       }) {
    SCOPED_TRACE(table);
    ExpectOneError(Rename(table, {"--quiet"}), 1, {part});
    EXPECT_EQ(Names(), before);
  }
  ExpectOneError(RunKinebase({"rename", clips(), "--table", "nowhere.csv"}), 1, {"nowhere.csv"});
  ExpectOneError(RunKinebase({"rename", "nowhere", "--table", "nowhere.csv"}), 1,
                 {"nowhere: does not exist"});
  ExpectOneError(RunKinebase({"sort", "nowhere"}), 1, {"nowhere: does not exist"});
  ExpectOneError(RunKinebase({"sort", clips() / "notes.txt"}), 1, {"notes.txt: is no folder"});
}

}  // namespace
}  // namespace kinebase::test
