// Files that are missing, broken or of the wrong kind: exit code 1 or 3, one line, nothing left.
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
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::string Replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// A motion that no command can use: each refuses it in the same way and writes nothing.
void ExpectEveryCommandRefuses(const SyntheticLibrary& library, const std::string& motion,
                               const std::vector<std::string>& parts) {
  const std::string squat_template = library.Learn("squat1Reps");
  const std::string output = library.scratch() / "output";
  const auto before = NamesBelow(library.scratch());
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"info", motion},
           {"info", "--json", motion},
           {"joints", motion, "-o", output},
           {"features", motion, "-o", output},
           {"render", motion, "-o", output + ".svg"},
           {"learn", motion, "--name", "bad", "-o", output},
           {"search", squat_template, "--in", motion, "--curve", output},
       }) {
    SCOPED_TRACE(arguments.front());
    ExpectOneError(RunKinebase(arguments), 1, parts);
  }
  EXPECT_EQ(NamesBelow(library.scratch()), before);
}

TEST(BadInput, MissingFile) {
  const SyntheticLibrary library;
  ExpectEveryCommandRefuses(library, library.scratch() / "nowhere.amc",
                            {"nowhere.amc: does not exist"});
}

TEST(BadInput, MissingSkeleton) {
  const SyntheticLibrary library;
  const std::string motion = library.BadMotion(ReadText(library.Squat()));
  fs::remove(fs::path(motion).parent_path() / "SYN_sa.asf");
  ExpectEveryCommandRefuses(library, motion,
                            {motion, "no skeleton found", "SYN_sa.asf", "--skeleton"});
  ExpectOneError(RunKinebase({"info", library.Squat(), "--skeleton", "nowhere.asf"}), 1,
                 {"nowhere.asf"});
}

TEST(BadInput, BoneThatTheSkeletonLacks) {
  const SyntheticLibrary library;
  const std::string text = Replaced(ReadText(library.Squat()), "\nhead ", "\nhat ");
  const std::string motion = library.BadMotion(text);
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(text.find("\nhat "));
  const auto line = std::to_string(std::count(text.begin(), end, '\n') + 2);
  ExpectEveryCommandRefuses(library, motion, {motion + ":" + line, "'hat'", "SYN_sa.asf"});
}

TEST(BadInput, BinaryData) {
  const SyntheticLibrary library;
  std::string noise;
  for (unsigned i = 0; i < 5000; ++i) noise += static_cast<char>(i * 2654435761U >> 13U);
  const std::string motion = library.BadMotion(noise);
  ExpectEveryCommandRefuses(library, motion, {motion, "binary"});
}

TEST(BadInput, EmptyFile) {
  const SyntheticLibrary library;
  const std::string motion = library.BadMotion("");
  ExpectEveryCommandRefuses(library, motion, {motion, "is empty"});
}

TEST(BadInput, NoFrames) {
  const SyntheticLibrary library;
  const std::string motion = library.BadMotion(":FULLY-SPECIFIED\n:DEGREES\n");
  ExpectEveryCommandRefuses(library, motion, {motion, "no frames"});
}

TEST(BadInput, UnknownFormat) {
  const SyntheticLibrary library;
  const std::string file = library.BadMotion("some text", "notes.txt");
  ExpectEveryCommandRefuses(library, file, {file, ".amc", ".c3d", ".mat"});
}

TEST(BadInput, CutOffLastFrameIsDroppedWithAWarning) {
  const SyntheticLibrary library;
  const std::string text = ReadText(library.Squat());
  const std::string motion = library.BadMotion(text.substr(0, text.size() - 100));
  const std::string output = library.scratch() / "joints.csv";
  const ProgramResult result = RunKinebase({"joints", motion, "-o", output});
  EXPECT_EQ(result.exit_code, 0);
  ASSERT_EQ(result.ErrorLines().size(), 2U) << result.err;
  EXPECT_THAT(result.ErrorLines()[0], HasSubstr(motion + ":"));
  EXPECT_THAT(result.ErrorLines()[0], HasSubstr(": warning: "));
  const auto whole = RunKinebase({"info", "--json", library.Squat()}).Json();
  EXPECT_EQ(ReadCsv(output).rows.size() + 1, whole["files"][0]["frames"]);
  const auto info = RunKinebase({"info", "--json", motion}).Json()["files"][0];
  EXPECT_EQ(info["frames"].get<int>() + 1, whole["files"][0]["frames"]);
  ASSERT_EQ(info["diagnostics"].size(), 1U);
  EXPECT_EQ(info["diagnostics"][0]["severity"], "warning");
  EXPECT_TRUE(info["diagnostics"][0]["line"].is_number_integer());
}

TEST(BadInput, CutOffLastFrameIsRefusedUnderStrict) {
  const SyntheticLibrary library;
  const std::string text = ReadText(library.Squat());
  const std::string motion = library.BadMotion(text.substr(0, text.size() - 100));
  const std::string output = library.scratch() / "joints.csv";
  ExpectOneError(RunKinebase({"joints", motion, "--strict", "-o", output}), 1,
                 {motion + ":", "--strict", "last frame"});
  EXPECT_FALSE(fs::exists(output));
}

