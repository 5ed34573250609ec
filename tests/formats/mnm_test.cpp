// Each point of docs/formats/csm.md about marker-name files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "formats/texts.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/mnm.h"
#include "support/files.h"

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Row = MarkerNames::Row;

MarkerNames Parse(std::string_view text, bool strict = false) {
  return ParseMnm(text, "own.mnm", {.strict = strict});
}

std::string RepairOf(std::string_view text) {
  const MarkerNames names = Parse(text);
  EXPECT_EQ(names.diagnostics.size(), 1) << text;
  EXPECT_EQ(test::ErrorOf([&] { (void)Parse(text, true); }).code(), ErrorCode::kMalformedFile);
  return names.diagnostics.empty() ? "" : names.diagnostics.front().message;
}

TEST(MnmReader, ReadsTwoColumns) {
  const MarkerNames names = Parse("LFHD FrontLeft\n\n  C7\tneck\t\nRFHD RFHD", true);
  EXPECT_THAT(names.rows,
              ElementsAre(Row{"LFHD", "FrontLeft"}, Row{"C7", "neck"}, Row{"RFHD", "RFHD"}));
  EXPECT_EQ(names.rows[1].line, 3);
  EXPECT_THAT(names.diagnostics, IsEmpty());
}

TEST(MnmReader, FindsNamesInAnyCase) {
  const MarkerNames names = Parse("LFHD FrontLeft\nC7 neck\n");
  EXPECT_EQ(names.PresetName("frontleft"), "LFHD");
  EXPECT_EQ(names.CustomName("lfhd"), "FrontLeft");
  EXPECT_EQ(names.PresetName("LFHD"), std::nullopt);
  EXPECT_EQ(names.CustomName("neck"), std::nullopt);
}

TEST(MnmReader, TakesAnyLineEndAndAByteOrderMark) {
  const std::string_view text = "LFHD a\nC7 b\n";
  for (const char* ending : {"\r\n", "\r", "\n\n"}) {
    EXPECT_EQ(Parse("\xEF\xBB\xBF" + test::WithLineEnds(text, ending), true), Parse(text));
  }
}

TEST(MnmReader, TakesCommasForBlanks) {
  const std::string_view text = "LFHD,a\nC7 , b\n";
  EXPECT_THAT(RepairOf(text), HasSubstr("comma"));
  EXPECT_EQ(Parse(text), Parse("LFHD a\nC7 b\n"));
}

TEST(MnmReader, KeepsComments) {
  const MarkerNames names = Parse("# Hall 2\nLFHD a\n; and more\n", true);
  EXPECT_THAT(names.comments, ElementsAre("# Hall 2", "; and more"));
  EXPECT_THAT(names.rows, ElementsAre(Row{"LFHD", "a"}));
}

TEST(MnmReader, RepairsRowsThatMakeNoSense) {
  EXPECT_THAT(RepairOf("LFHD a\nC7\n"), HasSubstr("only one name: 'C7'"));
  EXPECT_THAT(RepairOf("LFHD a b\n"), HasSubstr("more than two names: 'b'"));
  EXPECT_THAT(RepairOf("LFHD a\nlfhd b\n"), HasSubstr("'lfhd' stands twice on the left"));
  EXPECT_THAT(RepairOf("LFHD a\nRFHD A\n"), HasSubstr("'A' stands twice on the right"));
  EXPECT_THAT(Parse("LFHD a\nlfhd b\n").rows, ElementsAre(Row{"LFHD", "a"}));
}

TEST(MnmReader, RefusesWhatIsNoMarkerNameFile) {
  for (const std::string_view text : {std::string_view(""), std::string_view("\n \n"),
                                      std::string_view("a\0b c\n", 6), std::string_view("# x\n")}) {
    const Error error = test::ErrorOf([&] { (void)Parse(text); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    EXPECT_EQ(error.place().file, "own.mnm");
  }
  EXPECT_EQ(test::ErrorOf([] { (void)Parse("a b\n,#a b\n"); }).place().line, 2);
}

TEST(MnmWriter, GivesBackWhatWasRead) {
  for (const std::string_view text :
       {"# one\nLFHD a\n;two\nC7 b\n", "\xEF\xBB\xBF\xEF\xBB\xBFodd name\n", "A,B"}) {
    const MarkerNames names = Parse(text);
    EXPECT_EQ(Parse(FormatMnm(names), true), names) << text;
  }
}

TEST(Preset, HasTheMarkersOfTheFormatsTable) {
  using Need = PresetMarker::Need;
  const auto count = [](Need need) {
    return std::ranges::count(PresetMarkers(), need, &PresetMarker::need);
  };
  EXPECT_EQ(count(Need::kRequired), 26);
  EXPECT_EQ(count(Need::kOptional), 9);
  EXPECT_EQ(count(Need::kStick), 4);
  EXPECT_EQ(count(Need::kBand), 4);
  EXPECT_EQ(count(Need::kProp), 9);
  std::set<std::string_view> names;
  for (const PresetMarker& marker : PresetMarkers()) {
    EXPECT_TRUE(names.insert(marker.name).second) << marker.name;
    EXPECT_FALSE(marker.place.empty() || marker.tells.empty()) << marker.name;
    // What is there on the left is there on the right.
    if (marker.name.front() != 'L') continue;
    std::string other(marker.name);
    other.front() = 'R';
    ASSERT_NE(FindPresetMarker(other), nullptr) << other;
    EXPECT_EQ(FindPresetMarker(other)->need, marker.need);
  }
  EXPECT_EQ(FindPresetMarker("lmt5")->name, "LMT5");
  EXPECT_EQ(FindPresetMarker("LHEE"), nullptr);
}

}  // namespace
}  // namespace kinebase
