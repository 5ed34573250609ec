// Every real C3D file: what is in it, what is odd about it, and that it is given back.
//
// The expectations were compared with two other readers, ezc3d 1.7 and the Python package c3d 0.6:
// each value of each file equals that of at least one of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/formats/c3d.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using test::TestData;

constexpr C3dProcessor kIntel = C3dProcessor::kIntel;
constexpr C3dProcessor kDec = C3dProcessor::kDec;
constexpr C3dProcessor kMips = C3dProcessor::kMips;
constexpr C3dStorage kFloat = C3dStorage::kFloat;
constexpr C3dStorage kInt16 = C3dStorage::kInteger;

struct RealFile {
  std::string_view path;  // Below data/.
  C3dProcessor processor;
  C3dStorage storage;
  double rate_hz;
  std::int64_t first_frame;
  std::size_t frames;
  std::size_t points;
  std::size_t channels;
  std::size_t subframes;
  std::size_t events;
  std::size_t plates;
  std::size_t diagnostics;
};

// clang-format off
constexpr RealFile kFiles[] = {
    {"c3d/btk/PiG/PiG_Calibration-FlatFoot-One.c3d", kIntel, kFloat, 100, 140, 1, 138, 38, 10, 0, 2, 2},
    {"c3d/btk/PiG/PiG_Motion-FlatFoot-One.c3d", kIntel, kFloat, 100, 342, 255, 193, 38, 10, 8, 2, 2},
    {"c3d/btk/PiG/PiG_Motion3_FF.c3d", kIntel, kFloat, 100, 725, 293, 97, 34, 10, 12, 3, 0},
    {"c3d/btk/c3d.org/sample01/Eb015pi.c3d", kIntel, kInt16, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample01/Eb015pr.c3d", kIntel, kFloat, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample01/Eb015si.c3d", kMips, kInt16, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample01/Eb015sr.c3d", kMips, kFloat, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample01/Eb015vi.c3d", kDec, kInt16, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample01/Eb015vr.c3d", kDec, kFloat, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample02/DEC_INT.C3D", kDec, kInt16, 50, 1, 89, 36, 16, 4, 8, 2, 0},
    {"c3d/btk/c3d.org/sample02/Dec_real.c3d", kDec, kFloat, 50, 1, 89, 36, 16, 4, 9, 2, 0},
    {"c3d/btk/c3d.org/sample02/pc_int.c3d", kIntel, kInt16, 50, 1, 89, 36, 16, 4, 9, 2, 0},
    {"c3d/btk/c3d.org/sample02/pc_real.c3d", kIntel, kFloat, 50, 1, 89, 36, 16, 4, 9, 2, 0},
    {"c3d/btk/c3d.org/sample02/sgi_int.c3d", kMips, kInt16, 50, 1, 89, 36, 16, 4, 9, 2, 1},
    {"c3d/btk/c3d.org/sample02/sgi_real.c3d", kMips, kFloat, 50, 1, 89, 36, 16, 4, 9, 2, 1},
    {"c3d/btk/c3d.org/sample04/sub_labels.c3d", kDec, kInt16, 60, 1, 333, 114, 36, 20, 8, 2, 0},
    {"c3d/btk/c3d.org/sample06/MACsample.c3d", kMips, kInt16, 60, 1, 180, 33, 16, 17, 0, 0, 1},
    {"c3d/btk/c3d.org/sample08/TESTAPI.c3d", kIntel, kInt16, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample08/TESTBPI.c3d", kIntel, kInt16, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample08/TESTCPI.c3d", kIntel, kInt16, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample08/TESTDPI.c3d", kIntel, kInt16, 50, 1, 450, 26, 16, 4, 3, 2, 0},
    {"c3d/btk/c3d.org/sample09/PlugInC3D.c3d", kDec, kInt16, 60, 1, 281, 86, 36, 20, 8, 2, 0},
    {"c3d/btk/c3d.org/sample10/TYPE-2.C3D", kDec, kInt16, 60, 1, 199, 13, 6, 20, 0, 1, 1},
    {"c3d/btk/c3d.org/sample10/TYPE-4.C3D", kDec, kInt16, 60, 1, 199, 13, 6, 20, 0, 1, 1},
    {"c3d/btk/c3d.org/sample10/type-2a.c3d", kDec, kInt16, 60, 1, 360, 25, 20, 16, 0, 2, 0},
    {"c3d/btk/c3d.org/sample10/type-4a.c3d", kDec, kInt16, 60, 1, 360, 25, 20, 16, 0, 2, 0},
    {"c3d/btk/c3d.org/sample13/Dance.c3d", kIntel, kFloat, 65.0533, 1, 499, 40, 8, 1, 0, 0, 3},
    {"c3d/btk/c3d.org/sample13/golfswing.c3d", kIntel, kFloat, 107.527, 1, 514, 29, 8, 1, 0, 0, 3},
    {"c3d/btk/c3d.org/sample15/FP1.C3D", kIntel, kFloat, 60, 1, 480, 8, 12, 10, 4, 1, 1},
    {"c3d/btk/c3d.org/sample15/FP2.C3D", kIntel, kFloat, 60, 1, 480, 8, 12, 10, 4, 1, 1},
    {"c3d/btk/c3d.org/sample18/bad_parameter_section.c3d", kIntel, kInt16, 120, 1, 332, 45, 32, 10, 7, 2, 2},
    {"c3d/btk/c3d.org/sample20/phasespace_sample.c3d", kIntel, kFloat, 30, 1, 701, 40, 0, 0, 0, 0, 1},
    {"c3d/btk/c3d.org/sample21/sample21.c3d", kDec, kInt16, 60, 1, 574, 14, 12, 17, 0, 2, 0},
    {"c3d/btk/c3d.org/sample22/BKINtechnologies.c3d", kIntel, kFloat, 1000, 1, 5065, 2, 20, 1, 0, 0, 0},
    {"c3d/btk/c3d.org/sample24/MotionMonitorC3D.c3d", kIntel, kFloat, 140, 1, 840, 8, 16, 7, 0, 1, 1},
    {"c3d/btk/c3d.org/sample28/dynamic.C3D", kIntel, kFloat, 100, 1, 296, 34, 6, 1, 0, 1, 0},
    {"c3d/btk/c3d.org/sample28/standing.C3D", kIntel, kFloat, 100, 1, 200, 38, 6, 1, 0, 1, 0},
    {"c3d/btk/c3d.org/sample28/type1.C3D", kIntel, kFloat, 100, 1, 296, 28, 6, 1, 0, 1, 0},
    {"c3d/btk/others/1123x01EMG.c3d", kIntel, kFloat, 1000, 1, 4564, 0, 8, 1, 0, 0, 0},
    {"c3d/btk/others/561xxa01_anonym.C3D", kIntel, kFloat, 100, 1, 361, 34, 18, 1, 0, 3, 0},
    {"c3d/btk/others/ADemo1_rewrite_c3d_pc_float.c3d", kIntel, kFloat, 200, 1, 512, 24, 16, 2, 0, 1, 0},
    {"c3d/btk/others/ADemo1_rewrite_c3d_pc_integer.c3d", kIntel, kInt16, 200, 1, 512, 24, 16, 2, 0, 1, 0},
    {"c3d/btk/others/Analysis.c3d", kDec, kFloat, 100, 1, 101, 24, 16, 1, 6, 0, 0},
    {"c3d/btk/others/Gait.c3d", kDec, kInt16, 100, 1, 487, 33, 28, 10, 0, 2, 0},
    {"c3d/btk/others/MyCube.c3d", kIntel, kFloat, 50, 1, 1, 14, 0, 1, 0, 0, 0},
    {"c3d/btk/others/Res16bits.c3d", kIntel, kFloat, 100, 1, 100, 44, 81, 10, 0, 6, 1},
    {"c3d/btk/others/badParameterOffset.c3d", kIntel, kFloat, 250, 1, 111, 41, 0, 0, 0, 0, 2},
    {"c3d/btk/others/mocap36.c3d", kIntel, kFloat, 100, 1, 1380, 36, 0, 0, 0, 0, 0},
    {"c3d/btk/others/parameterOverflow.c3d", kDec, kFloat, 100, 1, 101, 142, 36, 1, 6, 3, 1},
    {"c3d/btk/others/shd01.c3d", kIntel, kFloat, 250, 91, 237, 27, 6, 4, 0, 2, 0},
    {"c3d/btk/others/Я могу есть стекло/оно мне не вредит.c3d", kIntel, kFloat, 250, 91, 237, 27, 6, 4, 0, 2, 0},
    {"cmu/02/02_01.c3d", kIntel, kFloat, 120, 50, 343, 41, 0, 1, 0, 0, 0},
    {"cmu/135/135_02.c3d", kIntel, kFloat, 120, 1, 5202, 41, 0, 0, 0, 0, 0},
    {"cmu/85/85_02.c3d", kIntel, kFloat, 120, 1, 810, 41, 0, 1, 0, 0, 0},
    {"hdm05/amc_c3d_pair/HDM_dg_06-03_03_120.c3d", kIntel, kFloat, 120, 2925, 202, 44, 0, 0, 0, 0, 0},
    {"hdm05/take_c3d/HDM_bd_05-01_01_120.c3d", kIntel, kFloat, 120, 1, 5920, 44, 0, 0, 0, 0, 0},
};
// clang-format on

// What is odd about a file, a part of the message.
struct Oddity {
  std::string_view path;
  std::string_view message;
};
constexpr Oddity kOddities[] = {
    {"c3d/btk/PiG/PiG_Calibration-FlatFoot-One.c3d", "139 parameters of group 'PROCESSING' repeat"},
    {"c3d/btk/PiG/PiG_Calibration-FlatFoot-One.c3d", "two groups are named 'PROCESSING'"},
    {"c3d/btk/PiG/PiG_Motion-FlatFoot-One.c3d", "70 parameters of group 'PROCESSING' repeat"},
    {"c3d/btk/PiG/PiG_Motion-FlatFoot-One.c3d", "two groups are named 'PROCESSING'"},
    // A link that was written in the other byte order.
    {"c3d/btk/c3d.org/sample02/sgi_int.c3d", "'LABELS' says that the next one is 16129 bytes"},
    {"c3d/btk/c3d.org/sample02/sgi_real.c3d", "'LABELS' says that the next one is 16129 bytes"},
    {"c3d/btk/c3d.org/sample06/MACsample.c3d", "POINT:SCALE is 0.0215412, the header says 0.0551"},
    {"c3d/btk/c3d.org/sample10/TYPE-2.C3D", "9 parameters belong to a group 7 that is not there"},
    {"c3d/btk/c3d.org/sample10/TYPE-4.C3D", "9 parameters belong to a group 7 that is not there"},
    {"c3d/btk/c3d.org/sample13/Dance.c3d", "more than the 3 blocks"},
    {"c3d/btk/c3d.org/sample13/Dance.c3d", "POINT:DATA_START says block 0, the header 8"},
    {"c3d/btk/c3d.org/sample13/Dance.c3d", "POINT:FRAMES says 500 frames, for which the file is"},
    {"c3d/btk/c3d.org/sample13/golfswing.c3d", "more than the 3 blocks"},
    {"c3d/btk/c3d.org/sample13/golfswing.c3d", "POINT:DATA_START says block 0, the header 7"},
    {"c3d/btk/c3d.org/sample13/golfswing.c3d", "POINT:FRAMES says 515 frames, for which the file"},
    {"c3d/btk/c3d.org/sample15/FP1.C3D", "more than the 3 blocks"},
    {"c3d/btk/c3d.org/sample15/FP2.C3D", "more than the 3 blocks"},
    // Its data were written over the end of its parameters.
    {"c3d/btk/c3d.org/sample18/bad_parameter_section.c3d",
     "'LABELS' says that the next one is 199"},
    {"c3d/btk/c3d.org/sample18/bad_parameter_section.c3d",
     "'LABELS' has more values than there is"},
    {"c3d/btk/c3d.org/sample20/phasespace_sample.c3d", "has no parameters"},
    {"c3d/btk/c3d.org/sample24/MotionMonitorC3D.c3d", "7 × 16 analog samples"},
    {"c3d/btk/others/Res16bits.c3d", "96896 bytes follow the last frame"},
    {"c3d/btk/others/badParameterOffset.c3d", "'UNITS' has more values than there is room for"},
    {"c3d/btk/others/badParameterOffset.c3d", "POINT:SCALE is -0.01, the header says -1"},
    {"c3d/btk/others/parameterOverflow.c3d", "more than the 46 blocks"},
};

// The one file that is none.
constexpr std::string_view kEmptyFile = "c3d/btk/others/Empty.c3d";

std::filesystem::path PathOf(std::string_view path) { return TestData("data") / path; }

std::vector<std::filesystem::path> AllFiles() {
  std::vector<std::filesystem::path> files = test::FilesBelow(TestData("data"), ".c3d");
  const auto upper = test::FilesBelow(TestData("data"), ".C3D");
  files.insert(files.end(), upper.begin(), upper.end());
  std::ranges::sort(files);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

TEST(RealC3dFiles, AreAllInTheTable) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const auto& file : AllFiles()) {
    const std::string path = std::filesystem::relative(file, TestData("data")).string();
    if (path == kEmptyFile) continue;
    EXPECT_EQ(std::ranges::count(kFiles, path, &RealFile::path), 1) << path;
  }
  EXPECT_EQ(AllFiles().size(), std::size(kFiles) + 1);
}

