#include "kinebase/library/file_moves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/motion/motion_file.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

class FileMoves : public testing::Test {
 protected:
  [[nodiscard]] const fs::path& root() const { return folder_.path(); }

  // Files whose text is their name.
  void Write(const std::vector<std::string>& names) const {
    for (const std::string& name : names) test::WriteText(root() / name, name);
  }

  // Each file as "where it is < what it was called at first".
  [[nodiscard]] std::vector<std::string> Files() const {
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(root())) {
      if (!entry.is_regular_file()) continue;
      files.push_back(fs::relative(entry.path(), root()).string() + " < " +
                      test::ReadText(entry.path()));
    }
    std::ranges::sort(files);
    return files;
  }

  [[nodiscard]] MovePlan RenameBy(const std::string& table) const {
    test::WriteText(table_.path() / "names.csv", table);
    return PlanRename(root(), table_.path() / "names.csv");
  }

  // The plan as "from > to".
  [[nodiscard]] std::vector<std::string> Moves(const MovePlan& plan) const {
    std::vector<std::string> moves;
    for (const auto& [from, to] : plan.moves) {
      moves.push_back(fs::relative(from, root()).string() + " > " +
                      fs::relative(to, root()).string());
    }
    return moves;
  }

  static std::vector<std::string> Messages(const MovePlan& plan) {
    std::vector<std::string> messages;
    messages.reserve(plan.obstacles.size());
    for (const Error& obstacle : plan.obstacles) messages.emplace_back(obstacle.what());
    return messages;
  }

 private:
  test::TemporaryFolder folder_;
  test::TemporaryFolder table_;
};

class Sorting : public FileMoves {};

TEST_F(Sorting, PutsClipsIntoFoldersOfTheirClasses) {
  Write({"HDM_bd_squat1Reps_001_120.amc", "HDM_bd_squat1Reps_001_120.C3D",
         "HDM_tr_kickRFront1Reps_002_120.amc", "HDM_bd_05-01_01_120.amc", "HDM_bd.asf",
         "notes_about_walks_001_120.txt", "deep/HDM_bd_squat1Reps_002_120.amc"});
  const MovePlan plan = PlanSort(root());
  EXPECT_THAT(plan.obstacles, IsEmpty());
  EXPECT_THAT(plan.warnings, IsEmpty());
  EXPECT_THAT(plan.left, ElementsAre(root() / "HDM_bd_05-01_01_120.amc"));
  EXPECT_THAT(Moves(plan),
              UnorderedElementsAre(
                  "HDM_bd_squat1Reps_001_120.C3D > squat1Reps/HDM_bd_squat1Reps_001_120.C3D",
                  "HDM_bd_squat1Reps_001_120.amc > squat1Reps/HDM_bd_squat1Reps_001_120.amc",
                  "HDM_tr_kickRFront1Reps_002_120.amc > "
                  "kickRFront1Reps/HDM_tr_kickRFront1Reps_002_120.amc"));
  EXPECT_THAT(Files(), SizeIs(7));  // A plan moves nothing.
  EXPECT_THAT(ApplyMoves(plan.moves), IsEmpty());
  EXPECT_THAT(
      Files(),
      ElementsAre("HDM_bd.asf < HDM_bd.asf", "HDM_bd_05-01_01_120.amc < HDM_bd_05-01_01_120.amc",
                  "deep/HDM_bd_squat1Reps_002_120.amc < deep/HDM_bd_squat1Reps_002_120.amc",
                  "kickRFront1Reps/HDM_tr_kickRFront1Reps_002_120.amc < "
                  "HDM_tr_kickRFront1Reps_002_120.amc",
                  "notes_about_walks_001_120.txt < notes_about_walks_001_120.txt",
                  "squat1Reps/HDM_bd_squat1Reps_001_120.C3D < HDM_bd_squat1Reps_001_120.C3D",
                  "squat1Reps/HDM_bd_squat1Reps_001_120.amc < HDM_bd_squat1Reps_001_120.amc"));
  // The skeleton stayed and is found from the folder.
  EXPECT_EQ(FindSkeleton(root() / "squat1Reps" / "HDM_bd_squat1Reps_001_120.amc"),
            root() / "HDM_bd.asf");
}

TEST_F(Sorting, AgainMovesNothing) {
  Write({"HDM_bd_squat1Reps_001_120.amc"});
  EXPECT_THAT(ApplyMoves(PlanSort(root()).moves), IsEmpty());
  const MovePlan again = PlanSort(root());
  EXPECT_THAT(again.moves, IsEmpty());
  EXPECT_THAT(again.obstacles, IsEmpty());
}

