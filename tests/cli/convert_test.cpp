// convert as scripts and people see it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kReadable[] = {".amc", ".c3d", ".bvh", ".trc", ".npz", ".mat"};
constexpr const char* kAll[] = {".amc", ".c3d", ".bvh", ".trc", ".npz",
                                ".mat", ".mot", ".sto", ".glb", ".csv"};

class Converting : public ::testing::Test {
 protected:
  [[nodiscard]] std::string squat() const { return library_.Squat(); }
  [[nodiscard]] fs::path out() const { return library_.scratch() / "out"; }
  [[nodiscard]] std::string Out(const std::string& name) const { return out() / name; }

  static ProgramResult Convert(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "convert");
    return RunKinebase(arguments);
  }
  // Must work; what was written.
  std::string Make(const std::string& in, const std::string& name,
                   const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {in, Out(name), "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = Convert(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err + result.out, "");
    return Out(name);
  }

  static nlohmann::ordered_json Info(const std::string& file,
                                     const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"info", file, "--json", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto json = RunKinebase(arguments).Json();
    return json["files"][0];
  }

  static std::vector<double> Joints(const std::string& motion) {
    const ProgramResult result = RunKinebase({"joints", motion, "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::vector<double> values;
    for (const auto& row : ParseCsv(result.out, "joints").rows) {
      for (std::size_t i = 1; i < row.size(); ++i) values.push_back(std::stod(row[i]));
    }
    return values;
  }

  // Infinite if they have not the same number of frames.
  static double LargestDifference(const std::string& a, const std::string& b) {
    const auto values = Joints(a);
    const auto others = Joints(b);
    if (values.size() != others.size()) return INFINITY;
    double largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      largest = std::max(largest, std::abs(values[i] - others[i]));
    }
    return largest;
  }

  SyntheticLibrary library_;
};

TEST_F(Converting, KeepsTheJointsInEveryFormatThatIsReadBack) {
  for (const std::string extension : kReadable) {
    SCOPED_TRACE(extension);
    const std::string file = Make(squat(), "SYN_sa_squat" + extension);
    EXPECT_LT(LargestDifference(file, squat()), 1e-3);
    EXPECT_EQ(Info(file)["rate_hz"], 120);
  }
}

TEST_F(Converting, WritesEveryFormat) {
  for (const std::string extension : kAll) {
    SCOPED_TRACE(extension);
    const std::string file = Out("a" + extension);
    const ProgramResult result = Convert({squat(), file});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("written to " + file));
    EXPECT_GT(fs::file_size(file), 1000U);
  }
  EXPECT_THAT(Convert({squat(), Out("b.amc")}).err, HasSubstr("written to " + Out("b.asf")));
}

TEST_F(Converting, HasTheDocumentedJson) {
  const auto json = Convert({squat(), Out("a.trc"), "--json", "--quiet"}).Json();
  EXPECT_THAT(FieldsOf(json), ElementsAre("file:string", "format:string", "frames:integer",
                                          "rate_hz:number", "skeleton:null", "diagnostics:array"));
  EXPECT_EQ(json["file"], Out("a.trc"));
  EXPECT_EQ(json["format"], "TRC");
  ASSERT_FALSE(json["diagnostics"].empty());
  EXPECT_THAT(FieldsOf(json["diagnostics"][0]), ElementsAre("severity:string", "message:string"));
  EXPECT_THAT(json["diagnostics"][0]["message"].get<std::string>(), HasSubstr("joints"));
  const auto amc = Convert({squat(), Out("a.amc"), "--json", "--quiet"}).Json();
  EXPECT_EQ(amc["skeleton"], Out("a.asf"));
}

TEST_F(Converting, SaysWhatIsLost) {
  const ProgramResult result = Convert({squat(), Out("a.trc")});
  EXPECT_THAT(result.err, HasSubstr(Out("a.trc") + ": info: the "));
  EXPECT_THAT(result.err, HasSubstr("joints are written as points"));
}