TEST(RealC3dFiles, HoldWhatOthersReadInThem) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const RealFile& file : kFiles) {
    SCOPED_TRACE(file.path);
    const C3dRecording c3d = ReadC3d(PathOf(file.path), {.strict = true});
    EXPECT_EQ(c3d.processor, file.processor);
    EXPECT_EQ(c3d.storage, file.storage);
    EXPECT_NEAR(static_cast<double>(c3d.rate_hz), file.rate_hz, 1e-3);
    EXPECT_EQ(c3d.first_frame, file.first_frame);
    EXPECT_EQ(c3d.frame_count, file.frames);
    EXPECT_EQ(c3d.point_count, file.points);
    EXPECT_EQ(c3d.channel_count, file.channels);
    EXPECT_EQ(c3d.subframe_count, file.subframes);
    EXPECT_EQ(c3d.points.size(), file.frames * file.points);
    EXPECT_EQ(c3d.analog.size(), file.frames * file.channels * file.subframes);
    EXPECT_EQ(Events(c3d).size(), file.events);
    EXPECT_EQ(ForcePlates(c3d).size(), file.plates);
    EXPECT_EQ(c3d.diagnostics.size(), file.diagnostics);
  }
}

TEST(RealC3dFiles, AreOddInKnownWays) {
  KINEBASE_NEEDS_TEST_DATA();
  std::size_t total = 0;
  for (const RealFile& file : kFiles) total += file.diagnostics;
  EXPECT_EQ(total, std::size(kOddities)) << "each diagnostic has its row";
  for (const Oddity& odd : kOddities) {
    const C3dRecording c3d = ReadC3d(PathOf(odd.path));
    const auto tells = [&](const Diagnostic& each) {
      return each.message.find(odd.message) != std::string::npos;
    };
    EXPECT_EQ(std::ranges::count_if(c3d.diagnostics, tells), 1) << odd.path << ": " << odd.message;
  }
  const Error error = test::ErrorOf([] { (void)ReadC3d(PathOf(kEmptyFile)); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.message(), "is empty; expected a C3D file");
}

TEST(RealC3dFiles, AreGivenBack) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const RealFile& file : kFiles) {
    SCOPED_TRACE(file.path);
    const C3dRecording c3d = ReadC3d(PathOf(file.path));
    const std::string bytes = FormatC3d(c3d);
    const C3dRecording again = ParseC3d(bytes, PathOf(file.path), {.strict = true});
    EXPECT_TRUE(again == c3d);
    EXPECT_LE(again.diagnostics.size(), c3d.diagnostics.size());
    EXPECT_EQ(FormatC3d(again), bytes);
  }
}

