// template compile as scripts and people see it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "kinebase/templates/query.h"
#include "kinebase/templates/template_file.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Compiling : public ::testing::Test {
 protected:
  ProgramResult Compile(const std::string& query, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"template", "compile", query, "-o", output_});
    return RunKinebase(more);
  }

  TemporaryFolder folder_;
  std::string output_ = folder_.path() / "q.template.json";
};

TEST_F(Compiling, WritesTheTemplateAndShowsItsPhases) {
  const std::string query = "rhand raised & lknee bent for 0.3s then both feet apart";
  const ProgramResult result = Compile(query);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out,
            "columns    seconds  asks for\n"
            "    0-8  0.00-0.30  rhand above neck & lknee bent\n"
            "   9-17  0.30-0.60  feet far apart, sideways\n");
  EXPECT_EQ(result.err, "written to " + output_ + "\n");
  EXPECT_EQ(ReadTemplate(output_), CompileQuery(query, LoadFeatureSet("bonn")).templates[0]);
  EXPECT_THAT(RunKinebase({"template", "show", output_}).out, HasSubstr("query: " + query));
  EXPECT_EQ(RunKinebase({"template", "render", output_, "-o", folder_.path() / "q.svg"}).exit_code,
            0);
  ExpectOneError(Compile(query), 1, {output_ + ": exists already", "--force"});
}

TEST_F(Compiling, GivesJson) {
  const auto json = Compile("F3 then within 1s not lknee bent",
                            {"--json", "--name", "mine", "--rate", "60", "--profile", "paper"})
                        .Json();
  EXPECT_THAT(FieldsOf(json), ElementsAre("templates:array", "phases:array"));
  EXPECT_THAT(FieldsOf(json["templates"][0]),
              ElementsAre("name:string", "columns:integer", "file:string"));
  EXPECT_EQ(json["templates"][0]["name"], "mine");
  EXPECT_EQ(json["templates"][0]["columns"], 66);
  ASSERT_EQ(json["phases"].size(), 3U);
  EXPECT_THAT(FieldsOf(json["phases"][2]),
              ElementsAre("first_column:integer", "last_column:integer", "start_s:number",
                          "end_s:number", "asks_for:array"));
  EXPECT_EQ(json["phases"][1]["asks_for"].size(), 0U);
  EXPECT_EQ(json["phases"][2]["asks_for"][0], "not F21");
  EXPECT_EQ(json["phases"][2]["first_column"], 48);
  const MotionTemplate compiled = ReadTemplate(output_);
  EXPECT_EQ(compiled.feature_set, "paper");
  EXPECT_EQ(compiled.matching, Profile::kPaper);
}

TEST_F(Compiling, WritesBothSidesBesideEachOther) {
  const std::string other = folder_.path() / "q-mirrored.template.json";
  ASSERT_EQ(Compile("either side: rknee bent then rfoot fast").exit_code, 0);
  EXPECT_EQ(ReadTemplate(other), MirrorTemplate(ReadTemplate(output_), LoadFeatureSet("bonn")));
  // Both or none: the second is there already.
  fs::remove(output_);
  ExpectOneError(Compile("either side: rknee bent"), 1, {other + ": exists already"});
  EXPECT_FALSE(fs::exists(output_));
  output_ = folder_.path() / "plain.json";
  ASSERT_EQ(Compile("either side: rknee bent").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_.path() / "plain-mirrored.json"));
}

TEST_F(Compiling, PointsAtTheWordThatIsWrong) {
  const ProgramResult result = Compile("lknee bent & rhand raisd for 1s");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err,
            "error: query, column 20: 'raisd' is unknown; did you mean 'rhand raised' or 'lhand "
            "raised'?\n"
            "  lknee bent & rhand raisd for 1s\n"
            "                     ^~~~~\n");
  EXPECT_FALSE(fs::exists(output_));
}