// A take whose first frame has the number 50: people count from the first stored frame all the
// same, and the numbers of the file go on.
TEST_F(Converting, TakesAStretchAsPeopleCount) {
  const std::string take = Make(squat() + ":50-149", "take.c3d");
  EXPECT_EQ(Info(take)["first_frame"], 50);
  EXPECT_EQ(Info(take)["frames"], 100);
  const std::string clip = Make(take + ":10-20", "clip.c3d");
  EXPECT_EQ(Info(clip)["first_frame"], 59);
  EXPECT_EQ(Info(clip)["frames"], 11);
  EXPECT_LT(LargestDifference(clip, squat() + ":59-69"), 1e-3);
  const std::string one = Make(take + ":100-100", "one.trc");
  EXPECT_LT(LargestDifference(one, squat() + ":149-149"), 1e-3);
}

TEST_F(Converting, ResamplesAndKeepsTheTime) {
  const std::string take = Make(squat() + ":51-151", "take.c3d");
  const std::string half = Make(take, "half.trc", {"--rate", "60"});
  EXPECT_EQ(Info(half)["frames"], 51);
  EXPECT_EQ(Info(half)["rate_hz"], 60);
  const auto all = Joints(squat() + ":51-151");
  const auto every_other = Joints(half);
  constexpr std::size_t kWidth = 72;  // 24 joints × xyz.
  ASSERT_EQ(every_other.size(), 51 * kWidth);
  for (std::size_t i = 0; i < every_other.size(); ++i) {
    ASSERT_NEAR(every_other[i], all[i / kWidth * 2 * kWidth + i % kWidth], 1e-3);
  }
  // Frame 51 at 120 Hz is at 50 / 120 s: frame 26 at 60 Hz.
  EXPECT_EQ(Info(half)["first_frame"], 26);
  EXPECT_THAT(ReadText(half), HasSubstr("\n26\t0.41666"));
  const std::string thrice = Make(squat(), "thrice.bvh", {"--rate", "360"});
  EXPECT_EQ(Info(thrice)["rate_hz"], 360);
  EXPECT_EQ(Info(thrice)["frames"], (Info(squat())["frames"].get<int>() - 1) * 3 + 1);
}

TEST_F(Converting, StoresAC3dAsAsked) {
  const std::string whole = Make(squat(), "int16.c3d", {"--storage", "int16"});
  EXPECT_EQ(Info(whole)["contents"]["storage"], "int16");
  EXPECT_EQ(Info(Make(whole, "kept.c3d"))["contents"]["storage"], "int16");
  EXPECT_EQ(Info(Make(whole, "float.c3d", {"--storage", "float"}))["contents"]["storage"], "float");
  // Half a step of a scale that holds two metres in 32,767 of them.
  const auto before = Joints(squat());
  const auto after = Joints(whole);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) ASSERT_NEAR(after[i], before[i], 0.01);
}

TEST_F(Converting, TurnsAndScalesAsAsked) {
  for (const std::string extension : {".c3d", ".trc", ".bvh"}) {
    for (const std::string units : {"mm", "m", "inch"}) {
      SCOPED_TRACE(units);
      SCOPED_TRACE(extension);
      const std::string file =
          Make(squat(), "a" + extension, {"--up", "z", "--units", units, "-f"});
      const std::vector<std::string> told = {"--source-up", "z", "--source-units", units};
      const auto info = Info(file, told);
      EXPECT_EQ(info["up_axis"], "Z");
      EXPECT_EQ(info["units"], units);
      const auto& box = info["bounding_box_cm"];
      const auto expected = Info(squat())["bounding_box_cm"];
      for (const std::string corner : {"low", "high"}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(box[corner][axis].get<double>(), expected[corner][axis].get<double>(), .01);
        }
      }
    }
  }
}

TEST_F(Converting, TakesTheRateFromTheUserWhereTheFileHasNone) {
  // Without the line that tells it.
  const std::string text = ReadText(squat());
  const std::string motion = library_.BadMotion(text.substr(text.find(":FULLY")), "SYN_sa.amc");
  EXPECT_THAT(Convert({motion, Out("a.bvh")}).err, HasSubstr("does not tell its rate"));
  EXPECT_EQ(Info(Out("a.bvh"))["rate_hz"], 120);
  EXPECT_EQ(Info(Make(motion, "b.bvh", {"--source-rate", "50"}))["rate_hz"], 50);
  EXPECT_EQ(Info(Make(motion, "c.bvh", {"--source-rate", "50", "--rate", "25"}))["rate_hz"], 25);
}

