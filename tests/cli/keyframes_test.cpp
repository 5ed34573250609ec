// template keyframes, and searching with them, as scripts and people see it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Keyframing : public ::testing::Test {
 protected:
  ProgramResult Keyframes(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"template", "keyframes", template_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

  ProgramResult Search(const std::string& file, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"search", file, "--in", library_.folder()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

  SyntheticLibrary library_;
  std::string template_ = library_.Learn("squat1Reps");
  std::string output_ = library_.scratch() / "keyframes.json";
};

TEST_F(Keyframing, ChoosesWritesAndLists) {
  const ProgramResult chosen = Keyframes({"--auto", "2", "-o", output_, "--json"});
  ASSERT_EQ(chosen.exit_code, 0) << chosen.err;
  const auto json = chosen.Json();
  EXPECT_THAT(FieldsOf(json), ElementsAre("name:string", "columns:integer", "keyframes:array"));
  ASSERT_EQ(json["keyframes"].size(), 2U);
  EXPECT_THAT(FieldsOf(json["keyframes"][0]),
              ElementsAre("column:integer", "ones:array", "zeros:array", "misses:integer",
                          "stiffness:null"));
  EXPECT_LT(json["keyframes"][0]["column"], json["keyframes"][1]["column"]);
  EXPECT_EQ(RunKinebase({"template", "keyframes", output_, "--json"}).Json(), json);
  EXPECT_THAT(RunKinebase({"template", "show", output_}).out, HasSubstr("keyframes  2 ("));
  const ProgramResult listed = RunKinebase({"template", "keyframes", output_});
  EXPECT_THAT(listed.out, AllOf(HasSubstr("must hold"), HasSubstr("misses")));
  EXPECT_THAT(listed.err, HasSubstr("squat1Reps: 2 keyframes"));
}

TEST_F(Keyframing, TakesThemByHandAndAway) {
  const ProgramResult set =
      Keyframes({"--set", "30:lower:1", "--set", "20:F37", "--stiffness", "0.5", "-o", output_});
  ASSERT_EQ(set.exit_code, 0) << set.err;
  const auto keyframes =
      RunKinebase({"template", "keyframes", output_, "--json"}).Json()["keyframes"];
  ASSERT_EQ(keyframes.size(), 2U);
  EXPECT_EQ(keyframes[0]["column"], 20);
  EXPECT_EQ(keyframes[0]["stiffness"], nullptr);
  EXPECT_EQ(keyframes[1]["column"], 30);
  EXPECT_EQ(keyframes[1]["misses"], 1);
  EXPECT_EQ(keyframes[1]["stiffness"], 0.5);
  const std::string cleared = library_.scratch() / "cleared.json";
  EXPECT_EQ(RunKinebase({"template", "keyframes", output_, "--clear", "-o", cleared}).exit_code, 0);
  EXPECT_EQ(ReadText(cleared), ReadText(template_));
}

// A preselection only takes away: each hit it leaves is one of the exact search.
TEST_F(Keyframing, NarrowsTheSearchAndSaysSo) {
  ASSERT_EQ(Keyframes({"--auto", "2", "-o", output_}).exit_code, 0);
  const auto exact = Search(template_, {"--json", "-q"}).Json();
  EXPECT_FALSE(exact.contains("searched_share"));
  EXPECT_EQ(Search(output_, {"--json", "-q"}).Json()["hits"], exact["hits"]);
  const auto narrowed = Search(output_, {"--keyframes", "auto", "--json", "-q"}).Json();
  EXPECT_LT(narrowed["searched_share"], 0.9);
  ASSERT_FALSE(narrowed["hits"].empty());
  for (const auto& hit : narrowed["hits"]) EXPECT_THAT(exact["hits"], ::testing::Contains(hit));
  EXPECT_EQ(Search(template_, {"--keyframes", output_, "--json", "-q"}).Json()["hits"],
            narrowed["hits"]);
  EXPECT_EQ(Search(template_, {"--keyframes", "auto", "--json", "-q"}).Json()["hits"],
            narrowed["hits"]);
  EXPECT_THAT(Search(output_, {"--keyframes", "auto"}).err,
              AllOf(HasSubstr("keyframes left "), HasSubstr("% of the columns to search"),
                    HasSubstr("is missed")));
}

TEST_F(Keyframing, SaysInOneLineWhatIsWrong) {
  ExpectOneError(Keyframes({"--auto", "2", "-q"}), 2, {"-o, --output is required"});
  ExpectOneError(Keyframes({"-o", output_, "-q"}), 2, {"--auto, --set or --clear"});
  ExpectOneError(Keyframes({"--auto", "0", "-o", output_, "-q"}), 2, {"--auto"});
  ExpectOneError(Keyframes({"--clear", "--set", "3:upper", "-o", output_, "-q"}), 2, {"--clear"});
  const auto set = [&](const std::string& text) {
    return Keyframes({"--set", text, "-o", output_, "-q"});
  };
  ExpectOneError(set("soon"), 2, {"'soon'", "COLUMN:FEATURES"});
  ExpectOneError(set("999:upper"), 2, {"the template has columns 0 to"});
  ExpectOneError(set("20:F99"), 2, {"'F99'", "F1 to F39", "upper, lower, mix"});
  ExpectOneError(set("20:F1,F20"), 2, {"several groups"});
  ExpectOneError(set("20:F37:1"), 1, {"1 misses; expected 0 to 0"});
  EXPECT_FALSE(fs::exists(output_));
  const auto search = [&](const std::string& file) {
    return Search(template_, {"--keyframes", file, "-q"});
  };
  ExpectOneError(search(template_), 1, {template_, "holds no keyframes"});
  ExpectOneError(search("nowhere.json"), 1, {"nowhere.json"});
  const std::string kick = library_.Learn("kickRFront1Reps");
  ASSERT_EQ(RunKinebase({"template", "keyframes", kick, "--auto", "2", "-o", output_}).exit_code,
            0);
  ExpectOneError(search(output_), 1, {output_, "keyframes of another template"});
}

}  // namespace
}  // namespace kinebase::test