TEST(RealC3dFiles, AreTheSameThroughEveryProcessor) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const RealFile& file : kFiles) {
    SCOPED_TRACE(file.path);
    const C3dRecording c3d = ReadC3d(PathOf(file.path));
    for (const C3dProcessor processor : {kIntel, kDec, kMips}) {
      C3dRecording other = c3d;
      other.processor = processor;
      other = ParseC3d(FormatC3d(other), PathOf(file.path));
      EXPECT_EQ(other.processor, processor);
      EXPECT_TRUE(other.points == c3d.points);
      EXPECT_TRUE(other.analog == c3d.analog);
      EXPECT_EQ(Events(other), Events(c3d));
    }
  }
}

TEST(RealC3dFiles, CanBeCutWithTheirEvents) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const RealFile& file : kFiles) {
    SCOPED_TRACE(file.path);
    const C3dRecording take = ReadC3d(PathOf(file.path));
    const auto last = static_cast<std::int64_t>(file.frames) - 1;
    const std::int64_t first = last / 3;
    const C3dRecording clip = CutC3d(take, first, last);
    EXPECT_TRUE(ParseC3d(FormatC3d(clip), PathOf(file.path), {.strict = true}) == clip);
    EXPECT_EQ(clip.first_frame, take.first_frame + first);
    EXPECT_EQ(clip.last_frame(), take.last_frame());
    // As the nearest frame counts, half a frame earlier.
    const double begin_s =
        static_cast<double>(clip.first_frame - 1) / file.rate_hz - .5 / file.rate_hz;
    const auto all = Events(take);
    const auto inside =
        std::ranges::count_if(all, [&](const C3dEvent& event) { return event.time_s >= begin_s; });
    const auto kept = Events(clip);
    EXPECT_EQ(std::ssize(kept), inside);
    for (const C3dEvent& event : kept) {
      EXPECT_TRUE(std::ranges::any_of(all, [&](const C3dEvent& other) {
        return other.label == event.label && std::abs(other.time_s - event.time_s) < 1e-6;
      }));
    }
  }
}

