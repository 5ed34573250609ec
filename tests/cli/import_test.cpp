// import and library as scripts see them, and searching a library like its files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::vector<nlohmann::ordered_json> JsonLines(const std::string& text) {
  std::vector<nlohmann::ordered_json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(nlohmann::ordered_json::parse(line));
  }
  return lines;
}

class LibraryOnDisk : public ::testing::Test {
 protected:
  [[nodiscard]] std::string library() const { return recordings_.scratch() / "motion.kinebase"; }

  ProgramResult Import(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"import", recordings_.folder(), "--library", library()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

  // The hits of a search, their files by name.
  [[nodiscard]] static nlohmann::ordered_json Hits(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "search");
    arguments.insert(arguments.end(), {"--json", "--quiet"});
    const ProgramResult result = RunKinebase(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    auto json = result.Json();
    for (auto& hit : json["hits"]) {
      hit["file"] = fs::path(hit["file"].get<std::string>()).filename();
    }
    json.erase("elapsed_s");
    return json;
  }

  SyntheticLibrary recordings_;
};

TEST_F(LibraryOnDisk, IsFilledLineByLine) {
  const ProgramResult result = Import({"--json"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const auto lines = JsonLines(result.out);
  ASSERT_THAT(lines, SizeIs(13));
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_THAT(FieldsOf(lines[i]), ElementsAre("file:string", "state:string", "frames:integer"));
    EXPECT_EQ(lines[i]["state"], "added");
  }
  EXPECT_THAT(FieldsOf(lines[12]),
              ElementsAre("added:integer", "updated:integer", "unchanged:integer", "failed:array",
                          "frames:integer", "elapsed_s:number"));
  EXPECT_EQ(lines[12]["added"], 12);
  const ProgramResult again = Import();
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.out, HasSubstr("0 added, 12 unchanged; 0 frames"));
}

TEST_F(LibraryOnDisk, IsListedVerifiedExportedAndEmptied) {
  Import({"--poses"});
  const auto list = RunKinebase({"library", "list", library(), "--json"}).Json();
  EXPECT_THAT(FieldsOf(list), ElementsAre("takes:array", "feature_sets:array", "bytes:integer"));
  ASSERT_THAT(list["takes"], SizeIs(12));
  EXPECT_THAT(FieldsOf(list["takes"][0]),
              ElementsAre("file:string", "format:string", "actor:string", "class:string",
                          "take:string", "frames:integer", "rate_hz:number", "duration_s:number",
                          "poses:boolean", "description:null", "labels:array", "skeleton:string",
                          "skeleton_key:string", "origin:object"));
  EXPECT_EQ(list["takes"][0]["poses"], true);
  EXPECT_EQ(list["feature_sets"][0]["name"], "bonn");
  const ProgramResult some =
      RunKinebase({"library", "list", library(), "--actors", "sb", "--classes", "squat1Reps"});
  EXPECT_THAT(some.out, AllOf(HasSubstr("SYN_sb_squat1Reps_003_120.amc"), HasSubstr("yes")));
  EXPECT_THAT(some.err, HasSubstr("2 takes"));

  const ProgramResult verified = RunKinebase({"library", "verify", library(), "--json"});
  EXPECT_EQ(verified.exit_code, 0);
  EXPECT_THAT(FieldsOf(verified.Json()),
              ElementsAre("takes:integer", "bytes:integer", "leftovers:integer"));
  EXPECT_THAT(RunKinebase({"library", "verify", library()}).out, HasSubstr("all intact"));

  const std::string table = recordings_.scratch() / "table.csv";
  EXPECT_EQ(RunKinebase({"library", "export", library(), "-o", table}).exit_code, 0);
  EXPECT_EQ(ReadText(table), RunKinebase({"library", "export", library()}).out);
  EXPECT_THAT(ReadCsv(table).rows, SizeIs(12));
  ExpectOneError(RunKinebase({"library", "export", library(), "-o", table}), 1, {"--force"});

  const auto removed =
      RunKinebase({"library", "remove", library(), "--classes", "squat1Reps", "--json"}).Json();
  EXPECT_THAT(removed["removed"], SizeIs(4));
  EXPECT_TRUE(fs::exists(recordings_.Squat()));
  EXPECT_EQ(RunKinebase({"library", "remove", library(), recordings_.folder()}).exit_code, 0);
  EXPECT_THAT(RunKinebase({"library", "verify", library()}).out, HasSubstr("0 takes"));
}

TEST_F(LibraryOnDisk, IsSearchedLikeItsFiles) {
  const std::string squat = recordings_.Learn("squat1Reps");
  const std::string kick = recordings_.Learn("kickRFront1Reps");
  Import();
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{squat},
        {squat, kick, "--tau", "1", "--top", "100"},
        {kick, "--mirror", "--tau", "1"},
        {squat, "--keyframes", "auto"},
        {squat, "--fuzzy", "--features", "lower", "--faults", "1"}}) {
    std::vector<std::string> files = options;
    files.insert(files.end(), {"--in", recordings_.folder()});
    std::vector<std::string> stored = options;
    stored.insert(stored.end(), {"--library", library()});
    const auto expected = Hits(files);
    EXPECT_EQ(Hits(stored), expected);
    EXPECT_FALSE(expected["hits"].empty());
  }
  const auto of_actor = Hits({squat, "--library", library(), "--actors", "sb", "--tau", "1"});
  EXPECT_EQ(of_actor, Hits({squat, "--in", recordings_.Clip("squat1Reps", "sb", 1),
                            recordings_.Clip("squat1Reps", "sb", 2),
                            recordings_.Clip("kickRFront1Reps", "sb", 1),
                            recordings_.Clip("kickRFront1Reps", "sb", 2),
                            recordings_.Clip("jumpingJack1Reps", "sb", 1),
                            recordings_.Clip("jumpingJack1Reps", "sb", 2), "--tau", "1"}));
  ExpectOneError(RunKinebase({"search", squat, "--in", library()}), 1,
                 {"is a library", "--library"});
  // The recordings are needed no more.
  const auto before = Hits({squat, "--library", library()});
  fs::remove_all(recordings_.folder());
  EXPECT_EQ(Hits({squat, "--library", library()}), before);
}

