// template draw, edit, combine, concatenate as scripts and people see them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "kinebase/features/vocabulary.h"
#include "kinebase/templates/editing.h"
#include "kinebase/templates/template_file.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class TemplateEditing : public ::testing::Test {
 protected:
  // kinebase template <arguments> -o <output>, which has to work.
  MotionTemplate Made(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "template");
    arguments.insert(arguments.end(), {"-o", output_, "--force", "--quiet"});
    const ProgramResult result = RunKinebase(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return ReadTemplate(output_);
  }

  MotionTemplate Drawn() const {
    return Made({"draw", "--length", "50", "--set", "F13,F32,F33=1", "--name", "brush"});
  }

  std::string DrawnFile() const {
    std::string file = folder_.path() / "brush.template.json";
    WriteTemplate(Drawn(), file, Overwrite::kYes);
    return file;
  }

  TemporaryFolder folder_;
  std::string output_ = folder_.path() / "out.template.json";
  FeatureSet bonn_ = LoadFeatureSet("bonn");
};

TEST_F(TemplateEditing, DrawsThePapersTemplate) {
  const MotionTemplate expected = WithEntries(BlankTemplate("brush", bonn_, 50),
                                              FindFeatures(bonn_, "F13,F32,F33"), {0, 49}, 1);
  EXPECT_EQ(Drawn(), expected);
  EXPECT_EQ(Made({"draw", "--length", "1.67s", "--set", "right hand fast,rhand lowered=1", "--set",
                  "spine horizontal=1"})
                .matrix,
            expected.matrix);
}

TEST_F(TemplateEditing, DrawsInPlacesAtAnyRateWithAnySet) {
  const MotionTemplate drawn = Made({"draw", "--length", "0.5s", "--rate", "60", "--profile",
                                     "paper", "--set", "hands far apart, sideways=0@10-19", "--set",
                                     "F1=any@0-29", "--set", "upper=0.25@0.4-0.5s"});
  EXPECT_EQ(drawn.matrix.column_count(), 30);
  EXPECT_EQ(drawn.matrix.rate_hz, 60);
  EXPECT_EQ(drawn.feature_set, "paper");
  EXPECT_EQ(drawn.matching, Profile::kPaper);
  EXPECT_EQ(drawn.matrix.Column(9)[8], 0.5);
  EXPECT_EQ(drawn.matrix.Column(10)[8], 0);
  EXPECT_EQ(drawn.matrix.Column(19)[8], 0);
  EXPECT_EQ(drawn.matrix.Column(23)[13], 0.5);
  EXPECT_EQ(drawn.matrix.Column(24)[13], 0.25);
  EXPECT_EQ(drawn.matrix.Column(24)[14], 0.5);
}

TEST_F(TemplateEditing, SaysWhenATemplateAsksForNothing) {
  const ProgramResult result =
      RunKinebase({"template", "draw", "--length", "3", "-o", output_, "--name", "blank"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("blank: warning: asks for nothing"),
                                HasSubstr("blank: 3 columns, written to " + output_)));
  EXPECT_THAT(RunKinebase({"template", "show", output_}).out, HasSubstr("100 % free"));
}

TEST_F(TemplateEditing, ChangesOneAfterTheOther) {
  MotionTemplate expected = ReadTemplate(DrawnFile());
  expected = WithEntries(expected, FindFeatures(bonn_, "F20"), {0, 9}, 0);
  expected = RestrictToFeatures(expected, FindFeatures(bonn_, "lower,F32"));
  expected = CutTemplate(expected, {5, 34});
  expected = StretchTemplate(expected, 60);
  expected = ExtendTemplate(expected, 3, 6);
  expected.tau = 0.02;
  expected.tau_origin = "set by hand";
  expected.name = "new";
  EXPECT_EQ(Made({"edit", DrawnFile(), "--set", "rknee bent=0@0-9", "--only", "lower,F32", "--cut",
                  "5-34", "--stretch", "2s", "--before", "3", "--after", "0.2s", "--tau", "0.02",
                  "--name", "new"}),
            expected);
}

TEST_F(TemplateEditing, DropsTheThresholdUnlessOnlyTheNameChanges) {
  MotionTemplate with_tau = Drawn();
  with_tau.tau = 0.03;
  with_tau.tau_origin = "somewhere";
  const std::string file = folder_.path() / "tau.json";
  WriteTemplate(with_tau, file, Overwrite::kNo);
  EXPECT_EQ(Made({"edit", file, "--name", "other"}).tau, 0.03);
  EXPECT_EQ(Made({"edit", file, "--cut", "0-9"}).tau, std::nullopt);
}

