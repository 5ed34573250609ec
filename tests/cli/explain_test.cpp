// explain as scripts and people see it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Explaining : public ::testing::Test {
 protected:
  ProgramResult Explain(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"explain", template_, "--in",
                                          library_.Clip("squat1Reps", "sb", 1)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

  SyntheticLibrary library_;
  std::string template_ = library_.Learn("squat1Reps");
};

TEST_F(Explaining, AccountsForWhatSearchFound) {
  const std::string clip = library_.Clip("squat1Reps", "sb", 1);
  const auto hit =
      RunKinebase({"search", template_, "--in", clip, "--tau", "1", "--json"}).Json()["hits"][0];
  const auto json = Explain({"--json"}).Json();
  EXPECT_THAT(FieldsOf(json), ElementsAre("template:string", "file:string", "first_frame:integer",
                                          "last_frame:integer", "start_s:number", "end_s:number",
                                          "cost:number", "path:array", "features:array"));
  for (const std::string field :
       {"template", "file", "first_frame", "last_frame", "start_s", "end_s", "cost"}) {
    EXPECT_EQ(json[field], hit[field]) << field;
  }
  EXPECT_THAT(FieldsOf(json["path"][0]),
              ElementsAre("template_column:integer", "column:integer", "cost:number",
                          "agreed:array", "disagreed:array"));
  EXPECT_THAT(FieldsOf(json["features"][0]),
              ElementsAre("id:string", "name:string", "agreed:integer", "disagreed:integer",
                          "cost:number"));
  const double cost = json["cost"];
  for (const std::string list : {"path", "features"}) {
    double sum = 0;
    for (const auto& entry : json[list]) sum += entry["cost"].get<double>();
    EXPECT_NEAR(sum, cost, 1e-12) << list;
  }
  const std::string range = std::to_string(hit["first_frame"].get<int>()) + '-' +
                            std::to_string(hit["last_frame"].get<int>());
  EXPECT_EQ(Explain({"--json", "--hit", range}).Json(), json);
}

TEST_F(Explaining, SaysItInWordsToo) {
  const ProgramResult result = Explain({});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("squat1Reps in "), ContainsRegex("cost 0\\.[0-9]{4}: "),
                                HasSubstr("entries along the path are as the template asks"),
                                HasSubstr("without a fault\n")));
}

