// From examples to hits, on made-up motion whose truth is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

ordered_json Search(const std::string& motion_template, const SyntheticLibrary& library,
                    const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"search", motion_template, "--in", library.folder(),
                                        "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult result = RunKinebase(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  return result.Json()["hits"];
}

std::vector<std::string> FilesOf(const ordered_json& hits) {
  std::vector<std::string> files;
  for (const auto& hit : hits) files.push_back(hit["file"]);
  return files;
}

std::vector<double> CostsOf(const ordered_json& hits) {
  std::vector<double> costs;
  for (const auto& hit : hits) costs.push_back(hit["cost"]);
  return costs;
}

// A motion file with frames first to last (1-based) of another, numbered from 1.
std::string CutText(const std::string& text, int first, int last) {
  std::istringstream lines(text);
  std::string cut;
  int frame = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool is_number = line.find_first_not_of("0123456789") == std::string::npos;
    if (is_number) frame = std::stoi(line);
    if (frame != 0 && (frame < first || frame > last)) continue;
    cut += (is_number ? std::to_string(frame - first + 1) : line) + '\n';
  }
  return cut;
}

TEST(EndToEnd, FindsWhatOtherActorsDo) {
  const SyntheticLibrary library;
  for (const char* class_name : {"squat1Reps", "kickRFront1Reps", "jumpingJack1Reps"}) {
    SCOPED_TRACE(class_name);
    const ordered_json hits = Search(library.Learn(class_name), library);
    EXPECT_THAT(FilesOf(hits), UnorderedElementsAre(library.Clip(class_name, "sa", 1).string(),
                                                    library.Clip(class_name, "sa", 2).string(),
                                                    library.Clip(class_name, "sb", 1).string(),
                                                    library.Clip(class_name, "sb", 2).string()));
  }
}

TEST(EndToEnd, ReadsTheSameFromAStretchAsFromAFileOfItsFrames) {
  const SyntheticLibrary library;
  const std::string stretch = library.Squat() + ":21-240";
  const std::string clip = library.BadMotion(CutText(ReadText(library.Squat()), 21, 240));
  for (const char* command : {"joints", "features"}) {
    const ProgramResult from_stretch = RunKinebase({command, stretch});
    EXPECT_EQ(from_stretch.exit_code, 0) << from_stretch.err;
    EXPECT_EQ(from_stretch.out, RunKinebase({command, clip}).out);
  }
  const auto learned = [&](const std::string& from, const std::string& name) {
    const fs::path file = library.scratch() / name;
    const ProgramResult result = RunKinebase(
        {"learn", from, library.Clip("squat1Reps", "sb", 1), "--name", "squat", "-o", file});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(ReadText(file));
  };
  const auto from_stretch = learned(stretch, "stretch.json");
  const auto from_clip = learned(clip, "clip.json");
  EXPECT_EQ(from_stretch["matrix"], from_clip["matrix"]);
  EXPECT_EQ(from_stretch["rounds"], from_clip["rounds"]);
  EXPECT_EQ(from_stretch["clips"][0]["first_frame"], 21);
  EXPECT_EQ(from_stretch["clips"][0]["last_frame"], 240);
  EXPECT_EQ(from_clip["clips"][0]["first_frame"], 0);
}

TEST(EndToEnd, LearnsTheSameFromAListAsFromItsClips) {
  const SyntheticLibrary library;
  const std::string named = library.scratch() / "named.json";
  const ProgramResult result =
      RunKinebase({"learn", library.Clip("squat1Reps", "sa", 1),
                   library.Clip("squat1Reps", "sa", 2), "--name", "squat1Reps", "-o", named});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(ReadText(named), ReadText(library.Learn("squat1Reps")));
}