TEST_F(LibraryOnDisk, IsSearchedWithPosesWhereATemplateNeedsThem) {
  const std::string classes = recordings_.scratch() / "classes";
  ASSERT_EQ(RunKinebase({"learn", "--list", recordings_.list(), "--all-classes", "--method", "mt+",
                         "-o", classes, "--quiet"})
                .exit_code,
            0);
  std::vector<std::string> templates = {"--tau", "1"};
  for (const auto& file : FilesBelow(classes, ".json")) templates.push_back(file);
  const std::vector<std::string> arguments = {"search", FilesBelow(classes, ".json")[0].string(),
                                              "--library", library()};
  Import();
  ExpectOneError(RunKinebase(arguments), 1, {"no poses", "--poses"});
  EXPECT_THAT(Import({"--poses"}).out, HasSubstr("12 updated"));
  std::vector<std::string> stored = templates;
  stored.insert(stored.end(), {"--library", library()});
  std::vector<std::string> files = templates;
  files.insert(files.end(), {"--in", recordings_.folder()});
  const auto found = Hits(stored);
  const auto expected = Hits(files);
  ASSERT_EQ(found["hits"].size(), expected["hits"].size());
  ASSERT_FALSE(found["hits"].empty());
  for (std::size_t i = 0; i < found["hits"].size(); ++i) {
    // Places are rounded to hundredths of a millimetre, and so costs to thousandths.
    EXPECT_NEAR(found["hits"][i]["cost"].get<double>(), expected["hits"][i]["cost"].get<double>(),
                1e-3);
  }
}

TEST_F(LibraryOnDisk, NamesWhatIsDamagedAndSearchesTheRest) {
  const std::string squat = recordings_.Learn("squat1Reps");
  Import();
  const fs::path segment = fs::path(library()) / "segments" / "00000001.segment";
  std::string bytes = ReadText(segment);
  bytes[64 + 12 * 64] ^= 1;  // The first take's first word.
  WriteText(segment, bytes);
  const ProgramResult verified = RunKinebase({"library", "verify", library(), "--json"});
  EXPECT_EQ(verified.exit_code, 3);
  ASSERT_THAT(verified.ErrorLines(), SizeIs(1));
  EXPECT_THAT(verified.err, AllOf(HasSubstr(segment.string() + " at byte 832"),
                                  HasSubstr("SYN_sa_jumpingJack1Reps_001_120.amc"),
                                  HasSubstr("library remove LIBRARY --damaged")));
  EXPECT_THAT(verified.Json()["failed"], SizeIs(1));
  EXPECT_EQ(RunKinebase({"search", squat, "--library", library()}).exit_code, 3);
  EXPECT_EQ(RunKinebase({"library", "remove", library(), "--damaged"}).exit_code, 0);
  EXPECT_THAT(Import().out, HasSubstr("1 added, 11 unchanged"));
  EXPECT_EQ(RunKinebase({"library", "verify", library()}).exit_code, 0);
}

