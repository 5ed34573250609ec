#include "kinebase/library/cut_list.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "kinebase/synth/synthetic_motion.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

CutList Parse(std::string_view text, bool unquoted = false) {
  return ParseCutList(text, "cuts.txt", {.unquoted = unquoted});
}

// The one cut of a text.
Cut OnlyCut(std::string_view text, bool unquoted = false) {
  CutList list = Parse(text, unquoted);
  EXPECT_THAT(list.refused, IsEmpty()) << list.refused.front().what();
  EXPECT_THAT(list.cuts, SizeIs(1));
  return list.cuts.empty() ? Cut{} : list.cuts.front();
}

TEST(CutList, ReadsTheDocumentedLine) {
  const Cut cut = OnlyCut(
      "% motion class staircaseUp3Rstart\n"
      "\"HDM05\\HDM05_amc\\bd\\HDM_bd_01-05_02_120.amc\"\t3506\t3907\t"
      "HDM_bd_staircaseUp3Rstart_001_120\n");
  EXPECT_EQ(cut.take, "HDM05/HDM05_amc/bd/HDM_bd_01-05_02_120");
  EXPECT_EQ(cut.first_frame, 3506);
  EXPECT_EQ(cut.last_frame, 3907);
  EXPECT_EQ(cut.clip, "HDM_bd_staircaseUp3Rstart_001_120");
  EXPECT_EQ(cut.place.ToString(), "cuts.txt:2");
}

TEST(CutList, TakesTabsAndBlanksAnyLineEndAnyExtensionAndAnOwnByteOrderMark) {
  const CutList list = Parse(
      "\xEF\xBB\xBF\"a.amc\" 1 2 x\r\n\"b.C3D\"\t \t3   4\ty.amc  \r\"c\" 5 5 z.c3d\n"
      "\"d.e.AMC\"6 +7 v1.5");
  ASSERT_THAT(list.refused, IsEmpty());
  std::vector<std::string> texts;
  for (const Cut& cut : list.cuts) {
    texts.push_back(
        fmt::format("{} {} {} {}", cut.take, cut.first_frame, cut.last_frame, cut.clip));
  }
  EXPECT_THAT(texts, ElementsAre("a 1 2 x", "b 3 4 y", "c 5 5 z", "d.e 6 7 v1.5"));
}

TEST(CutList, KeepsBlanksAndOtherLettersInQuotedNames) {
  const Cut cut = OnlyCut("\"für Bonn\\take 1.amc\" 1 2 \"squat one\" % a remark\n");
  EXPECT_EQ(cut.take, "für Bonn/take 1");
  EXPECT_EQ(cut.clip, "squat one");
}

TEST(CutList, ReadsAFolderInAClipsNameAndLeavesOutEmptyParts) {
  const Cut cut = OnlyCut("\".\\takes\\\\a.amc\" 1 2 squat\\.\\x\n");
  EXPECT_EQ(cut.take, "takes/a");
  EXPECT_EQ(cut.clip, "squat/x");
}

TEST(CutList, PassesOverLinesWithoutQuotesAndCountsThoseThatLookLikeCuts) {
  const CutList list = Parse(
      "% a.amc 1 2 x\n# a.amc 1 2 x\nThere are 10 20 takes here\n\n"
      "a.amc 1 2 x\n \"b.amc\" 3 4 y\n\"c.amc\" 5 6 z\nd.amc one 2 x\n");
  EXPECT_THAT(list.cuts, SizeIs(1));
  EXPECT_THAT(list.refused, IsEmpty());
  EXPECT_EQ(list.unquoted_lines, 2);
  EXPECT_EQ(list.first_unquoted_line.line, 5);
}

TEST(CutList, TakesLinesWithoutQuotesOnRequest) {
  const CutList list = Parse(
      "% a.amc 1 2 x\nThere are 10 20 takes here\nHDM05\\a.amc\t1\t2\tx\n  \"b c.amc\" 3 4 y\n",
      true);
  ASSERT_THAT(list.cuts, SizeIs(2));
  EXPECT_EQ(list.cuts[0].take, "HDM05/a");
  EXPECT_EQ(list.cuts[1].take, "b c");
  EXPECT_EQ(list.unquoted_lines, 0);
}

struct BadLine {
  std::string line;
  std::string message;
};