TEST_F(Converting, NamesMarkersByAnMnmFile) {
  const std::string points = Make(squat(), "a.c3d");
  const std::string names = Out("names.mnm");
  WriteText(names, "Basis root\n");
  const auto labels = Info(Make(points, "b.trc", {"--names", names}))["contents"]["labels"];
  EXPECT_EQ(std::ranges::count(labels, "Basis"), 1);
  EXPECT_EQ(std::ranges::count(labels, "root"), 0);

  WriteText(names, "root Nobody\n");
  EXPECT_THAT(Convert({points, Out("c.trc"), "--names", names}).err,
              HasSubstr("warning: the marker names fit none of the markers"));
}

TEST_F(Converting, WritesMarkersUnderTheNamesOfAnMnmFile) {
  const std::string names = Out("names.mnm");
  WriteText(names, "root Basis\n");
  for (const std::string extension : {".trc", ".c3d"}) {
    const std::string file = Make(squat(), "a" + extension, {"--write-names", names});
    const auto labels = Info(file)["contents"]["labels"];
    EXPECT_EQ(std::ranges::count(labels, "Basis"), 1);
    EXPECT_EQ(std::ranges::count(labels, "root"), 0);
    const auto again = Info(file, {"--names", names})["contents"]["labels"];
    EXPECT_EQ(std::ranges::count(again, "root"), 1);
  }
}

TEST_F(Converting, SaysHowToReadWhatAFileCannotTell) {
  const std::string points = Make(squat(), "points.c3d");
  EXPECT_THAT(Convert({squat(), Out("a.mat"), "--units", "mm", "--up", "z"}).err,
              HasSubstr("warning: MAT cannot tell what it is in; read this file with --source-up "
                        "z --source-units mm\n"));
  EXPECT_THAT(Convert({points, Out("b.mat"), "--units", "m"}).err,
              HasSubstr("read this file with --source-units m\n"));
  EXPECT_THAT(Convert({points, Out("a.trc"), "--units", "m", "--up", "x"}).err,
              HasSubstr("read this file with --source-up x\n"));
  EXPECT_THAT(Convert({squat(), Out("a.bvh"), "--units", "m", "--up", "x"}).err,
              HasSubstr("read this file with --source-up x\n"));
  // What is as readers expect it, or guess it, needs no word.
  for (const auto& [in, name, units, up] : {std::tuple(squat(), "c.mat", "inch", "y"),
                                            {points, "d.mat", "cm", "y"},
                                            {points, "c.trc", "m", "y"},
                                            {squat(), "c.bvh", "m", "z"},
                                            {squat(), "c.npz", "m", "z"}}) {
    EXPECT_THAT(Convert({in, Out(name), "--units", units, "--up", up}).err,
                Not(HasSubstr("read this file with")))
        << name;
  }
}

TEST_F(Converting, TakesTheSkeletonThatIsNamed) {
  const std::string motion = Out("alone/move.amc");
  WriteText(motion, ReadText(squat()));
  ExpectOneError(Convert({motion, Out("a.bvh")}), 1, {motion, "no skeleton found", "--skeleton"});
  const std::string skeleton = library_.folder() / "asf" / "SYN_sa.asf";
  const std::string file = Make(motion, "a.bvh", {"--skeleton", skeleton, "--source-rate", "120"});
  EXPECT_LT(LargestDifference(file, squat()), 1e-3);
}

TEST_F(Converting, OverwritesNothingWithoutForce) {
  for (const std::string extension : kAll) {
    SCOPED_TRACE(extension);
    const std::string file = Out("a" + extension);
    WriteText(file, "precious");
    ExpectOneError(Convert({squat(), file}), 1, {file + ": exists already", "--force"});
    EXPECT_EQ(ReadText(file), "precious");
    EXPECT_EQ(Convert({squat(), file, "--force"}).exit_code, 0);
    EXPECT_NE(ReadText(file), "precious");
  }
  // The skeleton that an AMC brings along is not written over either, nor half of the pair.
  WriteText(Out("b.asf"), "precious");
  ExpectOneError(Convert({squat(), Out("b.amc")}), 1, {Out("b.asf") + ": exists already"});
  EXPECT_EQ(ReadText(Out("b.asf")), "precious");
  EXPECT_FALSE(fs::exists(Out("b.amc")));
}

