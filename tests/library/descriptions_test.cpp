#include "kinebase/library/descriptions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kinebase/library/take_library.h"
#include "library/made_up_takes.h"

namespace kinebase {
namespace {

using test::ErrorOf;
using testing::HasSubstr;

std::string DescriptionOf(const std::string& file, const std::string& table) {
  std::vector<ImportSource> sources = {{.file = file}};
  Describe(sources, ParseDescriptions(table, "table.csv"));
  return sources[0].description;
}

TEST(Descriptions, AreFoundByTheNameOfTheFile) {
  EXPECT_EQ(DescriptionOf("x/05_01.amc", "trial,cmu_description\n05_01,\"walk, turn\"\n"),
            "walk, turn");
  EXPECT_EQ(DescriptionOf("HDM_bd_01-01_01_120.amc",
                          "take,frames,description\nHDM_bd_01-01_01,9,walks\n"),
            "walks");
  EXPECT_EQ(DescriptionOf("a.c3d", "description,file\nfirst,/b/a.c3d\nsecond,a.c3d\n"), "first");
  EXPECT_EQ(DescriptionOf("a.c3d", "file,description\nb.c3d,other\na.c3d, \n"), "");
}

TEST(Descriptions, AreFoundByTheClass) {
  const std::string table = "class,description\nsquat1Reps,bends the knees\n";
  EXPECT_EQ(DescriptionOf("HDM_bd_squat1Reps_001_120.amc", table), "bends the knees");
  std::vector<ImportSource> listed = {{.file = "a.amc", .class_name = "squat1Reps"},
                                      {.file = "b.amc"}};
  EXPECT_EQ(Describe(listed, ParseDescriptions(table, "table.csv")), 1);
  EXPECT_EQ(listed[0].description, "bends the knees");
}

TEST(Descriptions, OfATableWithoutThemSaysWhatItHas) {
  EXPECT_THAT(ErrorOf([] { (void)ParseDescriptions("file,text\na,b\n", "table.csv"); }).what(),
              testing::AllOf(HasSubstr("table.csv"), HasSubstr("description"), HasSubstr("text")));
  EXPECT_THAT(ErrorOf([] { (void)ParseDescriptions("name,description\na,b\n", "t.csv"); }).what(),
              HasSubstr("class"));
}

// docs/hdm05.md: what the script asks for in scene 1-1, and what the class is.
TEST(Hdm05Description, IsThatOfTheScriptOrClass) {
  EXPECT_THAT(Hdm05Description("HDM_bd_01-01_01_120.amc"), HasSubstr("walk"));
  EXPECT_EQ(Hdm05Description("HDM_bd_clap5Reps_001_120.amc"), "clap hands 5 times");
  EXPECT_EQ(Hdm05Description("SYN_sa_clap5Reps_001_120.amc"), "");
  EXPECT_EQ(Hdm05Description("05_01.amc"), "");
}

TEST(Descriptions, ComeIntoTheLibraryAndLaterOnesReplaceThem) {
  const test::MadeUpTakes takes(2);
  std::vector<ImportSource> sources = takes.Sources();
  sources[0].description = "waves";
  const auto import = [&] {
    return ImportTakes(takes.library(), sources, test::MadeUpTakes::Options());
  };
  import();
  const auto described = [&](std::size_t take) {
    return TakeLibrary(takes.library()).takes()[take].description;
  };
  EXPECT_EQ(described(0), "waves");
  EXPECT_EQ(described(1), "");
  sources[0].description = "";
  EXPECT_EQ(import().unchanged, 2);
  EXPECT_EQ(described(0), "waves");
  sources[1].description = "waves, too";
  EXPECT_EQ(import().updated, 1);
  EXPECT_EQ(described(1), "waves, too");
}

}  // namespace
}  // namespace kinebase
