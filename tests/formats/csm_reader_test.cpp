// Each point of docs/formats/csm.md about what stands in a file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fmt/format.h"
#include "formats/texts.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/csm.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using test::LineOf;
using test::With;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::NanSensitiveDoubleEq;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Made up after the format's own sample.
constexpr std::string_view kWalk = R"($Filename walk.csm
$CaptureDate 2001/02/03
$CaptureTime 04:05:06
$Actor Ada Example
$Comments
First line
  second line

last line

$FirstFrame 12
$LastFrame 13
$SpineLinks 2
$Rate 25.000
$Talent inches head 7 neck 2.5 clavicle 4.0 upperarm 10.5 forearm 10 spine 16
pelvheight 4 pelvlength 8 thigh 18 calf 16.5 footheight 5 footlength 7
$Order
LFHD RFHD MyOwn

$Points
12 -1085.5 34.25 1419.75 -1083 -104 1430 1 2 3
13 -1014.5 35.25 1436.75 DROPOUT 4 5 6
)";

// Three markers without anything else.
std::string Points(std::string_view points) {
  return fmt::format("$Order A B C\n$Points\n{}", points);
}

CsmRecording Parse(std::string_view text, bool strict = false) {
  return ParseCsm(text, "walk.csm", {.strict = strict});
}

std::vector<std::string> Messages(const Diagnostics& diagnostics) {
  std::vector<std::string> messages;
  for (const auto& diagnostic : diagnostics) messages.push_back(diagnostic.message);
  return messages;
}

