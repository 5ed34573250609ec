// Each point of docs/formats/asf-amc.md about motion files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmt/format.h"
#include "formats/texts.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/amc.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using test::kArmAmc;
using test::LineOf;
using test::With;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

AmcMotion Parse(std::string_view text, bool strict = false) {
  return ParseAmc(text, "arm.amc", {.strict = strict});
}

// The error of a text, which must name the line that holds `part`.
std::string ErrorAt(std::string_view text, std::string_view part) {
  const Error error = test::ErrorOf([&] { (void)Parse(text); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.place().file, "arm.amc");
  EXPECT_EQ(error.place().line, LineOf(text, part)) << error.what();
  return error.message();
}

TEST(AmcReader, ReadsEveryField) {
  const AmcMotion amc = Parse(kArmAmc, true);
  EXPECT_THAT(amc.header, ElementsAre("# made up", ":FULLY-SPECIFIED", ":DEGREES"));
  EXPECT_EQ(amc.angle_unit, AmcAngleUnit::kDegrees);
  EXPECT_FALSE(amc.all_bones_have_three_dofs);
  EXPECT_THAT(amc.bones,
              ElementsAre(AmcBone{"root", 0, 6}, AmcBone{"upper", 6, 3}, AmcBone{"lower", 9, 1}));
  EXPECT_EQ(amc.bones[1].line, 6);
  EXPECT_EQ(amc.column_count, 10);
  EXPECT_THAT(amc.frame_numbers, ElementsAre(8, 9, 10, 11));
  EXPECT_THAT(amc.Frame(1), ElementsAre(0, 1.5, -2.5, 10, 20, 31, -20.25, 2.5, -19.5, 36.5));
  EXPECT_THAT(amc.remarks, IsEmpty());
  EXPECT_THAT(amc.diagnostics, IsEmpty());
}

// Frames like the first are read as a whole, others line by line.
TEST(AmcReader, ReadsFramesInTheOrderOfTheFirstAsItReadsOthers) {
  std::string same = ":DEGREES\n";
  std::string other = same;
  for (int frame = 1; frame <= 50; ++frame) {
    const std::string a = fmt::format("a {} -{}.25\n", frame, frame);
    const std::string ab = fmt::format("ab\t{}e-3  .5 \r\n", frame);
    same += fmt::format("{}\n{}{}", frame, a, ab);
    other += frame == 1 ? fmt::format("1\n{}{}", a, ab) : fmt::format("{} \n{}{}", frame, ab, a);
  }
  const AmcMotion motion = Parse(same, true);
  EXPECT_EQ(motion, Parse(other, true));
  EXPECT_EQ(motion.frame_count(), 50);
  EXPECT_THAT(motion.Frame(49), ElementsAre(50, -50.25, .05, .5));
  EXPECT_EQ(ErrorAt(same + "51\na 1 1\nab 1 x\n", "ab 1 x"),
            "a value of bone 'ab' is not a number: 'x'");
}

TEST(AmcReader, ReadsFrameNumbersAsFarAsTheyGo) {
  EXPECT_THAT(Parse("-1\na 1\n\n0\na 2\n").frame_numbers, ElementsAre(-1, 0));
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(Parse("9223372036854775806\na 1\n9223372036854775807\na 2\n").frame_numbers,
              ElementsAre(kLargest - 1, kLargest));
  EXPECT_THAT(ErrorAt("9223372036854775807\na 1\n-9223372036854775808\na 2\n", "-9"),
              HasSubstr("must grow"));
}

TEST(AmcReader, TakesAnyLineEndTabsBlanksAndAByteOrderMark) {
  const AmcMotion expected = Parse(kArmAmc);
  for (const char* ending : {"\r\n", "\r", "\n\n\n"}) {
    EXPECT_EQ(Parse("\xEF\xBB\xBF" + test::WithLineEnds(kArmAmc, ending), true), expected);
  }
  std::string blanks;
  for (const char c : kArmAmc.substr(kArmAmc.find("\n8\n"))) {
    blanks += c == ' ' ? "\t \f " : c == '\n' ? "\v \t\n  \t" : std::string(1, c);
  }
  EXPECT_EQ(Parse(blanks, true).values, expected.values);
}

TEST(AmcReader, TakesHeadersOfEveryKind) {
  const std::string frames = "1\nroot 1 2 3\n";
  EXPECT_EQ(Parse(frames).angle_unit, AmcAngleUnit::kUnstated);
  EXPECT_EQ(Parse(":radians\n" + frames).angle_unit, AmcAngleUnit::kRadians);
  EXPECT_EQ(Parse(":Degrees  \n" + frames).angle_unit, AmcAngleUnit::kDegrees);
  EXPECT_EQ(Parse(":FULLY-SPECIFIED :DEGREES # unit\n" + frames).angle_unit,
            AmcAngleUnit::kDegrees);
  EXPECT_EQ(Parse("# :RADIANS\n" + frames).angle_unit, AmcAngleUnit::kUnstated);
  EXPECT_TRUE(Parse(":FORCE-ALL-JOINTS-BE-3DOF\n" + frames).all_bones_have_three_dofs);
  EXPECT_THAT(Parse("#!OML:ASF Y:\\a b\n:SAMPLES-PER-SECOND 60\n" + frames).header,
              ElementsAre("#!OML:ASF Y:\\a b", ":SAMPLES-PER-SECOND 60"));
}

TEST(AmcReader, KeepsFrameNumbersThatDoNotStartAtOne) {
  EXPECT_THAT(Parse("-1\na 1\n0\na 2\n+1\na 3\n").frame_numbers, ElementsAre(-1, 0, 1));
}

TEST(AmcReader, ReportsFrameNumbersThatJump) {
  const AmcMotion amc = Parse("1\na 1\n2\na 2\n5\na 3\n");
  EXPECT_THAT(amc.frame_numbers, ElementsAre(1, 2, 5));
  ASSERT_EQ(amc.diagnostics.size(), 1);
  EXPECT_EQ(amc.diagnostics[0].line, 5);
  EXPECT_EQ(amc.diagnostics[0].severity, Severity::kWarning);
}

TEST(AmcReader, ReportsManyJumpsOnce) {
  const AmcMotion amc = Parse("1\na 1\n5\na 2\n9\na 3\n13\na 4\n");
  ASSERT_EQ(amc.diagnostics.size(), 1);
  EXPECT_EQ(amc.diagnostics[0].line, 3);
  EXPECT_THAT(amc.diagnostics[0].message, HasSubstr("and 2 more"));
}

TEST(AmcReader, RefusesFrameNumbersThatDoNotGrow) {
  EXPECT_THAT(ErrorAt(With(kArmAmc, "\n10\n", "\n9 \n"), "9 \n"),
              HasSubstr("frame 9 after frame 9"));
  (void)ErrorAt(With(kArmAmc, "\n10\n", "\n3\n"), "3\nroot 0 1.5 -3 ");
  (void)ErrorAt("9223372036854775807\na 1\n-9223372036854775808\na 1\n", "-9");
}

TEST(AmcReader, RefusesFrameNumbersThatAreNone) {
  for (const char* number :
       {"\n1.0e1\n", "\n10 x\n", "\n10 11\n", "\n-\n", "\n99999999999999999999\n"}) {
    const std::string text = With(kArmAmc, "\n10\n", number);
    (void)ErrorAt(text, std::string_view(number).substr(1));
  }
}

TEST(AmcReader, TakesBonesInAnyOrderInEachFrame) {
  const AmcMotion amc =
      Parse("1\na 1\nb 2 3\nc 4\n2\nc 8\na 5\nb 6 7\n3\na 9\nb 10 11\nc 12\n", true);
  EXPECT_THAT(amc.bones, ElementsAre(AmcBone{"a", 0, 1}, AmcBone{"b", 1, 2}, AmcBone{"c", 3, 1}));
  EXPECT_THAT(amc.values, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
}

TEST(AmcReader, TellsABoneFromOneWhoseNameBeginsTheSame) {
  const AmcMotion amc = Parse("1\nl 1\nlfoot 2\n2\nlfoot 4\nl 3\n", true);
  EXPECT_THAT(amc.values, ElementsAre(1, 2, 3, 4));
}

TEST(AmcReader, NamesTheFrameThatLacksABone) {
  const std::string text = With(kArmAmc, "upper -20.25 2.5 -19.5\n", "");
  EXPECT_EQ(ErrorAt(text, "9\nroot"), "frame 9 lacks bone 'upper'");
}

TEST(AmcReader, NamesABoneThatStandsTwice) {
  EXPECT_EQ(ErrorAt(With(kArmAmc, "lower 36.5\n", "lower 36.5\nupper 0 0 0\n"), "upper 0 0 0"),
            "bone 'upper' stands twice in frame 9");
  EXPECT_EQ(ErrorAt(With(kArmAmc, "lower 35\n", "lower 35\nroot 0\n"), "root 0\n"),
            "bone 'root' stands twice in frame 8");
}

TEST(AmcReader, NamesABoneWithAnotherNumberOfValues) {
  EXPECT_EQ(ErrorAt(With(kArmAmc, "lower 36.5", "lower 36.5 1"), "lower 36.5 1"),
            "bone 'lower' has 2 values; in the first frame it has 1");
  (void)ErrorAt(With(kArmAmc, "upper -20.25 2.5 -19.5", "upper -20.25 2.5"), "upper -20.25");
  (void)ErrorAt(With(kArmAmc, "lower 36.5", "lower"), "lower\n10");
  (void)ErrorAt(With(kArmAmc, "lower 35", "lower"), "lower\n9");
}

TEST(AmcReader, NamesABoneThatTheFirstFrameLacks) {
  EXPECT_EQ(ErrorAt(With(kArmAmc, "lower 36.5", "lowed 36.5"), "lowed"),
            "bone 'lowed' is not in the first frame");
}

TEST(AmcReader, RefusesValuesThatAreNoNumbers) {
  for (const char* value : {"3x", "--1", "+-1", "1,5", "1e400", "0x1F", "1e", "."}) {
    const std::string line = std::string("lower ") + value;
    EXPECT_THAT(ErrorAt(With(kArmAmc, "lower 36.5", line), line), HasSubstr(value));
    EXPECT_THAT(ErrorAt(With(kArmAmc, "lower 35", line), line), HasSubstr(value));
  }
}

TEST(AmcReader, TakesNumbersOfEveryForm) {
  const AmcMotion amc = Parse("1\na 1e-3 -2.5E+2 +1.5 -0 .5 5. 1e-400 -6.33626e-016\n", true);
  EXPECT_THAT(amc.values, ElementsAre(1e-3, -250, 1.5, 0, 0.5, 5, 0, -6.33626e-16));
  EXPECT_TRUE(std::signbit(amc.values[3]));
}

TEST(AmcReader, KeepsValuesThatAreNotFinite) {
  const AmcMotion amc = Parse("1\na nan NaN -nan inf -INF\n", true);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isnan(amc.values[i]));
  EXPECT_EQ(amc.values[3], std::numeric_limits<double>::infinity());
  EXPECT_EQ(amc.values[4], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(Parse(FormatAmc(amc)), amc);
}

TEST(AmcReader, KeepsCommentsBetweenFrames) {
  const std::string text = "1\na 1\n# one\n2\n  #two \na 2\n:LATE 3\n";
  const AmcMotion amc = Parse(text, true);
  EXPECT_THAT(amc.remarks,
              ElementsAre(AmcMotion::Remark{0, "# one"}, AmcMotion::Remark{1, "  #two "},
                          AmcMotion::Remark{1, ":LATE 3"}));
  EXPECT_THAT(amc.header, IsEmpty());
  EXPECT_EQ(Parse(FormatAmc(amc)), amc);
}

TEST(AmcReader, KeepsCommentsAtTheEndOfALine) {
  const AmcMotion amc = Parse("1 # start\na 1 2 # two\n2\na 3 4#four\n");
  EXPECT_THAT(amc.values, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(amc.remarks,
              ElementsAre(AmcMotion::Remark{0, "# start"}, AmcMotion::Remark{0, "# two"},
                          AmcMotion::Remark{1, "#four"}));
  EXPECT_EQ(Parse(FormatAmc(amc)), amc);
}

TEST(AmcReader, RefusesWhatIsNoMotion) {
  for (const std::string_view text :
       {std::string_view(""), std::string_view("\n\n \t\n"), std::string_view("\xEF\xBB\xBF"),
        std::string_view(":FULLY-SPECIFIED\n:DEGREES\n"), std::string_view("# only\n"),
        std::string_view("1\n"), std::string_view("1\n2\n"), std::string_view("1\nroot\n")}) {
    EXPECT_EQ(test::ErrorOf([&] { (void)Parse(text); }).code(), ErrorCode::kMalformedFile) << text;
  }
  EXPECT_THAT(ErrorAt("root 1 2 3\n", "root"), HasSubstr("'root 1 2 3'"));
  (void)ErrorAt(test::kArmAsf, "  mass");
}

TEST(AmcReader, RefusesBinaryFiles) {
  std::string every_byte;
  for (int i = 255; i >= 0; --i) every_byte += static_cast<char>(i);
  EXPECT_THROW((void)Parse(every_byte), Error);
  EXPECT_THAT(
      ErrorAt(With(kArmAmc, "lower 36.5", std::string_view("lower 36\0.5", 11)), "lower 36\x00"),
      HasSubstr("binary"));
  EXPECT_THAT(ErrorAt(With(kArmAmc, "lower 35", std::string_view("lo\0er 35", 8)), "35"),
              HasSubstr("binary"));
  EXPECT_THAT(ErrorAt(With(kArmAmc, "# made up", std::string_view("# \0", 3)), "# "),
              HasSubstr("binary"));
  EXPECT_THAT(ErrorAt(std::string(100, '\0'), ""), HasSubstr("binary"));
}

TEST(AmcReader, KeepsMessagesShortWhateverTheToken) {
  const std::string huge(2'000'000, 'x');
  for (const std::string& text :
       {huge, fmt::format("1\n{}", huge), fmt::format("1\na {}\n", huge),
        fmt::format("1\na 1\n2\n{} 1\n", huge), fmt::format("1\n{0} 1\n2\n{0} 1 2\n", huge),
        fmt::format("1\n{} 1\n2\n3\n", huge)}) {
    EXPECT_LT(test::ErrorOf([&] { (void)Parse(text); }).message().size(), 300);
  }
  const std::string digits = "1\na " + std::string(2'000'000, '1') + "\n";
  EXPECT_THROW((void)Parse(digits), Error);
  EXPECT_EQ(Parse("1\na 0." + std::string(2'000'000, '3') + "\n").values[0], 1.0 / 3);
}

TEST(AmcReader, ReadsPastAMillionBlankLines) {
  const std::string blank(1'000'000, '\n');
  EXPECT_EQ(Parse(With(kArmAmc, "lower 36.5\n", "lower 36.5" + blank), true), Parse(kArmAmc));
  const std::string carriage_returns(1'000'000, '\r');
  EXPECT_EQ(Parse(With(kArmAmc, "lower 36.5\n", "lower 36.5" + carriage_returns), true),
            Parse(kArmAmc));
}

TEST(AmcReader, ReadsFilesByName) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "größe 1.amc", kArmAmc);
  EXPECT_EQ(ReadAmc(folder.path() / "größe 1.amc"), Parse(kArmAmc));
  EXPECT_EQ(test::ErrorOf([&] { (void)ReadAmc(folder.path()); }).code(), ErrorCode::kIoFailure);
}

// A whole frame is one whose last line ends before the cut.
std::size_t WholeFrames(std::string_view text) {
  std::size_t frames = 0;
  for (const char* end : {"lower 35\n", "lower 36.5\n", "lower 37.25\n", "lower 38.125\n"}) {
    frames += text.find(end) != std::string_view::npos ? 1 : 0;
  }
  return frames;
}

TEST(AmcReader, KeepsTheFramesBeforeTheCutWhereverAFileIsCut) {
  const AmcMotion whole = Parse(kArmAmc);
  const std::size_t second_frame = kArmAmc.find("9\nroot");
  for (std::size_t length = second_frame; length < kArmAmc.size(); ++length) {
    const std::string_view text = kArmAmc.substr(0, length);
    SCOPED_TRACE(testing::Message() << length << " bytes");
    const std::size_t frames = WholeFrames(text);
    const AmcMotion cut = Parse(text);
    ASSERT_EQ(cut.bones, whole.bones);
    ASSERT_GE(cut.frame_count(), frames);
    for (std::size_t frame = 0; frame < frames; ++frame) {
      EXPECT_EQ(cut.frame_numbers[frame], whole.frame_numbers[frame]);
      EXPECT_TRUE(std::ranges::equal(cut.Frame(frame), whole.Frame(frame)));
    }
    if (cut.frame_count() == frames) continue;
    // A last line that may have lost digits of its value: all but that value is right, and said.
    ASSERT_EQ(cut.frame_count(), frames + 1);
    EXPECT_NE(text.back(), '\n');
    EXPECT_TRUE(std::ranges::equal(cut.Frame(frames).first(9), whole.Frame(frames).first(9)));
    ASSERT_EQ(cut.diagnostics.size(), 1);
    EXPECT_THAT(cut.diagnostics[0].message, HasSubstr("last line has no end"));
  }
}

TEST(AmcReader, SaysWhatACutCost) {
  for (std::size_t length = kArmAmc.find("9\nroot") + 1; length < kArmAmc.size(); ++length) {
    const std::string_view text = kArmAmc.substr(0, length);
    const bool between_frames = text.ends_with("lower 36.5\n") || text.ends_with("lower 37.25\n");
    EXPECT_EQ(Parse(text).diagnostics.size(), between_frames ? 0 : 1) << length;
  }
}

TEST(AmcReader, RefusesEveryCutWithinAFrameWhenStrict) {
  for (std::size_t length = kArmAmc.find("9\nroot") + 1; length < kArmAmc.size(); ++length) {
    const std::string_view text = kArmAmc.substr(0, length);
    if (text.ends_with("lower 36.5\n") || text.ends_with("lower 37.25\n")) {
      EXPECT_EQ(Parse(text, true), Parse(text));
    } else {
      EXPECT_THROW((void)Parse(text, true), Error) << length;
    }
  }
}

TEST(AmcReader, SaysWhyItIsStrict) {
  const auto refusal = [](std::string_view text) {
    return test::ErrorOf([&] { (void)Parse(text, true); });
  };
  const Error dropped = refusal("1\na 1\nb 1\n2\na 2\n");
  EXPECT_EQ(dropped.place().line, 4);
  EXPECT_THAT(dropped.message(), HasSubstr("the last frame, 2, is cut off"));
  EXPECT_THAT(refusal("1\na 1\n2\na 2").message(), HasSubstr("its last line has no end"));
}

TEST(AmcReader, EndsWithAFrameOrAnErrorWhereverTheFirstFrameIsCut) {
  for (std::size_t length = 0; length <= kArmAmc.find("9\nroot"); ++length) {
    try {
      EXPECT_EQ(Parse(kArmAmc.substr(0, length)).frame_count(), 1);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    }
  }
}

TEST(AmcReader, KeepsTheOnlyFrameBeforeACutFrameNumber) {
  const AmcMotion amc = Parse("10\na 1\n1");
  EXPECT_THAT(amc.frame_numbers, ElementsAre(10));
  EXPECT_EQ(amc.diagnostics.size(), 1);
}

TEST(AmcReader, RefusesANonsensicalLineThatDoesEnd) {
  (void)ErrorAt(std::string(kArmAmc) + "hand\n", "hand");
  EXPECT_EQ(Parse(std::string(kArmAmc) + "han"), Parse(kArmAmc));
}

}  // namespace
}  // namespace kinebase