TEST_F(Sorting, GoesOnWhereItWasInterrupted) {
  Write({"HDM_bd_squat1Reps_001_120.amc", "HDM_bd_squat1Reps_002_120.amc",
         "HDM_bd_squat1Reps_003_120.amc"});
  const MovePlan plan = PlanSort(root());
  const Error error = test::ErrorOf([&] {
    (void)ApplyMoves(plan.moves, [](std::string_view, std::size_t done, std::size_t total) {
      EXPECT_EQ(total, 3);
      return done < 2;
    });
  });
  EXPECT_EQ(error.code(), ErrorCode::kCancelled);
  const MovePlan rest = PlanSort(root());
  EXPECT_THAT(rest.obstacles, IsEmpty());
  EXPECT_THAT(rest.moves, SizeIs(1));
  EXPECT_THAT(ApplyMoves(rest.moves), IsEmpty());
  EXPECT_THAT(PlanSort(root()).moves, IsEmpty());
}

struct FolderName {
  std::string file;
  SortOptions options;
  std::string folder;  // Empty: the file stays.
};

TEST_F(Sorting, TakesTheFoldersNameFromWhereItIsTold) {
  for (const auto& [file, options, folder] : std::vector<FolderName>{
           {"HDM_bd_walk_001.amc", {.start_position = 8}, "walk"},
           {"HDM_bd_walk_001.amc", {.start_position = 1}, "HDM"},
           {"HDM_bd_walk_001.amc", {.start_position = 8, .delimiter = "_001"}, "walk"},
           {"HDM_bd_walk_001.amc", {.start_position = 8, .delimiter = ""}, "walk_001"},
           {"HDM_bd_walk_001.amc", {.start_position = 13, .delimiter = "-"}, "001"},
           {"HDM_bd_walk_001.amc", {.start_position = 99}, ""},
           {"HDM_bd_walk_001.amc", {.start_position = 7}, ""},
           {"HDM_bd_walk_001.amc", {.start_text = "HDM_"}, "bd"},
           {"HDM_bd_walk_001.amc", {.start_text = "_bd_", .delimiter = "0"}, "walk_"},
           {"HDM_bd_walk_001.amc", {.start_text = "_tr_"}, ""},
           {"HDM_bd_walk_001.amc", {.start_text = "001"}, ""},
           {"für-läufe-1.c3d", {.start_position = 5, .delimiter = "-"}, "läufe"},
           {"a_.._b.amc", {.start_text = "a_"}, ""},
           {"a_._b.amc", {.start_text = "a_"}, ""},
           {"HDM_bd_.._001_120.amc", {}, ""},
       }) {
    SCOPED_TRACE(file + " at " + std::to_string(options.start_position) + options.start_text);
    Write({file});
    const MovePlan plan = PlanSort(root(), options);
    if (folder.empty()) {
      EXPECT_THAT(plan.left, ElementsAre(root() / file));
      EXPECT_THAT(plan.moves, IsEmpty());
    } else {
      EXPECT_THAT(Moves(plan), ElementsAre(fmt::format("{0} > {1}/{0}", file, folder)));
    }
    fs::remove(root() / file);
  }
}

TEST_F(Sorting, SeesWhatIsInItsWayBeforeAnythingMoves) {
  Write({"HDM_bd_squat_001_120.amc", "HDM_bd_squat_002_120.amc", "squat/HDM_bd_squat_002_120.amc",
         "HDM_bd_walk_001_120.amc", "walk"});
  const MovePlan plan = PlanSort(root());
  EXPECT_THAT(Messages(plan),
              UnorderedElementsAre(
                  AllOf(HasSubstr("squat/HDM_bd_squat_002_120.amc: "), HasSubstr("exists already")),
                  AllOf(HasSubstr("walk: is a file"), HasSubstr("HDM_bd_walk_001_120.amc"))));
}

TEST_F(Sorting, WarnsOfSkeletonsThatAreTooFarUp) {
  Write({"HDM_bd.asf", "a/b/c/HDM_bd_squat_001_120.amc", "a/b/HDM_bd_squat_001_120.amc"});
  EXPECT_THAT(PlanSort(root() / "a" / "b").warnings, IsEmpty());
  EXPECT_THAT(PlanSort(root() / "a" / "b" / "c").warnings,
              ElementsAre(AllOf(HasSubstr("HDM_bd.asf"), HasSubstr("--skeleton"))));
}

TEST_F(Sorting, NeedsAFolderWithMotions) {
  EXPECT_EQ(test::ErrorOf([&] { (void)PlanSort(root() / "no"); }).code(), ErrorCode::kNotFound);
  Write({"a.txt"});
  EXPECT_EQ(test::ErrorOf([&] { (void)PlanSort(root() / "a.txt"); }).code(), ErrorCode::kNotFound);
  EXPECT_THAT(test::ErrorOf([&] { (void)PlanSort(root()); }).what(),
              HasSubstr("holds no motion file"));
}

