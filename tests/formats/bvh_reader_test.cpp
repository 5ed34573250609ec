// Each point of docs/formats/bvh.md about the file as it stands.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "fmt/format.h"
#include "formats/bvh_texts.h"
#include "formats/texts.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/bvh.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using test::kArmBvh;
using test::LineOf;
using test::With;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using enum BvhChannel;

BvhMotion Parse(std::string_view text, bool strict = false) {
  return ParseBvh(text, "arm.bvh", {.strict = strict});
}

Error ErrorOf(std::string_view text, bool strict = false) {
  return test::ErrorOf([&] { (void)Parse(text, strict); });
}

// A hierarchy of one joint with a channel, and what follows `MOTION`.
std::string OneJoint(std::string_view motion) {
  return fmt::format("HIERARCHY\nROOT a\n{{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}}\nMOTION\n{}",
                     motion);
}

TEST(BvhReader, ReadsEveryField) {
  const BvhMotion bvh = Parse(kArmBvh, true);
  ASSERT_EQ(bvh.joints.size(), 3);
  const BvhJoint& root = bvh.joints[0];
  EXPECT_EQ(root.name, "Base Plate");
  EXPECT_EQ(root.parent, -1);
  EXPECT_THAT(root.channels,
              ElementsAre(kXPosition, kYPosition, kZPosition, kZRotation, kXRotation, kYRotation));
  EXPECT_EQ(root.line, 2);
  const BvhJoint& upper = bvh.joints[1];
  EXPECT_EQ(upper.name, "rig:Upper");
  EXPECT_EQ(upper.parent, 0);
  EXPECT_THAT(upper.offset, ElementsAre(0, 10, 0));
  EXPECT_EQ(upper.first_column, 6);
  ASSERT_EQ(upper.end_sites.size(), 1);
  EXPECT_EQ(upper.end_sites[0].name, "Site");
  EXPECT_THAT(upper.end_sites[0].offset, ElementsAre(0, 5.5, 0));
  const BvhJoint& slide = bvh.joints[2];
  EXPECT_EQ(slide.parent, 0);
  EXPECT_THAT(slide.channels, ElementsAre(kXPosition));
  EXPECT_THAT(slide.end_sites, IsEmpty());
  EXPECT_EQ(bvh.column_count, 10);
  EXPECT_EQ(bvh.declared_frame_count, 3);
  EXPECT_EQ(bvh.frame_time_text, "0.0083333");
  EXPECT_EQ(bvh.frame_time_s, 0.0083333);
  ASSERT_EQ(bvh.frame_count(), 3);
  EXPECT_THAT(bvh.Frame(1), ElementsAre(1.5, 2.5, 3.5, 11, 21, 31, 41, 51, 61, 7.5));
  EXPECT_THAT(bvh.diagnostics, IsEmpty());
}

TEST(BvhReader, TakesAnyLineEndTabsBlanksCaseAndAByteOrderMark) {
  const BvhMotion expected = Parse(kArmBvh);
  for (const char* ending : {"\r\n", "\r", "\n\n\n", " \t\n"}) {
    EXPECT_EQ(Parse("\xEF\xBB\xBF" + test::WithLineEnds(kArmBvh, ending)), expected);
  }
  std::string other(kArmBvh);
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"HIERARCHY", "hierarchy"},
                                                        {"ROOT", "Root\t"},
                                                        {"Frames:", "FRAMES : "},
                                                        {"Frame Time:", "frame\ttime:"},
                                                        {"MOTION", "Motion  "},
                                                        {"End Site", "END Site"},
                                                        {"OFFSET 3 0 -1", "offset\t3.0   0e5\t-1"},
                                                        {"1 Xposition", "1 xPOSITION"}}) {
    other = With(other, from, to);
  }
  EXPECT_EQ(Parse(other, true), expected);
}

TEST(BvhReader, TakesBracesOnAnyLine) {
  std::string text;
  const std::string_view hierarchy = kArmBvh.substr(0, kArmBvh.find("MOTION"));
  for (const char c : hierarchy) text += c == '\n' && text.back() != '}' ? ' ' : c;
  // All but the closing braces are now on one line; names still end before a brace.
  text = With(text, "ROOT Base Plate {", "ROOT Base Plate{");
  EXPECT_EQ(Parse(text + "\nMOTION" + std::string(kArmBvh.substr(kArmBvh.find("\nFrames:")))),
            Parse(kArmBvh));
}

