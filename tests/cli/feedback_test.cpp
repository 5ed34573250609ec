// learn --update with marked hits, and the CSV of search that they are marked in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/templates/template_file.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view kHead = "file,first_frame,last_frame,verdict\n";

class Feedback : public ::testing::Test {
 protected:
  std::string Marks(const std::string& rows) const {
    const fs::path table = library_.scratch() / "marks" / "hits.csv";
    WriteText(table, std::string(kHead) + rows);
    return table;
  }

  ProgramResult Update(const std::string& marks, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"learn", "--update",        template_, "--marks", marks,
                                          "--in",  library_.folder(), "-o",      better_,   "-f"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

  // Best first, without limit.
  nlohmann::ordered_json HitsOf(const std::string& file) const {
    return RunKinebase({"search", file, "--in", library_.folder(), "--tau", "9", "--json", "-q"})
        .Json()["hits"];
  }

  SyntheticLibrary library_;
  std::string template_ = library_.Learn("squat1Reps");
  std::string better_ = library_.scratch() / "better.json";
};

TEST_F(Feedback, GoesFromMarkedHitsToABetterTemplate) {
  const ProgramResult csv = RunKinebase(
      {"search", template_, "--in", library_.folder(), "--tau", "9", "--format", "csv", "-q"});
  ASSERT_EQ(csv.exit_code, 0) << csv.err;
  // People write in the last column: squats are right, all else is wrong.
  std::string marked;
  LineScanner lines(csv.out);
  for (int row = 0; lines.Next() && row < 8; ++row) {
    std::string line(lines.line());
    if (row == 0) {
      EXPECT_EQ(line, "template,file,first_frame,last_frame,start_s,end_s,cost,confidence,verdict");
    } else {
      line += line.find("/squat1Reps/") == std::string::npos ? "wrong" : "right";
    }
    marked += line + '\n';
  }
  const fs::path table = library_.scratch() / "marked.csv";
  WriteText(table, marked);
  const auto json = Update(table, {"--json"}).Json();
  EXPECT_THAT(
      FieldsOf(json),
      ElementsAre("name:string", "clips:integer", "columns:integer", "rounds:integer",
                  "elapsed_s:number", "file:string", "learned_again:boolean", "clips_added:integer",
                  "clips_dropped:integer", "right:integer", "wrong:integer",
                  "contradictory:boolean", "tau:number", "tau_before:null"));
  EXPECT_EQ(json["learned_again"], true);
  EXPECT_EQ(json["clips_added"], 2);  // Two of the four squats are clips of the template already.
  EXPECT_EQ(json["clips"], 4);
  EXPECT_EQ(json["right"], 4);
  EXPECT_EQ(json["wrong"], 3);
  const MotionTemplate better = ReadTemplate(better_);
  EXPECT_EQ(better.marks.size(), 7U);
  EXPECT_FALSE(better.contrast);
  EXPECT_THAT(RunKinebase({"template", "show", better_}).out, HasSubstr("4 right, 3 wrong"));
  EXPECT_THAT(better.tau_origin, HasSubstr("4 right and 3 wrong marks"));
  // With its own threshold it finds all squats, and nothing else.
  const auto hits =
      RunKinebase({"search", better_, "--in", library_.folder(), "--json", "-q"}).Json()["hits"];
  ASSERT_EQ(hits.size(), 4U);
  for (const auto& hit : hits) EXPECT_THAT(hit["file"], HasSubstr("/squat1Reps/"));
}

TEST_F(Feedback, OfItsOwnClipsLeavesHitsAsTheyWere) {
  const std::string squats = library_.Clip("squat1Reps", "sa", 1).string() + ",1,250,right\n" +
                             library_.Clip("squat1Reps", "sa", 2).string() + ",1,240,right\n";
  ASSERT_EQ(Update(Marks(squats)).exit_code, 0);
  EXPECT_EQ(HitsOf(better_), HitsOf(template_));
}

TEST_F(Feedback, RemembersEarlierMarks) {
  const std::string kick = library_.Clip("kickRFront1Reps", "sb", 1);
  const std::string squat = library_.Clip("squat1Reps", "sb", 1);
  const MotionTemplate original = ReadTemplate(template_);
  ASSERT_EQ(Update(Marks(kick + ",1,150,wrong\n")).exit_code, 0);
  template_ = better_;
  const auto second = Update(Marks(squat + ",1,250,right\n"), {"--json"}).Json();
  EXPECT_EQ(second["clips_added"], 1);
  EXPECT_THAT(ReadTemplate(better_).marks,
              ElementsAre(TemplateMark{kick, 1, 150, Verdict::kWrong},
                          TemplateMark{squat, 1, 250, Verdict::kRight}));
  // People may change their minds.
  const auto third = Update(Marks(squat + ",1,250,wrong\n"), {"--json"}).Json();
  EXPECT_EQ(third["clips_dropped"], 1);
  EXPECT_EQ(ReadTemplate(better_).matrix, original.matrix);
}

TEST_F(Feedback, SharpensTemplatesThatKnowOtherMotion) {
  const fs::path folder = library_.scratch() / "classes";
  ASSERT_EQ(RunKinebase({"learn", "--list", library_.list(), "--all-classes", "--method", "mt+",
                         "-o", folder})
                .exit_code,
            0);
  template_ = folder / "squat1Reps.template.json";
  const std::string jack = library_.Clip("jumpingJack1Reps", "sb", 1);
  ASSERT_EQ(Update(Marks(jack + ",1,180,wrong\n")).exit_code, 0);
  const MotionTemplate before = ReadTemplate(template_);
  const MotionTemplate after = ReadTemplate(better_);
  ASSERT_TRUE(after.contrast && after.calibration);
  EXPECT_EQ(after.matrix, before.matrix);
  EXPECT_NE(after.contrast->entry_weights, before.contrast->entry_weights);
  EXPECT_EQ(after.contrast->background, before.contrast->background);
}

TEST_F(Feedback, GoesOnWithoutTheClips) {
  const fs::path alone = library_.scratch() / "alone";
  const std::string squat = library_.Clip("squat1Reps", "sb", 1);
  fs::create_directories(alone);
  fs::copy_file(template_, alone / "squat.json");
  template_ = alone / "squat.json";
  const std::string marks = alone / "marks.csv";
  WriteText(marks, std::string(kHead) + squat + ",1,250,right\n");
  const ProgramResult updated =
      RunKinebase({"learn", "--update", template_, "--marks", marks, "-o", better_});
  EXPECT_EQ(updated.exit_code, 0) << updated.err;
  EXPECT_THAT(updated.err, AllOf(HasSubstr("2 of its clips cannot be had"),
                                 HasSubstr("averaged in instead"), HasSubstr("--in")));
  EXPECT_NE(ReadTemplate(better_).matrix, ReadTemplate(template_).matrix);
}

TEST_F(Feedback, SaysInOneLineWhatIsWrong) {
  const std::string squat = library_.Squat();
  const auto expect = [&](const std::string& rows, const std::vector<std::string>& parts) {
    ExpectOneError(Update(Marks(rows), {"-q"}), 1, parts);
  };
  expect("nowhere.amc,1,9,right\n", {"hits.csv:2", "nowhere.amc", "--in"});
  expect(squat + ",1,9,perhaps\n", {"hits.csv:2", "'perhaps'", "right or wrong"});
  expect(squat + ",1,99999,right\n", {squat, "99999", "it has 1 to"});
  expect(squat + ",1,200,right\n" + squat + ",10,210,wrong\n",
         {"hits.csv:3", "is marked wrong", "the same stretch"});
  expect(squat + ",1,200,\n", {"hits.csv", "no hit is marked"});
  WriteText(library_.scratch() / "other.csv",
            "template,file,first_frame,last_frame,verdict\nkick," + squat + ",1,9,wrong\n");
  ExpectOneError(Update(library_.scratch() / "other.csv", {"-q"}), 1,
                 {"hits of kick", "none of 'squat1Reps'"});
  EXPECT_FALSE(fs::exists(better_));
  const std::string marks = Marks(squat + ",1,200,right\n");
  ExpectOneError(RunKinebase({"learn", "--update", template_, "-q"}), 2, {"--marks"});
  ExpectOneError(RunKinebase({"learn", squat, "--marks", marks, "-q"}), 2, {"--update"});
  ExpectOneError(Update(marks, {"--method", "mt", "-q"}), 2, {"--method", "--update"});
  ExpectOneError(RunKinebase({"learn", "--update", template_, "--marks", marks, "-q"}), 1,
                 {template_, "--force"});
  ExpectOneError(RunKinebase({"learn", squat, "--in", library_.folder(), "--name", "x", "-q"}), 2,
                 {"--list", "--update"});
}

TEST_F(Feedback, HitsHaveOneFormatAtATime) {
  ExpectOneError(RunKinebase({"search", template_, "--in", library_.folder(), "--json", "--format",
                              "csv", "-q"}),
                 2, {"--json and --format csv"});
  const std::vector<std::string> search = {"search", template_, "--in", library_.folder(), "-q"};
  const auto hits_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = search;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments).Json()["hits"];
  };
  EXPECT_EQ(hits_of({"--format", "json"}), hits_of({"--json"}));
}

}  // namespace
}  // namespace kinebase::test
