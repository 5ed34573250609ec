// What scripts rely on: fields and types of JSON, what goes to which stream, units, manners.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kInfoFields = {"path:string",
                                              "format:string",
                                              "frames:integer",
                                              "first_frame:integer",
                                              "rate_hz:number",
                                              "duration_s:number",
                                              "joints:integer",
                                              "markers:integer",
                                              "units:string",
                                              "up_axis:string",
                                              "bounding_box_cm:object",
                                              "actor:string",
                                              "class:string",
                                              "take:string",
                                              "skeleton:string",
                                              "contents:object",
                                              "standard_joints:array",
                                              "no_standard_joints:null",
                                              "diagnostics:array"};

TEST(InfoJson, HasTheDocumentedFields) {
  const SyntheticLibrary library;
  const auto json = RunKinebase({"info", library.Squat(), "--json"}).Json();
  EXPECT_THAT(FieldsOf(json), ElementsAre("files:array"));
  ASSERT_EQ(json["files"].size(), 1U);
  const auto& file = json["files"][0];
  EXPECT_THAT(FieldsOf(file), ElementsAreArray(kInfoFields));
  EXPECT_THAT(FieldsOf(file["bounding_box_cm"]), ElementsAre("low:array", "high:array"));
  EXPECT_EQ(file["bounding_box_cm"]["low"].size(), 3U);
  EXPECT_EQ(file["path"], library.Squat());
  EXPECT_EQ(file["format"], "ASF/AMC");
  EXPECT_EQ(file["rate_hz"], 120);
  EXPECT_DOUBLE_EQ(file["duration_s"].get<double>(), file["frames"].get<double>() / 120);
  EXPECT_EQ(file["actor"], "sa");
  EXPECT_EQ(file["class"], "squat1Reps");
  EXPECT_EQ(file["take"], "001");
  EXPECT_TRUE(
      fs::equivalent(file["skeleton"].get<std::string>(), library.folder() / "asf" / "SYN_sa.asf"));
}

TEST(InfoJson, HasDiagnosticsWithTheirPlace) {
  const SyntheticLibrary library;
  const std::string text = ReadText(library.Squat());
  const std::string motion = library.BadMotion(text.substr(0, text.size() - 100), "SYN_sa.amc");
  const auto file = RunKinebase({"info", motion, "--json"}).Json()["files"][0];
  ASSERT_FALSE(file["diagnostics"].empty());
  for (const auto& diagnostic : file["diagnostics"]) {
    EXPECT_THAT(FieldsOf(diagnostic),
                ElementsAre("severity:string", ::testing::AnyOf("line:integer", "line:null"),
                            ::testing::AnyOf("byte:integer", "byte:null"), "message:string"));
  }
  EXPECT_TRUE(file["class"].is_null());  // The name does not tell.
}

TEST(FileJson, OfCommandsThatWriteOneFile) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  const std::string output = library.scratch() / "output.svg";
  const auto fields = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", output, "--json", "--force"});
    const ProgramResult result = RunKinebase(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.Json()["file"], output);
    EXPECT_TRUE(fs::exists(output));
    return FieldsOf(result.Json());
  };
  EXPECT_THAT(fields({"joints", library.Squat()}),
              ElementsAre("file:string", "frames:integer", "rate_hz:number"));
  EXPECT_THAT(fields({"features", library.Squat()}),
              ElementsAre("file:string", "columns:integer", "features:integer", "rate_hz:number"));
  EXPECT_THAT(fields({"render", library.Squat(), library.Squat()}),
              ElementsAre("file:string", "recordings:integer"));
  EXPECT_THAT(fields({"template", "render", squat}), ElementsAre("file:string"));
  EXPECT_THAT(fields({"template", "mirror", squat}), ElementsAre("name:string", "file:string"));
  EXPECT_THAT(fields({"learn", library.Squat(), library.Squat()}),
              ElementsAre("name:string", "clips:integer", "columns:integer", "rounds:integer",
                          "elapsed_s:number", "file:string"));
}

TEST(TemplateShowJson, IsTheFile) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  EXPECT_EQ(RunKinebase({"template", "show", squat, "--json"}).out, ReadText(squat));
}

