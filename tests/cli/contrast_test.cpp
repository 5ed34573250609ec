// learn --method mt+, search with such templates, evaluate.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "kinebase/templates/template_file.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class ContrastCommands : public testing::Test {
 protected:
  // Templates of all classes of both actors, in <scratch>/classes.
  fs::path LearnAll() {
    fs::path folder = library_.scratch() / "classes";
    const ProgramResult run = RunKinebase({"learn", "--list", library_.list(), "--all-classes",
                                           "--method", "mt+", "-o", folder, "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(json::parse(run.out).at("templates").size(), NamesBelow(folder).size());
    return folder;
  }

  SyntheticLibrary library_;
};

TEST_F(ContrastCommands, LearnEveryClassOfAListWithThresholdAndConfidence) {
  const fs::path folder = LearnAll();
  for (const std::string& name : NamesBelow(folder)) {
    const MotionTemplate learned = ReadTemplate(folder / name);
    EXPECT_TRUE(learned.contrast) << name;
    EXPECT_FALSE(learned.clips.empty()) << name;
    EXPECT_EQ(fs::path(name).filename(), learned.name + ".template.json");
    EXPECT_EQ(learned.tau.has_value(), learned.calibration.has_value()) << name;
  }
  const fs::path squat = folder / "squat1Reps.template.json";
  EXPECT_THAT(RunKinebase({"template", "show", squat}).out,
              HasSubstr("half way from right to wrong"));
  // The plain matrix is the same as without.
  EXPECT_EQ(ReadTemplate(squat).matrix, [&] {
    const fs::path plain = library_.scratch() / "plain.json";
    RunKinebase({"learn", "--list", library_.list(), "--class", "squat1Reps", "-o", plain});
    return ReadTemplate(plain).matrix;
  }());
}

TEST_F(ContrastCommands, FindTheClassWithConfidence) {
  const fs::path squat = LearnAll() / "squat1Reps.template.json";
  const auto hits_of = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "search", squat.string(), "--in", library_.folder().string(), "--json", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult run = RunKinebase(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out).at("hits");
  };
  const json hits = hits_of({});
  ASSERT_FALSE(hits.empty());
  for (const json& hit : hits) {
    EXPECT_THAT(hit["file"].get<std::string>(), HasSubstr("SYN_"));
    EXPECT_GE(hit["confidence"].get<double>(), 0.5);
  }
  EXPECT_GE(hits_of({"--tau", "9"}).size(), hits.size());
  const json plain = hits_of({"--method", "mt"});
  ASSERT_FALSE(plain.empty());
  EXPECT_TRUE(plain[0]["confidence"].is_null());
}

TEST_F(ContrastCommands, FindWhatIsAsSureAsAskedFor) {
  const fs::path squat = LearnAll() / "squat1Reps.template.json";
  const auto hits_of = [&](const std::string& option, const std::string& value) {
    const ProgramResult run =
        RunKinebase({"search", squat, "--in", library_.folder(), option, value, "--json", "-q"});
    return json::parse(run.out).at("hits");
  };
  const json all = hits_of("--tau", "9");
  for (const char* confidence : {"0.9", "0.5", "0.02"}) {
    json sure = json::array();
    for (const json& hit : all) {
      if (hit["confidence"] >= std::stod(confidence)) sure.push_back(hit);
    }
    EXPECT_THAT(sure, testing::AllOf(testing::Not(testing::IsEmpty()),
                                     testing::Not(testing::SizeIs(all.size()))));
    EXPECT_EQ(hits_of("--confidence", confidence), sure) << confidence;
  }
}