TEST_F(FileMoves, NeverReplaceWhatHasComeUpSinceThePlan) {
  Write({"HDM_bd_squat_001_120.amc", "HDM_bd_squat_002_120.amc", "HDM_bd_walk_001_120.amc"});
  const MovePlan plan = PlanSort(root());
  Write({"squat/HDM_bd_squat_001_120.amc"});
  fs::remove(root() / "HDM_bd_walk_001_120.amc");
  const auto failures = ApplyMoves(plan.moves);
  ASSERT_THAT(failures, SizeIs(2));
  EXPECT_EQ(failures[0].error.code(), ErrorCode::kAlreadyExists);
  EXPECT_EQ(failures[0].move, plan.moves[0]);
  EXPECT_EQ(failures[1].error.code(), ErrorCode::kNotFound);
  EXPECT_THAT(Files(),
              ElementsAre("HDM_bd_squat_001_120.amc < HDM_bd_squat_001_120.amc",
                          "squat/HDM_bd_squat_001_120.amc < squat/HDM_bd_squat_001_120.amc",
                          "squat/HDM_bd_squat_002_120.amc < HDM_bd_squat_002_120.amc"));
}

TEST_F(FileMoves, SayWhichFolderCannotBeMade) {
  Write({"a.amc", "b"});
  const std::vector<FileMove> moves = {{root() / "a.amc", root() / "b" / "a.amc"}};
  const auto failures = ApplyMoves(moves);
  ASSERT_THAT(failures, SizeIs(1));
  EXPECT_EQ(failures[0].error.code(), ErrorCode::kIoFailure);
  EXPECT_THAT(Files(), ElementsAre("a.amc < a.amc", "b < b"));
}

class Renaming : public FileMoves {};

TEST_F(Renaming, FollowsTheTable) {
  Write({"a.amc", "b.c3d", "deep/c.amc", "notes.txt", "stays.amc"});
  const MovePlan plan = RenameBy(
      "remark,new,old\nfirst,x.amc,a.amc\n\"a, b\",new/y.c3d,b.c3d\n,z.amc,deep/c.amc\n"
      ",n.md,notes.txt\n");
  EXPECT_THAT(plan.obstacles, IsEmpty());
  EXPECT_THAT(Files(), SizeIs(5));
  EXPECT_THAT(ApplyMoves(plan.moves), IsEmpty());
  EXPECT_THAT(Files(), ElementsAre("n.md < notes.txt", "new/y.c3d < b.c3d", "stays.amc < stays.amc",
                                   "x.amc < a.amc", "z.amc < deep/c.amc"));
}

TEST_F(Renaming, TakesTwoColumnsWithoutTitles) {
  Write({"a.amc", "b.amc"});
  EXPECT_THAT(Moves(RenameBy("a.amc,x.amc\nb.amc,y.amc\n")),
              ElementsAre("a.amc > x.amc", "b.amc > y.amc"));
}

TEST_F(Renaming, OfANameWithoutExtensionMeansAllItsMotionFiles) {
  Write({"a.v1.amc", "a.v1.c3d", "a.v1.asf", "a.v1.txt", "b.amc", "c.AMC"});
  const MovePlan plan = RenameBy("old,new\na.v1,x.v2\nb.amc,y.v3\nc,z.amc\n");
  EXPECT_THAT(Messages(plan), IsEmpty());
  EXPECT_THAT(Moves(plan), UnorderedElementsAre("a.v1.amc > x.v2.amc", "a.v1.c3d > x.v2.c3d",
                                                "b.amc > y.v3.amc", "c.AMC > z.amc"));
}

TEST_F(Renaming, CanBeRunAgainAfterAnInterruption) {
  Write({"a.amc", "b.amc", "c.amc", "c.c3d", "d.amc", "notes.txt", "todo"});
  const std::string table =
      "old,new\na.amc,x.amc\nb.amc,y.amc\nc,z\nd,w.amc\nnotes.txt,n.md\ntodo,done\n";
  const MovePlan plan = RenameBy(table);
  ASSERT_THAT(plan.moves, SizeIs(7));
  for (std::size_t made = 0; made < plan.moves.size(); ++made) {
    EXPECT_THAT(ApplyMoves(std::span(plan.moves).subspan(made, 1)), IsEmpty());
    const MovePlan rest = RenameBy(table);
    EXPECT_THAT(Messages(rest), IsEmpty());
    EXPECT_THAT(rest.moves, SizeIs(plan.moves.size() - made - 1));
  }
  EXPECT_THAT(Files(),
              ElementsAre("done < todo", "n.md < notes.txt", "w.amc < d.amc", "x.amc < a.amc",
                          "y.amc < b.amc", "z.amc < c.amc", "z.c3d < c.c3d"));
}

