// Where results go: nothing is overwritten, nothing is left half done, any file name will do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Every command that writes a file, with an input that lasts.
std::vector<std::vector<std::string>> WritingCommands(const SyntheticLibrary& library,
                                                      const std::string& output) {
  const std::string squat_template = library.Learn("squat1Reps");
  return {
      {"joints", library.Squat(), "-o", output},
      {"features", library.Squat(), "-o", output},
      {"features", library.Squat(), "-o", output + ".png"},
      {"render", library.Squat(), "-o", output + ".png"},
      {"learn", library.Squat(), "--name", "squat", "-o", output},
      {"search", squat_template, "--in", library.folder(), "--curve", output},
      {"template", "mirror", squat_template, "-o", output},
      {"template", "render", squat_template, "-o", output + ".png"},
  };
}

TEST(Output, IsNotOverwrittenWithoutForce) {
  const SyntheticLibrary library;
  const std::string output = library.scratch() / "output";
  for (std::vector<std::string> arguments : WritingCommands(library, output)) {
    SCOPED_TRACE(arguments.front());
    const std::string file = arguments.back();
    WriteText(file, "precious");
    ExpectOneError(RunKinebase(arguments), 1, {file + ": exists already", "--force"});
    EXPECT_EQ(ReadText(file), "precious");
    arguments.emplace_back("--force");
    EXPECT_EQ(RunKinebase(arguments).exit_code, 0);
    EXPECT_NE(ReadText(file), "precious");
  }
}

TEST(Output, IsLookedAtBeforeLongWork) {
  const SyntheticLibrary library;
  const std::string output = library.scratch() / "output.png";
  WriteText(output, "precious");
  const std::string bad = library.BadMotion("");
  const std::string bad_template = library.scratch() / "bad.json";
  WriteText(bad_template, "");
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"joints", bad, "-o", output},
           {"features", bad, "-o", output},
           {"render", bad, "-o", output},
           {"learn", bad, "-o", output},
           {"search", bad_template, "--in", bad, "--curve", output},
           {"template", "mirror", bad_template, "-o", output},
           {"template", "render", bad_template, "-o", output}}) {
    SCOPED_TRACE(arguments.front());
    ExpectOneError(RunKinebase(arguments), 1, {output + ": exists already"});
  }
}

TEST(Output, CannotBeAFolder) {
  const SyntheticLibrary library;
  const std::string folder = library.scratch() / "output";
  fs::create_directory(folder);
  fs::create_directory(folder + ".png");
  for (const auto& arguments : WritingCommands(library, folder)) {
    SCOPED_TRACE(arguments.front());
    ExpectOneError(RunKinebase(arguments), 1, {arguments.back() + ": is a folder"});
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(Output, DoesNotReplaceWhatIsNoRegularFile) {
  const SyntheticLibrary library;
  const fs::path pipe = library.scratch() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ExpectOneError(RunKinebase({"joints", library.Squat(), "-o", pipe, "--force"}), 1,
                 {pipe.string() + ": is no regular file"});
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(Output, CannotGoBelowAFile) {
  const SyntheticLibrary library;
  const std::string file = library.scratch() / "file";
  WriteText(file, "precious");
  for (const auto& arguments : WritingCommands(library, file + "/output")) {
    SCOPED_TRACE(arguments.front());
    ExpectOneError(RunKinebase(arguments), 1, {file, "cannot write"});
  }
  EXPECT_EQ(ReadText(file), "precious");
}

TEST(Output, MakesMissingFoldersAndLeavesNothingElse) {
  const SyntheticLibrary library;
  const fs::path folder = library.scratch() / "new";
  const auto commands = WritingCommands(library, folder / "below" / "output");
  for (const auto& arguments : commands) {
    SCOPED_TRACE(arguments.front());
    EXPECT_EQ(RunKinebase(arguments).exit_code, 0);
    EXPECT_THAT(NamesBelow(folder),
                ::testing::ElementsAre("below", fs::relative(arguments.back(), folder).string()));
    fs::remove_all(folder);
  }
}

TEST(Output, GoesToStandardOutputWithoutAFileOrWithADash) {
  const SyntheticLibrary library;
  for (const char* command : {"joints", "features"}) {
    const ProgramResult without = RunKinebase({command, library.Squat()});
    const ProgramResult dash =
        RunKinebase({command, library.Squat(), "-o", "-"}, {.folder = library.scratch()});
    EXPECT_EQ(without.exit_code, 0);
    EXPECT_TRUE(without.out.starts_with("frame,"));
    EXPECT_EQ(without.err, "");
    EXPECT_EQ(dash.out, without.out);
    EXPECT_FALSE(fs::exists(library.scratch() / "-"));
    const std::string file = library.scratch() / "file.csv";
    EXPECT_EQ(RunKinebase({command, library.Squat(), "-o", file, "--force"}).exit_code, 0);
    EXPECT_EQ(ReadText(file), without.out);
  }
}

TEST(Output, ToAFullDiskIsAnError) {
  const SyntheticLibrary library;
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"info", library.folder()}, {"joints", library.Squat()}, {"manual"}}) {
    const ProgramResult result = RunKinebase(arguments, {.out_file = "/dev/full"});
    ExpectOneError(result, 1, {"cannot write to standard output"});
  }
}