// The largest distance between the points that both hold, and how many only one does.
struct Difference {
  double distance = 0;
  int validity = 0;
  double analog = 0;
};

Difference Compare(const C3dRecording& a, const C3dRecording& b) {
  Difference difference;
  EXPECT_EQ(a.points.size(), b.points.size());
  EXPECT_EQ(a.analog.size(), b.analog.size());
  for (std::size_t i = 0; i < std::min(a.points.size(), b.points.size()); ++i) {
    difference.validity += a.points[i].is_valid() != b.points[i].is_valid() ? 1 : 0;
    if (!a.points[i].is_valid()) continue;
    for (const float C3dPoint::*axis : {&C3dPoint::x, &C3dPoint::y, &C3dPoint::z}) {
      const double apart =
          static_cast<double>(a.points[i].*axis) - static_cast<double>(b.points[i].*axis);
      difference.distance = std::max(difference.distance, std::abs(apart));
    }
  }
  const auto analog_a = ScaledAnalog(a);
  const auto analog_b = ScaledAnalog(b);
  for (std::size_t i = 0; i < std::min(analog_a.size(), analog_b.size()); ++i) {
    difference.analog = std::max(difference.analog, std::abs(analog_a[i] - analog_b[i]));
  }
  return difference;
}

void ExpectSame(std::string_view folder, const std::vector<std::string>& names) {
  const C3dRecording first = ReadC3d(PathOf(folder) / names.front());
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const C3dRecording other = ReadC3d(PathOf(folder) / name);
    EXPECT_TRUE(other.points == first.points);
    EXPECT_TRUE(other.analog == first.analog);
    EXPECT_EQ(PointLabels(other), PointLabels(first));
    EXPECT_EQ(ForcePlates(other), ForcePlates(first));
  }
}