TEST(SynthJson, CountsWhatWasMade) {
  const TemporaryFolder folder;
  const ProgramResult result = RunKinebase(
      {"synth", folder.path() / "lib", "--actors", "1", "--takes", "1", "--clips-per-take", "1",
       "--repetitions", "2", "--classes", "squat1Reps", "--seed", "7", "--json"});
  EXPECT_EQ(result.err, "");
  const auto json = result.Json();
  EXPECT_THAT(FieldsOf(json),
              ElementsAre("synthetic:boolean", "folder:string", "actors:integer", "clips:integer",
                          "takes:integer", "frames:integer", "seed:integer", "elapsed_s:number"));
  EXPECT_EQ(json["synthetic"], true);
  EXPECT_EQ(json["clips"], 2);
  EXPECT_EQ(json["takes"], 1);
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(FilesBelow(folder.path(), ".amc").size(), 3U);
}

TEST(SearchJson, HasTheDocumentedFieldsAndUnits) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  const auto info = RunKinebase({"info", library.folder(), "--json"}).Json();
  std::map<std::string, int> frames_of;
  int frames = 0;
  for (const auto& file : info["files"]) {
    frames_of[file["path"]] = file["frames"];
    frames += file["frames"].get<int>();
  }
  const auto json = RunKinebase({"search", squat, "--in", library.folder(), "--json"}).Json();
  EXPECT_THAT(FieldsOf(json),
              ElementsAre("hits:array", "scanned_frames:integer", "elapsed_s:number"));
  EXPECT_EQ(json["scanned_frames"], frames);
  ASSERT_GE(json["hits"].size(), 4U);
  for (const auto& hit : json["hits"]) {
    EXPECT_THAT(FieldsOf(hit), ElementsAre("template:string", "file:string", "first_frame:integer",
                                           "last_frame:integer", "start_s:number", "end_s:number",
                                           "cost:number", "confidence:null"));
    EXPECT_EQ(hit["template"], "squat1Reps");
    const int first = hit["first_frame"];
    const int last = hit["last_frame"];
    EXPECT_GE(first, 1);
    EXPECT_LT(first, last);
    EXPECT_LE(last, frames_of.at(hit["file"]));
    EXPECT_DOUBLE_EQ(hit["start_s"], (first - 1) / 120.0);
    EXPECT_DOUBLE_EQ(hit["end_s"], last / 120.0);
  }
}

TEST(SearchJson, HasNoHitsWhereThereAreNone) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  const std::string kick = library.Clip("kickRFront1Reps", "sb", 1);
  const ProgramResult result = RunKinebase({"search", squat, "--in", kick, "--tau", "0", "--json"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.Json()["hits"], nlohmann::json::array());
  EXPECT_EQ(RunKinebase({"search", squat, "--in", kick, "--tau", "0"}).out, "");
}

// Every command with good input.
std::vector<std::vector<std::string>> GoodCommands(const SyntheticLibrary& library) {
  const std::string squat = library.Learn("squat1Reps");
  const auto output = [&](const char* name) { return (library.scratch() / name).string(); };
  return {{"info", library.Squat()},
          {"info", library.folder()},
          {"joints", library.Squat()},
          {"joints", library.Squat(), "-o", output("1.csv")},
          {"features", library.Squat()},
          {"features", library.Squat(), "-o", output("2.csv")},
          {"render", library.Squat(), "-o", output("3.png")},
          {"learn", library.Squat(), "-o", output("4.json")},
          {"search", squat, "--in", library.folder()},
          {"annotate", squat, "--in", library.Squat()},
          {"template", "show", squat},
          {"template", "render", squat, "-o", output("5.svg")},
          {"template", "mirror", squat, "-o", output("6.json")},
          {"synth", output("7"), "--actors", "1", "--classes", "squat1Reps", "--takes", "0"}};
}