TEST_F(TemplateEditing, PutsTemplatesTogether) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  const std::string kick = library.Learn("kickRFront1Reps");
  const std::vector<MotionTemplate> both = {ReadTemplate(squat), ReadTemplate(kick)};
  EXPECT_EQ(Made({"concatenate", squat, kick, "--gap", "0.5s"}), ConcatenateTemplates(both, 15));
  EXPECT_EQ(Made({"combine", squat, kick}), CombineTemplates(both));
  EXPECT_EQ(Made({"combine", squat, kick, "--learning", "paper"}),
            CombineTemplates(both, {.profile = Profile::kPaper}));
  // Kicks of either side become one class that finds both.
  const std::string left = folder_.path() / "left.json";
  ASSERT_EQ(RunKinebase({"template", "mirror", kick, "-o", left}).exit_code, 0);
  const MotionTemplate either = Made({"combine", kick, left, "--name", "kick"});
  EXPECT_EQ(either.name, "kick");
  EXPECT_EQ(either.clips.size(), 4U);
  const std::string clip = library.Clip("kickRFront1Reps", "sb", 1);
  EXPECT_EQ(RunKinebase({"search", output_, "--in", clip, "--tau", "0.1", "--json", "-q"})
                .Json()["hits"]
                .size(),
            1U);
}

TEST_F(TemplateEditing, HasTheSameJsonForAll) {
  const std::string file = DrawnFile();
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"draw", "--length", "1"},
                                             {"edit", file},
                                             {"combine", file, file},
                                             {"concatenate", file, file}}) {
    std::vector<std::string> all = {"template"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"-o", output_, "--json", "--force", "--quiet"});
    const ProgramResult result = RunKinebase(all);
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(FieldsOf(result.Json()),
                ElementsAre("name:string", "columns:integer", "file:string"));
    EXPECT_EQ(result.Json()["columns"], ReadTemplate(output_).matrix.column_count());
    all.erase(std::ranges::find(all, "--force"));
    ExpectOneError(RunKinebase(all), 1, {output_ + ": exists already", "--force"});
  }
}

TEST_F(TemplateEditing, SaysInOneLineWhatIsWrong) {
  const std::string file = DrawnFile();
  const auto refused = [&](std::vector<std::string> arguments, int exit_code,
                           const std::vector<std::string>& parts) {
    arguments.insert(arguments.begin(), "template");
    arguments.insert(arguments.end(), {"-o", output_});
    ExpectOneError(RunKinebase(arguments), exit_code, parts);
    EXPECT_FALSE(std::filesystem::exists(output_));
  };
  std::filesystem::remove(output_);
  refused({"draw"}, 2, {"--length is required"});
  refused({"draw", "--length", "0"}, 2, {"--length takes columns from 1", "'0'"});
  refused({"draw", "--length", "0s"}, 2, {"--length", "expected more than 0"});
  refused({"draw", "--length", "long"}, 2, {"1.5s", "'long'"});
  refused({"draw", "--length", "9", "--rate", "50"}, 2, {"--rate", "50"});
  refused({"draw", "--length", "9", "--set", "F1"}, 2, {"'F1'", "a value, as in F13,F32=1"});
  refused({"draw", "--length", "9", "--set", "F1=2"}, 2, {"0, 1, any", "'2'"});
  refused({"draw", "--length", "9", "--set", "F1=1@x"}, 2, {"'x' is neither columns from 0"});
  refused({"draw", "--length", "9", "--set", "F1=1@3-2"}, 2, {"'3-2'"});
  refused({"draw", "--length", "9", "--set", "F1=1@0-9"}, 1, {"it has columns 0 to 8"});
  refused({"draw", "--length", "9", "--set", "F77=1"}, 1, {"'F77' is no feature", "'F7'"});
  refused({"draw", "--length", "9", "--set", "rknee straight=1"}, 1, {"name F20 itself"});
  refused({"edit"}, 2, {"TEMPLATE is required"});
  refused({"edit", "nowhere.json"}, 1, {"nowhere.json: "});
  refused({"edit", file, "--cut", "1-2-3"}, 2, {"--cut", "'1-2-3'"});
  refused({"edit", file, "--cut", "40-50"}, 1, {"columns 40 to 50", "0 to 49"});
  refused({"edit", file, "--cut", "5-6s"}, 1, {"between 5 and 6 s", "lasts 1.67 s"});
  refused({"edit", file, "--stretch", "0"}, 2, {"--stretch"});
  refused({"edit", file, "--before", "-1"}, 2, {"--before"});
  refused({"edit", file, "--tau", "-1"}, 2, {"--tau"});
  refused({"edit", file, "--only", "knees"}, 1, {"'knees' is no feature", "knees bent"});
  refused({"edit", file, "--feature-set", "paper", "--only", "F1"}, 1, {"'bonn'", "'paper'"});
  refused({"combine", file}, 2, {"one template alone"});
  refused({"concatenate", file, file, "--gap", "x"}, 2, {"--gap", "'x'"});
}

TEST_F(TemplateEditing, RefusesToPutTogetherWhatIsOfDifferentSets) {
  const std::string bonn = DrawnFile();
  const std::string paper = folder_.path() / "paper.json";
  ASSERT_EQ(RunKinebase({"template", "draw", "--length", "9", "--profile", "paper", "-o", paper})
                .exit_code,
            0);
  for (const std::string command : {"combine", "concatenate"}) {
    ExpectOneError(RunKinebase({"template", command, bonn, paper, "-o", output_ + ".new"}), 1,
                   {"'bonn' (6a102498ef583fa9)", "'paper' (3e7b4815660b8a1f)"});
  }
}

}  // namespace
}  // namespace kinebase::test
