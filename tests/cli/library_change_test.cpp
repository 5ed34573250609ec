// library label, templates, annotations and compact as scripts see them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
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
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class ChangedLibrary : public ::testing::Test {
 protected:
  ChangedLibrary() {
    EXPECT_EQ(
        RunKinebase({"import", recordings_.folder(), "--library", library(), "--quiet"}).exit_code,
        0);
  }

  [[nodiscard]] std::string library() const { return recordings_.scratch() / "motion.kinebase"; }

  // kinebase library ACTION LIBRARY …
  [[nodiscard]] ProgramResult Run(const std::string& action,
                                  std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"library", action, library()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }
  [[nodiscard]] nlohmann::ordered_json Takes(std::vector<std::string> filter) const {
    filter.emplace_back("--json");
    return Run("list", filter).Json()["takes"];
  }

  SyntheticLibrary recordings_;
};

TEST_F(ChangedLibrary, IsLabelledByHandAndFoundByLabels) {
  const auto added = Run("label", {"--classes", "squat1Reps", "--add", "gym,legs", "--json"});
  EXPECT_THAT(FieldsOf(added.Json()), ElementsAre("takes:integer", "added:integer",
                                                  "removed:integer", "passed_over:integer"));
  EXPECT_EQ(added.Json()["added"], 8);
  EXPECT_THAT(
      Run("label", {"SYN_sa_squat1Reps_001_120.amc", "--add", "deep", "--frames", "20-90"}).out,
      HasSubstr("1 label added, 0 removed, in 1 take"));
  EXPECT_THAT(Takes({"--labelled", "gym"}), SizeIs(4));
  EXPECT_THAT(Takes({"--labelled", "gym,deep", "--text", "sa deep"}), SizeIs(1));
  const auto labels = Takes({"--labelled", "deep"})[0]["labels"];
  ASSERT_THAT(labels, SizeIs(3));
  EXPECT_EQ(labels[0]["label"], "deep");
  EXPECT_EQ(labels[0]["first_frame"], 20);
  EXPECT_EQ(labels[0]["last_frame"], 90);
  EXPECT_TRUE(labels[1]["first_frame"].is_null());
  EXPECT_THAT(Run("list", {"--labelled", "deep", "--show", "labels"}).out,
              HasSubstr("deep 20-90, gym, legs"));
  EXPECT_EQ(Run("label", {"--labelled", "gym", "--remove", "legs", "--json"}).Json()["removed"], 4);
  EXPECT_EQ(Run("verify").exit_code, 0);
}

TEST_F(ChangedLibrary, TakesLabelsOfTables) {
  const std::string table = recordings_.scratch() / "labels.csv";
  WriteText(table,
            "file,class,first_frame,last_frame\n"
            "cut_amc/SYN_sa_squat1Reps_001_120.amc,down,1,100\n"
            "cut_amc/SYN_sa_squat1Reps_001_120.amc,up,101,200\n"
            "cut_amc/SYN_sz_squat1Reps_001_120.amc,up,101,200\n");
  const auto report = Run("label", {"--from", table, "--json"});
  ASSERT_EQ(report.exit_code, 0) << report.err;
  EXPECT_EQ(report.Json()["added"], 2);
  EXPECT_EQ(report.Json()["passed_over"], 1);
  EXPECT_THAT(Run("label", {"--from", table}).err, HasSubstr("1 row of recordings"));
  EXPECT_THAT(Takes({"--labelled", "up"}), SizeIs(1));
  // What is written is read again, also as truth.
  EXPECT_EQ(Run("label", {"SYN_sa_squat1Reps_002_120.amc", "--add", "a, b"}).exit_code, 0);
  const std::string out = recordings_.scratch() / "out.csv";
  EXPECT_EQ(Run("label", {"-o", out}).exit_code, 0);
  const std::string written = ReadText(out);
  EXPECT_EQ(Run("label", {"-o", "-"}).out, written);
  const std::string squat = Takes({"--labelled", "up"})[0]["file"];
  EXPECT_THAT(written, HasSubstr(squat + ",down,1,100\n" + squat + ",up,101,200\n"));
  EXPECT_EQ(Run("label", {"--from", out, "--json"}).Json()["takes"], 0);  // As they were.
  WriteText(table, "file,class,first_frame,last_frame\nSYN_sa_squat1Reps_001_120,up,9000,9001\n");
  ExpectOneError(Run("label", {"--from", table}), 1, {"labels.csv:2", "9000"});
}