TEST(StandardError, IsEmptyWithQuietOnGoodInput) {
  const SyntheticLibrary library;
  for (std::vector<std::string> arguments : GoodCommands(library)) {
    SCOPED_TRACE(arguments.front());
    arguments.emplace_back("--quiet");
    const ProgramResult result = RunKinebase(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
  }
}

TEST(StandardError, HasNoProgressAndNoColourInAFile) {
  const SyntheticLibrary library;
  for (const auto& arguments : GoodCommands(library)) {
    SCOPED_TRACE(arguments.front());
    const ProgramResult result = RunKinebase(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_LE(result.ErrorLines().size(), 1U);
    for (const std::string& text : {result.out, result.err}) {
      EXPECT_THAT(text.substr(0, 1000), Not(HasSubstr("\r")));
      EXPECT_THAT(text, Not(HasSubstr("\x1b")));
    }
  }
}

TEST(StandardError, ShowsProgressOnATerminalAndClearsIt) {
  if (!HasTerminals()) GTEST_SKIP() << "this system gives no terminals (no /dev/pts)";
  const SyntheticLibrary library;
  const std::vector<std::string> search = {"search", library.Learn("squat1Reps"), "--in",
                                           library.folder()};
  const ProgramResult result = RunKinebase(search, {.on_terminal = true});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("reading ["));
  EXPECT_THAT(result.err, HasSubstr("\r\x1b[K4 hits"));
  EXPECT_TRUE(result.err.ends_with("\n")) << "something is drawn below the last word";
  std::vector<std::string> quiet = search;
  quiet.emplace_back("--quiet");
  EXPECT_EQ(RunKinebase(quiet, {.on_terminal = true}).err, "");
}

TEST(StandardError, HasColourOnATerminalUnlessNoColor) {
  if (!HasTerminals()) GTEST_SKIP() << "this system gives no terminals (no /dev/pts)";
  const std::vector<std::string> wrong = {"info", "nowhere.amc"};
  EXPECT_THAT(RunKinebase(wrong, {.on_terminal = true}).err, HasSubstr("\x1b[1;31merror:\x1b[0m"));
  for (const ProgramResult& plain :
       {RunKinebase(wrong, {.environment = {{"NO_COLOR", "1"}}, .on_terminal = true}),
        RunKinebase(wrong)}) {
    EXPECT_THAT(plain.err, Not(HasSubstr("\x1b")));
  }
}

TEST(Version, IsNameAndNumber) {
  const ProgramResult result = RunKinebase({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, ::testing::MatchesRegex("kinebase [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_EQ(result.err, "");
}

TEST(Help, OfEveryCommandShowsAnExample) {
  const ProgramResult program = RunKinebase({"--help"});
  EXPECT_EQ(program.exit_code, 0);
  EXPECT_EQ(program.err, "");
  EXPECT_THAT(program.out, HasSubstr("kinebase learn "));
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"info"},
                                             {"render"},
                                             {"joints"},
                                             {"features"},
                                             {"learn"},
                                             {"search"},
                                             {"annotate"},
                                             {"synth"},
                                             {"manual"},
                                             {"completion"},
                                             {"template"},
                                             {"template", "show"},
                                             {"template", "render"},
                                             {"template", "mirror"},
                                             {"template", "draw"},
                                             {"template", "edit"},
                                             {"template", "combine"},
                                             {"template", "concatenate"},
                                             {"template", "compile"}}) {
    SCOPED_TRACE(command.back());
    EXPECT_THAT(program.out, HasSubstr("  " + command.front() + "  "));
    std::vector<std::string> arguments = command;
    arguments.emplace_back("--help");
    const ProgramResult result = RunKinebase(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(result.out, HasSubstr("kinebase " + command.front()));
    EXPECT_THAT(result.out, ::testing::ContainsRegex("Examples?:\n  "));
    EXPECT_THAT(result.out, Not(HasSubstr("TEXT")));  // The parser's word for what has no name.
    EXPECT_TRUE(result.out.ends_with("\n"));
  }
}

TEST(Tables, AlignTheirColumns) {
  const SyntheticLibrary library;
  const ProgramResult result = RunKinebase({"info", library.folder()});
  std::istringstream lines(result.out);
  std::string title;
  std::getline(lines, title);
  const std::size_t frames_end = title.find("frames") + 6;
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    ASSERT_GT(line.size(), frames_end);
    EXPECT_TRUE(std::isdigit(line[frames_end - 1])) << line;
    EXPECT_EQ(line[frames_end], ' ') << line;
  }
  EXPECT_EQ(count, 12);
}

}  // namespace
}  // namespace kinebase::test