TEST(CutList, RefusesALineThatIsNoCutOrAnUnsafeOneAndReadsOn) {
  for (const auto& [line, message] : std::vector<BadLine>{
           {"\"a.amc 1 2 x", "not closed"},
           {"\"a.amc' 1 2 x", "not closed"},
           {"\"a.amc\" 1 2 \"x", "not closed"},
           {"\"a.amc\"", "ends early"},
           {"\"a.amc\" 1 2", "ends early"},
           {"\"a.amc\" 1 2 \"\"", "ends early"},
           {"\"a.amc\" one 2 x", "'one' is no frame number"},
           {"\"a.amc\" 1 2.5 x", "'2.5' is no frame number"},
           {"\"a.amc\" 1 99999999999999999999 x", "is no frame number"},
           {"\"a.amc\" 1 2 x y", "'y' follows"},
           {"\"a.amc\" 0 2 x", "frames 0 to 2 are no range"},
           {"\"a.amc\" -5 2 x", "frames -5 to 2 are no range"},
           {"\"a.amc\" 3 2 x", "frames 3 to 2 are no range"},
           {"\"\" 1 2 x", "take '' names no file"},
           {"\".amc\" 1 2 x", "names no file"},
           {"\"a\\.\" 1 2 x", "names no file"},
           {"\"a.amc\" 1 2 .amc", "clip '' names no file"},
           {"\"a.amc\" 1 2 x\\", "names no file"},
           {"\"..\\a.amc\" 1 2 x", "'..'"},
           {"\"a\\..\\..\\b.amc\" 1 2 x", "'..'"},
           {"\"a.amc\" 1 2 ..\\x", "clip '../x' leaves its folder"},
           {"\"a.amc\" 1 2 a/../../x", "'..'"},
           {"\"a.amc\" 1 2 ...amc", "'..'"},
           {"\"a.amc\" 1 2 /tmp/x", "is absolute"},
           {"\"a.amc\" 1 2 \\x", "is absolute"},
           {"\"a.amc\" 1 2 \\\\server\\x", "is absolute"},
           {"\"a.amc\" 1 2 C:\\x", "is absolute"},
           {"\"a.amc\" 1 2 c:x", "is absolute"},
           {"\"D:\\a.amc\" 1 2 x", "take 'D:/a' is absolute"},
           {std::string("\"a\0b.amc\" 1 2 x", 15), "control character"},
           {"\"a.amc\" 1 2 x\x1b[2J", "control character"},
       }) {
    SCOPED_TRACE(line);
    const CutList list = Parse("% first\n" + line + "\n\"b\" 1 2 y\n");
    EXPECT_THAT(list.cuts, SizeIs(1));
    ASSERT_THAT(list.refused, SizeIs(1));
    EXPECT_THAT(list.refused[0].what(), AllOf(HasSubstr("cuts.txt:2: "), HasSubstr(message)));
  }
}

TEST(CutList, TakesNamesWithFullStopsThatLeadNowhereUp) {
  EXPECT_EQ(OnlyCut("\"a..b\\...\\c.amc\" 1 2 ..x..y\n").take, "a..b/.../c");
  EXPECT_EQ(OnlyCut("\"a\" 1 2 ..x..y\n").clip, "..x..y");
  EXPECT_EQ(OnlyCut("\"7:b\" 1 2 ab:c\n").clip, "ab:c");
}

