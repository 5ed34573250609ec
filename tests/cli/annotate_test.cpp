// annotate as scripts and people see it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/output_file.h"
#include "pictures/svg_reader.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

// Templates from actor sa, recordings of actor sb.
class Annotating : public ::testing::Test {
 protected:
  ProgramResult Annotate(const std::vector<std::string>& more,
                         const std::vector<std::string>& paths) const {
    std::vector<std::string> arguments = {"annotate", squat_, kick_, "--in"};
    arguments.insert(arguments.end(), paths.begin(), paths.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

  [[nodiscard]] std::string Clip(const char* class_name, int repetition = 1) const {
    return library_.Clip(class_name, "sb", repetition).string();
  }

  // Labels that give each of the files whole to its class.
  [[nodiscard]] std::string WriteTruth(const std::map<std::string, std::string>& class_of) const {
    std::string text = "file,class,first_frame,last_frame\n";
    for (const auto& [file, class_name] : class_of) {
      const auto info = RunKinebase({"info", file, "--json"}).Json();
      text += fs::path(file).filename().string() + ',' + class_name + ",1," +
              std::to_string(info["files"][0]["frames"].get<int>()) + '\n';
    }
    const fs::path path = library_.scratch() / "truth.csv";
    WriteFile(path, text, Overwrite::kYes);
    return path;
  }

  SyntheticLibrary library_;
  std::string squat_ = library_.Learn("squat1Reps");
  std::string kick_ = library_.Learn("kickRFront1Reps");
};

TEST_F(Annotating, GivesEveryFrameOneClassOrUnknown) {
  const std::vector<std::string> files = {Clip("squat1Reps"), Clip("kickRFront1Reps"),
                                          Clip("jumpingJack1Reps")};
  const auto json = Annotate({"--json"}, files).Json();
  EXPECT_THAT(FieldsOf(json), ElementsAre("segments:array", "thresholds:array"));
  EXPECT_THAT(FieldsOf(json["thresholds"][0]),
              ElementsAre("template:string", "class:string", "tau:number"));
  std::map<std::string, int> next;  // [file]
  std::map<std::string, int> squats;
  for (const auto& segment : json["segments"]) {
    const bool is_class = segment["class"] != "unknown";
    EXPECT_THAT(FieldsOf(segment),
                ElementsAre("file:string", "class:string", "first_frame:integer",
                            "last_frame:integer", "start_s:number", "end_s:number",
                            is_class ? "cost:number" : "cost:null", "confidence:null"));
    const std::string file = segment["file"];
    EXPECT_EQ(segment["first_frame"], next[file] + 1);
    next[file] = segment["last_frame"];
    EXPECT_DOUBLE_EQ(segment["start_s"], (segment["first_frame"].get<int>() - 1) / 120.0);
    EXPECT_DOUBLE_EQ(segment["end_s"], segment["last_frame"].get<int>() / 120.0);
    if (segment["class"] == "squat1Reps") ++squats[file];
  }
  for (const std::string& file : files) {
    EXPECT_EQ(next[file], RunKinebase({"info", file, "--json"}).Json()["files"][0]["frames"]);
  }
  EXPECT_EQ(squats, (std::map<std::string, int>{{files[0], 1}}));
}

TEST_F(Annotating, LeavesTheUnknownOut) {
  const auto json = Annotate({"--json", "--no-unknown"}, {Clip("jumpingJack1Reps")}).Json();
  EXPECT_THAT(json["segments"], SizeIs(0));
}

TEST_F(Annotating, PutsTemplatesOfOneNameIntoOneClass) {
  const auto json =
      RunKinebase({"annotate", "--class", "exercise=" + squat_, "--class", "exercise=" + kick_,
                   "--in", Clip("squat1Reps"), Clip("kickRFront1Reps"), "--json", "--no-unknown"})
          .Json();
  ASSERT_THAT(json["segments"], SizeIs(2));
  for (const auto& segment : json["segments"]) EXPECT_EQ(segment["class"], "exercise");
}

TEST_F(Annotating, MeasuresItselfAgainstLabels) {
  const std::string squat = Clip("squat1Reps");
  const std::string jack = Clip("jumpingJack1Reps");
  const std::string truth = WriteTruth({{squat, "down and up"}, {jack, "unknown"}});
  const std::vector<std::string> compare = {"--truth", truth, "--label", "down and up=squat1Reps"};
  std::vector<std::string> as_json = compare;
  as_json.emplace_back("--json");
  const auto json = Annotate(as_json, {squat, jack}).Json();
  int right = 0;  // All frames of the squat's only clip that were found to be one.
  for (const auto& segment : json["segments"]) {
    if (segment["class"] != "squat1Reps") continue;
    EXPECT_EQ(segment["file"], squat);
    right += segment["last_frame"].get<int>() - segment["first_frame"].get<int>() + 1;
  }
  ASSERT_GT(right, 0);
  const auto& accuracy = json["accuracy"];
  EXPECT_THAT(FieldsOf(accuracy),
              ElementsAre("frames:object", "segments:object", "confusion:object"));
  const auto& frames = accuracy["frames"]["classes"][0];
  EXPECT_EQ(frames["class"], "squat1Reps");
  EXPECT_EQ(frames["right"], right);
  EXPECT_EQ(frames["found"], right);
  EXPECT_EQ(frames["present"], RunKinebase({"info", squat, "--json"}).Json()["files"][0]["frames"]);
  EXPECT_EQ(accuracy["segments"]["micro"]["f1"], 1);
  EXPECT_EQ(accuracy["confusion"]["classes"].back(), "unknown");
  EXPECT_EQ(accuracy["confusion"]["frames"][0][0], right);

  const ProgramResult text = Annotate(compare, {squat, jack});
  EXPECT_THAT(text.out, ContainsRegex("micro +1 +1 +1 +1\\.000 +1\\.000 +1\\.000"));
}

TEST_F(Annotating, WritesWhatItReads) {
  const std::string file = library_.scratch() / "found.csv";
  const std::string squat = Clip("squat1Reps");
  EXPECT_EQ(Annotate({"-o", file}, {squat}).exit_code, 0);
  const CsvTable table = ParseCsv(ReadText(file), file);
  EXPECT_THAT(table.columns, ElementsAre("file", "class", "first_frame", "last_frame", "start_s",
                                         "end_s", "cost", "confidence"));
  const auto json = Annotate({"--truth", file, "--json"}, {squat}).Json();
  EXPECT_EQ(json["accuracy"]["frames"]["micro"]["f1"], 1);
}

TEST_F(Annotating, WritesElanDocuments) {
  const std::string file = library_.scratch() / "found.eaf";
  EXPECT_EQ(Annotate({"-o", file}, {Clip("squat1Reps")}).exit_code, 0);
  EXPECT_THAT(ReadText(file), HasSubstr("<ANNOTATION_VALUE>squat1Reps</ANNOTATION_VALUE>"));
  EXPECT_THAT(ReadText(file), HasSubstr("TIER_ID=\"motion\""));
  EXPECT_EQ(Annotate({"--overlap", "all", "-o", file, "-f"}, {Clip("squat1Reps")}).exit_code, 0);
  EXPECT_THAT(ReadText(file), HasSubstr("TIER_ID=\"kickRFront1Reps\""));
  const fs::path folder = library_.scratch() / "documents";
  EXPECT_EQ(
      Annotate({"--format", "eaf", "-o", folder}, {Clip("squat1Reps"), Clip("kickRFront1Reps")})
          .exit_code,
      0);
  EXPECT_THAT(NamesBelow(folder), SizeIs(2));
  EXPECT_THAT(NamesBelow(folder), Each(HasSubstr(".eaf")));
}

TEST_F(Annotating, ChoosesThresholdsFromTheBackground) {
  const auto json = Annotate({"--background", library_.folder(), "--json", "--no-unknown"},
                             {Clip("squat1Reps"), Clip("jumpingJack1Reps")})
                        .Json();
  // The clips of a class are no background for it: else nothing would be found.
  ASSERT_THAT(json["segments"], SizeIs(1));
  EXPECT_EQ(json["segments"][0]["class"], "squat1Reps");
  // The others at their best; the second-best recording counts.
  std::map<std::string, double> cost_of;
  const auto hits =
      RunKinebase({"search", squat_, "--in", library_.folder(), "--tau", "9", "--json"}).Json();
  for (const auto& hit : hits["hits"]) {
    const std::string file = hit["file"];
    if (file.find("squat1Reps") != std::string::npos) continue;
    cost_of.try_emplace(file, hit["cost"]);  // The best comes first.
  }
  std::vector<double> costs;
  costs.reserve(cost_of.size());
  for (const auto& [file, cost] : cost_of) costs.push_back(cost);
  std::ranges::sort(costs);
  EXPECT_DOUBLE_EQ(json["thresholds"][0]["tau"], 0.7 * costs.at(1));
}

TEST_F(Annotating, LetsClassesOfOtherSetsOverlap) {
  // The same template under two names: of one set one of them is found, of two sets both are.
  const auto classes_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"annotate",        squat_,        "--class",
                                          "again=" + squat_, "--in",        Clip("squat1Reps"),
                                          "--json",          "--no-unknown"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto json = RunKinebase(arguments).Json();
    std::vector<std::string> classes;
    for (const auto& segment : json["segments"]) classes.push_back(segment["class"]);
    return classes;
  };
  EXPECT_THAT(classes_of({}), SizeIs(1));
  EXPECT_THAT(classes_of({"--set", "squat1Reps,again"}), SizeIs(1));
  EXPECT_THAT(classes_of({"--overlap", "parts"}), SizeIs(1));  // Both ask for all parts.
  EXPECT_THAT(classes_of({"--set", "squat1Reps", "--set", "again"}),
              ElementsAre("squat1Reps", "again"));
  EXPECT_THAT(classes_of({"--overlap", "all"}), ElementsAre("squat1Reps", "again"));
}

TEST_F(Annotating, FindsWhatLongTakesAreKnownToHold) {
  const fs::path other = library_.scratch() / "other";
  RunKinebase({"synth", other, "--actors", "1", "--takes", "1", "--clips-per-take", "3",
               "--repetitions", "1", "--classes", "squat1Reps", "-q"});
  const auto annotate = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"--truth", other / "takes.truth.csv", "--json",
                                          "--no-unknown"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Annotate(arguments, {other / "takes"}).Json();
  };
  const auto json = annotate({});
  EXPECT_THAT(json["segments"], SizeIs(3));
  EXPECT_EQ(json["accuracy"]["segments"]["micro"]["f1"], 1);
  EXPECT_GT(json["accuracy"]["frames"]["micro"]["recall"], 0.95);
  EXPECT_THAT(annotate({"--merge", "1000"})["segments"], SizeIs(1));
}