TEST_F(ContrastCommands, AnnotateWhatIsAsSureAsAskedFor) {
  const fs::path squat = LearnAll() / "squat1Reps.template.json";
  const Calibration learned = *ReadTemplate(squat).calibration;
  std::size_t fewest = 0;
  for (const double confidence : {0.9, 0.5, 0.02}) {
    const json found = RunKinebase({"annotate", squat, "--in", library_.folder(), "--confidence",
                                    std::to_string(confidence), "--no-unknown", "--json", "-q"})
                           .Json();
    const double tau = found["thresholds"][0]["tau"];
    EXPECT_NEAR(1 / (1 + std::exp(learned.slope * tau + learned.offset)), confidence, 1e-9);
    EXPECT_GE(found["segments"].size(), fewest);
    fewest = found["segments"].size();
    for (const json& segment : found["segments"]) {
      EXPECT_GE(segment["confidence"].get<double>(), confidence);
    }
  }
  EXPECT_GT(fewest, 0);
  const std::vector<std::string> for_people = {"annotate", squat, "--in", library_.folder(), "-q"};
  EXPECT_THAT(RunKinebase(for_people).out, testing::ContainsRegex("cost +confidence +file"));
}

// The threshold as search would tell it: a share of what the second-best recording costs.
TEST_F(ContrastCommands, AnnotateWithThresholdsFromTheBackground) {
  const fs::path squat = LearnAll() / "squat1Reps.template.json";
  std::map<std::string, double> least;
  const json hits =
      RunKinebase({"search", squat, "--in", library_.folder(), "--tau", "9", "--json", "-q"})
          .Json()["hits"];
  for (const json& hit : hits) {
    const std::string file = hit["file"];
    if (file.find("squat1Reps") != std::string::npos) continue;
    const auto [entry, is_new] = least.try_emplace(file, hit["cost"]);
    entry->second = std::min(entry->second, hit["cost"].get<double>());
  }
  std::vector<double> costs;
  costs.reserve(least.size());
  for (const auto& [file, cost] : least) costs.push_back(cost);
  std::ranges::sort(costs);
  const auto annotate = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"annotate",
                                          squat,
                                          "--in",
                                          library_.Clip("squat1Reps", "sb", 1),
                                          "--background",
                                          library_.folder(),
                                          "--no-unknown",
                                          "--json",
                                          "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments).Json();
  };
  const json found = annotate({});
  const double tau = found["thresholds"][0]["tau"];
  EXPECT_DOUBLE_EQ(tau, 0.7 * costs.at(1));
  ASSERT_FALSE(found["segments"].empty());
  // The confidence is ½ there, and as steep as it was learned.
  const double slope = ReadTemplate(squat).calibration->slope;
  const json& segment = found["segments"][0];
  EXPECT_NEAR(segment["confidence"].get<double>(),
              1 / (1 + std::exp(slope * (segment["cost"].get<double>() - tau))), 1e-9);
  EXPECT_NEAR(annotate({"--confidence", "0.1"})["thresholds"][0]["tau"].get<double>(),
              tau + std::log(9) / slope, 1e-9);
}

TEST_F(ContrastCommands, LearnOneClassFromClipsAgainstABackground) {
  const fs::path squat = library_.scratch() / "squat.json";
  const ProgramResult run =
      RunKinebase({"learn", library_.Squat(), library_.Clip("squat1Reps", "sb", 1), "--name",
                   "squat", "--method", "mt+", "--background", library_.folder(), "-o", squat});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const MotionTemplate learned = ReadTemplate(squat);
  EXPECT_EQ(learned.name, "squat");
  EXPECT_EQ(learned.clips.size(), 2);
  EXPECT_TRUE(learned.contrast && learned.calibration && learned.tau);
  const json hits = json::parse(
      RunKinebase({"search", squat, "--in", library_.folder(), "--json", "--quiet"}).out)["hits"];
  ASSERT_FALSE(hits.empty());
  EXPECT_THAT(hits[0]["file"].get<std::string>(), HasSubstr("squat1Reps"));
}