TEST(BadInput, FolderWithNothingUsable) {
  const SyntheticLibrary library;
  const fs::path empty = library.scratch() / "empty";
  WriteText(empty / "below" / "notes.txt", "nothing");
  const std::string squat = library.Learn("squat1Reps");
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"info", empty}, {"search", squat, "--in", empty}, {"learn", empty, "--name", "a"}}) {
    ExpectOneError(RunKinebase(arguments, {.folder = library.scratch()}), 1,
                   {empty.string() + ": holds no motion file", ".amc"});
  }
  EXPECT_FALSE(fs::exists(library.scratch() / "a.template.json"));
}

TEST(BadInput, FolderInPlaceOfAMotion) {
  const SyntheticLibrary library;
  for (const char* command : {"joints", "features"}) {
    ExpectOneError(RunKinebase({command, library.folder()}), 1, {"library: is a folder"});
  }
}

TEST(BadInput, StretchThatLeavesTheTake) {
  const SyntheticLibrary library;
  const auto before = NamesBelow(library.scratch());
  const std::string motion = library.Squat();
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"joints", motion + ":5-99999"},
           {"features", motion + ":5-99999"},
           {"learn", motion + ":5-99999", "--name", "a"},
           {"render", motion, "--frames", "5-99999", "-o", "a.svg"}}) {
    SCOPED_TRACE(arguments.front());
    ExpectOneError(RunKinebase(arguments, {.folder = library.scratch()}), 1,
                   {motion, "5 to 99999", "1 to "});
  }
  EXPECT_EQ(NamesBelow(library.scratch()), before);
}

// One good file and one bad: the good one is done, the bad one is listed.
class PartOfABatch : public ::testing::Test {
 protected:
  void ExpectPartFailed(const ProgramResult& result) const {
    EXPECT_EQ(result.exit_code, 3);
    ASSERT_EQ(result.ErrorLines().size(), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr("error: " + bad_ + ": is empty"));
  }
  void ExpectListed(const nlohmann::ordered_json& json) const {
    ASSERT_EQ(json["failed"].size(), 1U);
    EXPECT_THAT(FieldsOf(json["failed"][0]), ElementsAre("file:string", "message:string"));
    EXPECT_EQ(json["failed"][0]["file"], bad_);
    EXPECT_THAT(json["failed"][0]["message"].get<std::string>(), HasSubstr("is empty"));
  }

  SyntheticLibrary library_;
  std::string bad_ = library_.BadMotion("");
  std::string good_ = library_.Squat();
  std::string output_ = library_.scratch() / "output";
};

TEST_F(PartOfABatch, Info) {
  const ProgramResult result = RunKinebase({"info", bad_, good_, "--json", "--quiet"});
  ExpectPartFailed(result);
  ExpectListed(result.Json());
  ASSERT_EQ(result.Json()["files"].size(), 1U);
  EXPECT_EQ(result.Json()["files"][0]["path"], good_);
  const ProgramResult text = RunKinebase({"info", bad_, good_});
  ExpectPartFailed(text);
  EXPECT_THAT(text.out, HasSubstr(good_));
  EXPECT_THAT(text.out, Not(HasSubstr(bad_)));
}

TEST_F(PartOfABatch, Learn) {
  const ProgramResult result =
      RunKinebase({"learn", bad_, good_, "--name", "squat", "-o", output_, "--json", "--quiet"});
  ExpectPartFailed(result);
  ExpectListed(result.Json());
  EXPECT_EQ(result.Json()["clips"], 1);
  const auto learned = nlohmann::json::parse(ReadText(output_));
  EXPECT_EQ(learned["clips"][0]["file"], fs::path(good_).filename().string());
}

TEST_F(PartOfABatch, Search) {
  const ProgramResult result = RunKinebase(
      {"search", library_.Learn("squat1Reps"), "--in", bad_, good_, "--json", "--quiet"});
  ExpectPartFailed(result);
  ExpectListed(result.Json());
  ASSERT_FALSE(result.Json()["hits"].empty());
  EXPECT_EQ(result.Json()["hits"][0]["file"], good_);
}

TEST_F(PartOfABatch, LearnNotesTheStretchesThatWereUsed) {
  const ProgramResult result = RunKinebase({"learn", good_ + ":1-99999", good_ + ":20-200",
                                            "--name", "squat", "-o", output_, "--quiet"});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  const auto clips = nlohmann::json::parse(ReadText(output_))["clips"];
  ASSERT_EQ(clips.size(), 1U);
  EXPECT_EQ(clips[0]["first_frame"], 20);
  EXPECT_EQ(clips[0]["last_frame"], 200);
}

