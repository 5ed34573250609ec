// Each kind of bad C3D file has its one error, with the byte.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formats/c3d_bytes.h"
#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

using test::RawC3d;
using test::TwoFrames;

std::string Good() {
  RawC3d raw = TwoFrames();
  raw.AddUsualParameters();
  return raw.Bytes();
}

std::string Changed(std::size_t byte, const std::string& by) {
  std::string bytes = Good();
  return bytes.replace(byte, by.size(), by);
}

struct BadFile {
  std::string name;
  std::string bytes;
  std::int64_t byte;
  std::string message;
};

std::vector<BadFile> BadFiles() {
  const test::C3dNumbers n(C3dProcessor::kIntel);
  RawC3d no_scale = TwoFrames();
  no_scale.scale = 0;
  no_scale.AddUsualParameters();
  RawC3d tiny_scale = TwoFrames();
  tiny_scale.is_float = false;
  tiny_scale.AddUsualParameters();
  std::string tiny = tiny_scale.Bytes();
  tiny.replace(12, 4, n.Real(1e-35));
  // 65,535 points and samples in each of 65,535 frames.
  std::string absurd = Changed(2, std::string(8, '\xff'));
  absurd.resize(1024);
  return {
      {"Empty", "", 0, "is empty; expected a C3D file"},
      {"Text", ":FULLY-SPECIFIED\n:DEGREES\n", 1,
       "is no C3D file: expected 0x50 in its second byte"},
      {"OneByte", "\2", 1, "is no C3D file: expected 0x50 in its second byte"},
      {"HeaderCutOff", Good().substr(0, 300), 300, "ends within its header: 300 bytes of 512"},
      {"HeaderOnly", Good().substr(0, 512), 512,
       "ends before its parameters, which begin at byte 512"},
      {"ParametersCutOff", Good().substr(0, 700), 700,
       "ends before its first frame; it tells of 2 frames of 48 bytes from byte 1024"},
      {"NoData", Good().substr(0, 1024), 1024,
       "ends before its first frame; it tells of 2 frames of 48 bytes from byte 1024"},
      {"HalfAFrame", Good().substr(0, 1060), 1060,
       "ends before its first frame; it tells of 2 frames of 48 bytes from byte 1024"},
      {"ParametersInTheHeader", Changed(0, "\1"), 0,
       "is no C3D file: its parameters begin at block 1, expected 2 or more"},
      {"ParametersPastTheEnd", Changed(0, "\xc8"), static_cast<std::int64_t>(Good().size()),
       "ends before its parameters, which begin at byte 101888"},
      {"Processor", Changed(515, "\x41"), 515,
       "has the unknown processor type 65; expected 84 (Intel), 85 (DEC) or 86 (MIPS)"},
      {"DataPastTheEnd", Changed(16, n.Word(60000)), static_cast<std::int64_t>(Good().size()),
       "ends before its first frame; it tells of 2 frames of 48 bytes from byte 30719488"},
      {"NoScale", no_scale.Bytes(), 12,
       "has no scale: POINT:SCALE is neither negative (floats) nor positive (integers)"},
      {"TinyScale", tiny, 12, "has coordinates in steps of 1e-35, which makes no sense"},
      {"AbsurdCounts", absurd, 1024, "ends before its first frame; it tells of"},
  };
}

class C3dBadFiles : public testing::TestWithParam<BadFile> {};

TEST_P(C3dBadFiles, HaveTheirOneError) {
  const BadFile& bad = GetParam();
  const Error error = test::ErrorOf([&] { (void)ParseC3d(bad.bytes, "bad.c3d"); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.message().substr(0, bad.message.size()), bad.message);
  EXPECT_EQ(error.place().byte, bad.byte);
  EXPECT_EQ(error.place().file, "bad.c3d");
  EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, C3dBadFiles, testing::ValuesIn(BadFiles()),
                         [](const auto& each) { return each.param.name; });

// Loops, or links that lead nowhere, at every place of the chain.
TEST(C3dReader, ComesToAnEndWhateverALinkSays) {
  const std::string good = Good();
  for (std::size_t at = 516; at < 700; ++at) {
    for (const int value : {0, 1, 2, 3, 255, 0x7fff, 0x8000, 0xffff}) {
      std::string bytes = good;
      bytes.replace(at, 2, test::C3dNumbers(C3dProcessor::kIntel).Word(value));
      try {
        const C3dRecording c3d = ParseC3d(bytes, "loop.c3d");
        ASSERT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d"), c3d) << at << " " << value;
      } catch (const Error& error) {
        ASSERT_EQ(error.code(), ErrorCode::kMalformedFile) << error.what();
      }
    }
  }
}

TEST(C3dReader, CanBeCutOffAnywhere) {
  const std::string good = Good();
  for (std::size_t size = 0; size < good.size(); ++size) {
    try {
      const C3dRecording c3d = ParseC3d(good.substr(0, size), "cut.c3d");
      ASSERT_EQ(c3d.frame_count, 1) << size;
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ErrorCode::kMalformedFile) << error.what();
      ASSERT_LT(size, 1024 + 48) << error.what();
    }
  }
}

}  // namespace
}  // namespace kinebase