TEST_F(ContrastCommands, SayWhatIsMissing) {
  const std::string squat = library_.Squat();
  const std::string out = library_.scratch() / "x.json";
  const std::string list = library_.list();
  struct Wrong {
    std::vector<std::string> arguments;
    int exit_code;
    std::string message;
  };
  for (const auto& [arguments, exit_code, message] : std::vector<Wrong>{
           {{"learn", squat, "--method", "mt+", "-o", out}, 2, "--background"},
           {{"learn", squat, "--method", "mt", "--background", squat, "-o", out},
            2,
            "--background is for --method mt+"},
           {{"learn", squat, "--background", squat, "-o", out}, 1, "but what clips are from"},
           {{"learn", squat, "--method", "mt", "--styles", "-o", out},
            2,
            "--styles is for --method mt+"},
           {{"learn", squat, "--styles", "-o", out}, 2, "--background"},
           {{"learn", "--list", list, "-o", out}, 2, "--class NAME or --all-classes"},
           {{"learn", "--list", list, "--all-classes", "--method", "mt+"}, 2, "-o FOLDER"},
           {{"learn", "--list", list, "--all-classes", "--method", "mt", "-o", out},
            2,
            "--method mt+"},
           {{"learn", "--list", list, "--class", "nothing", "--method", "mt+", "-o", out},
            1,
            "has no class 'nothing'"},
           {{"search", library_.Learn("squat1Reps"), "--in", squat, "--method", "mt+"},
            1,
            "plain template"},
           {{"search", (LearnAll() / "squat1Reps.template.json").string(), "--in", squat,
             "--keyframes", "auto"},
            1,
            "--method mt"},
           {{"search", library_.Learn("kickRFront1Reps"), "--in", squat, "--confidence", "0.5"},
            1,
            "--method mt+"},
           {{"annotate", library_.Learn("jumpingJack1Reps"), "--in", squat, "--confidence", "0.5"},
            1,
            "--method mt+"},
           {{"annotate", squat, "--in", squat, "--confidence", "0.5", "--tau", "1"},
            2,
            "--tau or --confidence"},
           {{"search", squat, "--in", squat, "--confidence", "0.5", "--tau", "1"},
            2,
            "--confidence"},
           {{"search", squat, "--in", squat, "--confidence", "0.5", "--method", "mt"},
            2,
            "leave out --method mt"},
           {{"annotate", squat, "--in", squat, "--confidence", "1"}, 2, "from 0.001 to 0.999"},
           {{"evaluate", "--clips", list, "--thresholds", "background"}, 2, "--protocol annotate"},
           {{"evaluate", "--clips", list, "--thresholds", "training", "--preset", "table1"},
            2,
            "--thresholds excludes --preset"},
           {{"evaluate", "--clips", out}, 1, "x.json"},
           {{"evaluate", "--clips", list, "--methods", "best"}, 2, "mt+"},
           {{"evaluate", "--clips", list, "--possibly-relevant", list}, 2, "--labels"},
       }) {
    ExpectOneError(RunKinebase(arguments), exit_code, {message});
  }
}

