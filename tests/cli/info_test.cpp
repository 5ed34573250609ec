// info as scripts and people see it, for every format that is read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "fmt/format.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

nlohmann::ordered_json InfoOf(const std::string& file, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"info", file, "--json", "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult result = RunKinebase(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  auto json = result.Json();
  return json["files"][0];
}

std::vector<std::string> MessagesIn(const nlohmann::ordered_json& info) {
  std::vector<std::string> messages;
  for (const auto& diagnostic : info["diagnostics"]) {
    EXPECT_THAT(FieldsOf(diagnostic),
                ElementsAre("severity:string", ::testing::AnyOf("line:integer", "line:null"),
                            ::testing::AnyOf("byte:integer", "byte:null"), "message:string"));
    messages.push_back(diagnostic["message"]);
  }
  return messages;
}

struct Format {
  std::string extension;
  std::string name;
  std::string units;
  bool has_skeleton;
};

TEST(Info, TellsTheSameOfOneMotionInEveryFormat) {
  const SyntheticLibrary library;
  const auto expected = InfoOf(library.Squat());
  for (const auto& [extension, name, units, has_skeleton] :
       std::vector<Format>{{".amc", "ASF/AMC", "inch / 0.45", true},
                           {".bvh", "BVH", "cm", true},
                           {".npz", "NPZ", "cm", true},
                           {".mat", "MAT", "inch", true},
                           {".c3d", "C3D", "mm", false},
                           {".trc", "TRC", "mm", false}}) {
    SCOPED_TRACE(extension);
    const std::string file = library.scratch() / ("SYN_sa_squat1Reps_001_120" + extension);
    ASSERT_EQ(RunKinebase({"convert", library.Squat(), file, "--quiet"}).exit_code, 0);
    const auto info = InfoOf(file);
    EXPECT_EQ(info["path"], file);
    EXPECT_EQ(info["format"], name);
    EXPECT_EQ(info["units"], units);
    for (const std::string field : {"frames", "first_frame", "rate_hz", "duration_s", "actor",
                                    "class", "take", "no_standard_joints"}) {
      EXPECT_EQ(info[field], expected[field]) << field;
    }
    EXPECT_EQ(info["joints"].get<int>() > 0, has_skeleton);
    EXPECT_EQ(info["markers"].get<int>() > 0, !has_skeleton);
    EXPECT_EQ(info["skeleton"].is_null(), extension != ".amc");
    EXPECT_EQ(info["standard_joints"].size(), 24U);
    for (const std::string corner : {"low", "high"}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(info["bounding_box_cm"][corner][axis].get<double>(),
                    expected["bounding_box_cm"][corner][axis].get<double>(), .01);
      }
    }
    const std::string text = RunKinebase({"info", file}).out;
    EXPECT_THAT(text, AllOf(HasSubstr("  format    " + name + '\n'), HasSubstr("  frames    "),
                            HasSubstr(" s at 120 Hz\n"), HasSubstr("  units     " + units + ", "),
                            HasSubstr("  class     squat1Reps\n"), HasSubstr("  standard  all")));
    EXPECT_THAT(text, HasSubstr(has_skeleton ? "  joints    " : "  markers   "));
  }
}

TEST(Info, SaysWhatNumberTheFirstFrameHas) {
  const SyntheticLibrary library;
  const std::string file = library.scratch() / "a.c3d";
  ASSERT_EQ(RunKinebase({"convert", library.Squat() + ":50-59", file, "-q"}).exit_code, 0);
  EXPECT_THAT(RunKinebase({"info", file}).out, HasSubstr("frames    10, numbered from 50\n"));
}

TEST(Info, ReadsTheFileAsTheUserSays) {
  const SyntheticLibrary library;
  const std::string text = ReadText(library.Squat());  // Its rate stands before the keywords.
  const std::string file = library.BadMotion(text.substr(text.find(":FULLY")), "SYN_sa.amc");
  EXPECT_THAT(MessagesIn(InfoOf(file)), Contains(HasSubstr("does not tell its rate; 120 Hz")));
  const auto info = InfoOf(file, {"--source-rate", "60"});
  EXPECT_EQ(info["rate_hz"], 60);
  EXPECT_TRUE(info["diagnostics"].empty());
}

TEST(Info, ListsFilesOfAllFormatsAndTheOnesThatFail) {
  const SyntheticLibrary library;
  const fs::path folder = library.scratch() / "mixed";
  for (const std::string name : {"a.bvh", "b.c3d", "c.npz"}) {
    ASSERT_EQ(RunKinebase({"convert", library.Squat(), folder / name, "-q"}).exit_code, 0);
  }
  WriteText(folder / "broken.trc", "nothing of the kind");
  const ProgramResult text = RunKinebase({"info", folder});
  EXPECT_EQ(text.exit_code, 3);
  EXPECT_THAT(text.err, HasSubstr("error: " + (folder / "broken.trc").string()));
  EXPECT_THAT(text.out, ContainsRegex("a.bvh +BVH .*yes"));
  EXPECT_THAT(text.out, ContainsRegex("b.c3d +C3D .*yes"));
  EXPECT_THAT(text.out, ContainsRegex("c.npz +NPZ .*yes"));
  const ProgramResult json = RunKinebase({"info", folder, "--json", "--quiet"});
  EXPECT_EQ(json.exit_code, 3);
  EXPECT_EQ(json.Json()["files"].size(), 3U);
  ASSERT_EQ(json.Json()["failed"].size(), 1U);
  EXPECT_THAT(FieldsOf(json.Json()["failed"][0]), ElementsAre("file:string", "message:string"));
}