TEST_F(Converting, CanWriteOverItsOwnInput) {
  const std::string file = Make(squat(), "a.bvh");
  EXPECT_EQ(Convert({file + ":11-20", file, "--force"}).exit_code, 0);
  EXPECT_LT(LargestDifference(file, squat() + ":11-20"), 1e-3);
}

// A limit on the size of files stands for a full disk: writing fails in the middle.
ProgramResult ConvertOnAFullDisk(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {"bash", "-c", "trap '' XFSZ; ulimit -f 4; exec \"$0\" \"$@\"",
                                      KINEBASE_PROGRAM, "convert"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return RunCommand(command);
}

TEST_F(Converting, LosesNothingOnAFullDisk) {
  fs::create_directories(out());
  for (const std::string extension : kAll) {
    SCOPED_TRACE(extension);
    const std::string file = Out("a" + extension);
    const ProgramResult result = ConvertOnAFullDisk({squat(), file, "--quiet"});
    ExpectOneError(result, 1, {Out("a."), ": cannot write", std::strerror(EFBIG)});
    EXPECT_THAT(NamesBelow(out()), IsEmpty());
    WriteText(file, "precious");
    ExpectOneError(ConvertOnAFullDisk({squat(), file, "--quiet", "--force"}), 1, {"cannot write"});
    EXPECT_THAT(NamesBelow(out()), ElementsAre("a" + extension));
    EXPECT_EQ(ReadText(file), "precious");
    fs::remove(file);
  }
}

TEST_F(Converting, SaysInOneLineWhatIsWrong) {
  const std::string points = Make(squat(), "points.c3d");
  const std::string skeleton = library_.folder() / "asf" / "SYN_sa.asf";
  const std::string out = Out("out");
  WriteText(Out("empty.mnm"), "");
  struct Wrong {
    std::vector<std::string> arguments;
    int exit_code;
    std::vector<std::string> parts;
  };
  for (const auto& [arguments, exit_code, parts] : std::vector<Wrong>{
           {{squat()}, 2, {"OUT is required"}},
           {{squat(), out + ".xyz"}, 2, {"'" + out + ".xyz'", "no format", ".bvh"}},
           {{squat(), out}, 2, {"'" + out + "'", "no format", ".bvh"}},
           {{squat(), out + ".bvh", "--up", "up"}, 2, {"--up", "x, y, z"}},
           {{squat(), out + ".bvh", "--units", "ell"}, 2, {"--units", "mm, cm, m, inch, ft"}},
           {{squat(), out + ".bvh", "--source-units", "ell"}, 2, {"--source-units", "inch / 0.45"}},
           {{squat(), out + ".bvh", "--write-names", Out("empty.mnm")},
            1,
            {"BVH", "C3D, CSM and TRC"}},
           {{squat(), out + ".bvh", "--rate", "0"}, 2, {"--rate"}},
           {{squat(), out + ".bvh", "--source-rate", "nan"}, 2, {"--source-rate"}},
           {{squat() + ":20-10", out + ".bvh"}, 2, {"1 ≤ first ≤ last"}},
           {{squat() + ":0-10", out + ".bvh"}, 2, {"1 ≤ first ≤ last"}},
           {{squat() + ":10", out + ".bvh"}, 2, {"a stretch is first-last"}},
           {{squat() + ":1-99999", out + ".bvh"}, 1, {"frames 1 to 99999", "it has 1 to"}},
           {{"nowhere.amc", out + ".bvh"}, 1, {"nowhere.amc: does not exist"}},
           {{skeleton, out + ".bvh"}, 1, {"is a skeleton", ".amc"}},
           {{library_.folder().string(), out + ".bvh"}, 1, {"is a folder"}},
           {{squat(), out + ".bvh", "--skeleton", "nowhere.asf"}, 1, {"nowhere.asf"}},
           {{squat(), out + ".csm"}, 1, {"CSM holds markers", "BVH"}},
           {{points, out + ".bvh"}, 1, {"BVH needs a skeleton", "markers only", "TRC"}},
           {{points, out + ".amc"}, 1, {"ASF/AMC needs a skeleton", "markers only", "TRC"}},
           {{points, out + ".glb"}, 1, {"GLB needs a skeleton", "markers only", "TRC"}},
           {{points, out + ".trc", "--names", "nowhere.mnm"}, 1, {"nowhere.mnm"}},
           {{points, out + ".trc", "--names", Out("empty.mnm")}, 1, {"empty.mnm: has no rows"}},
           {{squat(), out + ".amc", "--units", "mm"}, 1, {"without --up and --units"}},
           {{squat(), out + ".glb", "--up", "z"}, 1, {"without --up and --units"}},
           {{points, out + ".csm", "--up", "y"}, 1, {"without --up and --units"}},
       }) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    std::vector<std::string> quiet = arguments;
    quiet.emplace_back("--quiet");
    ExpectOneError(Convert(quiet), exit_code, parts);
  }
  EXPECT_THAT(NamesBelow(this->out()), ElementsAre("empty.mnm", "points.c3d"));
}