TEST_F(Annotating, DrawsTimelines) {
  const std::string squat = Clip("squat1Reps");
  const std::string picture = library_.scratch() / "timeline.svg";
  const std::string truth = WriteTruth({{squat, "squat1Reps"}});
  EXPECT_EQ(Annotate({"--picture", picture, "--truth", truth}, {squat}).exit_code, 0);
  EXPECT_THAT(SvgReader(ReadText(picture)).Texts(), Contains("truth, above"));
  ExpectOneError(Annotate({"--picture", picture, "-q"}, {squat}), 1, {"exists already"});
}

TEST_F(Annotating, SaysInOneLineWhatIsWrong) {
  const std::string squat = Clip("squat1Reps");
  const std::string truth = WriteTruth({{squat, "dance"}});
  const auto wrong = [&](std::vector<std::string> more, int code,
                         const std::vector<std::string>& parts) {
    more.emplace_back("-q");
    SCOPED_TRACE(more.front());
    ExpectOneError(Annotate(more, {squat}), code, parts);
  };
  wrong({"--truth", truth}, 1, {"truth.csv", "dance", "squat1Reps", "--label"});
  wrong({"--truth", truth, "--label", "dance=ballet"}, 2, {"'ballet'", "squat1Reps"});
  wrong({"--truth", truth, "--label", "dance"}, 2, {"LABEL=CLASS"});
  wrong({"--label", "a=b"}, 2, {"--truth is missing"});
  wrong({"--tau", "0.1", "--background", squat}, 2, {"--tau or --background"});
  wrong({"--set", "ballet"}, 2, {"'ballet'"});
  wrong({"--set", "squat1Reps", "--set", "squat1Reps"}, 2, {"two of --set"});
  wrong({"--overlap", "some"}, 2, {"none, parts, all"});
  wrong({"--class", squat_}, 2, {"NAME=FILE"});
  wrong({"--class", "unknown=" + squat_}, 1, {"what no template fits"});
  wrong({"-o", "found.txt"}, 2, {"found.txt", "--format"});
  wrong({"--format", "csv", "--truth", truth}, 2, {"-o FILE"});
  wrong({"--background", squat, "--class", "squat1Reps=" + squat_}, 1, {"--background"});
  ExpectOneError(RunKinebase({"annotate", "--in", squat, "-q"}), 2, {"needs templates"});
  ExpectOneError(RunKinebase({"annotate", squat_, "-q"}), 2, {"--in is required"});
  const std::vector<std::string> two = {squat, Clip("kickRFront1Reps")};
  ExpectOneError(Annotate({"--format", "eaf", "-q"}, two), 2, {"one recording", "-o"});
  const fs::path document = library_.scratch() / "two.eaf";
  ExpectOneError(Annotate({"-o", document, "-q"}, two), 2, {"one recording", "a folder"});
  EXPECT_FALSE(fs::exists(document));
}

TEST_F(Annotating, DoesTheRestOfABatch) {
  const std::string bad = library_.BadMotion("nothing");
  const ProgramResult result = Annotate({"--json", "-q"}, {Clip("squat1Reps"), bad});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.Json()["failed"][0]["file"], bad);
  ExpectOneError(Annotate({"--json", "-q"}, {bad}), 1, {bad});
}

}  // namespace
}  // namespace kinebase::test