TEST(Output, OfSynthKeepsWhatIsThere) {
  const SyntheticLibrary library;
  const auto before = NamesBelow(library.folder());
  const ProgramResult result = RunKinebase({"synth", library.folder(), "--actors", "1"});
  ExpectOneError(result, 1, {library.folder()});
  EXPECT_EQ(NamesBelow(library.folder()), before);
}

TEST(Output, OfLearnIsNamedAfterTheClass) {
  const SyntheticLibrary library;
  const RunOptions there = {.folder = library.scratch()};
  EXPECT_EQ(RunKinebase({"learn", library.Squat(), "--name", "deep/squat"}, there).exit_code, 0);
  EXPECT_TRUE(fs::exists(library.scratch() / "deep_squat.template.json"));
  EXPECT_EQ(RunKinebase({"learn", library.Squat(), "-o", "low.template.json"}, there).exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(ReadText(library.scratch() / "low.template.json"))["name"],
            "low");
  const ProgramResult listed =
      RunKinebase({"learn", "--list", library.list(), "--class", "squat1Reps", "--json"}, there);
  EXPECT_EQ(listed.Json()["file"], "squat1Reps.template.json");
  EXPECT_TRUE(fs::exists(library.scratch() / "squat1Reps.template.json"));
}

struct OddNameCase {
  std::string title;
  std::string name;
};

void PrintTo(const OddNameCase& odd, std::ostream* out) { *out << odd.title; }

class OddName : public ::testing::TestWithParam<OddNameCase> {};

// A motion, a template and outputs whose names hold blanks, quotes, commas, … work everywhere.
TEST_P(OddName, WorksInEveryPlace) {
  const std::string& name = GetParam().name;
  const SyntheticLibrary library;
  const fs::path folder = library.scratch() / ("in " + name);
  const fs::path motion = folder / (name + ".amc");
  fs::create_directories(folder);
  fs::copy_file(library.Squat(), motion);
  fs::copy_file(library.folder() / "asf" / "SYN_sa.asf", folder / (name + ".asf"));
  const fs::path learned = folder / (name + ".json");
  const fs::path curve = folder / (name + ".csv");

  const ProgramResult learn = RunKinebase(
      {"learn", motion.string() + ":10-250", "--name=" + name, "-o", learned, "--json"});
  ASSERT_EQ(learn.exit_code, 0) << learn.err;
  EXPECT_EQ(learn.Json()["name"], name);
  const ProgramResult found =
      RunKinebase({"search", learned, "--in", folder, "--curve", curve, "--json", "--quiet"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(found.Json()["hits"][0]["file"], motion.string());
  EXPECT_EQ(found.Json()["hits"][0]["template"], name);
  const CsvTable table = ReadCsv(curve);
  for (const auto& row : table.rows) ASSERT_EQ(row[table.Column("file")], motion.string());
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"joints", motion, "-o", folder / (name + ".joints.csv")},
           {"render", motion, "-o", folder / (name + ".svg")},
           {"template", "render", learned, "-o", folder / (name + ".t.svg")}}) {
    EXPECT_EQ(RunKinebase(arguments).exit_code, 0);
    EXPECT_TRUE(fs::exists(arguments.back()));
  }
  // What people see stays in its line: a header and a file.
  const ProgramResult text =
      RunKinebase({"search", learned, "--in", folder, "--top", "1", "--quiet"});
  EXPECT_EQ(std::ranges::count(text.out, '\n'), 2);
  EXPECT_EQ(text.err, "");
}

INSTANTIATE_TEST_SUITE_P(
    Names, OddName,
    ::testing::Values(OddNameCase{"Blanks", "two words"}, OddNameCase{"Utf8", "größe 動き"},
                      OddNameCase{"Quotes", "a 'quoted' \"name\""}, OddNameCase{"Commas", "a,b;c"},
                      OddNameCase{"LineBreak", "line\nbreak"}, OddNameCase{"Dash", "-dash"},
                      OddNameCase{"Shell", "%s{}\\n$(x)"}, OddNameCase{"Colour", "\x1b[31mred"}),
    [](const auto& odd) { return odd.param.title; });

TEST(FileName, OfAMissingFileStaysInOneLine) {
  ExpectOneError(RunKinebase({"info", "no\nsuch\x1b[31m file.amc"}), 1,
                 {"no\\x0Asuch\\x1B[31m file.amc: does not exist"});
}

TEST(FileName, ThatIsNotUtf8IsReplacedInJson) {
  const SyntheticLibrary library;
  const std::string motion = library.BadMotion(ReadText(library.Squat()), "SYN_sa_l\xE4uft.amc");
  const ProgramResult result = RunKinebase({"info", motion, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.Json()["files"][0]["path"].get<std::string>(), HasSubstr("l\xEF\xBF\xBDuft"));
}

}  // namespace
}  // namespace kinebase::test
