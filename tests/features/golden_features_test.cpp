// Joints and features of real recordings against an independent second implementation.

#include <gtest/gtest.h>

#include "kinebase/core/text_scanner.h"
#include "kinebase/features/feature_extraction.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_file.h"
#include "nlohmann/json.hpp"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

struct GoldenClip {
  std::string name;
  std::filesystem::path amc;
  int frames120 = 0;
  int frames30 = 0;
};

// The clips of golden/clips and where their recordings are.
std::vector<GoldenClip> GoldenClips() {
  std::vector<GoldenClip> clips;
  const auto listed =
      nlohmann::json::parse(test::ReadText(test::TestData("golden/clips/clips.json")));
  const auto recordings = test::FilesBelow(test::TestData("data"), ".amc");
  for (const auto& entry : listed) {
    GoldenClip clip{
        .name = entry["clip"], .frames120 = entry["frames120"], .frames30 = entry["frames30"]};
    for (const auto& path : recordings) {
      if (path.stem() == clip.name) clip.amc = path;
    }
    EXPECT_FALSE(clip.amc.empty()) << clip.name;
    clips.push_back(std::move(clip));
  }
  return clips;
}

double Number(const std::string& field) { return ParseDouble(field).value(); }

TEST(GoldenClips, HaveTheSameStandardJoints) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto clips = GoldenClips();
  ASSERT_EQ(clips.size(), 11);
  for (const GoldenClip& clip : clips) {
    SCOPED_TRACE(clip.name);
    const JointTrajectories joints = StandardJoints(LoadRecording(clip.amc).motion);
    EXPECT_EQ(joints.frame_count(), clip.frames120);
    const CsvTable golden =
        test::ReadCsv(test::TestData("golden/clips") / (clip.name + ".joints.csv"));
    ASSERT_EQ(golden.columns.size(), 1 + 3 * kStandardJointCount);
    ASSERT_FALSE(golden.rows.empty());
    double largest = 0;
    for (const auto& row : golden.rows) {
      const int frame = static_cast<int>(Number(row[0])) - 1;
      for (int j = 0; j < kStandardJointCount; ++j) {
        EXPECT_EQ(golden.columns[1 + 3 * j],
                  std::string(ToString(static_cast<StandardJoint>(j))) + "_x");
        const Eigen::Vector3d expected(Number(row[1 + 3 * j]), Number(row[2 + 3 * j]),
                                       Number(row[3 + 3 * j]));
        largest = std::max(largest, (joints.at(frame, j) - expected).lpNorm<Eigen::Infinity>());
      }
    }
    EXPECT_LE(largest, 1e-5);
  }
}

class GoldenFeatures : public testing::TestWithParam<std::string> {};

TEST_P(GoldenFeatures, AreEqualBitForBit) {
  KINEBASE_NEEDS_TEST_DATA();
  const FeatureSet features = LoadFeatureSet(GetParam());
  for (const GoldenClip& clip : GoldenClips()) {
    SCOPED_TRACE(clip.name);
    const FeatureMatrix matrix =
        ExtractFeatures(StandardJoints(LoadRecording(clip.amc).motion), features);
    ASSERT_EQ(matrix.column_count(), clip.frames30);
    const CsvTable golden = test::ReadCsv(test::TestData("golden/clips") /
                                          (clip.name + ".features_" + GetParam() + ".csv"));
    ASSERT_EQ(golden.rows.size(), matrix.columns.size());
    for (int column = 0; column < matrix.column_count(); ++column) {
      EXPECT_EQ(golden.rows[column][0], std::to_string(4 * column + 1));
      for (int f = 0; f < features.feature_count(); ++f) {
        EXPECT_EQ(matrix.at(column, f) ? "1" : "0", golden.rows[column][f + 1])
            << features.features[f].id << " column " << column;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Profiles, GoldenFeatures, testing::Values("bonn", "paper"));

}  // namespace
}  // namespace kinebase