// The error of a text, which must name the line that holds `part`.
std::string ErrorAt(std::string_view text, std::string_view part) {
  const Error error = test::ErrorOf([&] { (void)Parse(text); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.place().file, "walk.csm");
  EXPECT_EQ(error.place().line, LineOf(text, part)) << error.what();
  return error.message();
}

// The one diagnostic of a text, which strict reading refuses.
std::string RepairOf(std::string_view text) {
  const CsmRecording csm = Parse(text);
  EXPECT_EQ(csm.diagnostics.size(), 1) << text;
  EXPECT_EQ(test::ErrorOf([&] { (void)Parse(text, true); }).code(), ErrorCode::kMalformedFile);
  return csm.diagnostics.empty() ? "" : csm.diagnostics.front().message;
}

testing::Matcher<const std::vector<double>&> AreValues(const std::vector<double>& expected) {
  std::vector<testing::Matcher<double>> matchers;
  for (const double value : expected) matchers.push_back(NanSensitiveDoubleEq(value));
  return testing::ElementsAreArray(matchers);
}

TEST(CsmReader, ReadsEveryField) {
  const CsmRecording csm = Parse(kWalk, true);
  EXPECT_EQ(csm.file_name, "walk.csm");
  EXPECT_EQ(csm.capture_date, "2001/02/03");
  EXPECT_EQ(csm.capture_time, "04:05:06");
  EXPECT_EQ(csm.actor, "Ada Example");
  EXPECT_THAT(csm.comments, ElementsAre("First line", "second line", "", "last line"));
  EXPECT_EQ(csm.declared_first_frame, 12);
  EXPECT_EQ(csm.declared_last_frame, 13);
  EXPECT_EQ(csm.rate_hz, 25);
  EXPECT_EQ(csm.spine_links, 2);
  EXPECT_THAT(csm.labels, ElementsAre("LFHD", "RFHD", "MyOwn"));
  EXPECT_THAT(csm.frame_numbers, ElementsAre(12, 13));
  EXPECT_THAT(csm.values, AreValues({-1085.5, 34.25, 1419.75, -1083, -104, 1430, 1, 2, 3,  //
                                     -1014.5, 35.25, 1436.75, kNaN, kNaN, kNaN, 4, 5, 6}));
  EXPECT_THAT(csm.unknown_sections, IsEmpty());
  EXPECT_THAT(csm.diagnostics, IsEmpty());
}

TEST(CsmReader, ReadsTheTalentInItsOwnUnit) {
  const CsmRecording csm = Parse(kWalk);
  ASSERT_TRUE(csm.talent);
  EXPECT_EQ(csm.talent->unit, CsmTalent::Unit::kInches);
  EXPECT_EQ(csm.talent->measures.size(), 12);
  EXPECT_EQ(csm.talent->measures[1], (CsmTalent::Measure{"neck", 2.5}));
  EXPECT_DOUBLE_EQ(*csm.talent->LengthCm("Neck"), 6.35);
  EXPECT_EQ(csm.talent->LengthCm("tail"), std::nullopt);
  const CsmRecording metric = Parse(With(kWalk, "inches", "millimeter"));
  EXPECT_DOUBLE_EQ(*metric.talent->LengthCm("neck"), .25);
}

TEST(CsmReader, ReadsTheSecondPelvisHeightAsItsLength) {
  const CsmRecording csm = Parse(With(kWalk, "pelvlength", "PelvHeight"));
  EXPECT_EQ(csm.talent, Parse(kWalk).talent);
  EXPECT_THAT(Messages(csm.diagnostics), ElementsAre(HasSubstr("'pelvlength'")));
  EXPECT_EQ(csm.diagnostics[0].severity, Severity::kInfo);
  const std::string three = With(kWalk, "neck 2.5", "pelvheight 3");
  EXPECT_THAT(Messages(Parse(three).diagnostics),
              ElementsAre(HasSubstr("stands twice: 'pelvheight'"), HasSubstr("lacks 'neck'")));
  EXPECT_EQ(Parse(three).talent->measures.size(), 11);
}

TEST(CsmReader, KeepsUnknownTalentNamesAndReportsThemAndMissingOnes) {
  const CsmRecording csm = Parse(With(kWalk, "calf", "calv"));
  EXPECT_THAT(csm.talent->measures, Contains(CsmTalent::Measure{"calv", 16.5}));
  EXPECT_THAT(Messages(csm.diagnostics),
              ElementsAre(HasSubstr("unknown names: 'calv'"), HasSubstr("lacks 'calf'")));
}

TEST(CsmReader, LeavesOutWhatMakesNoSenseInTheTalent) {
  EXPECT_THAT(RepairOf(With(kWalk, "inches head", "inches 5 head")), HasSubstr("'5'"));
  EXPECT_THAT(RepairOf(With(kWalk, "inches head", "inches tail head")), HasSubstr("'tail'"));
  EXPECT_THAT(RepairOf(With(kWalk, "footlength 7", "footlength 7 tail")), HasSubstr("'tail'"));
  EXPECT_THAT(RepairOf(With(kWalk, "footlength 7", "footlength 7 neck 3")), HasSubstr("'neck'"));
  const CsmRecording no_number = Parse(With(kWalk, "head 7", "head nan"));
  EXPECT_EQ(no_number.talent->LengthCm("head"), std::nullopt);
  const CsmRecording no_unit = Parse(With(kWalk, "inches", ""));
  EXPECT_EQ(no_unit.talent->LengthCm("head"), std::nullopt);
  EXPECT_THAT(Messages(no_unit.diagnostics), ElementsAre(HasSubstr("cannot be used")));
}

TEST(CsmReader, TakesAnyLineEndTabsBlanksAndAByteOrderMark) {
  const CsmRecording expected = Parse(kWalk);
  for (const char* ending : {"\r\n", "\r"}) {
    EXPECT_EQ(Parse("\xEF\xBB\xBF" + test::WithLineEnds(kWalk, ending), true), expected);
  }
  EXPECT_EQ(Parse(test::WithLineEnds(With(kWalk, "line\n\nlast", "line\nlast"), " \t\n\n\t "), true)
                .values.size(),
            expected.values.size());
}

TEST(CsmReader, TakesSectionsInAnyCaseAndOrder) {
  const CsmRecording csm =
      Parse("$ORDER a b\n$points\n1 1 2 3 4 5 6\n$rAtE 60\n$ACTOR\nAda\n", true);
  EXPECT_EQ(csm.rate_hz, 60);
  EXPECT_EQ(csm.actor, "Ada");
  EXPECT_EQ(csm.frame_count(), 1);
}

TEST(CsmReader, TakesBothNamesOfDateAndTime) {
  const CsmRecording csm =
      Parse(With(With(kWalk, "$CaptureDate", "$Date"), "$CaptureTime", "$Time"), true);
  EXPECT_EQ(csm, Parse(kWalk));
}

TEST(CsmReader, TakesValuesOnTheTitlesLineOrBelow) {
  const CsmRecording below =
      Parse("$Rate\n25\n$Comments one\ntwo\n$Order\nA\nB\n$Points\n1 1 2 3 4 5 6\n", true);
  const CsmRecording beside =
      Parse("$Rate 25 $Order A B\n$Comments\none\ntwo\n$Points 1 1 2 3 4 5 6\n", true);
  EXPECT_EQ(below, beside);
  EXPECT_EQ(below.rate_hz, 25);
  EXPECT_THAT(below.comments, ElementsAre("one", "two"));
}

TEST(CsmReader, KeepsUnknownSections) {
  const CsmRecording csm =
      Parse("$Stage Left Hall\n  cold\n\n$Order A\n$Points\n1 1 2 3\n$x\n", true);
  EXPECT_THAT(csm.unknown_sections, ElementsAre(CsmUnknownSection{"Stage", {"Left Hall", "cold"}},
                                                CsmUnknownSection{"x", {}}));
  EXPECT_EQ(Parse(FormatCsm(csm)), csm);
}

TEST(CsmReader, KeepsCommentsThatHoldADollarSign) {
  const CsmRecording csm =
      Parse("$Comments $5 a day\nat $9\n$Order A\n$Points\n1 1 2 3\n$comments $1\n", true);
  EXPECT_THAT(csm.comments, ElementsAre("$5 a day", "at $9", "$1"));
  EXPECT_EQ(Parse(FormatCsm(csm)), csm);
}

TEST(CsmReader, NeedsNothingButOrderAndPoints) {
  const CsmRecording csm = Parse(Points("1 1 2 3 4 5 6 7 8 9\n"), true);
  EXPECT_EQ(csm.rate_hz, std::nullopt);
  EXPECT_EQ(csm.spine_links, std::nullopt);
  EXPECT_EQ(csm.talent, std::nullopt);
  EXPECT_EQ(csm.declared_first_frame, std::nullopt);
}

TEST(CsmReader, ReadsARangeOfOneFrameZero) {
  const CsmRecording csm =
      Parse("$FirstFrame 0\n$LastFrame 0\n$Order\nA\n$Points\n0  1.0 2.0 3.0\n", true);
  EXPECT_THAT(csm.frame_numbers, ElementsAre(0));
  EXPECT_THAT(csm.values, ElementsAre(1, 2, 3));
  EXPECT_THAT(csm.diagnostics, IsEmpty());
}

TEST(CsmReader, KeepsTheRowsThatAreThereWhateverRangeIsDeclared) {
  const CsmRecording csm = Parse(With(kWalk, "$LastFrame 13", "$LastFrame 300"), true);
  EXPECT_EQ(csm.frame_count(), 2);
  EXPECT_THAT(Messages(csm.diagnostics),
              ElementsAre("frames 12 to 300 are declared, 12 to 13 are there: 2 frames"));
  const std::string huge = With(With(kWalk, "$LastFrame 13", "$LastFrame 9223372036854775807"),
                                "$FirstFrame 12", "$FirstFrame -9223372036854775808");
  EXPECT_EQ(Parse(huge).frame_count(), 2);
}

TEST(CsmReader, ReportsFrameNumbersThatJump) {
  const CsmRecording csm = Parse(With(kWalk, "\n13 -1014.5", "\n15 -1014.5"));
  EXPECT_THAT(csm.frame_numbers, ElementsAre(12, 15));
  EXPECT_THAT(Messages(csm.diagnostics),
              ElementsAre(HasSubstr("frame 15 follows frame 12"), HasSubstr("12 to 15 are there")));
}

TEST(CsmReader, RefusesFrameNumbersThatDoNotGrow) {
  EXPECT_THAT(ErrorAt(With(kWalk, "\n13 -1014.5", "\n12 -1014.5"), "12 -1014.5"),
              HasSubstr("frame 12 after frame 12"));
}

TEST(CsmReader, TakesOneDropoutForAMarker) {
  const std::string text = Points(
      "1 DROPOUT 4 5 6 7 8 9\n2 1 2 3 dropout DropOut\n"
      "3 DROPOUT DROPOUT DROPOUT\n4 1 2 3 4 5 6 DROPOUT\n");
  const CsmRecording csm = Parse(text, true);
  EXPECT_THAT(csm.frame_numbers, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(csm.values,
              AreValues({kNaN, kNaN, kNaN, 4,    5,    6,    7,    8,    9,    1,    2,    3,
                         kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN,
                         kNaN, kNaN, kNaN, 1,    2,    3,    4,    5,    6,    kNaN, kNaN, kNaN}));
}

TEST(CsmReader, TakesADropoutAtTheVeryEnd) {
  for (const char* end : {"", "\n", " ", "\r\n\r\n", "\n$Rate 5\n"}) {
    const CsmRecording csm = Parse(Points("1 1 2 3 4 5 6 DROPOUT") + end);
    EXPECT_THAT(csm.values, AreValues({1, 2, 3, 4, 5, 6, kNaN, kNaN, kNaN})) << end;
  }
}

TEST(CsmReader, TakesThreeDropoutsForAMarkerWhereOnlyThatFits) {
  const std::string text = Points(
      "1 DROPOUT DROPOUT DROPOUT 4 5 6 7 8 9\n"
      "2 1 2 3 DROPOUT DROPOUT DROPOUT DROPOUT DROPOUT DROPOUT\n"
      "3 1 2 3 4 5 6 7 8 9\n");
  const CsmRecording csm = Parse(text, true);
  EXPECT_THAT(csm.values, AreValues({kNaN, kNaN, kNaN, 4,    5, 6, 7, 8, 9, 1, 2, 3, kNaN, kNaN,
                                     kNaN, kNaN, kNaN, kNaN, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(CsmReader, TakesADropoutForAValueWhereOnlyThatFits) {
  const CsmRecording csm = Parse(Points("1 1 DROPOUT 3 4 5 6 7 8 9\n2 1 2 3 4 5 6 7 8 9\n"), true);
  EXPECT_THAT(csm.Point(0, 0), testing::ElementsAre(1, NanSensitiveDoubleEq(kNaN), 3));
  EXPECT_EQ(csm.frame_count(), 2);
}

TEST(CsmReader, TakesNanOfAnyKindForAMissingValue) {
  const CsmRecording csm = Parse(Points("1 nan NaN -nan 1.#QNAN -1.#IND00 1.#INF00 7 8 9\n"), true);
  EXPECT_THAT(csm.values, AreValues({kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, 7, 8, 9}));
}

TEST(CsmReader, CountsValuesWhereFramesDoNotKeepToLines) {
  const CsmRecording expected = Parse(Points("1 1 2 3 4 5 6 7 8 9\n2 DROPOUT 4 5 6 7 8 9\n"));
  EXPECT_EQ(Parse(Points("1\n1 2 3\n4 5 6\n7 8 9\n2\nDROPOUT 4 5\n6 7 8 9\n"), true), expected);
  EXPECT_EQ(Parse(Points("1 1 2 3 4 5 6 7 8 9 2 DROPOUT 4 5 6 7 8 9\n"), true), expected);
  EXPECT_EQ(Parse(Points("1 1 2 3 4 5\n6 7 8 9 2 DROPOUT 4 5 6\n7 8 9\n"), true), expected);
}

TEST(CsmReader, RefusesAFrameThatDoesNotFitTheOrder) {
  EXPECT_THAT(ErrorAt(Points("1 1 2 3 4 5 6 7 8 9\n2 1 2 3 4 5 6\n3 1 2 3 4 5 6 7 8 9\n"), "2 1 2"),
              HasSubstr("frame 2 has 6 values and 0 drop-outs; '$order' names 3 markers"));
  EXPECT_THAT(ErrorAt(Points("1 1 2 3 4 5 6 7 8 9\n2 1 2 3 4 5 6 7 8 9 10\n3 1 2 3 4 5 6 7 8 9\n"),
                      "2 1 2"),
              HasSubstr("frame 2 has 10 values"));
  EXPECT_THAT(ErrorAt(Points("1 1 2 3 DROPOUT DROPOUT DROPOUT\n2 1 2 3 4 5 6 7 8 9\n"), "1 1 2"),
              HasSubstr("3 drop-outs"));
  EXPECT_THAT(ErrorAt(Points("1 1 2 3 4 5 6\n$Rate 5\n"), "1 1 2"), HasSubstr("frame 1"));
  (void)ErrorAt(Points("1 1 2 3 4 5 6 7 8 9 DROPOUT\n"), "1 1 2");
}

TEST(CsmReader, RefusesAValueThatIsNoNumber) {
  EXPECT_THAT(ErrorAt(Points("1 1 2 3 4 five 6 7 8 9\n"), "five"), HasSubstr("frame 1"));
  EXPECT_THAT(ErrorAt(Points("1 1 2 3 4\n5 1e999 7 8 9\n"), "1e999"), HasSubstr("'1e999'"));
  EXPECT_THAT(ErrorAt(Points("one 1 2 3 4 5 6 7 8 9\n"), "one 1"),
              HasSubstr("expected the number of a frame, found 'one'"));
  EXPECT_THAT(ErrorAt(Points("1.5 1 2 3 4 5 6 7 8 9\n"), "1.5"), HasSubstr("'1.5'"));
}

TEST(CsmReader, LeavesOutALastFrameThatIsCutOff) {
  const std::string text = Points("1 1 2 3 4 5 6 7 8 9\n2 1 2 3 4 5 6 7 8 9\n");
  const CsmRecording whole = Parse(text);
  const std::size_t second = text.find("2 1 2 3 4");
  for (std::size_t size = second + 1; size + 2 < text.size(); ++size) {
    const CsmRecording csm = Parse(text.substr(0, size));
    EXPECT_EQ(csm.frame_count(), 1);
    EXPECT_THAT(Messages(csm.diagnostics), ElementsAre(HasSubstr("cut off")));
    (void)test::ErrorOf([&] { (void)Parse(text.substr(0, size), true); });
  }
  const std::string no_end = text.substr(0, text.size() - 1);
  EXPECT_THAT(RepairOf(no_end), HasSubstr("may lack digits"));
  EXPECT_EQ(Parse(no_end), whole);
  const Error first = test::ErrorOf([&] { (void)Parse(Points("1 1 2 3 4")); });
  EXPECT_THAT(first.message(), HasSubstr("frame, 1, is cut off"));
}

TEST(CsmReader, LeavesOutACutFrameWithThreeDropoutsAMarker) {
  const std::string text = Points(
      "1 DROPOUT DROPOUT DROPOUT 4 5 6 7 8 9\n"
      "2 DROPOUT DROPOUT DROPOUT 4 5 6 7 8\n");
  EXPECT_EQ(Parse(text).frame_count(), 1);
}

TEST(CsmReader, RefusesPointsBeforeTheOrder) {
  EXPECT_THAT(ErrorAt("$Rate 5\n$Points\n1 1 2 3\n$Order A\n", "$Points"),
              HasSubstr("'$points' before any marker of '$order'"));
  EXPECT_THAT(ErrorAt("$Order\n$Points\n1 1 2 3\n", "$Order"), HasSubstr("names no marker"));
}

TEST(CsmReader, RefusesAFileWithoutOrderPointsOrFrames) {
  const auto message = [](std::string_view text) {
    return test::ErrorOf([&] { (void)Parse(text); }).message();
  };
  EXPECT_THAT(message(""), HasSubstr("is empty"));
  EXPECT_THAT(message("$Rate 5\n"), HasSubstr("no '$order'"));
  EXPECT_THAT(message("$Order A B\n"), HasSubstr("no '$points'"));
  EXPECT_THAT(message("$Order A B\n$Points\n"), HasSubstr("no frames"));
  EXPECT_THAT(message("$Order A B\n$Points\n$Rate 5\n"), HasSubstr("no frames"));
  EXPECT_THAT(message("Rate 5\n"), HasSubstr("expected a section such as '$order', found 'Rate'"));
  EXPECT_THAT(message(std::string_view("C3D\0\1", 5)), HasSubstr("binary"));
  EXPECT_THAT(message("$Order A\n$Order B\n$Points\n1 1 2 3\n"),
              HasSubstr("'$Order' stands twice"));
  EXPECT_THAT(message("$Order A\n$Points\n1 1 2 3\n$Points\n2 1 2 3\n"),
              HasSubstr("'$Points' stands twice"));
}

TEST(CsmReader, TakesCommasBetweenNamesForBlanks) {
  const std::string text = "$Order A,B, C ,D\n$Points\n1 1 2 3 4 5 6 7 8 9 10 11 12\n";
  EXPECT_THAT(RepairOf(text), HasSubstr("comma"));
  EXPECT_THAT(Parse(text).labels, ElementsAre("A", "B", "C", "D"));
}

TEST(CsmReader, ReportsNamesThatRepeat) {
  const CsmRecording csm = Parse("$Order A B A\n$Points\n1 1 2 3 4 5 6 7 8 9\n", true);
  EXPECT_THAT(csm.labels, ElementsAre("A", "B", "A"));
  EXPECT_THAT(Messages(csm.diagnostics), ElementsAre("markers of the same name: 'A'"));
}

TEST(CsmReader, RepairsSectionsThatMakeNoSense) {
  EXPECT_THAT(RepairOf("$Rate\n" + Points("1 1 2 3 4 5 6 7 8 9\n")),
              HasSubstr("without its number"));
  EXPECT_THAT(RepairOf("$Rate fast\n" + Points("1 1 2 3 4 5 6 7 8 9\n")), HasSubstr("'fast'"));
  EXPECT_THAT(RepairOf("$Rate nan\n" + Points("1 1 2 3 4 5 6 7 8 9\n")), HasSubstr("'nan'"));
  EXPECT_THAT(RepairOf("$Rate 5 6\n" + Points("1 1 2 3 4 5 6 7 8 9\n")), HasSubstr("'6'"));
  EXPECT_THAT(RepairOf("$LastFrame 1.5\n" + Points("1 1 2 3 4 5 6 7 8 9\n")), HasSubstr("'1.5'"));
  const std::string twice = "$Rate 5\n$Rate 6\n" + Points("1 1 2 3 4 5 6 7 8 9\n");
  EXPECT_THAT(RepairOf(twice), HasSubstr("'$rate' stands twice"));
  EXPECT_EQ(Parse(twice).rate_hz, 5);
  const CsmRecording links = Parse("$SpineLinks 7\n" + Points("1 1 2 3 4 5 6 7 8 9\n"), true);
  EXPECT_THAT(Messages(links.diagnostics), ElementsAre(HasSubstr("7 spine links")));
}

TEST(CsmReader, TakesTokensOfAnyLength) {
  const std::string name(1 << 20, 'x');
  const std::string number = "1." + std::string(1 << 16, '0') + "5";
  const CsmRecording csm = Parse(
      fmt::format("$Actor {0}\n${0}\n$Talent mm {0} 5\n$Order {0} B\n$Points\n1 {1} 2 3 4 5 6\n",
                  name, number));
  EXPECT_EQ(csm.labels[0], name);
  EXPECT_EQ(csm.actor, name);
  EXPECT_DOUBLE_EQ(csm.values[0], 1);
  for (const auto& diagnostic : csm.diagnostics) EXPECT_LT(diagnostic.message.size(), 1000);
  const Error error = test::ErrorOf([&] { (void)Parse(Points("1 " + name + " 2 3\n")); });
  EXPECT_LT(error.message().size(), 200);
}

TEST(CsmReader, TakesManyTitlesOnALine) {
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += "$rate ";
  EXPECT_EQ(Parse(text + "5\n" + Points("1 1 2 3 4 5 6 7 8 9\n")).frame_count(), 1);
}

TEST(CsmReader, ReadsTheRealRecording) {
  KINEBASE_NEEDS_TEST_DATA();
  const CsmRecording csm = ReadCsm(test::TestData("data/csm/ThomasFechten.csm"), {.strict = true});
  EXPECT_EQ(csm.file_name, "ThomasFechten2.csm");
  EXPECT_EQ(csm.capture_date, "2008/07/17");
  EXPECT_EQ(csm.capture_time, "14:57:42");
  EXPECT_EQ(csm.actor, "Thomas_Neu");
  EXPECT_THAT(csm.comments, ElementsAre("General Capture"));
  EXPECT_EQ(csm.rate_hz, 120);
  EXPECT_EQ(csm.labels.size(), 43);
  EXPECT_EQ(csm.frame_count(), 2439);
  EXPECT_EQ(csm.frame_numbers.back(), 2439);
  EXPECT_THAT(csm.Point(0, 0), ElementsAre(26.327553, 157.341293, 1656.915527));
  EXPECT_TRUE(std::ranges::all_of(csm.values, [](double value) { return std::isfinite(value); }));
  EXPECT_THAT(csm.diagnostics, IsEmpty());
}

TEST(CsmReader, ReadsTheZeroFrameRangeThatOthersFailAt) {
  KINEBASE_NEEDS_TEST_DATA();
  const CsmRecording csm =
      ReadCsm(test::TestData("data/csm/assimp_malformed_zero_framerange.csm"), {.strict = true});
  EXPECT_EQ(csm.frame_count(), 1);
  EXPECT_THAT(csm.diagnostics, IsEmpty());
}

TEST(CsmReader, NamesAFileThatDoesNotExist) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(test::ErrorOf([&] { (void)ReadCsm(folder.path() / "none.csm"); }).code(),
            ErrorCode::kNotFound);
}

}  // namespace
}  // namespace kinebase