TEST(EndToEnd, LearnsTheSameFromAFolderAsFromItsClips) {
  const SyntheticLibrary library;
  std::vector<std::string> templates;
  const fs::path folder = library.Clip("squat1Reps", "sa", 1).parent_path();
  std::vector<std::string> clips;
  for (const fs::path& clip : FilesBelow(folder, ".amc")) clips.push_back(clip);
  for (const auto& from : {std::vector<std::string>{folder}, clips}) {
    const std::string output = library.scratch() / std::to_string(from.size());
    std::vector<std::string> arguments = {"learn", "--name", "squat", "-o", output};
    arguments.insert(arguments.end(), from.begin(), from.end());
    EXPECT_EQ(RunKinebase(arguments).exit_code, 0);
    templates.push_back(ReadText(output));
  }
  EXPECT_EQ(templates[0], templates[1]);
}

TEST(EndToEnd, FindsTheFilesOfAListInOtherFolders) {
  const SyntheticLibrary library;
  const std::string list = library.scratch() / "elsewhere" / "list.csv";
  WriteText(list, ReadText(library.list()));
  const std::string output = library.scratch() / "squat.json";
  const ProgramResult result =
      RunKinebase({"learn", "--list", list, "--class", "squat1Reps", "--actors", "sa", "--in",
                   library.folder(), "-o", output});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(ReadText(output), ReadText(library.Learn("squat1Reps")));
}

TEST(EndToEnd, GivesTheSameWithAnyNumberOfThreads) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  EXPECT_EQ(Search(squat, library, {"--tau", "1", "--threads", "1"}),
            Search(squat, library, {"--tau", "1", "--threads", "4"}));
  std::vector<std::string> templates;
  for (const char* threads : {"1", "4"}) {
    const std::string output = library.scratch() / threads;
    EXPECT_EQ(RunKinebase({"learn", "--list", library.list(), "--class", "squat1Reps", "-o", output,
                           "--threads", threads})
                  .exit_code,
              0);
    templates.push_back(ReadText(output));
  }
  EXPECT_EQ(templates[0], templates[1]);
}

TEST(EndToEnd, MirrorsInASearchAsInAFile) {
  const SyntheticLibrary library;
  const std::string kick = library.Learn("kickRFront1Reps");
  const std::string mirrored = library.scratch() / "mirrored.json";
  EXPECT_EQ(RunKinebase({"template", "mirror", kick, "-o", mirrored}).exit_code, 0);
  const ordered_json hits = Search(kick, library, {"--mirror", "--tau", "1"});
  EXPECT_EQ(hits, Search(mirrored, library, {"--tau", "1"}));
  EXPECT_NE(hits, Search(kick, library, {"--tau", "1"}));
  // Twice is not at all.
  const ordered_json twice = Search(mirrored, library, {"--mirror", "--tau", "1"});
  const ordered_json plain = Search(kick, library, {"--tau", "1"});
  ASSERT_EQ(twice.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(twice[i]["cost"], plain[i]["cost"]);
}

TEST(EndToEnd, NamesAMirroredTemplateAsAsked) {
  const SyntheticLibrary library;
  const std::string kick = library.Learn("kickRFront1Reps");
  const std::string mirrored = library.scratch() / "mirrored.json";
  EXPECT_EQ(RunKinebase({"template", "mirror", kick, "-o", mirrored, "--name", "kickL"}).exit_code,
            0);
  EXPECT_EQ(nlohmann::json::parse(ReadText(mirrored))["name"], "kickL");
}

TEST(EndToEnd, ListsEverythingAtTauOneAndTheBestWithTop) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  const ordered_json all = Search(squat, library, {"--tau", "1"});
  const auto files = FilesOf(all);
  EXPECT_EQ(std::set<std::string>(files.begin(), files.end()).size(), 12U);
  EXPECT_TRUE(std::ranges::is_sorted(
      all, {}, [](const auto& hit) { return hit["cost"].template get<double>(); }));
  const ordered_json best = Search(squat, library, {"--tau", "1", "--top", "5"});
  ASSERT_EQ(best.size(), 5U);
  EXPECT_TRUE(std::equal(best.begin(), best.end(), all.begin()));
  EXPECT_EQ(Search(squat, library, {"--top", "0"}).size(), 0U);
  // A threshold cuts the list and changes nothing else.
  const double tau = CostsOf(all)[2];
  const ordered_json cut = Search(squat, library, {"--tau", all[2]["cost"].dump()});
  EXPECT_EQ(std::ssize(cut),
            std::ranges::count_if(CostsOf(all), [&](double cost) { return cost <= tau; }));
  EXPECT_TRUE(std::equal(cut.begin(), cut.end(), all.begin()));
}