TEST(BvhReader, ReadsSeveralRoots) {
  const BvhMotion bvh = Parse(With(OneJoint("Frames: 1\nFrame Time: .1\n1 2\n"), "MOTION",
                                   "ROOT b\n{\nOFFSET 1 2 3\nCHANNELS 1 Zposition\n}\nMOTION"),
                              true);
  ASSERT_EQ(bvh.joints.size(), 2);
  EXPECT_EQ(bvh.joints[1].parent, -1);
  EXPECT_EQ(bvh.joints[1].first_column, 1);
}

TEST(BvhReader, KeepsTheRowsWhereTheFrameCountDiffers) {
  for (const char* count : {"Frames: 2", "Frames: 4000000000000"}) {
    const std::string text = With(kArmBvh, "Frames: 3", count);
    const BvhMotion bvh = Parse(text);
    EXPECT_EQ(bvh.frame_count(), 3);
    ASSERT_EQ(bvh.diagnostics.size(), 1);
    EXPECT_EQ(bvh.diagnostics[0].line, LineOf(text, count));
    EXPECT_THAT(ErrorOf(text, true).message(), HasSubstr("3 rows"));
  }
}

TEST(BvhReader, KeepsLinesThatItDoesNotUnderstand) {
  std::string text = With(kArmBvh, "\tOFFSET 3 0 -1\n", "\tOFFSET 3 0 -1\n  Colour  red blue \n");
  text = With(text, "\tOFFSET 0 5.5 0\n", "\tCHANNELS 0\n\tOFFSET 0 5.5 0\n");
  text = With(text, "Frame Time", "Interpolation: linear\nFrame Time");
  const BvhMotion bvh = Parse(text);
  EXPECT_THAT(bvh.joints[2].unknown, ElementsAre("Colour  red blue"));
  EXPECT_THAT(bvh.joints[1].end_sites[0].unknown, ElementsAre("CHANNELS 0"));
  EXPECT_THAT(bvh.unknown, ElementsAre("Interpolation: linear"));
  ASSERT_EQ(bvh.diagnostics.size(), 1);
  EXPECT_THAT(bvh.diagnostics[0].message, HasSubstr("'Colour  red blue' and 1 more"));
  EXPECT_EQ(Parse(FormatBvh(bvh)), bvh);
}

TEST(BvhReader, DoesWithoutFrameCountAndFrameTime) {
  const BvhMotion bvh = Parse(OneJoint("1\n2\n"));
  EXPECT_EQ(bvh.frame_count(), 2);
  EXPECT_EQ(bvh.declared_frame_count, std::nullopt);
  EXPECT_EQ(bvh.frame_time_s, 0);
  EXPECT_EQ(bvh.diagnostics.size(), 2);
  for (const char* time : {"0", "-0.01", "nan", "inf"}) {
    const BvhMotion timeless = Parse(OneJoint(fmt::format("Frames: 1\nFrame Time: {}\n1\n", time)));
    EXPECT_EQ(timeless.frame_time_s, 0);
    EXPECT_EQ(timeless.frame_time_text, time);
    ASSERT_EQ(timeless.diagnostics.size(), 1);
    EXPECT_EQ(timeless.diagnostics[0].line, 9);
  }
}

TEST(BvhReader, TakesRowsThatAreSpreadOverLines) {
  const BvhMotion bvh = Parse(With(With(kArmBvh, "3 10 20", "3\n10 20"), "3 4 12", "3\n\n4\n12"));
  EXPECT_EQ(bvh, Parse(kArmBvh));
  ASSERT_EQ(bvh.diagnostics.size(), 1);
  EXPECT_THAT(bvh.diagnostics[0].message, HasSubstr("2 frames"));
}

TEST(BvhReader, TakesNumbersOfEveryForm) {
  const BvhMotion bvh =
      Parse(OneJoint("Frames: 9\nFrame Time: .1\n1e-3\n-2.5E+2\n+1.5\n-0\n.5\n5.\n"
                     "1e-400\nnan\n-inf\n"),
            true);
  EXPECT_THAT(std::vector<double>(bvh.values.begin(), bvh.values.begin() + 7),
              ElementsAre(1e-3, -250, 1.5, 0, 0.5, 5, 0));
  EXPECT_TRUE(std::isnan(bvh.values[7]));
  EXPECT_EQ(bvh.values[8], -std::numeric_limits<double>::infinity());
}