TEST(BadList, NamesWhatIsMissing) {
  const SyntheticLibrary library;
  const std::string list = library.list();
  const auto learn = [&](const std::string& from, const std::string& class_name,
                         const std::string& actors) {
    return RunKinebase({"learn", "--list", from, "--class", class_name, "--actors", actors, "-o",
                        library.scratch() / "output"});
  };
  ExpectOneError(learn("nowhere.csv", "squat1Reps", "sa"), 1, {"nowhere.csv"});
  ExpectOneError(learn(list, "flying", "sa"), 1, {list, "'flying'", "squat1Reps"});
  ExpectOneError(learn(list, "squat1Reps", "sz"), 1, {list, "squat1Reps", "sz"});
  const std::string other = library.scratch() / "elsewhere" / "list.csv";
  WriteText(other, "file,class,actor\ngone.amc,squat1Reps,sa\n");
  ExpectOneError(learn(other, "squat1Reps", "sa"), 1, {other + ":2", "gone.amc", "--in"});
  WriteText(other, "name,class,actor\ngone.amc,squat1Reps,sa\n");
  ExpectOneError(learn(other, "squat1Reps", "sa"), 1, {other, "'file'", "name, class, actor"});
  EXPECT_FALSE(fs::exists(library.scratch() / "output"));
}

// A template that cannot be used, for every command that reads one.
class BadTemplate : public ::testing::Test {
 protected:
  void ExpectRefused(const std::string& text, const std::vector<std::string>& parts,
                     bool shown = false) {
    const fs::path file = library_.scratch() / "bad.template.json";
    WriteText(file, text);
    std::vector<std::string> all = parts;
    all.emplace_back("bad.template.json");
    const std::string output = library_.scratch() / "output";
    ExpectOneError(RunKinebase({"search", file, "--in", library_.folder(), "--curve", output}), 1,
                   all);
    ExpectOneError(RunKinebase({"template", "mirror", file, "-o", output}), 1, all);
    ExpectOneError(RunKinebase({"template", "render", file, "-o", output + ".svg"}), 1, all);
    if (shown) {
      EXPECT_EQ(RunKinebase({"template", "show", file}).exit_code, 0);
    } else {
      ExpectOneError(RunKinebase({"template", "show", file}), 1, all);
    }
    EXPECT_FALSE(fs::exists(output));
    EXPECT_FALSE(fs::exists(output + ".svg"));
  }

  [[nodiscard]] std::string WithField(const char* field, const nlohmann::json& value) const {
    auto json = nlohmann::json::parse(good_);
    json[nlohmann::json::json_pointer(field)] = value;
    return json.dump();
  }

  SyntheticLibrary library_;
  std::string good_ = ReadText(library_.Learn("squat1Reps"));
};

TEST_F(BadTemplate, OfAnotherFeatureSet) {
  ExpectRefused(WithField("/feature_set/hash", "0123456789abcdef"), {"0123456789abcdef", "bonn"},
                true);
}

TEST_F(BadTemplate, OfAUserFeatureSetThatIsNotNamed) {
  ExpectRefused(WithField("/feature_set/name", "mine"), {"'mine'", "--feature-set"}, true);
}

TEST_F(BadTemplate, OfARateThatTheFeaturesLack) {
  ExpectRefused(WithField("/matrix/rate_hz", 50), {"50", "120"}, true);
}

TEST_F(BadTemplate, OfANewerVersion) {
  ExpectRefused(WithField("/version", 99), {"version 99", "newer Kinebase"});
}

TEST_F(BadTemplate, ThatIsNoTemplate) {
  ExpectRefused(R"({"format": "something-else", "version": 1})", {"kinebase-template"});
}

TEST_F(BadTemplate, ThatIsNotJson) { ExpectRefused("squat", {"not JSON"}); }

TEST_F(BadTemplate, ThatIsEmpty) { ExpectRefused("", {"not JSON"}); }

TEST_F(BadTemplate, ThatIsCutOff) { ExpectRefused(good_.substr(0, 2000), {"not JSON"}); }

TEST_F(BadTemplate, ThatIsMissing) {
  ExpectOneError(RunKinebase({"search", "nowhere.json", "--in", library_.folder()}), 1,
                 {"nowhere.json"});
}

TEST_F(BadTemplate, IsUsedWithItsFeatureSetNamed) {
  const fs::path feature_set = library_.scratch() / "mine.toml";
  WriteText(feature_set,
            Replaced(ReadText(fs::path(KINEBASE_SOURCE_DIR) / "data/feature_sets/bonn.toml"),
                     "name = \"bonn\"", "name = \"mine\""));
  const std::string mine = library_.scratch() / "mine.template.json";
  const ProgramResult learned = RunKinebase({"learn", library_.Squat(), "--name", "squat", "-o",
                                             mine, "--feature-set", feature_set, "--quiet"});
  ASSERT_EQ(learned.exit_code, 0) << learned.err;
  ExpectOneError(RunKinebase({"search", mine, "--in", library_.folder()}), 1,
                 {mine, "--feature-set"});
  ExpectOneError(RunKinebase({"search", mine, "--in", library_.folder(), "--feature-set", "paper"}),
                 1, {mine, "'paper'"});
  const ProgramResult found = RunKinebase(
      {"search", mine, "--in", library_.folder(), "--feature-set", feature_set, "--json"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(found.Json()["hits"][0]["file"], library_.Squat());
}

}  // namespace
}  // namespace kinebase::test
