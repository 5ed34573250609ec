// annotate, learn and search over a library give what they give over its files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::SizeIs;

using Arguments = std::vector<std::string>;

Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// What a command prints as JSON, but for the time that it took.
std::string Output(const Arguments& arguments, int exit_code = 0) {
  const ProgramResult result = RunKinebase(arguments + Arguments{"--json", "--quiet"});
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  auto json = result.Json();
  json.erase("elapsed_s");
  return json.dump(1);
}

// Two JSON texts that agree but for numbers, which are near each other.
void ExpectNear(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b, double error) {
  if (a.is_number_float() || b.is_number_float()) {
    EXPECT_NEAR(a.get<double>(), b.get<double>(), error);
    return;
  }
  ASSERT_EQ(a.type(), b.type());
  if (!a.is_structured()) {
    EXPECT_EQ(a, b);
    return;
  }
  ASSERT_EQ(a.size(), b.size());
  for (auto left = a.items().begin(), right = b.items().begin(); left != a.items().end();
       ++left, ++right) {
    ASSERT_EQ(left.key(), right.key());
    ExpectNear(left.value(), right.value(), error);
  }
}

class UseOfALibrary : public ::testing::Test {
 protected:
  UseOfALibrary() {
    const ProgramResult result =
        RunKinebase({"import", "--list", recordings_.list(), "--library", library_, "--poses"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }

  // A file in the scratch folder.
  [[nodiscard]] std::string Scratch(const std::string& name) const {
    return recordings_.scratch() / name;
  }

  // Templates of all classes by method mt+, from the list.
  [[nodiscard]] Arguments ClassTemplates() const {
    const std::string classes = Scratch("classes");
    EXPECT_EQ(RunKinebase({"learn", "--list", recordings_.list(), "--all-classes", "-o", classes,
                           "--quiet"})
                  .exit_code,
              0);
    const std::vector<fs::path> files = FilesBelow(classes, ".json");
    return {files.begin(), files.end()};
  }

  SyntheticLibrary recordings_;
  std::string library_ = recordings_.scratch() / "motion.kinebase";
};

TEST_F(UseOfALibrary, AnnotatesLikeItsFiles) {
  const std::string squat = recordings_.Learn("squat1Reps");
  const std::string kick = recordings_.Learn("kickRFront1Reps");
  const Arguments files = {"--in", recordings_.folder()};
  const Arguments stored = {"--library", library_};
  for (const Arguments& options :
       {Arguments{squat, kick}, Arguments{squat, kick, "--tau", "0.2", "--overlap", "all"},
        Arguments{squat, kick, "--background", recordings_.folder() / "cut_amc/jumpingJack1Reps"},
        Arguments{squat, "--merge", "1", "--no-unknown"}}) {
    const std::string expected = Output(Arguments{"annotate"} + options + files);
    EXPECT_THAT(expected, HasSubstr("squat1Reps"));
    EXPECT_EQ(Output(Arguments{"annotate"} + options + stored), expected);
    EXPECT_EQ(Output(Arguments{"annotate"} + options + stored + Arguments{"--threads", "1"}),
              expected);
  }
  // A library is a background, too.
  EXPECT_EQ(Output({"annotate", squat, "--in", recordings_.folder(), "--background", library_}),
            Output({"annotate", squat, "--in", recordings_.folder(), "--background",
                    recordings_.folder()}));
  EXPECT_EQ(Output({"annotate", squat, "--library", library_, "--actors", "sb", "--classes",
                    "squat1Reps"}),
            Output({"annotate", squat, "--in", recordings_.Clip("squat1Reps", "sb", 1),
                    recordings_.Clip("squat1Reps", "sb", 2)}));
}

// Only the squats have the features of both profiles.
TEST_F(UseOfALibrary, NamesTakesThatLackFeaturesAndGivesWhatTheOthersShow) {
  const std::string library = Scratch("two.kinebase");
  const std::string squats = recordings_.folder() / "cut_amc/squat1Reps";
  ASSERT_EQ(RunKinebase({"import", "--list", recordings_.list(), "--profile", "paper", "--library",
                         library})
                .exit_code,
            0);
  ASSERT_EQ(RunKinebase({"import", squats, "--library", library}).exit_code, 0);
  const std::string squat = recordings_.Learn("squat1Reps");  // In profile bonn.
  const std::string kick = Scratch("kick.template.json");
  ASSERT_EQ(RunKinebase({"learn", "--list", recordings_.list(), "--class", "kickRFront1Reps",
                         "--profile", "paper", "-o", kick})
                .exit_code,
            0);
  const auto run = [&](const Arguments& arguments, int exit_code) {
    return nlohmann::ordered_json::parse(Output(arguments + Arguments{"--tau", "0.1"}, exit_code));
  };
  for (const auto& [command, list] :
       {std::pair(Arguments{"search"}, "hits"),
        std::pair(Arguments{"annotate", "--overlap", "all", "--no-unknown"}, "segments")}) {
    SCOPED_TRACE(list);
    const auto both = run(command + Arguments{squat, kick, "--library", library}, 3);
    EXPECT_THAT(both["failed"], SizeIs(8));
    const std::size_t squats_alone =
        run(command + Arguments{squat, "--in", squats}, 0)[list].size();
    const std::size_t kicks_alone =
        run(command + Arguments{kick, "--in", recordings_.folder() / "cut_amc"}, 0)[list].size();
    EXPECT_GT(squats_alone, 0U);
    EXPECT_GT(kicks_alone, 0U);
    EXPECT_EQ(both[list].size(), squats_alone + kicks_alone);
  }
}

// Stored poses are rounded, and with them what mt+ templates cost.
TEST_F(UseOfALibrary, AnnotatesByPosesNearlyLikeItsFiles) {
  const Arguments annotate = Arguments{"annotate"} + ClassTemplates();
  const std::string expected = Output(annotate + Arguments{"--in", recordings_.folder()});
  const std::string found = Output(annotate + Arguments{"--library", library_});
  ExpectNear(nlohmann::ordered_json::parse(found), nlohmann::ordered_json::parse(expected), 1e-3);
}

TEST_F(UseOfALibrary, LearnsLikeFromItsFiles) {
  const Arguments stored = {"learn", "--library", library_, "--class", "squat1Reps"};
  const Arguments listed = {"learn", "--list", recordings_.list(), "--class", "squat1Reps"};
  for (const Arguments& options :
       {Arguments{}, Arguments{"--actors", "sb"}, Arguments{"--learning", "paper"}}) {
    for (const auto& [from, name] : {std::pair(stored, "stored"), std::pair(listed, "listed")}) {
      const ProgramResult result =
          RunKinebase(from + options + Arguments{"-o", Scratch(name), "--force"});
      EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    EXPECT_EQ(ReadText(Scratch("stored")), ReadText(Scratch("listed")));
  }
}

TEST_F(UseOfALibrary, LearnsWhatSetsClassesOffNearlyLikeFromItsFiles) {
  const std::string jacks = recordings_.folder() / "cut_amc/jumpingJack1Reps";
  const std::string others = Scratch("others.kinebase");
  ASSERT_EQ(RunKinebase({"import", jacks, "--library", others, "--poses"}).exit_code, 0);
  const Arguments stored = {"learn", "--library", library_, "--background", others};
  const Arguments listed = {"learn", "--list", recordings_.list(), "--background", jacks};
  // The background is of takes that are learned from when all classes are.
  for (const Arguments& options :
       {Arguments{"--class", "squat1Reps", "--method", "mt"}, Arguments{"--all-classes"}}) {
    const bool is_refused = options.back() == "mt";
    const int exit_code = is_refused ? 2 : 1;
    EXPECT_EQ(RunKinebase(stored + options + Arguments{"-o", Scratch("a")}).exit_code, exit_code);
    EXPECT_EQ(RunKinebase(listed + options + Arguments{"-o", Scratch("b")}).exit_code, exit_code);
  }
  EXPECT_EQ(RunKinebase({"learn", "--library", library_, "--all-classes", "-o", Scratch("stored")})
                .exit_code,
            0);
  (void)ClassTemplates();
  for (const std::string name : {"squat1Reps", "kickRFront1Reps", "jumpingJack1Reps"}) {
    SCOPED_TRACE(name);
    const std::string file = name + ".template.json";
    ExpectNear(nlohmann::ordered_json::parse(ReadText(fs::path(Scratch("stored")) / file)),
               nlohmann::ordered_json::parse(ReadText(fs::path(Scratch("classes")) / file)), 0.01);
  }
}

TEST_F(UseOfALibrary, LearnsFromChosenTakesAndFromStretchesWithALabel) {
  const auto learn = [&](const Arguments& options, const std::string& name) {
    const ProgramResult result = RunKinebase(Arguments{"learn", "--library", library_} + options +
                                             Arguments{"-o", Scratch(name), "--force", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.Json()["clips"];
  };
  const auto label = [&](const Arguments& options) {
    const ProgramResult result = RunKinebase(Arguments{"library", "label", library_} + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  const std::string squat = recordings_.Clip("squat1Reps", "sb", 1);
  label({squat, "--add", "good"});
  EXPECT_EQ(learn({"--class", "squat1Reps", "--labelled", "good"}, "a"), 1);
  EXPECT_EQ(learn({"--class", "squat1Reps", "--text", "squat sb"}, "b"), 2);
  EXPECT_EQ(learn({"--label", "good"}, "c"), 1);
  // The label's name aside, learning from the labelled take is learning from its file.
  EXPECT_EQ(learn({"--label", "good", "--name", "squat"}, "d"), 1);
  ASSERT_EQ(RunKinebase({"learn", squat, "--name", "squat", "-o", Scratch("e")}).exit_code, 0);
  EXPECT_EQ(ReadText(Scratch("d")), ReadText(Scratch("e")));
  ExpectOneError(RunKinebase({"learn", squat, "--label", "good", "-o", Scratch("f")}), 2,
                 {"--library"});
  ExpectOneError(
      RunKinebase({"learn", "--library", library_, "--label", "bad", "-o", Scratch("f")}), 1,
      {"'bad'", "good"});
}

TEST_F(UseOfALibrary, SaysWhatIsWrongWithItsUse) {
  const std::string squat = recordings_.Learn("squat1Reps");
  ExpectOneError(RunKinebase({"annotate", squat}), 2, {"--in is required, or --library"});
  ExpectOneError(
      RunKinebase({"annotate", squat, "--in", recordings_.folder(), "--library", library_}), 2,
      {"--library"});
  ExpectOneError(RunKinebase({"search", squat, "--library", library_, "--memory", "1M"}), 2,
                 {"--memory", "64M", "'1M'"});
  ExpectOneError(RunKinebase({"search", squat, "--library", library_, "--memory", "much"}), 2,
                 {"--memory", "'much'"});
  ExpectOneError(
      RunKinebase({"learn", "--library", library_, "--class", "swim", "-o", Scratch("swim")}), 1,
      {"swim", "squat1Reps"});
  ExpectOneError(RunKinebase({"learn", "--library", library_, "-o", Scratch("none")}), 2,
                 {"--library needs either --class NAME or --all-classes"});
  EXPECT_EQ(Output({"search", squat, "--library", library_, "--memory", "64M"}),
            Output({"search", squat, "--library", library_, "--memory", "4G"}));
}

// All clips of HDM05 and all takes of CMU in one library.
TEST(LibraryOfRealRecordings, IsSearchedAndAnnotatedLikeItsFiles) {
  KINEBASE_NEEDS_TEST_DATA();
  const TemporaryFolder folder;
  const std::string library = folder.path() / "real.kinebase";
  const std::string list = TestData("data/hdm05/clips.csv");
  // By path, as a library has its takes.
  const Arguments recordings = {fs::canonical(TestData("data/cmu")),
                                fs::canonical(TestData("data/hdm05/cut_amc"))};
  Arguments templates;
  for (const std::string name : {"squat1Reps", "elbowToKnee1RepsLelbowStart", "throwBasketball"}) {
    templates.push_back(folder.path() / (name + ".template.json"));
    const ProgramResult learned =
        RunKinebase({"learn", "--list", list, "--class", name, "-o", templates.back(), "--quiet"});
    ASSERT_EQ(learned.exit_code, 0) << learned.err;
  }
  (void)RunKinebase(Arguments{"import", "--library", library, "--quiet"} + recordings);
  const auto expect_same = [&](const Arguments& command, int exit_code) {
    const std::string expected = Output(command + Arguments{"--in"} + recordings, exit_code);
    EXPECT_THAT(expected, HasSubstr("squat1Reps"));
    for (const std::string threads : {"1", "2", "7"}) {
      EXPECT_EQ(Output(command + Arguments{"--library", library, "--threads", threads}, 0),
                expected);
    }
  };
  expect_same(Arguments{"search", "--tau", "0.2", "--top", "2000"} + templates, 0);
  expect_same(Arguments{"search", "--keyframes", "auto", "--tau", "0.2"} + templates, 0);
  expect_same(Arguments{"search", "--mirror", "--tau", "0.15"} + templates, 0);
  expect_same(Arguments{"search", "--fuzzy", "--features", "lower", "--faults", "1"} +
                  Arguments{templates.front()},
              0);
  expect_same(Arguments{"annotate", "--tau", "0.1"} + templates, 0);
}

}  // namespace
}  // namespace kinebase::test