TEST_F(ChangedLibrary, SaysWhatItCannotDo) {
  ExpectOneError(Run("label"), 2, {"--add", "--from"});
  ExpectOneError(Run("label", {"--add", "gym"}), 2, {"TAKE"});
  ExpectOneError(Run("label", {"a.amc", "--add", "gym", "--frames", "9"}), 2, {"120-480"});
  ExpectOneError(Run("label", {"a.amc", "--add", "gym"}), 1, {"no take", "a.amc"});
  ExpectOneError(Run("list", {"--labelled", "gym"}), 1, {"label 'gym'"});
  ExpectOneError(Run("list", {"--formats", "c3d"}), 1, {"format 'c3d'", "ASF/AMC"});
  ExpectOneError(Run("list", {"--text", "moonwalk"}), 1, {"moonwalk", "description"});
  ExpectOneError(Run("list", {"--show", "colour"}), 2, {"labels"});
  ExpectOneError(Run("templates", {"--remove", "squat"}), 1, {"holds no templates", "--add"});
  ExpectOneError(Run("templates", {"-o", "squat.json"}), 2, {"--export"});
  ExpectOneError(Run("annotations", {"--of", "squat1Reps"}), 2, {"--remove"});
}

TEST_F(ChangedLibrary, ListsWhereTakesCameFrom) {
  const auto take = Takes({"--actors", "sa", "--classes", "squat1Reps"})[0];
  EXPECT_THAT(take["skeleton"].get<std::string>(), HasSubstr("SYN_sa.asf"));
  EXPECT_THAT(take["skeleton_key"].get<std::string>(), SizeIs(32));
  EXPECT_THAT(FieldsOf(take["origin"]),
              ElementsAre("imported:string", "file_changed:string", "file_bytes:integer",
                          "program:string", "options:string"));
  EXPECT_EQ(take["origin"]["file_bytes"], fs::file_size(take["file"].get<std::string>()));
  EXPECT_THAT(take["origin"]["imported"].get<std::string>(),
              ::testing::MatchesRegex("20[0-9-]+T[0-9:]+Z"));
}

TEST_F(ChangedLibrary, KeepsTemplates) {
  const std::string file = recordings_.Learn("squat1Reps");
  EXPECT_THAT(Run("templates", {"--add", file}).out, HasSubstr("1 template stored"));
  ExpectOneError(Run("templates", {"--add", file}), 1, {"--force"});
  EXPECT_EQ(Run("templates", {"--add", file, "--force"}).exit_code, 0);
  const auto list = Run("templates", {"--json"}).Json();
  ASSERT_THAT(list["templates"], SizeIs(1));
  EXPECT_THAT(FieldsOf(list["templates"][0]),
              ElementsAre("name:string", "feature_set:string", "columns:integer", "stored:string"));
  const std::string name = list["templates"][0]["name"];
  EXPECT_EQ(Run("templates", {"--export", name}).out, ReadText(file));
  // By name wherever the library is searched.
  const auto hits = [&](const std::string& what) {
    return RunKinebase({"search", what, "--library", library(), "--json", "--quiet"})
        .Json()["hits"];
  };
  EXPECT_EQ(hits(name), hits(file));
  const auto segments = [&](const std::vector<std::string>& what) {
    std::vector<std::string> arguments = {"annotate", "--library", library(), "--json", "--quiet"};
    arguments.insert(arguments.end(), what.begin(), what.end());
    return RunKinebase(arguments).Json()["segments"];
  };
  EXPECT_THAT(segments({file}), ::testing::Not(::testing::IsEmpty()));
  EXPECT_EQ(segments({name}), segments({file}));
  EXPECT_EQ(segments({"--class", "down=" + name}), segments({"--class", "down=" + file}));
  // Not a folder, as takes of a class lie in one.
  const fs::path folder = recordings_.scratch() / "here";
  fs::create_directories(folder / name);
  EXPECT_EQ(
      RunKinebase({"search", name, "--library", library(), "--json", "--quiet"}, {.folder = folder})
          .Json()["hits"],
      hits(file));
  ExpectOneError(RunKinebase({"search", "squad", "--library", library()}), 1,
                 {"no template 'squad'", name});
  EXPECT_THAT(Run("templates", {"--remove", name}).out, HasSubstr("1 template removed"));
}

