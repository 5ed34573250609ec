// Real recordings against golden results, through the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/run_program.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;

struct GoldenClip {
  std::string name;
  fs::path motion;

  [[nodiscard]] fs::path Result(const std::string& kind) const {
    return TestData("golden/clips/" + name + "." + kind + ".csv");
  }
};

std::vector<GoldenClip> GoldenClips() {
  std::vector<GoldenClip> clips;
  const auto motions = FilesBelow(TestData("data"), ".amc");
  for (const fs::path& golden : FilesBelow(TestData("golden/clips"), ".csv")) {
    const std::string file = golden.filename();
    if (!file.ends_with(".joints.csv")) continue;
    const std::string name = file.substr(0, file.find('.'));
    const auto motion =
        std::ranges::find(motions, name, [](const fs::path& p) { return p.stem().string(); });
    EXPECT_NE(motion, motions.end()) << name;
    if (motion != motions.end()) clips.push_back({name, *motion});
  }
  EXPECT_EQ(clips.size(), 11U);
  return clips;
}

TEST(RealRecordings, HaveTheGoldenFeatures) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const GoldenClip& clip : GoldenClips()) {
    for (const std::string profile : {"bonn", "paper"}) {
      SCOPED_TRACE(clip.name + " " + profile);
      const ProgramResult result =
          RunKinebase({"features", clip.motion, "--profile", profile, "--quiet"});
      EXPECT_EQ(result.exit_code, 0) << result.err;
      const CsvTable features = ParseCsv(result.out, "features");
      const CsvTable golden = ReadCsv(clip.Result("features_" + profile));
      EXPECT_EQ(features.columns, golden.columns);
      EXPECT_EQ(features.rows, golden.rows);
    }
  }
}

TEST(RealRecordings, HaveTheGoldenJoints) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const GoldenClip& clip : GoldenClips()) {
    SCOPED_TRACE(clip.name);
    const ProgramResult result = RunKinebase({"joints", clip.motion, "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const CsvTable joints = ParseCsv(result.out, "joints");
    const CsvTable golden = ReadCsv(clip.Result("joints"));
    ASSERT_EQ(joints.columns, golden.columns);
    double largest = 0;
    for (const auto& expected : golden.rows) {  // Every tenth frame.
      const std::size_t frame = std::stoul(expected[0]);
      ASSERT_LE(frame, joints.rows.size());
      const auto& row = joints.rows[frame - 1];
      for (std::size_t i = 0; i < expected.size(); ++i) {
        largest = std::max(largest, std::abs(std::stod(row[i]) - std::stod(expected[i])));
      }
    }
    EXPECT_LE(largest, 1e-5);  // As far as the golden results are written.
  }
}

TEST(RealRecordings, ShowAllSquatsOfAnActorWhoWasNotLearnedFrom) {
  KINEBASE_NEEDS_TEST_DATA();
  const TemporaryFolder folder;
  const std::string squat = folder.path() / "squat.template.json";
  const ProgramResult learned =
      RunKinebase({"learn", "--list", TestData("data/hdm05/clips.csv"), "--class", "squat1Reps",
                   "--actors", "bd,bk", "-o", squat, "--quiet"});
  ASSERT_EQ(learned.exit_code, 0) << learned.err;
  std::vector<std::string> arguments = {"search", squat,     "--tau", "0.06",
                                        "--json", "--quiet", "--in"};
  std::vector<std::string> squats;
  std::size_t recordings = 0;
  for (const fs::path& file : FilesBelow(TestData("data/hdm05/cut_amc"), ".amc")) {
    const std::string name = file.filename();
    if (!name.starts_with("HDM_dg_")) continue;
    ++recordings;
    arguments.push_back(file);
    if (name.starts_with("HDM_dg_squat1Reps_")) squats.push_back(file);
  }
  ASSERT_EQ(squats.size(), 12U);
  ASSERT_GT(recordings, 2 * squats.size());
  const ProgramResult found = RunKinebase(arguments);
  ASSERT_EQ(found.exit_code, 0) << found.err;
  std::vector<std::string> files;
  const nlohmann::ordered_json json = found.Json();
  for (const auto& hit : json["hits"]) files.push_back(hit["file"]);
  EXPECT_THAT(files, ::testing::UnorderedElementsAreArray(squats));
}

}  // namespace
}  // namespace kinebase::test