TEST(Info, GoesOnWhereAPathIsMissing) {
  const SyntheticLibrary library;
  const ProgramResult result = RunKinebase({"info", "nowhere.bvh", library.Squat(), "-q"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("error: nowhere.bvh: does not exist"));
  EXPECT_THAT(result.out, HasSubstr("SYN_sa_squat1Reps_001_120.amc"));
  ExpectOneError(RunKinebase({"info", "nowhere.bvh", "-q"}), 1, {"nowhere.bvh: does not exist"});
}

// What a format has for people, and the fields of its contents.
struct Other {
  std::string file;
  std::string format;
  std::vector<std::string> lines;
  std::vector<std::string> fields;
};

TEST(Info, ReadsWhatIsNoMotionByItself) {
  const SyntheticLibrary library;
  const std::string out = library.scratch() / "a";
  WriteText(out + ".mnm", "LFHD Stirn\nC7 Hals\n");
  for (const char* const extension : {".mot", ".sto", ".glb", ".csv"}) {
    ASSERT_EQ(RunKinebase({"convert", library.Squat() + ":1-13", out + extension, "-q"}).exit_code,
              0);
  }
  for (const auto& [file, format, lines, fields] : std::vector<Other>{
           {library.folder() / "asf" / "SYN_sa.asf",
            "ASF",
            {"  joints    31, ", " degrees of freedom", "  units     5.644",
             "  standard  all found"},
            {"name:string", "bones:array", "degrees_of_freedom:integer", "cm_per_unit:number",
             "documentation:array", "no_standard_joints:null"}},
           {out + ".mnm",
            "MNM",
            {"  names     2: LFHD = Stirn, C7 = Hals\n", "  warning   "},
            {"names:array"}},
           {out + ".mot",
            "MOT",
            {"  rows      13\n", "  angles    degrees\n", ": root_tx, root_ty",
             "  time      0.000 to 0.100 s, 120 rows a second\n"},
            {"name:string", "data_type:string", "in_degrees:boolean", "rows:integer",
             "columns:array", "first_time_s:number", "last_time_s:number", "rate_hz:number"}},
           {out + ".sto",
            "STO",
            {"  cells     Quaternion\n", "root_imu", "  header    DataRate=120\n"},
            {"name:string", "data_type:string", "in_degrees:null", "rows:integer", "columns:array",
             "first_time_s:number", "last_time_s:number", "rate_hz:number"}},
           {out + ".glb",
            "GLB",
            {"  nodes     ", "root, ", "  animation 0.100 s\n", "  rate      120 Hz\n",
             "  frames    numbered from 1\n"},
            {"generator:string", "nodes:array", "animations:integer", "last_time_s:number",
             "rate_hz:number", "first_frame:integer"}},
           {out + ".csv",
            "CSV",
            {"  rows      13\n", ": frame, time_s, root_x", "120 rows a second\n"},
            {"rows:integer", "columns:array", "first_time_s:number", "last_time_s:number",
             "rate_hz:number"}},
       }) {
    SCOPED_TRACE(format);
    const ProgramResult text = RunKinebase({"info", file});
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("  format    " + format + '\n'));
    for (const std::string& line : lines) EXPECT_THAT(text.out, HasSubstr(line));
    const auto info = InfoOf(file);
    EXPECT_EQ(info["format"], format);
    EXPECT_TRUE(info["frames"].is_null());
    EXPECT_THAT(FieldsOf(info["contents"]), ::testing::ElementsAreArray(fields));
    // All fields of a recording are there.
    const auto recording = InfoOf(library.Squat());
    for (const auto& [name, value] : recording.items()) EXPECT_TRUE(info.contains(name)) << name;
    // Beside others it has a row of the table.
    EXPECT_THAT(RunKinebase({"info", file, library.Squat()}).out,
                ContainsRegex(fmt::format("{} +{}[ \n]", file, format)));
  }
}

