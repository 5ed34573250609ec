// What stands in a C3D file, trap by trap, against files that were put together by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "formats/c3d_bytes.h"
#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

using test::ErrorOf;
using test::RawC3d;
using test::TwoFrames;

bool HasDiagnostic(const C3dRecording& c3d, std::string_view part) {
  for (const Diagnostic& each : c3d.diagnostics) {
    if (each.message.find(part) != std::string::npos) return true;
  }
  return false;
}

// One point that counts its frames in x.
RawC3d Counting(int frames) {
  RawC3d raw;
  for (int i = 1; i <= frames; ++i) raw.points.push_back({static_cast<double>(i), 0, 0, 0});
  return raw;
}

class C3dFlavours : public testing::TestWithParam<std::tuple<C3dProcessor, bool>> {};

TEST_P(C3dFlavours, AreReadAlike) {
  const auto [processor, is_float] = GetParam();
  RawC3d raw = TwoFrames(processor, is_float);
  raw.AddUsualParameters();
  raw.Texts(1, "LABELS", 6, {"A:LFHD", "RFHD"});
  raw.Reals(2, "SCALE", {2}, {.25, -3});
  raw.Integers(2, "OFFSET", {2}, {1, -1});
  const test::C3dNumbers n = raw.numbers();
  raw.events = n.Word(0) + n.Word(0) + n.Word(12345) + n.Word(1) + n.Word(0) + n.Real(.01);
  raw.events.resize(376 - 294);
  raw.events += '\1';
  raw.events.resize(396 - 294);
  raw.events += "RHS ";

  const C3dRecording c3d = ParseC3d(raw.Bytes(), "raw.c3d");
  EXPECT_EQ(c3d.processor, processor);
  EXPECT_EQ(c3d.storage, is_float ? C3dStorage::kFloat : C3dStorage::kInteger);
  EXPECT_EQ(c3d.scale, .5F);
  EXPECT_EQ(c3d.rate_hz, 100.F);
  EXPECT_EQ(c3d.first_frame, 11);
  EXPECT_EQ(c3d.last_frame(), 12);
  EXPECT_EQ(c3d.max_gap, 7);
  const std::vector<C3dPoint> expected = {
      {1, -2.5, 1000, 0x0503}, {0, 0, 0, -1}, {1.5, -3, 1001, 0}, {-.5, 7, 8, 1}};
  EXPECT_EQ(c3d.points, expected);
  EXPECT_EQ(c3d.analog, (std::vector<float>{1, -2, 3, -4, 5, -6, 7, -8}));
  EXPECT_EQ(PointLabels(c3d), (std::vector<std::string>{"A:LFHD", "RFHD"}));
  EXPECT_EQ(ScaledAnalog(c3d), (std::vector<double>{0, 3, .5, 9, 1, 15, 1.5, 21}));
  ASSERT_EQ(c3d.header_events.size(), 1);
  EXPECT_EQ(c3d.header_events[0], (C3dHeaderEvent{.label = "RHS", .time_s = .01F}));
  EXPECT_TRUE(c3d.diagnostics.empty()) << c3d.diagnostics[0].message;
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d"), c3d);
}

INSTANTIATE_TEST_SUITE_P(All, C3dFlavours,
                         testing::Combine(testing::Values(C3dProcessor::kIntel, C3dProcessor::kDec,
                                                          C3dProcessor::kMips),
                                          testing::Bool()));

TEST(C3dReader, KnowsTheFloatsOfDec) {
  RawC3d raw;
  raw.processor = C3dProcessor::kDec;
  raw.points = {{}, {}};
  raw.AddUsualParameters();
  std::string bytes = raw.Bytes();
  // From the VAX Architecture Reference Manual: 1 is 4080 0000, .5 is 4000 0000, -12.5 is C248
  // 0000; a sign without an exponent is no number; the last two are the largest and the smallest.
  const std::string words = {
      '\x80', '\x40', 0,      0,      0,      '\x40', 0, 0, '\x48', '\xC2', 0, 0, 0, '\x80', 0, 0,
      '\xff', '\x7f', '\xff', '\xff', '\x80', 0,      0, 0, 0,      0,      0, 0, 0, 0,      0, 0};
  bytes.replace(bytes.size() - words.size(), words.size(), words);
  const C3dRecording c3d = ParseC3d(bytes, "dec.c3d");
  EXPECT_EQ(c3d.points[0].x, 1.F);
  EXPECT_EQ(c3d.points[0].y, .5F);
  EXPECT_EQ(c3d.points[0].z, -12.5F);
  EXPECT_TRUE(std::isnan(c3d.points[0].quality));
  EXPECT_EQ(c3d.points[1].x, std::ldexp(1 - std::ldexp(1.F, -24), 127));
  EXPECT_EQ(c3d.points[1].y, std::ldexp(1.F, -128));
  EXPECT_EQ(c3d.points[1].z, 0.F);
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d"), c3d);
}