void ExpectWithin(std::string_view folder, const std::string& a, const std::string& b,
                  double tolerance) {
  SCOPED_TRACE(a + " and " + b);
  const Difference difference = Compare(ReadC3d(PathOf(folder) / a), ReadC3d(PathOf(folder) / b));
  EXPECT_LE(difference.distance, tolerance);
  EXPECT_EQ(difference.validity, 0);
  EXPECT_EQ(difference.analog, 0);
}

TEST(RealC3dFiles, AgreeInTheSixFlavoursOfSample01) {
  KINEBASE_NEEDS_TEST_DATA();
  constexpr std::string_view kFolder = "c3d/btk/c3d.org/sample01";
  ExpectSame(kFolder, {"Eb015pi.c3d", "Eb015vi.c3d", "Eb015si.c3d"});
  ExpectSame(kFolder, {"Eb015pr.c3d", "Eb015vr.c3d", "Eb015sr.c3d"});
  ExpectWithin(kFolder, "Eb015pi.c3d", "Eb015pr.c3d", 1e-4);
}

// DEC_INT.C3D was made apart from the other integers: it has the places of the floats to the bit,
// and other cameras at 96 points.
TEST(RealC3dFiles, AgreeInTheSixFlavoursOfSample02) {
  KINEBASE_NEEDS_TEST_DATA();
  constexpr std::string_view kFolder = "c3d/btk/c3d.org/sample02";
  constexpr double kOneStep = .28118188;
  ExpectSame(kFolder, {"pc_int.c3d", "sgi_int.c3d"});
  ExpectSame(kFolder, {"pc_real.c3d", "Dec_real.c3d", "sgi_real.c3d"});
  ExpectWithin(kFolder, "pc_int.c3d", "pc_real.c3d", kOneStep);
  ExpectWithin(kFolder, "pc_int.c3d", "DEC_INT.C3D", kOneStep);
  ExpectWithin(kFolder, "DEC_INT.C3D", "Dec_real.c3d", 0);
}