TEST_F(Compiling, ListsItsWords) {
  const ProgramResult result = RunKinebase({"template", "compile", "--list"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("\nrhand raised "));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("\nrknee straight +not F20\n"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("\nboth hands raised +F3 & F4\n"));
  const auto json = RunKinebase({"template", "compile", "--list", "--json"}).Json();
  EXPECT_THAT(FieldsOf(json), ElementsAre("feature_set:string", "phrases:array"));
  EXPECT_THAT(FieldsOf(json["phrases"][0]), ElementsAre("text:string", "asks_for:array"));
  EXPECT_GT(json["phrases"].size(), 150U);
}

TEST_F(Compiling, TakesFeatureSetsOfOnesOwn) {
  const std::string set = folder_.path() / "my.toml";
  WriteText(set,
            "format = \"kinebase-feature-set\"\nversion = 1\nname = \"mine\"\n[[feature]]\n"
            "id = \"H\"\nname = \"hand up\"\nsynonyms = [\"waving\"]\nstrong = 1\nweak = 1\n"
            "unit = \"cm\"\nterms = [{ type = \"height\", joints = [\"rwrist\"] }]\n");
  EXPECT_EQ(Compile("waving for 1s", {"--feature-set", set}).exit_code, 0);
  EXPECT_EQ(ReadTemplate(output_).matrix.values, std::vector<double>(30, 1.0));
  EXPECT_THAT(RunKinebase({"template", "compile", "--list", "--feature-set", set}).out,
              ::testing::ContainsRegex("waving +H\n"));
}

TEST_F(Compiling, SaysInOneLineWhatIsMissing) {
  ExpectOneError(RunKinebase({"template", "compile"}), 2, {"compile needs a query, or --list"});
  ExpectOneError(RunKinebase({"template", "compile", "F3"}), 2, {"compile needs -o FILE"});
  ExpectOneError(Compile("F3", {"--rate", "50"}), 2, {"--rate", "50"});
  ExpectOneError(Compile("F3", {"--feature-set", "none"}), 1, {"'none'", "bonn, paper"});
  ExpectOneError(RunKinebase({"template", "compile", "rhand", "raised", "-o", output_}), 2,
                 {"'raised'"});
}

std::vector<std::string> FilesWithHits(const std::vector<std::string>& templates,
                                       const fs::path& folder) {
  std::vector<std::string> arguments = {"search", "--tau", "0.02", "--json", "-q", "--in", folder};
  arguments.insert(arguments.begin() + 1, templates.begin(), templates.end());
  std::vector<std::string> files;
  const auto found = RunKinebase(arguments).Json();
  for (const auto& hit : found["hits"]) files.push_back(hit["file"]);
  return files;
}

// docs/query-language.md says so.
TEST_F(Compiling, FindsTheSquatsOfHdm05FromWordsAlone) {
  KINEBASE_NEEDS_TEST_DATA();
  ASSERT_EQ(Compile("knees straight then within 1s knees bent & crouching & not rhand lowered & "
                    "not lhand lowered for 0.4s then within 1s knees straight")
                .exit_code,
            0);
  const auto files = FilesWithHits({output_}, TestData("data/hdm05/cut_amc"));
  EXPECT_EQ(files.size(), 37U);
  EXPECT_EQ(std::ranges::count_if(files,
                                  [](const std::string& file) {
                                    return file.find("squat1Reps") != std::string::npos;
                                  }),
            35);
}

// The three kicks of the take's labels: frames 3196 to 3496, 3522 to 3771, 3805 to 4070.
TEST_F(Compiling, FindsTheKicksOfALongTakeFromWordsAlone) {
  KINEBASE_NEEDS_TEST_DATA();
  ASSERT_EQ(Compile("either side: rknee bent & right thigh lifted then right foot raised & rknee "
                    "straight & right thigh lifted for 0.1s")
                .exit_code,
            0);
  const auto found =
      RunKinebase({"search", output_, folder_.path() / "q-mirrored.template.json", "--in",
                   TestData("data/cmu/86/86_01.amc"), "--tau", "0.02", "--json", "-q"})
          .Json();
  std::vector<std::pair<int, int>> hits;
  for (const auto& hit : found["hits"]) hits.emplace_back(hit["first_frame"], hit["last_frame"]);
  std::ranges::sort(hits);
  const std::vector<std::pair<int, int>> labels = {{3196, 3496}, {3522, 3771}, {3805, 4070}};
  ASSERT_EQ(hits.size(), labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_GE(hits[i].first, labels[i].first);
    EXPECT_LE(hits[i].second, labels[i].second);
  }
}

}  // namespace
}  // namespace kinebase::test
