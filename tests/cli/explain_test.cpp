// explain as scripts and people see it.
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