TEST(BvhReader, KeepsTheFramesBeforeTheCutWhereverAFileIsCut) {
  const BvhMotion whole = Parse(kArmBvh);
  const std::size_t second_row = kArmBvh.find("1.5 2.5");
  const std::size_t third_row = kArmBvh.find("-2 3 4");
  for (std::size_t length = second_row; length < kArmBvh.size(); ++length) {
    SCOPED_TRACE(testing::Message() << length << " bytes");
    const BvhMotion cut = Parse(kArmBvh.substr(0, length));
    const std::size_t rows = length < third_row - 1 ? 1 : 2;
    ASSERT_GE(cut.frame_count(), rows);
    EXPECT_EQ(cut.joints, whole.joints);
    for (std::size_t i = 0; i < rows; ++i) {
      // Of a row that lacks its end alone the last value may have lost digits; that is said.
      EXPECT_EQ(cut.Frame(i)[3], whole.Frame(i)[3]);
    }
    EXPECT_FALSE(cut.diagnostics.empty());
    EXPECT_THROW((void)Parse(kArmBvh.substr(0, length), true), Error);
  }
}

TEST(BvhReader, NamesWhatIsWrongAndWhere) {
  const std::string one = OneJoint("Frames: 1\nFrame Time: .1\n1\n");
  // The text, a part of the line that the error names, a part of its message.
  const std::vector<std::tuple<std::string, std::string, std::string>> table = {
      {"", "", "empty"},
      {"\n \t\n", "", "HIERARCHY"},
      {"MOTION\n", "MOTION", "'HIERARCHY'"},
      {With(one, "ROOT a\n", "LEAF a\n"), "LEAF", "'ROOT' or 'MOTION', found 'LEAF a'"},
      {With(one, "{\n", "OFFSET 0 0 0\n{\n"), "OFFSET", "expected '{'"},
      {With(one, "ROOT a\n", ""), "{", "without 'ROOT'"},
      {With(one, "}\n", "}\n}\n"), "}\nMOTION", "'}' without"},
      {With(one, "}\n", ""), "ROOT", "not closed with '}' before 'MOTION'"},
      {With(one, "OFFSET 0 0 0\n", ""), "}", "joint 'a' has no 'OFFSET'"},
      {With(one, "OFFSET 0 0 0", "OFFSET 0 0"), "OFFSET", "three numbers"},
      {With(one, "OFFSET 0 0 0", "OFFSET 0 0 x"), "OFFSET", "found 'x'"},
      {With(one, "OFFSET 0 0 0", "OFFSET 0 0 inf"), "OFFSET", "found 'inf'"},
      {With(one, "CHANNELS 1", "OFFSET 0 0 0\nCHANNELS 1"), "OFFSET 0 0 0\nCH", "second 'OFFSET'"},
      {With(one, "CHANNELS 1", "CHANNELS -1"), "CHANNELS", "number of channels"},
      {With(one, "CHANNELS 1", "CHANNELS 999999999999"), "CHANNELS", "has 1 channels"},
      {With(one, "CHANNELS 1", "CHANNELS 1 Yrotation"), "CHANNELS", "more channels than the 1"},
      {With(one, "Xrotation", "Wrotation"), "CHANNELS", "found 'Wrotation'"},
      {With(one, "CHANNELS 1 Xrotation\n", ""), "MOTION", "no joint has channels"},
      {With(one, "}\n", "JOINT b {OFFSET 0 0 0\n}\nCHANNELS 0\n}\n"), "CHANNELS 0",
       "second 'CHANNELS'"},
      {With(kArmBvh, "OFFSET 0 5.5 0", "OFFSET 0 5.5 0 JOINT x {"), "OFFSET 0 5.5", "'End Site'"},
      {With(kArmBvh, "OFFSET 0 5.5 0", "CHANNELS 3 Xrotation Yrotation Zrotation"), "CHANNELS 3 Xr",
       "cannot have channels"},
      {With(kArmBvh, "OFFSET 0 5.5 0\n", ""), "\t\t}\n\t}\n\tJOINT Slide", "'End Site' of joint"},
      {With(one, "MOTION\n", ""), "Frames", "'ROOT' or 'MOTION'"},
      {one.substr(0, one.find("MOTION")), "", "ends without 'MOTION'"},
      {With(one, "Frames: 1", "Frames: x"), "Frames", "whole number"},
      {With(one, "Frames: 1", "Frames: -1"), "Frames", "whole number"},
      {With(one, "Frames: 1", "Frames: 1\nFrames: 1"), "Frames: 1\nFrame ", "second 'Frames:'"},
      {With(one, "Time: .1", "Time: 0,1"), "Frame Time", "seconds of a frame"},
      {With(one, "\n1\n", "\n"), "", "has no frames"},
      {With(one, "\n1\n", "\n1 2\n"), "1 2", "frame 1 has 2 values; the joints have 1 channels"},
      {With(one, "\n1\n", "\n1\n2\nx\n4\n"), "x\n4", "expected a number, found 'x'"},
      {With(one, "\n1\n", "\n1\n2\n1,5\n"), "1,5", "found '1,5'"},
      {With(one, "\n1\n", "\n1\n2\n1e999\n"), "1e999", "found '1e999'"},
      {With(kArmBvh, "7\n1.5", "\n1.5"), "1 2 3 10",
       "frame 1 has 9 values, 19 with those of line 25; the joints have 10 channels"},
      {With(one, "\n1\n", std::string_view("\n1\n\0\n", 5)), std::string("\0\n", 2), "binary"},
      {std::string(100, '\1'), "\1", "binary"},
  };
  for (const auto& [text, place, message] : table) {
    SCOPED_TRACE(message);
    const Error error = ErrorOf(text);
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    EXPECT_EQ(error.place().file, "arm.bvh");
    EXPECT_THAT(error.message(), HasSubstr(message));
    if (!place.empty()) {
      EXPECT_EQ(error.place().line, LineOf(text, place)) << error.what();
    }
  }
}