TEST_F(Explaining, DrawsThePicture) {
  for (const std::string extension : {".svg", ".png"}) {
    const std::string file = library_.scratch() / ("why" + extension);
    const ProgramResult result = Explain({"-o", file, "--hit", "1-200"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("written to " + file));
    EXPECT_GT(fs::file_size(file), 1000U);
    ExpectOneError(Explain({"-o", file, "-q"}), 1, {file + ": exists already", "--force"});
  }
  EXPECT_THAT(ReadText(library_.scratch() / "why.svg"), HasSubstr("must hold and does not"));
}

// Templates of all classes with what sets them off, learned from actor sa.
class ExplainingWithContrast : public Explaining {
 protected:
  ExplainingWithContrast() {
    RunKinebase({"learn", "--list", library_.list(), "--all-classes", "--actors", "sa", "--method",
                 "mt+", "-o", folder_, "-q"});
  }

  [[nodiscard]] std::string File(const std::string& class_name) const {
    return folder_ / (class_name + ".template.json");
  }

  fs::path folder_ = library_.scratch() / "classes";
  std::string clip_ = library_.Clip("squat1Reps", "sb", 1);
};

TEST_F(ExplainingWithContrast, AddsUpToTheCostThatSearchPrints) {
  const std::vector<std::string> templates = {File("squat1Reps"), File("kickRFront1Reps"),
                                              File("jumpingJack1Reps")};
  const auto hits = RunKinebase({"search", templates[0], templates[1], templates[2], "--in", clip_,
                                 "--tau", "9", "--json", "-q"})
                        .Json()["hits"];
  const auto hit = *std::ranges::find(hits, "squat1Reps", [](const auto& each) {
    return each["template"].template get<std::string>();
  });
  const ProgramResult run = RunKinebase(
      {"explain", templates[0], templates[1], templates[2], "--in", clip_, "--json", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = run.Json();
  EXPECT_THAT(FieldsOf(json),
              ElementsAre("template:string", "file:string", "first_frame:integer",
                          "last_frame:integer", "start_s:number", "end_s:number", "cost:number",
                          "features_cost:number", "poses_cost:number", "lookalikes_cost:number",
                          "score:number", "confidence:number", "rival:object", "path:array",
                          "features:array", "joints:array"));
  for (const std::string field : {"template", "file", "first_frame", "last_frame", "start_s",
                                  "end_s", "cost", "confidence"}) {
    EXPECT_EQ(json[field], hit[field]) << field;
  }
  const auto sum_of = [&](const char* list, const char* field) {
    double sum = 0;
    for (const auto& entry : json[list]) sum += entry[field].template get<double>();
    return sum;
  };
  const double features = json["features_cost"];
  const double poses = json["poses_cost"];
  EXPECT_NEAR(features + poses + json["lookalikes_cost"].get<double>(), json["cost"].get<double>(),
              1e-12);
  EXPECT_NEAR(sum_of("path", "cost"), features, 1e-12);
  EXPECT_NEAR(sum_of("features", "cost"), features, 1e-12);
  EXPECT_NEAR(sum_of("path", "poses_cost"), poses, 1e-12);
  EXPECT_NEAR(sum_of("joints", "cost"), poses, 1e-12);
  EXPECT_NEAR(json["cost"].get<double>() + json["rival"]["penalty"].get<double>(),
              json["score"].get<double>(), 1e-12);
  EXPECT_NE(json["rival"]["template"], "squat1Reps");
  EXPECT_THAT(FieldsOf(json["joints"][0]),
              ElementsAre("joint:string", "cost:number", "most_off:object"));
  EXPECT_THAT(FieldsOf(json["joints"][0]["most_off"]),
              ElementsAre("direction:string", "spreads:number", "cost:number", "frame:integer"));
  for (const auto& cell : json["path"]) EXPECT_LE(cell["off"].size(), 3);
  // Plain, it is what a plain template gives.
  auto plain =
      RunKinebase({"explain", templates[0], "--in", clip_, "--method", "mt", "--json"}).Json();
  EXPECT_EQ(plain, Explain({"--json"}).Json());
}

TEST_F(ExplainingWithContrast, SaysWhichJointsWereOffAndDrawsThem) {
  const std::string file = library_.scratch() / "why.svg";
  const ProgramResult run = RunKinebase({"explain", File("squat1Reps"), File("kickRFront1Reps"),
                                         "--in", clip_, "--hit", "1-200", "-o", file});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out,
              AllOf(ContainsRegex("cost [0-9.]+: features [0-9.]+ and poses [0-9.]+; confidence "),
                    HasSubstr("rival"), ContainsRegex("[0-9.]+ spreads too "),
                    HasSubstr("entries along the path are as the template asks")));
  EXPECT_THAT(ReadText(file), AllOf(HasSubstr("rwrist"), HasSubstr("1 spread off"),
                                    HasSubstr("cost of features ")));
}

TEST_F(ExplainingWithContrast, SaysWhatCannotBeARival) {
  ExpectOneError(RunKinebase({"explain", File("squat1Reps"), template_, "--in", clip_, "-q"}), 1,
                 {template_, "no rivals", "--method mt+"});
  ExpectOneError(RunKinebase({"explain", File("squat1Reps"), File("kickRFront1Reps"), "--in", clip_,
                              "--method", "mt", "-q"}),
                 1, {"no rivals"});
  ExpectOneError(RunKinebase({"explain", template_, "--in", clip_, "--method", "mt+", "-q"}), 1,
                 {template_, "is a plain template"});
  const std::string other = library_.scratch() / "paper";
  RunKinebase({"learn", "--list", library_.list(), "--all-classes", "--method", "mt+", "--profile",
               "paper", "-o", other, "-q"});
  ExpectOneError(RunKinebase({"explain", File("squat1Reps"), other + "/squat1Reps.template.json",
                              "--in", clip_, "-q"}),
                 1, {"feature set 'paper'", "'bonn'"});
}

TEST_F(Explaining, SaysInOneLineWhatIsWrong) {
  const std::string clip = library_.Clip("squat1Reps", "sb", 1);
  ExpectOneError(Explain({"--hit", "1-2", "-q"}), 1, {clip, "nothing that ends at frame 2"});
  ExpectOneError(Explain({"--hit", "1-99999", "-q"}), 1, {clip, "has frames 1 to", "not 99999"});
  ExpectOneError(Explain({"--hit", "soon", "-q"}), 2, {"a stretch is first-last"});
  ExpectOneError(Explain({"--hit", "9-3", "-q"}), 2, {"1 ≤ first ≤ last"});
  ExpectOneError(RunKinebase({"explain", template_, "-q"}), 2, {"--in is required"});
  ExpectOneError(RunKinebase({"explain", template_, "--in", "nowhere.amc", "-q"}), 1,
                 {"nowhere.amc"});
}

}  // namespace
}  // namespace kinebase::test