TEST(Info, SaysWhatIsWrongWithWhatIsNoMotion) {
  const SyntheticLibrary library;
  const fs::path folder = library.scratch();
  struct Bad {
    std::string name;
    std::string text;
    std::string message;
  };
  using std::string_literals::operator""s;
  for (const auto& [name, text, message] : std::vector<Bad>{
           {"a.asf", "", "a.asf"},
           {"a.mnm", "", "has no rows"},
           {"a.mot", "name\n", "endheader"},
           {"a.csv", "frame,time_s\n1,soon\n", "a.csv:2: time_s is 'soon'"},
           {"a.glb", "glTF", "is no GLB"},
           {"b.glb", "glTF\1\0\0\0\0\0\0\0\0\0\0\0JSON"s, "version 1"},
           {"c.glb", "glTF\2\0\0\0\0\0\0\0\xFF\xFF\xFF\xFFJSON"s, "its scene is longer"},
           {"f.glb", "glTF\2\0\0\0\x40\0\0\0\2\0\0\0JSON{}"s, "is cut off: it has 22 of 64 bytes"},
           {"d.glb", "glTF\2\0\0\0\0\0\0\0\2\0\0\0JSON[["s, "no scene"},
           {"e.glb", "glTF\2\0\0\0\0\0\0\0\x0D\0\0\0JSON{\"nodes\":[7]}"s, "breaks glTF's rules"},
       }) {
    SCOPED_TRACE(name);
    WriteText(folder / name, text);
    ExpectOneError(RunKinebase({"info", folder / name, "-q"}), 1, {message});
  }
  WriteText(folder / "a.xyz", "");
  const std::string squat = library.Squat();
  for (const auto& [file, message] : std::vector<std::pair<std::string, std::string>>{
           {folder / "nothing.csv", "nothing.csv: does not exist"},
           {folder / "a.xyz", ".amc (ASF/AMC), .c3d (C3D)"},
           {folder / "a.xyz", "known, too: .asf, .mnm"},
           {squat + ":1-10", "whole files are taken here"},
       }) {
    ExpectOneError(RunKinebase({"info", file, "-q"}), 1, {message});
  }
}

TEST(InfoOfRealRecordings, SaysWhatIsOddAndWhere) {
  KINEBASE_NEEDS_TEST_DATA();
  const std::string boxing = TestData("data/bvh/misc/Boxing_Toes.bvh");
  const auto bvh = InfoOf(boxing);
  EXPECT_EQ(bvh["frames"], 3070);
  EXPECT_EQ(bvh["diagnostics"][0]["line"], 128);
  EXPECT_THAT(MessagesIn(bvh), Contains(HasSubstr("'Frames:' says 3069, but there are 3070")));
  EXPECT_THAT(RunKinebase({"info", boxing}).out,
              HasSubstr("  warning   line 128: 'Frames:' says 3069, but there are 3070"));
  const auto csm = InfoOf(TestData("data/csm/ThomasFechten.csm"));
  EXPECT_EQ(csm["markers"], 43);
  EXPECT_EQ(csm["frames"], 2439);
  EXPECT_THAT(MessagesIn(csm), Contains(HasSubstr("optional markers are missing")));
  EXPECT_THAT(RunKinebase({"info", TestData("data/csm/ThomasFechten.csm")}).out,
              HasSubstr("  standard  all found, least sure lelbow (0.70)\n"));
  EXPECT_THAT(MessagesIn(csm), Contains(HasSubstr("marker RANK does not keep its distance")));
  const auto c3d = InfoOf(TestData("data/c3d/btk/c3d.org/sample13/Dance.c3d"));
  EXPECT_THAT(MessagesIn(c3d), Contains(HasSubstr("POINT:FRAMES says 500 frames")));
}

TEST(InfoOfRealRecordings, SaysWhichCannotBeSearched) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const std::string name : {"full_precision_frame_time.bvh", "rotation_first_root.bvh"}) {
    const std::string file = TestData("data/bvh/misc/" + name);
    EXPECT_THAT(RunKinebase({"info", file}).out,
                HasSubstr("  standard  cannot be searched: the skeleton lacks bones"));
    EXPECT_THAT(InfoOf(file)["no_standard_joints"].get<std::string>(), HasSubstr("lacks bones"));
    EXPECT_EQ(RunKinebase({"joints", file, "--quiet"}).exit_code, 1);
  }
}

TEST(InfoOfRealRecordings, ShowsWhatElseAC3dHolds) {
  KINEBASE_NEEDS_TEST_DATA();
  const std::string file = TestData("data/c3d/btk/c3d.org/sample01/Eb015pi.c3d");
  EXPECT_THAT(RunKinebase({"info", file}).out,
              AllOf(HasSubstr("  stored    Intel int16\n"),
                    HasSubstr("  analog    16 channels at 200 Hz\n"),
                    HasSubstr("  events    RIC at 2.720 s, RHS at 5.400 s, RTO at 7.320 s\n"),
                    HasSubstr("  plates    type 2, type 2\n"),
                    HasSubstr("  markers   26, 1.9 % of the samples missing\n"),
                    HasSubstr("  standard  cannot be searched: "), Not(HasSubstr("rfingers"))));
  const auto contents = InfoOf(file)["contents"];
  EXPECT_EQ(contents["analog_channels"].size(), 16U);
  EXPECT_EQ(contents["events"].size(), 3U);
  EXPECT_EQ(contents["force_plates"].size(), 2U);
  EXPECT_EQ(contents["labels"].size(), 26U);
}

}  // namespace
}  // namespace kinebase::test