TEST(C3dPoint, TellsResidualAndCamerasByItsQuality) {
  const C3dPoint seen{1, 2, 3, 0x7f05};
  EXPECT_TRUE(seen.is_valid());
  EXPECT_EQ(seen.residual_steps(), 5);
  EXPECT_EQ(seen.camera_mask(), 0x7f);
  EXPECT_TRUE((C3dPoint{1, 2, 3, 0}).is_valid());
  EXPECT_TRUE((C3dPoint{1, 2, 3, .75F}).is_valid());
  EXPECT_FALSE((C3dPoint{1, 2, 3, -1}).is_valid());
  EXPECT_FALSE((C3dPoint{1, 2, 3, 65535}).is_valid()) << "-1 of 16 bits, taken for unsigned";
  EXPECT_FALSE((C3dPoint{1, 2, 3, std::nanf("")}).is_valid());
  EXPECT_FALSE((C3dPoint{1, 2, 3, INFINITY}).is_valid());
}

TEST(C3dReader, TakesFrameCountsAsUnsigned) {
  RawC3d raw = Counting(40000);
  raw.AddUsualParameters();
  const C3dRecording c3d = ParseC3d(raw.Bytes(), "raw.c3d");
  EXPECT_EQ(c3d.frame_count, 40000);
  EXPECT_EQ(c3d.points.back().x, 40000.F);
  EXPECT_TRUE(c3d.diagnostics.empty());
}

// What tells the number of frames when 16 bits do not, by the writers that do it so.
struct ManyFramesCase {
  std::string_view name;
  void (*add)(RawC3d& raw);
};
constexpr int kMany = 70000;

class C3dManyFrames : public testing::TestWithParam<ManyFramesCase> {};

TEST_P(C3dManyFrames, AreAllRead) {
  RawC3d raw = Counting(kMany);
  raw.last_frame = 65535;
  raw.Group(1, "POINT");
  raw.Integer(1, "USED", 1);
  raw.Group(3, "TRIAL");
  GetParam().add(raw);
  const C3dRecording c3d = ParseC3d(raw.Bytes(), "many.c3d");
  EXPECT_EQ(c3d.frame_count, kMany);
  EXPECT_EQ(c3d.first_frame, 1);
  EXPECT_EQ(c3d.points.back().x, static_cast<float>(kMany));
  EXPECT_TRUE(c3d.diagnostics.empty()) << c3d.diagnostics[0].message;
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d"), c3d);
}

void AddTrial(RawC3d& raw) {
  raw.Integers(3, "ACTUAL_START_FIELD", {2}, {1, 0});
  raw.Integers(3, "ACTUAL_END_FIELD", {2}, {kMany & 0xffff, kMany >> 16});
}