struct BadTable {
  std::string table;
  int line = 0;
  std::string message;
};

TEST_F(Renaming, SeesEverythingThatIsWrongBeforeAnythingMoves) {
  Write({"a.amc", "b.amc", "c.c3d", "taken.amc", "folder/x.amc"});
  for (const auto& [table, line, message] : std::vector<BadTable>{
           {"old,new\na.amc,x.amc\nno.amc,y.amc\n", 3, "no 'no.amc' in"},
           {"old,new\nno,y\n", 2, "no 'no' in"},
           {"old,new\na.amc,taken.amc\n", 2, "'taken.amc' exists already"},
           {"old,new\na.amc,folder/x\n", 2, "'folder/x.amc' exists already"},
           {"old,new\na.amc,x.amc\nb.amc,x.amc\n", 3, "'x.amc' is a new name in line 2 already"},
           {"old,new\na.amc,x.amc\na.amc,y.amc\n", 3, "'a.amc' is renamed in line 2 already"},
           {"old,new\na.amc,x.amc\na,y\n", 3, "'a.amc' is renamed in line 2 already"},
           {"old,new\na.amc,b.amc\nb.amc,x.amc\n", 2, "an old one in line 3"},
           {"old,new\na.amc,b.amc\nb.amc,a.amc\n", 3, "an old one in line 2"},
           {"old,new\na.amc,x.c3d\n", 2, "a .amc file cannot be named 'x.c3d'"},
           {"old,new\nfolder,other\n", 2, "'folder' is no file"},
           {"old,new\na.amc,../x.amc\n", 2, "'..'"},
           {"old,new\n../a.amc,x.amc\n", 2, "'..'"},
           {"old,new\na.amc,/tmp/x.amc\n", 2, "is absolute"},
           {"old,new\na.amc,\n", 2, "new name '' names no file"},
           {"old,new\n,x.amc\n", 2, "old name '' names no file"},
           {"a.amc,x.amc\nno.amc,y.amc\n", 2, "no 'no.amc' in"},
       }) {
    SCOPED_TRACE(table);
    const MovePlan plan = RenameBy(table);
    EXPECT_THAT(
        Messages(plan),
        Contains(AllOf(HasSubstr("names.csv:" + std::to_string(line) + ": "), HasSubstr(message))));
  }
  EXPECT_THAT(Files(), SizeIs(5));
}

TEST_F(Renaming, ListsAllObstaclesAtOnce) {
  Write({"a.amc", "taken.amc"});
  EXPECT_THAT(Messages(RenameBy("old,new\nno.amc,x.amc\na.amc,taken.amc\nno2.amc,y.amc\n")),
              ElementsAre(HasSubstr(":2: "), HasSubstr(":3: "), HasSubstr(":4: ")));
}

TEST_F(Renaming, RefusesATableThatIsNone) {
  Write({"a.amc"});
  for (const char* table :
       {"", "old,to\na.amc,x\n", "from,to,remark\na.amc,x,\n", "old,new\na\n"}) {
    SCOPED_TRACE(table);
    EXPECT_EQ(test::ErrorOf([&] { (void)RenameBy(table); }).code(), ErrorCode::kMalformedFile);
  }
  EXPECT_EQ(test::ErrorOf([&] { (void)PlanRename(root(), root() / "no.csv"); }).code(),
            ErrorCode::kNotFound);
  EXPECT_EQ(test::ErrorOf([&] { (void)PlanRename(root() / "no", root() / "no.csv"); }).code(),
            ErrorCode::kNotFound);
}

TEST_F(Renaming, WarnsOfSkeletonsThatLoseTheirMotions) {
  Write({"HDM_bd.asf", "HDM_bd_a_001_120.amc", "HDM_bd_b_001_120.amc", "wave.amc", "wave.asf"});
  EXPECT_THAT(RenameBy("old,new\nHDM_bd_a_001_120,HDM_bd_c_001_120\n").warnings, IsEmpty());
  EXPECT_THAT(RenameBy("old,new\nHDM_bd_a_001_120,SYN_x\nwave.amc,arm.amc\n").warnings,
              ElementsAre(AllOf(HasSubstr("SYN_x.amc"), HasSubstr("HDM_bd.asf")),
                          AllOf(HasSubstr("arm.amc"), HasSubstr("wave.asf"))));
  EXPECT_THAT(RenameBy("old,new\nwave.amc,arm.amc\nwave.asf,arm.asf\n").warnings, IsEmpty());
  EXPECT_THAT(
      RenameBy("old,new\nHDM_bd.asf,X.asf\nHDM_bd_a_001_120,X_a\nHDM_bd_b_001_120,Y_b\n").warnings,
      ElementsAre(HasSubstr("Y_b.amc")));
}

}  // namespace
}  // namespace kinebase