TEST(EndToEnd, UsesTheThresholdOfTheTemplate) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  auto json = nlohmann::json::parse(ReadText(squat));
  json["tau"] = 1;
  const std::string generous = library.scratch() / "generous.json";
  WriteText(generous, json.dump());
  EXPECT_EQ(Search(generous, library), Search(squat, library, {"--tau", "1"}));
  EXPECT_EQ(Search(generous, library, {"--tau", "0.06"}), Search(squat, library));
}

TEST(EndToEnd, WritesACurveWhoseMinimumIsTheBestHit) {
  const SyntheticLibrary library;
  const std::string curve = library.scratch() / "curve.csv";
  const ordered_json hits =
      Search(library.Learn("squat1Reps"), library, {"--tau", "1", "--curve", curve});
  const CsvTable table = ReadCsv(curve);
  ASSERT_THAT(table.columns, ElementsAre("file", "column", "frame", "delta", "start_frame"));
  std::size_t best = 0;
  std::string file;
  int column = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    if (row[0] != file) column = 0;
    file = row[0];
    ASSERT_EQ(row[1], std::to_string(column));
    ASSERT_EQ(row[2], std::to_string(4 * column + 1));  // 30 columns of 120 frames a second.
    ASSERT_EQ(row[3] == "inf", row[4].empty());
    if (std::stod(row[3]) < std::stod(table.rows[best][3])) best = i;
    ++column;
  }
  EXPECT_EQ(std::stod(table.rows[best][3]), hits[0]["cost"]);
  EXPECT_EQ(hits[0]["file"], table.rows[best][0]);
  EXPECT_EQ(table.rows[best][4], hits[0]["first_frame"].dump());
  EXPECT_EQ(std::stoi(table.rows[best][2]) + 3, hits[0]["last_frame"]);
}

TEST(EndToEnd, MergesTheHitsOfSeveralTemplates) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  const std::string kick = library.Learn("kickRFront1Reps");
  const ProgramResult result =
      RunKinebase({"search", squat, kick, "--in", library.folder(), "--tau", "1", "--json"});
  const ordered_json merged = result.Json()["hits"];
  EXPECT_TRUE(std::ranges::is_sorted(
      merged, {}, [](const auto& hit) { return hit["cost"].template get<double>(); }));
  for (const auto& [name, file] :
       {std::pair{"squat1Reps", squat}, std::pair{"kickRFront1Reps", kick}}) {
    ordered_json of_one = ordered_json::array();
    for (const auto& hit : merged) {
      if (hit["template"] == name) of_one.push_back(hit);
    }
    EXPECT_EQ(of_one, Search(file, library, {"--tau", "1"}));
  }
  const std::string table = RunKinebase({"search", squat, kick, "--in", library.folder()}).out;
  EXPECT_THAT(table, ::testing::HasSubstr("template"));
  EXPECT_THAT(table, ::testing::HasSubstr("kickRFront1Reps"));
}

TEST(EndToEnd, MatchesByAnotherProfileOnRequest) {
  const SyntheticLibrary library;
  const std::string squat = library.Learn("squat1Reps");
  const std::string other = library.scratch() / "other.json";
  EXPECT_EQ(RunKinebase({"learn", "--list", library.list(), "--class", "squat1Reps", "--actors",
                         "sa", "--matching", "paper", "-o", other})
                .exit_code,
            0);
  EXPECT_EQ(nlohmann::json::parse(ReadText(other))["matching"], "paper");
  EXPECT_EQ(nlohmann::json::parse(ReadText(other))["learning"], "bonn");
  EXPECT_EQ(Search(other, library, {"--tau", "1"}),
            Search(squat, library, {"--tau", "1", "--profile", "paper"}));
  EXPECT_NE(Search(other, library, {"--tau", "1"}), Search(squat, library, {"--tau", "1"}));
}

