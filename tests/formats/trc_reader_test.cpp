// Each point of docs/formats/opensim.md about TRC files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fmt/format.h"
#include "formats/texts.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/trc.h"
#include "support/files.h"

namespace kinebase {
namespace {

using test::LineOf;
using test::With;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::NanSensitiveDoubleEq;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr std::string_view kWalk =
    "PathFileType\t4\t(X/Y/Z)\ta walk.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
    "OrigNumFrames\tHall\n"
    "60.00\t120\t3\t2\tmm\t60.5\t5\t300\ttwo\n"
    "Frame#\tTime\tR.ASIS\t\t\tLeft heel\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "\n"
    "5\t0.067\t1.5\t2\t3\t4\t5\t6\n"
    "6\t0.083\t\t\t\t-4\t5e1\t6\n"
    "7\t0.1\t1.5\t2\t3\t4\t5\t6.25\n";

// Two markers without blanks at the line ends of the header.
std::string Rows(std::string_view rows) {
  return fmt::format("{}{}", kWalk.substr(0, kWalk.find("5\t0.067")), rows);
}

TrcRecording Parse(std::string_view text, bool strict = false) {
  return ParseTrc(text, "walk.trc", {.strict = strict});
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
  EXPECT_EQ(error.place().file, "walk.trc");
  EXPECT_EQ(error.place().line, LineOf(text, part)) << error.what();
  return error.message();
}

// The first diagnostic of a text, which strict reading refuses.
std::string RepairOf(std::string_view text) {
  const TrcRecording trc = Parse(text);
  EXPECT_EQ(test::ErrorOf([&] { (void)Parse(text, true); }).code(), ErrorCode::kMalformedFile);
  EXPECT_FALSE(trc.diagnostics.empty());
  return trc.diagnostics.empty() ? "" : trc.diagnostics.front().message;
}

testing::Matcher<const std::vector<double>&> AreValues(const std::vector<double>& expected) {
  std::vector<testing::Matcher<double>> matchers;
  for (const double value : expected) matchers.push_back(NanSensitiveDoubleEq(value));
  return testing::ElementsAreArray(matchers);
}

TEST(TrcReader, ReadsEveryField) {
  const TrcRecording trc = Parse(kWalk, true);
  EXPECT_EQ(trc.path_file_type, "4");
  EXPECT_EQ(trc.axes, "(X/Y/Z)");
  EXPECT_EQ(trc.file_name, "a walk.trc");
  EXPECT_EQ(trc.data_rate_hz, 60);
  EXPECT_EQ(trc.camera_rate_hz, 120);
  EXPECT_EQ(trc.units, "mm");
  EXPECT_EQ(trc.original_rate_hz, 60.5);
  EXPECT_EQ(trc.original_first_frame, 5);
  EXPECT_EQ(trc.original_frame_count, 300);
  EXPECT_EQ(trc.declared_frame_count, 3);
  EXPECT_EQ(trc.declared_marker_count, 2);
  EXPECT_THAT(trc.other_fields, ElementsAre(TrcField{"Hall", "two"}));
  EXPECT_THAT(trc.labels, ElementsAre("R.ASIS", "Left heel"));
  EXPECT_THAT(trc.frame_numbers, ElementsAre(5, 6, 7));
  EXPECT_THAT(trc.times_s, ElementsAre(.067, .083, .1));
  EXPECT_THAT(trc.values,
              AreValues({1.5, 2, 3, 4, 5, 6, kNaN, kNaN, kNaN, -4, 50, 6, 1.5, 2, 3, 4, 5, 6.25}));
  EXPECT_THAT(trc.diagnostics, IsEmpty());
}

TEST(TrcReader, TakesAnyLineEndBlankLinesTrailingTabsAndAByteOrderMark) {
  const TrcRecording expected = Parse(kWalk);
  for (const char* ending : {"\r\n", "\r", "\n\n", "\t\n", " \n\t\n"}) {
    EXPECT_EQ(Parse("\xEF\xBB\xBF" + test::WithLineEnds(kWalk, ending), true), expected);
  }
  EXPECT_EQ(Parse(With(kWalk, "Z2\n\n", "Z2\n"), true), expected);
}

TEST(TrcReader, TakesBlanksForTabsInLinesWithoutTabs) {
  const TrcRecording trc = Parse(
      "PathFileType 4 (X/Y/Z) a walk.trc\n"
      "DataRate CameraRate NumFrames NumMarkers Units\n60 60 1 2 m\n"
      "Frame# Time A B\nX1 Y1 Z1 X2 Y2 Z2\n1 0 1 2 3 4 5 6\n");
  EXPECT_EQ(trc.file_name, "a walk.trc");
  EXPECT_EQ(trc.units, "m");
  EXPECT_THAT(trc.labels, ElementsAre("A", "B"));
  EXPECT_THAT(trc.values, ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(TrcReader, TakesNamesThatStandSideBySide) {
  const std::string text = With(kWalk, "R.ASIS\t\t\tLeft heel\t\t", "R.ASIS\tLeft heel");
  EXPECT_THAT(RepairOf(text), HasSubstr("do not stand above their columns"));
  EXPECT_EQ(Parse(text), Parse(kWalk));
}

TEST(TrcReader, TakesMarkersWithoutAName) {
  EXPECT_THAT(Parse(With(kWalk, "Left heel", ""), true).labels, ElementsAre("R.ASIS", ""));
  EXPECT_THAT(Parse(With(kWalk, "R.ASIS", ""), true).labels, ElementsAre("", "Left heel"));
}

TEST(TrcReader, DoesWithoutTheLineOfAxes) {
  const std::string text = With(kWalk, "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n", "");
  EXPECT_THAT(RepairOf(text), HasSubstr("no line 'X1 Y1 Z1 …'"));
  EXPECT_EQ(Parse(text), Parse(kWalk));
}

TEST(TrcReader, NeedsNoValueInTheHeader) {
  const TrcRecording trc =
      Parse(With(kWalk, "60.00\t120\t3\t2\tmm\t60.5\t5\t300\ttwo", "\t\t\t\t-"));
  EXPECT_EQ(trc.data_rate_hz, std::nullopt);
  EXPECT_EQ(trc.original_frame_count, std::nullopt);
  EXPECT_EQ(trc.units, "-");
  EXPECT_EQ(trc.frame_count(), 3);
}

TEST(TrcReader, RepairsAHeaderThatMakesNoSense) {
  EXPECT_THAT(RepairOf(With(kWalk, "60.00\t", "fast\t")), HasSubstr("not a rate: 'fast'"));
  EXPECT_THAT(RepairOf(With(kWalk, "60.00\t", "inf\t")), HasSubstr("not a rate: 'inf'"));
  EXPECT_THAT(RepairOf(With(kWalk, "\t3\t2\tmm", "\t3\t2.5\tmm")), HasSubstr("'2.5'"));
  EXPECT_THAT(RepairOf(With(kWalk, "\tHall", "")), HasSubstr("without a name: 'two'"));
  EXPECT_EQ(Parse(With(kWalk, "\t5\t300\t", "\t5.0\t300\t"), true), Parse(kWalk));
}

TEST(TrcReader, ReportsCountsThatAreNotThere) {
  const TrcRecording trc = Parse(With(kWalk, "\t3\t2\tmm", "\t2147483648\t99\tmm"), true);
  EXPECT_EQ(trc, Parse(kWalk));
  EXPECT_THAT(Messages(trc.diagnostics), ElementsAre("2147483648 frames are declared, 3 are there",
                                                     "99 markers are declared, 2 are there"));
}

TEST(TrcReader, ReportsTimesThatDoNotFitTheRate) {
  EXPECT_THAT(Messages(Parse(With(kWalk, "7\t0.1\t", "7\t0.2\t"), true).diagnostics),
              ElementsAre(HasSubstr("frame 7 has time 0.2 s, at 60 Hz it is 0.100333 s")));
}

TEST(TrcReader, ReportsFrameNumbersThatJumpAndRefusesThoseThatDoNotGrow) {
  EXPECT_THAT(Messages(Parse(With(kWalk, "7\t0.1\t", "9\t0.133\t")).diagnostics),
              ElementsAre(HasSubstr("frame 9 follows frame 6")));
  EXPECT_THAT(ErrorAt(With(kWalk, "7\t0.1\t", "6\t0.1\t"), "6\t0.1\t"),
              HasSubstr("frame 6 after frame 6"));
}

TEST(TrcReader, TakesEmptyFieldsAndNanForMissing) {
  const TrcRecording trc = Parse(Rows("1\t0\t\t\t\tNaN\t1.#QNAN\t3\n"), true);
  EXPECT_THAT(trc.values, AreValues({kNaN, kNaN, kNaN, kNaN, kNaN, 3}));
  EXPECT_THAT(Parse(Rows("1\t0\t1\t2\t3\t\t\t\n"), true).values,
              AreValues({1, 2, 3, kNaN, kNaN, kNaN}));
}

TEST(TrcReader, TakesAShortRowForMissingMarkersAtItsEnd) {
  const std::string text = Rows("1\t0\t1\t2\t3\n2\t0.0167\t1\t2\t3\t4\t5\t6\n");
  EXPECT_THAT(RepairOf(text), HasSubstr("3 columns of coordinates instead of 6"));
  EXPECT_THAT(Parse(text).values, AreValues({1, 2, 3, kNaN, kNaN, kNaN, 1, 2, 3, 4, 5, 6}));
}

TEST(TrcReader, RefusesARowThatDoesNotFitTheMarkers) {
  EXPECT_THAT(ErrorAt(Rows("1\t0\t1\t2\t3\t4\t5\n"), "1\t0\t1"),
              HasSubstr("frame 1 has 5 coordinates; expected 6, three for each of 2 markers"));
  EXPECT_THAT(ErrorAt(Rows("1\t0\t1\t2\t3\t4\t5\t6\t7\n"), "1\t0\t1"), HasSubstr("7 coordinates"));
  EXPECT_THAT(ErrorAt(Rows("1 0 1 2 3\n"), "1 0 1"), HasSubstr("3 coordinates"));
}

TEST(TrcReader, RefusesWhatIsNoNumber) {
  EXPECT_THAT(ErrorAt(Rows("1\t0\t1\t2\tthree\t4\t5\t6\n"), "three"), HasSubstr("'three'"));
  EXPECT_THAT(ErrorAt(Rows("1\tnow\t1\t2\t3\t4\t5\t6\n"), "now"), HasSubstr("time of frame 1"));
  EXPECT_THAT(ErrorAt(Rows("1\tnan\t1\t2\t3\t4\t5\t6\n"), "nan"), HasSubstr("time of frame 1"));
  EXPECT_THAT(ErrorAt(Rows("one\t0\t1\t2\t3\t4\t5\t6\n"), "one"), HasSubstr("number of a frame"));
  EXPECT_THAT(ErrorAt(Rows("1.5\t0\t1\t2\t3\t4\t5\t6\n"), "1.5"), HasSubstr("number of a frame"));
}

TEST(TrcReader, LeavesOutALastRowThatIsCutOff) {
  const std::string_view text = kWalk;
  const std::size_t last = text.find("7\t0.1");
  for (std::size_t size = last + 1; size + 5 < text.size(); ++size) {
    const TrcRecording trc = Parse(text.substr(0, size));
    EXPECT_EQ(trc.frame_count(), 2) << text.substr(last, size - last);
    (void)test::ErrorOf([&] { (void)Parse(text.substr(0, size), true); });
  }
  EXPECT_THAT(RepairOf(text.substr(0, text.size() - 1)), HasSubstr("may lack digits"));
  EXPECT_THAT(test::ErrorOf([] { (void)Parse(Rows("1\t0\t1\t2")); }).message(),
              HasSubstr("frame 1 is cut off"));
}

TEST(TrcReader, RefusesWhatIsNoTrc) {
  const auto message = [](std::string_view text) {
    return test::ErrorOf([&] { (void)Parse(text); }).message();
  };
  EXPECT_THAT(message(""), HasSubstr("is empty"));
  EXPECT_THAT(message("PathFile\n"), HasSubstr("expected 'PathFileType', found 'PathFile'"));
  EXPECT_THAT(message(std::string_view("P\0", 2)), HasSubstr("binary"));
  EXPECT_THAT(message("PathFileType\n"), HasSubstr("ends before the names of its header"));
  EXPECT_THAT(message("PathFileType\nDataRate\n"), HasSubstr("ends before the values"));
  EXPECT_THAT(message("PathFileType\nDataRate\n5\n"), HasSubstr("ends before the markers' names"));
  EXPECT_THAT(message("PathFileType\nDataRate\n5\nX Y\n"), HasSubstr("expected 'Frame#'"));
  EXPECT_THAT(message("PathFileType\nDataRate\n5\nFrame#\tTime\n"), HasSubstr("has no frames"));
  EXPECT_THAT(message("PathFileType\nDataRate\n5\nFrame#\tTime\n1\t0\n"),
              HasSubstr("names no markers"));
  EXPECT_THAT(message(With(kWalk, "\tZ2", "")), HasSubstr("5 columns of coordinates"));
  EXPECT_THAT(message(With(kWalk, "X1", "Time")), HasSubstr("expected 'X1'"));
  EXPECT_THAT(message(Rows("")), HasSubstr("has no frames"));
}

TEST(TrcReader, TakesFieldsOfAnyLength) {
  const std::string name(1 << 20, 'x');
  EXPECT_EQ(Parse(With(kWalk, "R.ASIS", name), true).labels[0], name);
  EXPECT_LT(ErrorAt(Rows("1\t0\t1\t2\t" + name + "\t4\t5\t6\n"), "xxx").size(), 200);
}

}  // namespace
}  // namespace kinebase