RC_GTEST_PROP(CutList, ReadsWhatWasWritten, ()) {
  const auto letters = rc::gen::elementOf(std::string("abXY01_.-ä \t'%#"));
  const auto name = [&] { return "n" + *rc::gen::container<std::string>(letters) + "n"; };
  const std::string take = name() + '/' + name();
  const std::string clip = name();
  const auto first = *rc::gen::inRange<std::int64_t>(1, 1'000'000'000);
  const auto last = first + *rc::gen::inRange<std::int64_t>(0, 1'000'000'000);
  const std::string extension = *rc::gen::element<std::string>("", ".amc", ".c3d", ".AMC");
  const std::string blank = *rc::gen::element<std::string>(" ", "\t", "  \t ");
  std::string line = fmt::format("\"{}{}\"{}{}{}{}{}\"{}\"", take, extension, blank, first, blank,
                                 last, blank, clip);
  if (take.find('\t') != std::string::npos || clip.find('\t') != std::string::npos) {
    RC_ASSERT(Parse(line).refused.size() == 1U);  // A tab is a control character.
    return;
  }
  const CutList list = Parse(line);
  RC_ASSERT(list.cuts.size() == 1U);
  RC_ASSERT(list.cuts[0].take == take);
  RC_ASSERT(list.cuts[0].clip == clip);
  RC_ASSERT(list.cuts[0].first_frame == first);
  RC_ASSERT(list.cuts[0].last_frame == last);
}

TEST(CutLists, OfAFolderAreAllItsTextFilesInOrder) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "b.txt", "\"t\" 3 4 b\nu 1 2 x\n");
  test::WriteText(folder.path() / "a.TXT", "\"t\" 1 2 a\nu 1 2 x\n");
  test::WriteText(folder.path() / "c.cut", "\"t\" 5 6 c\n");
  test::WriteText(folder.path() / "readme.txt", "nothing in here\n");
  test::WriteText(folder.path() / "deep" / "d.txt", "\"t\" 5 6 d\n");
  const CutList list = ReadCutLists(std::vector{folder.path()});
  ASSERT_THAT(list.cuts, SizeIs(2));
  EXPECT_EQ(list.cuts[0].clip, "a");
  EXPECT_EQ(list.cuts[1].clip, "b");
  EXPECT_EQ(list.unquoted_lines, 2);
  EXPECT_EQ(list.first_unquoted_line.file, folder.path() / "a.TXT");
}

TEST(CutLists, SayWhatIsMissing) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "cuts.txt";
  const auto refusal = [](const fs::path& path) {
    return test::ErrorOf([&] { (void)ReadCutLists(std::vector{path}); });
  };
  EXPECT_EQ(refusal(file).code(), ErrorCode::kNotFound);
  EXPECT_THAT(refusal(folder.path()).what(), HasSubstr("*.txt"));
  test::WriteText(file, "% nothing\n");
  EXPECT_EQ(refusal(file).code(), ErrorCode::kMalformedFile);
  EXPECT_THAT(refusal(file).what(), AllOf(HasSubstr("cuts.txt: "), HasSubstr("\"take\" first")));
  test::WriteText(file, "% nothing\na.amc 1 2 x\nb.amc 1 2 y\n");
  EXPECT_THAT(refusal(file).what(),
              AllOf(HasSubstr("cuts.txt:2: "), HasSubstr("2 from here"), HasSubstr("--unquoted")));
}

TEST(CutLists, OfTheSyntheticLibraryIsItsTruth) {
  const test::TemporaryFolder folder;
  WriteSyntheticLibrary(folder.path(), {.actors = 1,
                                        .repetitions = 0,
                                        .clips_per_take = 4,
                                        .classes = {"squat1Reps", "grabHighR"},
                                        .threads = 1});
  const CutList list = ReadCutLists(std::vector{folder.path() / "takes.cuts.txt"});
  const CsvTable truth = test::ReadCsv(folder.path() / "takes.truth.csv");
  ASSERT_EQ(list.cuts.size(), truth.rows.size());
  for (std::size_t i = 0; i < list.cuts.size(); ++i) {
    EXPECT_EQ(std::to_string(list.cuts[i].first_frame), truth.rows[i][truth.Column("first_frame")]);
    EXPECT_EQ(std::to_string(list.cuts[i].last_frame), truth.rows[i][truth.Column("last_frame")]);
    EXPECT_EQ(fs::path(list.cuts[i].take).filename(),
              fs::path(truth.rows[i][truth.Column("file")]).stem());
    EXPECT_THAT(list.cuts[i].clip, HasSubstr(truth.rows[i][truth.Column("class")]));
  }
}

// Files named good_… hold cuts only; all others hold lines that are refused, or no cut.
TEST(CutListCorpus, IsReadOrRefusedAsItsNamesSay) {
  int files = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(KINEBASE_SOURCE_DIR) / "fuzz" / "corpus" / "cut_list")) {
    const std::string name = entry.path().filename();
    SCOPED_TRACE(name);
    const CutList list = ParseCutList(test::ReadText(entry.path()), entry.path());
    const bool is_good = !list.cuts.empty() && list.refused.empty();
    EXPECT_EQ(is_good, name.starts_with("good_"));
    ++files;
  }
  EXPECT_GE(files, 10);
}

}  // namespace
}  // namespace kinebase