TEST(Skeleton, IsFoundBesideAboveAndInFoldersNamedForIt) {
  const SyntheticLibrary library;
  const std::string motion = ReadText(library.Squat());
  const std::string skeleton = ReadText(library.folder() / "asf" / "SYN_sa.asf");
  for (const fs::path place : {"a/b/c/d", "a/b/c", "a/b", "a", "a/asf", "a/b/c/d/skeletons"}) {
    SCOPED_TRACE(place);
    const fs::path root = library.scratch() / "search" / "here";
    const fs::path file = root / "a/b/c/d/SYN_sa_squat1Reps_001_120.amc";
    WriteText(file, motion);
    WriteText(root / place / "SYN_sa.asf", skeleton);
    const ProgramResult result = RunKinebase({"info", file, "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.Json()["files"][0]["skeleton"], (root / place / "SYN_sa.asf").string());
    fs::remove_all(root);
  }
}

TEST(Skeleton, IsTheOneThatIsNamed) {
  const SyntheticLibrary library;
  const std::string other = library.folder() / "asf" / "SYN_sb.asf";
  const auto info = RunKinebase({"info", library.Squat(), "--skeleton", other, "--json"}).Json();
  EXPECT_EQ(info["files"][0]["skeleton"], other);
  EXPECT_NE(RunKinebase({"joints", library.Squat(), "--skeleton", other}).out,
            RunKinebase({"joints", library.Squat()}).out);
}

TEST(Info, ListsAFolderWhole) {
  const SyntheticLibrary library;
  const auto json = RunKinebase({"info", library.folder(), "--json"}).Json();
  std::vector<std::string> paths;
  for (const auto& file : json["files"]) paths.push_back(file["path"]);
  std::vector<std::string> expected;
  for (const fs::path& file : FilesBelow(library.folder(), ".amc")) expected.push_back(file);
  EXPECT_EQ(expected.size(), 12U);
  EXPECT_EQ(paths, expected);
  // A file that is named twice comes once.
  const auto twice = RunKinebase({"info", library.folder(), library.Squat(), "--json"}).Json();
  EXPECT_EQ(twice["files"].size(), 12U);
}

TEST(Joints, HasQuaternionsAndAnglesOfEveryFrame) {
  const SyntheticLibrary library;
  const std::size_t frames =
      RunKinebase({"info", library.Squat(), "--json"}).Json()["files"][0]["frames"];
  const std::string file = library.scratch() / "rotations.csv";
  const auto table = [&](const std::string& rotations) {
    EXPECT_EQ(RunKinebase({"joints", library.Squat(), "--rotations", rotations, "-o", file, "-f"})
                  .exit_code,
              0);
    CsvTable read = ReadCsv(file);
    EXPECT_EQ(read.rows.size(), frames);
    return read;
  };
  const CsvTable quaternions = table("quaternions");
  const std::size_t w = quaternions.Column("lknee_w");
  for (const auto& row : quaternions.rows) {
    double norm = 0;
    for (std::size_t i = w; i < w + 4; ++i) norm += std::stod(row[i]) * std::stod(row[i]);
    ASSERT_NEAR(norm, 1, 1e-9);
  }
  // A knee has one angle: what the file says at "ltibia" in its first frame.
  const CsvTable angles = table("euler");
  const std::string text = ReadText(library.Squat());
  const double knee = std::stod(text.substr(text.find("\nltibia ") + 8));
  EXPECT_NEAR(std::stod(angles.rows[0][angles.Column("lknee_rx")]), knee, 1e-9);
}

}  // namespace
}  // namespace kinebase::test