TEST(BvhReader, KeepsMessagesShortWhateverTheToken) {
  const std::string huge(2'000'000, 'x');
  for (const std::string& text :
       {huge, With(kArmBvh, "Xposition\n", huge + "\n"),
        With(kArmBvh, "OFFSET 3", "OFFSET " + huge),
        With(With(kArmBvh, "Slide", huge), "OFFSET 3 0 -1", ""), With(kArmBvh, "2.5 3.5", huge)}) {
    EXPECT_LT(ErrorOf(text).message().size(), 300);
  }
}

TEST(BvhReader, ReadsAndWritesDeepTrees) {
  constexpr int kDepth = 100'000;
  std::string text = "HIERARCHY\n";
  for (int i = 0; i < kDepth; ++i)
    text += i == 0 ? "ROOT a{OFFSET 0 0 0\n" : "JOINT a{OFFSET 0 0 0\n";
  text = With(text, "ROOT a{", "ROOT a{CHANNELS 1 Xrotation ");
  text += std::string(kDepth, '}') + "\nMOTION\nFrames: 1\nFrame Time: .1\n1\n";
  const BvhMotion bvh = Parse(text, true);
  ASSERT_EQ(bvh.joints.size(), kDepth);
  const std::string written = FormatBvh(bvh);
  EXPECT_LT(written.size(), kDepth * 200);
  EXPECT_EQ(Parse(written), bvh);
}

TEST(BvhReader, ReadsFilesByName) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "größe 1.bvh", kArmBvh);
  const BvhMotion bvh = ReadBvh(folder.path() / "größe 1.bvh");
  EXPECT_EQ(bvh, Parse(kArmBvh));
  EXPECT_EQ(bvh.file_name, "größe 1.bvh");
  EXPECT_EQ(test::ErrorOf([&] { (void)ReadBvh(folder.path() / "none.bvh"); }).code(),
            ErrorCode::kNotFound);
}

TEST(SnapRate, FindsTheRateBehindARoundedTime) {
  for (const auto& [time, rate] :
       std::vector<std::pair<double, double>>{{0.0083333, 120},
                                              {.008333, 120},
                                              {0.00833333333, 120},
                                              {0.033333, 30},
                                              {0.0333, 30},
                                              {0.016667, 60},
                                              {0.01, 100},
                                              {0.04, 25},
                                              {0.08, 12.5},
                                              {0.041667, 24},
                                              {0.0417, 24},
                                              {0.0417083750417, 24000.0 / 1001},
                                              {0.041708, 24000.0 / 1001},
                                              {0.033367, 30000.0 / 1001},
                                              {0.0166833, 60000.0 / 1001},
                                              {0.002, 500},
                                              {1, 1}}) {
    EXPECT_DOUBLE_EQ(SnapRate(time), rate) << time;
  }
  EXPECT_DOUBLE_EQ(SnapRate(0.033), 1 / 0.033);    // 1 % from 30.
  EXPECT_DOUBLE_EQ(SnapRate(0.0167), 1 / 0.0167);  // .2 % from 60.
}

}  // namespace
}  // namespace kinebase
