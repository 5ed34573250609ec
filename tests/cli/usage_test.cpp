// Wrong usage: exit code 2, one line that says what is wrong.
#include <gtest/gtest.h>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase::test {
namespace {

struct WrongUsageCase {
  std::string name;
  std::vector<std::string> arguments;
  std::vector<std::string> parts;  // Of the message.
};

void PrintTo(const WrongUsageCase& wrong, std::ostream* out) { *out << wrong.name; }

class WrongUsage : public ::testing::TestWithParam<WrongUsageCase> {};

TEST_P(WrongUsage, IsOneLineAndExitCodeTwo) {
  const TemporaryFolder folder;
  WriteText(folder.path() / "take.amc", "");
  const ProgramResult result = RunKinebase(GetParam().arguments, {.folder = folder.path()});
  ExpectOneError(result, 2, GetParam().parts);
  EXPECT_THAT(NamesBelow(folder.path()), ::testing::ElementsAre("take.amc"));
}

const std::vector<WrongUsageCase> kGeneral = {
    {"NoCommand", {}, {"kinebase needs a command: info, ", "see 'kinebase --help'"}},
    {"UnknownCommand", {"serach", "a.json"}, {"no command 'serach'", "info, ", "search"}},
    {"UnknownOption", {"info", "take.amc", "--bogus"}, {"'--bogus'", "see 'kinebase info --help'"}},
    {"UnknownGlobalOption", {"--bogus"}, {"kinebase does not take '--bogus'"}},
    {"MissingArgument", {"info"}, {"PATH is required", "see 'kinebase info --help'"}},
    {"ArgumentTooMany", {"joints", "take.amc", "more.amc"}, {"'more.amc'"}},
    {"EmptyArgument", {"info", ""}, {"empty"}},
    {"NoThreads", {"info", "take.amc", "--threads", "0"}, {"--threads", "from 1 to 4096", "'0'"}},
    {"OctalThreads", {"info", "take.amc", "--threads", "010"}, {"--threads", "'010'"}},
    {"WordAsRate", {"info", "take.amc", "--source-rate", "fast"}, {"--source-rate", "'fast'"}},
    {"NoRate", {"info", "take.amc", "--source-rate", "0"}, {"a number from 1 to 10000, not '0'"}},
    {"TinyRate", {"joints", "take.amc", "--source-rate", "1e-9"}, {"--source-rate", "'1e-9'"}},
    {"NanAsRate", {"info", "take.amc", "--source-rate", "nan"}, {"'nan'"}},
    {"InfiniteRate", {"features", "take.amc", "--rate", "inf"}, {"--rate", "'inf'"}},
    {"RateThatDoesNotDivide", {"features", "take.amc", "--rate", "50"}, {"--rate", "50", "120"}},
    {"UnknownLengthReading",
     {"info", "take.amc", "--asf-length", "miles"},
     {"auto, inches, centimetres", "'miles'"}},
    {"UnknownProfile", {"features", "take.amc", "--profile", "berlin"}, {"bonn, paper", "berlin"}},
    {"UnknownRotations", {"joints", "take.amc", "--rotations", "matrix"}, {"quaternions, euler"}},
    {"StretchWithoutEnd", {"joints", "take.amc:120"}, {"'take.amc:120'", "first-last"}},
    {"StretchBackwards", {"joints", "take.amc:9-5"}, {"'take.amc:9-5'", "first-last"}},
    {"StretchFromZero", {"features", "take.amc:0-5"}, {"'take.amc:0-5'", "first-last"}},
    {"JsonOfJointsWithoutFile", {"joints", "take.amc", "--json"}, {"--json", "-o FILE"}},
    {"JsonOfFeaturesOnOutput", {"features", "take.amc", "-o", "-", "--json"}, {"-o FILE"}},
    {"NoShell", {"completion"}, {"SHELL is required"}},
    {"UnknownShell", {"completion", "tcsh"}, {"bash, zsh, fish", "'tcsh'"}},
    {"NoFolder", {"synth"}, {"FOLDER is required"}},
    {"NegativeSeed", {"synth", "lib", "--seed", "-1"}, {"--seed", "'-1'"}},
    {"HugeSeed", {"synth", "lib", "--seed", "99999999999999999999"}, {"--seed"}},
    {"UnknownSyntheticClass", {"synth", "lib", "--classes", "flying"}, {"squat1Reps", "'flying'"}},
};

const std::vector<WrongUsageCase> kPictures = {
    {"RenderWithoutOutput", {"render", "take.amc"}, {"--output is required"}},
    {"RenderToUnknownFormat", {"render", "take.amc", "-o", "a.pdf"}, {".png or .svg", "'a.pdf'"}},
    {"RenderUnknownJoint",
     {"render", "take.amc", "-o", "a.png", "--trail", "tail"},
     {"--trail tail", "rwrist"}},
    {"RenderUnknownView",
     {"render", "take.amc", "-o", "a.png", "--view", "back"},
     {"three-quarter"}},
    {"RenderHalfARange", {"render", "take.amc", "-o", "a.png", "--frames", "10"}, {"first-last"}},
    {"RenderTooManyPoses", {"render", "take.amc", "-o", "a.png", "--poses", "201"}, {"1 to 200"}},
    {"TemplateWithoutAction", {"template"}, {"template needs a command: show, render, mirror"}},
    {"TemplateWithUnknownAction",
     {"template", "eat"},
     {"no command 'eat'", "show, render, mirror"}},
    {"TemplateShowWithoutFile", {"template", "show"}, {"TEMPLATE is required", "template show"}},
    {"TemplateRenderToJson",
     {"template", "render", "a.json", "-o", "b.json"},
     {".png or .svg", "'b.json'"}},
    {"TemplateMirrorWithoutOutput", {"template", "mirror", "a.json"}, {"--output is required"}},
};

const std::vector<WrongUsageCase> kLearnAndSearch = {
    {"LearnFromNothing", {"learn", "--name", "a"}, {"needs clips", "--list"}},
    {"LearnWithoutAnything", {"learn"}, {"needs clips", "--list"}},
    {"LearnWithoutNameOrOutput", {"learn", "take.amc"}, {"--name NAME or -o FILE"}},
    {"LearnFromClipsAndList",
     {"learn", "take.amc", "--list", "l.csv", "--class", "a"},
     {"clips, or --list, or --library"}},
    {"LearnFromListWithoutClass",
     {"learn", "--list", "l.csv"},
     {"--list needs either --class NAME or --all-classes"}},
    {"LearnActorsWithoutList",
     {"learn", "take.amc", "--name", "a", "--actors", "bd"},
     {"--actors choose from a --list or a --library"}},
    {"LearnClassWithoutList",
     {"learn", "take.amc", "--class", "a"},
     {"--class, --all-classes and --actors choose from"}},
    {"LearnAtOddRate",
     {"learn", "take.amc", "take.amc", "--name", "a", "--rate", "50"},
     {"--rate"}},
    {"LearnNoRounds", {"learn", "take.amc", "--name", "a", "--max-rounds", "0"}, {"--max-rounds"}},
    {"SearchNowhere", {"search", "a.json"}, {"--in is required"}},
    {"SearchNothing", {"search", "--in", "take.amc"}, {"TEMPLATE is required"}},
    {"SearchInNoPath", {"search", "a.json", "--in"}, {"--in"}},
    {"SearchNegativeTau", {"search", "a.json", "--in", ".", "--tau", "-1"}, {"--tau", "'-1'"}},
    {"SearchNanTau", {"search", "a.json", "--in", ".", "--tau", "nan"}, {"--tau", "'nan'"}},
    {"SearchNegativeTop", {"search", "a.json", "--in", ".", "--top", "-1"}, {"--top", "'-1'"}},
    {"SearchCurveOfTwo",
     {"search", "a.json", "b.json", "--in", ".", "--curve", "c.csv"},
     {"--curve takes one template"}},
};

std::string NameOf(const ::testing::TestParamInfo<WrongUsageCase>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(General, WrongUsage, ::testing::ValuesIn(kGeneral), NameOf);
INSTANTIATE_TEST_SUITE_P(Pictures, WrongUsage, ::testing::ValuesIn(kPictures), NameOf);
INSTANTIATE_TEST_SUITE_P(LearnAndSearch, WrongUsage, ::testing::ValuesIn(kLearnAndSearch), NameOf);

TEST(Program, TakesNamesOfCommandsAsFiles) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "search");
  ExpectOneError(RunKinebase({"info", "search"}, {.folder = folder.path()}), 1,
                 {"search: holds no motion file"});
}

}  // namespace
}  // namespace kinebase::test