INSTANTIATE_TEST_SUITE_P(All, C3dManyFrames,
                         testing::Values(ManyFramesCase{"LongFrames",
                                                        [](RawC3d& raw) {
                                                          raw.Integer(1, "FRAMES", 65535);
                                                          raw.Real(1, "LONG_FRAMES", kMany);
                                                        }},
                                         ManyFramesCase{"Trial",
                                                        [](RawC3d& raw) {
                                                          raw.Integer(1, "FRAMES", 65535);
                                                          AddTrial(raw);
                                                        }},
                                         ManyFramesCase{"OverflownFramesAndTrial",
                                                        [](RawC3d& raw) {
                                                          raw.Integer(1, "FRAMES", kMany & 0xffff);
                                                          AddTrial(raw);
                                                        }},
                                         ManyFramesCase{
                                             "FramesAsFloat",
                                             [](RawC3d& raw) { raw.Real(1, "FRAMES", kMany); }}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(C3dReader, TakesAFirstFrameBeyond16BitsFromTrial) {
  RawC3d raw = Counting(3);
  raw.first_frame = 65535;
  raw.last_frame = 65535;
  raw.AddUsualParameters();
  raw.Group(3, "TRIAL");
  raw.Integers(3, "ACTUAL_START_FIELD", {2}, {4464, 1});
  raw.Integers(3, "ACTUAL_END_FIELD", {2}, {4466, 1});
  const C3dRecording c3d = ParseC3d(raw.Bytes(), "late.c3d");
  EXPECT_EQ(c3d.first_frame, 70000);
  EXPECT_EQ(c3d.frame_count, 3);
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d"), c3d);
}

TEST(C3dReader, LetsTheParametersRuleOverTheHeader) {
  RawC3d raw = TwoFrames();
  raw.AddUsualParameters();
  std::string bytes = raw.Bytes();
  bytes.replace(2, 2, raw.numbers().Word(1));   // Points.
  bytes.replace(4, 2, raw.numbers().Word(2));   // Samples.
  bytes.replace(8, 2, raw.numbers().Word(11));  // Last frame.
  bytes.replace(20, 4, raw.numbers().Real(50));
  const C3dRecording c3d = ParseC3d(bytes, "raw.c3d");
  EXPECT_EQ(c3d.points.size(), 4);
  EXPECT_EQ(c3d.analog.size(), 8);
  EXPECT_EQ(c3d.rate_hz, 100.F);
  EXPECT_TRUE(HasDiagnostic(c3d, "the header 1; the parameter is taken"));
  EXPECT_TRUE(HasDiagnostic(c3d, "POINT:RATE is 100 Hz, the header says 50 Hz"));
  EXPECT_TRUE(HasDiagnostic(c3d, "the parameters are taken"));
}

TEST(C3dReader, LetsTheHeaderRuleWhereTheFileIsTooShortForTheParameters) {
  RawC3d raw = Counting(4);
  raw.Group(1, "POINT");
  raw.Integer(1, "USED", 1);
  raw.Integer(1, "FRAMES", 5);
  const C3dRecording c3d = ParseC3d(raw.Bytes(), "raw.c3d");
  EXPECT_EQ(c3d.frame_count, 4);
  EXPECT_TRUE(HasDiagnostic(c3d, "POINT:FRAMES says 5 frames, for which the file is too short"));
  EXPECT_EQ(FindParameter(c3d, "point", "frames")->Number(), 4) << "says what is so";
}

TEST(C3dReader, TakesTheScaleFromTheHeader) {
  RawC3d raw = Counting(2);
  raw.is_float = false;
  raw.Group(1, "POINT");
  raw.Real(1, "SCALE", .125);
  const C3dRecording c3d = ParseC3d(raw.Bytes(), "raw.c3d");
  EXPECT_EQ(c3d.points[1].x, 2.F);
  EXPECT_TRUE(HasDiagnostic(c3d, "POINT:SCALE is 0.125, the header says 0.5"));
}

TEST(C3dReader, DoesWithoutParameters) {
  RawC3d raw = TwoFrames();
  const C3dRecording c3d = ParseC3d(raw.Bytes(), "bare.c3d");
  EXPECT_EQ(c3d.points.size(), 4);
  EXPECT_EQ(c3d.channel_count, 2);
  EXPECT_EQ(c3d.subframe_count, 2);
  EXPECT_EQ(PointLabels(c3d), (std::vector<std::string>{"", ""}));
  EXPECT_TRUE(HasDiagnostic(c3d, "has no parameters"));
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d"), c3d);
}

TEST(C3dReader, NeverReadsOnBehindTheLastFrame) {
  RawC3d raw = Counting(2);
  raw.AddUsualParameters();
  raw.behind = std::string(600, 'x') + std::string(100, '\0');
  const C3dRecording c3d = ParseC3d(raw.Bytes(), "raw.c3d");
  EXPECT_EQ(c3d.frame_count, 2);
  EXPECT_EQ(c3d.trailing, std::string(600, 'x'));
  EXPECT_TRUE(HasDiagnostic(c3d, "600 bytes follow the last frame"));
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d").trailing, c3d.trailing);
}

TEST(C3dReader, KeepsTheFramesOfAFileThatIsCutOff) {
  RawC3d raw = Counting(10);
  raw.AddUsualParameters();
  std::string bytes = raw.Bytes();
  bytes.resize(bytes.size() - 5);
  const C3dRecording c3d = ParseC3d(bytes, "cut.c3d");
  EXPECT_EQ(c3d.frame_count, 9);
  EXPECT_TRUE(HasDiagnostic(c3d, "is cut off: 9 frames of 10 are there"));
  const Error error = ErrorOf([&] { (void)ParseC3d(bytes, "cut.c3d", {.strict = true}); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.place().byte, static_cast<std::int64_t>(bytes.size()));
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d", {.strict = true}), c3d);
}

TEST(C3dReader, ReadsDataThatStandBeforeTheParameters) {
  RawC3d raw = Counting(3);
  raw.AddUsualParameters();
  const std::string whole = raw.Bytes();
  raw.parameter_block = 3;
  raw.data_block = 2;
  std::string data = raw.Data();
  data.resize(512);
  const std::string bytes = raw.Header(2) + data + whole.substr(512, whole.size() - 512 - 48);
  const C3dRecording c3d = ParseC3d(bytes, "turned.c3d");
  EXPECT_EQ(c3d.frame_count, 3);
  EXPECT_EQ(c3d.points[2].x, 3.F);
  EXPECT_NE(FindParameter(c3d, "ANALOG", "USED"), nullptr);
  EXPECT_TRUE(c3d.trailing.empty());
}

TEST(C3dReader, FindsSubframesByTheRatesWhereTheHeaderIsWrong) {
  RawC3d raw = TwoFrames();
  raw.AddUsualParameters();
  std::string bytes = raw.Bytes();
  bytes.replace(4, 2, raw.numbers().Word(2));  // Channels in the place of all samples.
  bytes.replace(18, 2, raw.numbers().Word(9));
  const C3dRecording c3d = ParseC3d(bytes, "raw.c3d");
  EXPECT_EQ(c3d.subframe_count, 2);
  EXPECT_EQ(c3d.analog.size(), 8);
}

TEST(C3dReader, TakesUnsignedSamplesAndOffsetsAsUnsigned) {
  RawC3d raw = TwoFrames(C3dProcessor::kIntel, false);
  raw.analog = {0, 1, 32767, 32768, 40000, 65535, 2, 3};
  raw.AddUsualParameters();
  raw.Text(2, "FORMAT", "unsigned");
  raw.Integers(2, "OFFSET", {2}, {32768, 0});
  const C3dRecording c3d = ParseC3d(raw.Bytes(), "raw.c3d");
  EXPECT_TRUE(HasUnsignedAnalog(c3d));
  EXPECT_EQ(c3d.analog, (std::vector<float>{0, 1, 32767, 32768, 40000, 65535, 2, 3}));
  EXPECT_EQ(ScaledAnalog(c3d)[4], 40000 - 32768);
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d"), c3d);
}

TEST(C3dReader, ScalesAnalogSamplesAsFarAsItIsTold) {
  RawC3d raw = TwoFrames();
  raw.AddUsualParameters();
  raw.Reals(2, "SCALE", {1}, {2});  // One for two channels.
  raw.Integers(2, "OFFSETS", {2}, {1, 1});
  raw.Real(2, "GEN_SCALE", 0);
  const C3dRecording c3d = ParseC3d(raw.Bytes(), "raw.c3d");
  const C3dAnalogScaling scaling = AnalogScaling(c3d);
  EXPECT_EQ(scaling.scale, (std::vector<double>{2, 1}));
  EXPECT_EQ(scaling.offset, (std::vector<double>{1, 1}));
  EXPECT_EQ(scaling.general_scale, 1) << "0 would say nothing of any sample";
  EXPECT_EQ(scaling.units, (std::vector<std::string>{"", ""}));
}

}  // namespace
}  // namespace kinebase