TEST_F(ChangedLibrary, KeepsWhatAnnotateFound) {
  const std::string table = recordings_.scratch() / "annotations.csv";
  const ProgramResult annotated =
      RunKinebase({"annotate", recordings_.Learn("squat1Reps"), "--in", recordings_.folder(),
                   "--format", "csv", "-o", table, "--quiet"});
  ASSERT_EQ(annotated.exit_code, 0) << annotated.err;
  const auto stored = Run("annotations", {"--from", table, "--json"}).Json();
  EXPECT_GT(stored["stored"], 3);
  const auto list = Run("annotations", {"--actors", "sb", "--json"}).Json()["annotations"];
  ASSERT_THAT(list, SizeIs(::testing::Ge(2)));
  EXPECT_THAT(FieldsOf(list[0]), ElementsAre("file:string", "class:string", "first_frame:integer",
                                             "last_frame:integer", "cost:number", "confidence:null",
                                             "template:null", "stored:string"));
  // What is written out is read again.
  const std::string out = recordings_.scratch() / "out.csv";
  EXPECT_EQ(Run("annotations", {"-o", out}).exit_code, 0);
  EXPECT_THAT(Run("annotations", {"--remove", "--of", "squat1Reps", "--json"}).Json()["removed"],
              ::testing::Eq(stored["stored"]));
  EXPECT_EQ(Run("annotations", {"--from", out, "--json"}).Json()["stored"], stored["stored"]);
}

TEST_F(ChangedLibrary, IsCompactedAndSearchedAsBefore) {
  const std::string squat = recordings_.Learn("squat1Reps");
  const auto hits = [&] {
    return RunKinebase(
               {"search", squat, "--library", library(), "--actors", "sb", "--json", "--quiet"})
        .Json()["hits"];
  };
  const auto before = hits();
  EXPECT_EQ(Run("remove", {"--classes", "jumpingJack1Reps"}).exit_code, 0);
  const ProgramResult compacted = Run("compact", {"--json"});
  EXPECT_EQ(compacted.exit_code, 0) << compacted.err;
  EXPECT_THAT(FieldsOf(compacted.Json()),
              ElementsAre("segments_before:integer", "segments_after:integer",
                          "bytes_before:integer", "bytes_after:integer", "bytes_freed:integer"));
  EXPECT_GT(compacted.Json()["bytes_freed"], 0);
  EXPECT_THAT(Run("compact").out, HasSubstr("0.00 MB freed"));
  EXPECT_EQ(hits(), before);
  EXPECT_EQ(Run("verify").exit_code, 0);
}

TEST(LibraryOfRealRecordings, IsFoundByWhatItsTablesSay) {
  KINEBASE_NEEDS_TEST_DATA();
  const TemporaryFolder folder;
  const std::string library = folder.path() / "lib";
  const fs::path cmu = TestData("data/cmu");
  ASSERT_THAT(RunKinebase({"import", cmu, "--library", library, "--quiet", "--descriptions",
                           cmu / "labels" / "trial_descriptions.csv"})
                  .exit_code,
              ::testing::AnyOf(0, 3));
  ASSERT_EQ(RunKinebase({"import", TestData("data/hdm05/cut_amc"), "--library", library, "--quiet",
                         "--list", TestData("data/hdm05/clips.csv")})
                .exit_code,
            0);
  const auto names = [&](const std::vector<std::string>& filter) {
    std::vector<std::string> arguments = {"library", "list", library, "--json"};
    arguments.insert(arguments.end(), filter.begin(), filter.end());
    const auto json = RunKinebase(arguments).Json();
    std::set<std::string> found;
    for (const auto& take : json["takes"]) {
      found.insert(fs::path(take["file"].get<std::string>()).stem());
    }
    return found;
  };
  // By hand from the table.
  EXPECT_THAT(names({"--text", "salsa", "--formats", "amc"}),
              ElementsAre("60_01", "60_02", "60_03", "61_01", "61_02", "61_03"));
  EXPECT_THAT(names({"--text", "PIROUETTE", "--actors", "05", "--formats", "amc"}),
              ElementsAre("05_02", "05_06", "05_07"));
  EXPECT_THAT(names({"--classes", "squat1Reps", "--actors", "bd"}), SizeIs(::testing::Ge(3)));
  EXPECT_EQ(names({"--text", "squat", "--actors", "bd"}),
            names({"--classes", "squat1Reps", "--actors", "bd"}));
}

}  // namespace
}  // namespace kinebase::test