TEST_F(ContrastCommands, EvaluateLeavesEachActorOut) {
  const ProgramResult run = RunKinebase({"evaluate", "--clips", library_.list(), "--methods",
                                         "mt,mt+weights,mt,mt+", "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json methods = json::parse(run.out).at("methods");
  ASSERT_EQ(methods.size(), 3);
  EXPECT_EQ(methods[2]["method"], "mt+");
  for (const json& method : methods) {
    for (const char* measure : {"ap_strict", "ap_lenient", "r_precision", "classified"}) {
      const double value = method["macro"][measure];
      EXPECT_GT(value, 0.5) << measure;  // Made-up people move much alike.
      EXPECT_LE(value, 1) << measure;
    }
    EXPECT_EQ(method["reliability"].size(), 10);
    EXPECT_EQ(method["classes"][0]["actors"].size(), 2);
  }
  const ProgramResult text = RunKinebase(
      {"evaluate", "--clips", library_.list(), "--protocol", "half", "--format", "markdown"});
  EXPECT_THAT(text.out, HasSubstr("| squat1Reps | "));
  EXPECT_THAT(text.out, HasSubstr("| **macro** | "));
}

class EdgesOfLearning : public ContrastCommands {
 protected:
  // A list of clips beside the library's own.
  std::string List(const std::string& rows) {
    const fs::path file = library_.folder() / "edges.csv";
    WriteText(file, "file,class,actor\n" + rows);
    return file;
  }

  // A row for a clip under the name of any class.
  std::string Row(std::string_view clip_class, std::string_view actor, int repetition,
                  const std::string& class_name) {
    return library_.Clip(clip_class, actor, repetition).filename().string() + ',' + class_name +
           ',' + std::string(actor) + '\n';
  }

  std::string Squats() {
    return Row("squat1Reps", "sa", 1, "squat") + Row("squat1Reps", "sa", 2, "squat") +
           Row("squat1Reps", "sb", 1, "squat");
  }
};

TEST_F(EdgesOfLearning, EvaluateLeavesOutAClassThatOneActorPerforms) {
  const std::string list = List(Squats() + Row("kickRFront1Reps", "sa", 1, "kick"));
  const std::vector<std::string> command = {"evaluate",  "--clips", list,
                                            "--methods", "mt,mt+",  "-q"};
  const ProgramResult text = RunKinebase(command);
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, testing::ContainsRegex("kick +– +–"));
  std::vector<std::string> with_json = command;
  with_json.emplace_back("--json");
  const json method = RunKinebase(with_json).Json().at("methods").at(1);
  EXPECT_EQ(method["classes"][0]["class"], "kick");
  EXPECT_TRUE(method["classes"][0]["mean"].is_null());
  EXPECT_EQ(method["classes"][1]["mean"]["ap_strict"], method["macro"]["ap_strict"]);
}

TEST_F(EdgesOfLearning, EvaluateSaysWhatItHasTooLittleOf) {
  const std::string one_actor =
      List(Row("squat1Reps", "sa", 1, "squat") + Row("kickRFront1Reps", "sa", 1, "kick"));
  ExpectOneError(RunKinebase({"evaluate", "--clips", one_actor, "-q"}), 1, {"two or more"});
  ExpectOneError(RunKinebase({"evaluate", "--clips", one_actor, "--protocol", "half", "-q"}), 1,
                 {"no class has two clips"});
  const std::string apart =
      List(Row("squat1Reps", "sa", 1, "squat") + Row("kickRFront1Reps", "sb", 1, "kick"));
  ExpectOneError(RunKinebase({"evaluate", "--clips", apart, "-q"}), 1,
                 {"no class is performed by two actors"});
  ExpectOneError(RunKinebase({"evaluate", "--clips", List("a.amc,,sa\n"), "-q"}), 1,
                 {"edges.csv:2", "a clip without a class"});
}

TEST_F(EdgesOfLearning, LearnTakesOneActorAndOneClip) {
  const fs::path folder = library_.scratch() / "few";
  const std::string list =
      List(Row("squat1Reps", "sa", 1, "squat") + Row("squat1Reps", "sa", 2, "squat") +
           Row("kickRFront1Reps", "sa", 1, "kick"));
  const ProgramResult run = RunKinebase(
      {"learn", "--list", list, "--all-classes", "--method", "mt+", "-o", folder, "-q"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"squat", "kick"}) {
    const MotionTemplate learned = ReadTemplate(folder / (std::string(name) + ".template.json"));
    EXPECT_TRUE(learned.contrast && learned.tau && learned.calibration) << name;
  }
}

// Squats and kicks as one class are done in two ways.
TEST_F(EdgesOfLearning, LearnGivesEachStyleAFileOfItsOwn) {
  std::string rows;
  for (const char* actor : {"sa", "sb"}) {
    for (const int repetition : {1, 2}) {
      rows += Row("squat1Reps", actor, repetition, "exercise");
      rows += Row("kickRFront1Reps", actor, repetition, "exercise");
      rows += Row("jumpingJack1Reps", actor, repetition, "jump");
    }
  }
  const std::string list = List(rows);
  const fs::path folder = library_.scratch() / "styles";
  const ProgramResult run = RunKinebase({"learn", "--list", list, "--all-classes", "--method",
                                         "mt+", "--styles", "-o", folder, "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out).at("templates").size(), 3);
  const fs::path squats = folder / "exercise.template.json";
  const fs::path kicks = folder / "exercise-2.template.json";
  EXPECT_THAT(NamesBelow(folder),
              ElementsAre(kicks.filename(), squats.filename(), "jump.template.json"));
  for (const auto& [file, clip] : {std::pair{squats, "squat1Reps"}, {kicks, "kickRFront1Reps"}}) {
    const MotionTemplate learned = ReadTemplate(file);
    EXPECT_EQ(learned.name, "exercise");
    EXPECT_EQ(learned.clips.size(), 4);
    for (const TemplateClip& each : learned.clips) EXPECT_THAT(each.file, HasSubstr(clip));
  }
  EXPECT_EQ(ReadTemplate(squats).tau, ReadTemplate(kicks).tau);
  // One of them alone is a class with styles too.
  const fs::path one = library_.scratch() / "one.template.json";
  EXPECT_EQ(RunKinebase({"learn", "--list", list, "--class", "exercise", "--method", "mt+",
                         "--styles", "-o", one, "-q"})
                .exit_code,
            0);
  EXPECT_EQ(ReadTemplate(library_.scratch() / "one-2.template.json").matrix,
            ReadTemplate(kicks).matrix);
  // Each clip is found by the template of its style.
  for (const char* name : {"squat1Reps", "kickRFront1Reps"}) {
    const auto hits =
        RunKinebase({"search", squats, kicks, "--in", library_.Clip(name, "sb", 1), "--json", "-q"})
            .Json()["hits"];
    ASSERT_EQ(hits.size(), 1) << name;
    EXPECT_EQ(hits[0]["template"], "exercise");
  }
}

TEST_F(EdgesOfLearning, LearnRefusesClassesThatWouldShareAFile) {
  const fs::path folder = library_.scratch() / "shared";
  const std::string list =
      List(Row("squat1Reps", "sa", 1, "to/day") + Row("kickRFront1Reps", "sa", 1, "to_day"));
  ExpectOneError(RunKinebase({"learn", "--list", list, "--all-classes", "--method", "mt+", "-o",
                              folder, "-q"}),
                 1, {"'to/day'", "'to_day'", "rename"});
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(EdgesOfLearning, AClipOfTwoClassesIsReportedAndTheRestIsDone) {
  const std::string list =
      List(Squats() + Row("squat1Reps", "sb", 1, "kick") + Row("kickRFront1Reps", "sa", 1, "kick"));
  const ProgramResult run = RunKinebase({"learn", "--list", list, "--all-classes", "--method",
                                         "mt+", "-o", library_.scratch() / "two", "-q"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("is listed as 'squat' in line 4 and as 'kick' in line 5"));
}

// Each set is extracted once; both classes are found.
TEST_F(EdgesOfLearning, SearchAndAnnotateTakeTemplatesOfDifferentFeatureSets) {
  const std::string squat = LearnAll() / "squat1Reps.template.json";
  const fs::path paper = library_.scratch() / "paper";
  RunKinebase({"learn", "--list", library_.list(), "--all-classes", "--method", "mt+", "--profile",
               "paper", "-o", paper, "-q"});
  const std::string kick = paper / "kickRFront1Reps.template.json";
  for (const std::string command : {"search", "annotate"}) {
    const ProgramResult run =
        RunKinebase({command, squat, kick, "--in", library_.Clip("squat1Reps", "sb", 1),
                     library_.Clip("kickRFront1Reps", "sb", 1), "--json", "-q"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out,
                testing::AllOf(HasSubstr("\"squat1Reps\""), HasSubstr("\"kickRFront1Reps\"")))
        << command;
  }
}

}  // namespace
}  // namespace kinebase::test