TEST(RealC3dFiles, AgreeWhereverTheParametersStand) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto read = [](std::string_view name) {
    return ReadC3d(PathOf("c3d/btk/c3d.org/sample08") / name);
  };
  const C3dRecording first = read("TESTAPI.c3d");
  for (const auto name : {"TESTBPI.c3d", "TESTCPI.c3d", "TESTDPI.c3d"}) {
    SCOPED_TRACE(name);
    const C3dRecording other = read(name);
    EXPECT_TRUE(other.points == first.points);
    EXPECT_TRUE(other.analog == first.analog);
    EXPECT_EQ(other.header_events, first.header_events);
  }
}

// Frame 342 is 3.41 s behind frame 1; all eight events lie within what is stored.
TEST(RealC3dFiles, TellTimesOfEventsFromFrameOne) {
  KINEBASE_NEEDS_TEST_DATA();
  const C3dRecording c3d = ReadC3d(PathOf("c3d/btk/PiG/PiG_Motion-FlatFoot-One.c3d"));
  const auto events = Events(c3d);
  ASSERT_EQ(events.size(), 8);
  EXPECT_NEAR(events[0].time_s, 4.72, 1e-6);
  EXPECT_EQ(events[0].label, "Foot Strike");
  EXPECT_EQ(events[0].context, "Left");
  EXPECT_EQ(events[0].subject, "ANTO_M");
  for (const C3dEvent& event : events) {
    EXPECT_GE(event.time_s, 3.41 - 1e-6);
    EXPECT_LE(event.time_s, 5.95 + 1e-6);
  }
}

TEST(RealC3dFiles, TellTheSameAsIntegers) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const std::string_view path : {"hdm05/amc_c3d_pair/HDM_dg_06-03_03_120.c3d",
                                      "c3d/btk/others/ADemo1_rewrite_c3d_pc_float.c3d",
                                      "c3d/btk/c3d.org/sample24/MotionMonitorC3D.c3d"}) {
    SCOPED_TRACE(path);
    const C3dRecording c3d = ReadC3d(PathOf(path));
    C3dRecording integers = c3d;
    ChangeStorage(integers, C3dStorage::kInteger);
    integers = ParseC3d(FormatC3d(integers), PathOf(path), {.strict = true});
    const Difference difference = Compare(c3d, integers);
    EXPECT_LE(difference.distance, static_cast<double>(integers.scale) * .51);
    EXPECT_EQ(difference.validity, 0);
  }
}

}  // namespace
}  // namespace kinebase