TEST_F(LibraryOnDisk, NamesADamagedSegmentOnce) {
  Import();
  const fs::path segment = fs::path(library()) / "segments" / "00000001.segment";
  fs::resize_file(segment, fs::file_size(segment) - 1);
  const ProgramResult verified = RunKinebase({"library", "verify", library()});
  EXPECT_EQ(verified.exit_code, 1);
  EXPECT_THAT(verified.ErrorLines(),
              ElementsAre(AllOf(HasSubstr("12 takes, such as "), HasSubstr(segment.string()))));
}

TEST_F(LibraryOnDisk, TakesClassesFromAList) {
  const ProgramResult result = RunKinebase(
      {"import", "--list", recordings_.list(), "--library", library(), "--json", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(JsonLines(result.out).back()["added"], 12);
}

TEST_F(LibraryOnDisk, GoesOnAfterABadFile) {
  const std::string bad = recordings_.BadMotion("no motion");
  const ProgramResult result =
      RunKinebase({"import", recordings_.Squat(), bad, "--library", library(), "--json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.ErrorLines(), ElementsAre(HasSubstr(bad)));
  const auto summary = JsonLines(result.out).back();
  EXPECT_EQ(summary["added"], 1);
  EXPECT_EQ(summary["failed"][0]["file"], bad);
  ExpectOneError(RunKinebase({"import", bad, "--library", library()}), 1, {bad});
  const ProgramResult none = RunKinebase({"import", bad, "--library", library(), "--json"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_EQ(JsonLines(none.out).back()["failed"][0]["file"], bad);
}

TEST_F(LibraryOnDisk, SaysWhatIsWrongWithAFolder) {
  const std::string folder = recordings_.folder();
  ExpectOneError(RunKinebase({"import", folder, "--library", folder}), 1,
                 {"other files in it", "new or empty"});
  ExpectOneError(RunKinebase({"library", "list", folder}), 1, {"is no library", "import"});
  ExpectOneError(RunKinebase({"library", "verify", library()}), 1, {"does not exist"});
  ExpectOneError(RunKinebase({"library", "remove", library()}), 2, {"--damaged"});
  ExpectOneError(RunKinebase({"import", "--library", library()}), 2, {"--list"});
  ExpectOneError(RunKinebase({"search", "a.json", "--in", folder, "--actors", "sa"}), 2,
                 {"--library"});
  ExpectOneError(RunKinebase({"search", "a.json", "--in", folder, "--library", library()}), 2,
                 {"--library"});
  ExpectOneError(RunKinebase({"search", "a.json", "--library", library(), "--source-rate", "60"}),
                 2, {"--source-rate"});
  ExpectOneError(RunKinebase({"annotate", "a.json", "--library", library(), "--strict"}), 2,
                 {"--library have been read"});
  ExpectOneError(
      RunKinebase({"learn", "--library", library(), "--class", "a", "--skeleton", "a.asf"}), 2,
      {"--library have been read"});
  ExpectOneError(RunKinebase({"search", "a.json", "--library", library(), "--strict"}), 2,
                 {"--strict"});
}

TEST(LibraryOfRealRecordings, IsSearchedLikeItsFiles) {
  KINEBASE_NEEDS_TEST_DATA();
  const TemporaryFolder folder;
  const std::string library = folder.path() / "lib";
  const std::string data = TestData("data");
  const std::string output = folder.path() / "squat.template.json";
  ASSERT_EQ(RunKinebase({"learn", "--list", TestData("data/hdm05/clips.csv"), "--class",
                         "squat1Reps", "--actors", "bd", "-o", output, "--quiet"})
                .exit_code,
            0);
  ASSERT_THAT(RunKinebase({"import", data, "--library", library, "--quiet"}).exit_code,
              ::testing::AnyOf(0, 3));
  const auto hits = [&](const std::string& option, const std::string& path) {
    const ProgramResult result =
        RunKinebase({"search", output, option, path, "--json", "--quiet", "--tau", "0.1"});
    return result.Json()["hits"];
  };
  const auto stored = hits("--library", library);
  auto files = hits("--in", data);
  for (auto& hit : files) hit["file"] = fs::canonical(hit["file"].get<std::string>());
  ASSERT_GT(files.size(), 20U);
  EXPECT_EQ(stored, files);
}

}  // namespace
}  // namespace kinebase::test