TEST(RealRecordings, AreConvertedWithTheirNumbersAndWithoutAChange) {
  KINEBASE_NEEDS_TEST_DATA();
  const SyntheticLibrary library;
  const std::string take = TestData("data/cmu/02/02_01.c3d");  // Its first frame is number 50.
  const std::string clip = library.scratch() / "clip.c3d";
  EXPECT_EQ(RunKinebase({"convert", take + ":10-20", clip, "--quiet"}).exit_code, 0);
  const auto info = RunKinebase({"info", clip, "--json", "--quiet"}).Json()["files"][0];
  EXPECT_EQ(info["first_frame"], 59);
  EXPECT_EQ(info["frames"], 11);
  EXPECT_EQ(RunKinebase({"joints", clip, "--quiet"}).out,
            RunKinebase({"joints", take + ":10-20", "--quiet"}).out);
}

TEST(RealRecordings, KeepTheirChannelsInAStretchAndSayThatARateHasNone) {
  KINEBASE_NEEDS_TEST_DATA();
  const SyntheticLibrary library;
  const std::string gait = TestData("data/c3d/btk/PiG/PiG_Motion-FlatFoot-One.c3d");
  const std::string clip = library.scratch() / "clip.c3d";
  EXPECT_EQ(RunKinebase({"convert", gait + ":100-199", clip, "--quiet"}).exit_code, 0);
  const auto info = RunKinebase({"info", clip, "--json", "--quiet"}).Json()["files"][0];
  EXPECT_EQ(info["first_frame"], 441);  // The take begins at 342.
  EXPECT_EQ(info["contents"]["analog_channels"].size(), 38);
  EXPECT_EQ(info["contents"]["force_plates"].size(), 2);
  // Of its eight events those between 4.4 s and 5.4 s.
  EXPECT_EQ(info["contents"]["events"].size(), 3);

  const ProgramResult slow =
      RunKinebase({"convert", gait, library.scratch() / "slow.c3d", "--rate", "50"});
  EXPECT_THAT(slow.err, HasSubstr("another rate has no place for: 38 analog channels, 8 events, 2 "
                                  "force plates, residuals"));
  ExpectOneError(
      RunKinebase({"convert", gait, library.scratch() / "a.mot", "--rate", "50", "--quiet"}), 1,
      {"analog channels", "without --rate"});
}

TEST(RealRecordings, WithChannelsAloneGoWhereThoseCanBe) {
  KINEBASE_NEEDS_TEST_DATA();
  const SyntheticLibrary library;
  const std::string emg = TestData("data/c3d/btk/others/1123x01EMG.c3d");
  const std::string out = library.scratch() / "out";
  for (const std::string extension : {".trc", ".csm", ".npz", ".mat", ".csv", ".bvh"}) {
    ExpectOneError(RunKinebase({"convert", emg, out + extension, "--quiet"}), 1,
                   {"1123x01EMG.c3d' holds neither markers nor a skeleton", "C3D, MOT and STO"});
  }
  for (const std::string extension : {".c3d", ".mot", ".sto"}) {
    const ProgramResult result = RunKinebase({"convert", emg, out + extension});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.err, Not(HasSubstr("the 0 markers")));
  }
  const ProgramResult info = RunKinebase({"info", out + ".c3d"});
  EXPECT_THAT(info.out, AllOf(HasSubstr("8 channels at 1000 Hz"),
                              HasSubstr("cannot be searched: there are no markers")));
  EXPECT_THAT(info.out, Not(HasSubstr("warning")));
}

}  // namespace
}  // namespace kinebase::test
