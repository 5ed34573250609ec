// Every file of the test data: read, or refused with the one right error; and put on the standard
// skeleton, or the reason why not. docs/formats/real-files.md lists the same.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/asf.h"
#include "kinebase/motion/motion_file.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Refused {
  std::string_view file;  // Below data/.
  ErrorCode code;
  std::string_view message;  // A part of it.
};

constexpr Refused kRefused[] = {
    {"c3d/btk/others/Empty.c3d", ErrorCode::kMalformedFile, "is empty; expected a C3D file"},
    // Their skeletons are elsewhere, under other names.
    {"quirks/asfamc/131_04_FORCE-ALL-JOINTS-BE-3DOF.amc", ErrorCode::kNotFound,
     "no skeleton found: looked for 131_04_FORCE-ALL-JOINTS-BE-3DOF.asf"},
    {"quirks/asfamc/zeros_7frames.amc", ErrorCode::kNotFound,
     "no skeleton found: looked for zeros_7frames.asf"},
};

constexpr std::string_view kUnknownNames = "no set knows any of their names";

struct WithoutJoints {
  std::string_view file;  // Below data/; a folder stands for all C3D files in it.
  std::string_view message;
};

constexpr WithoutJoints kWithoutJoints[] = {
    // Legs only, as they are recorded in gait laboratories.
    {"c3d/btk/PiG/PiG_Motion3_FF.c3d", "places 10 of 24 joints"},
    {"c3d/btk/c3d.org/sample04/", "places 10 of 24 joints"},
    {"c3d/btk/c3d.org/sample09/", "places 10 of 24 joints"},
    {"c3d/btk/c3d.org/sample10/type-2a.c3d", "places 8 of 24 joints"},
    {"c3d/btk/c3d.org/sample10/type-4a.c3d", "places 8 of 24 joints"},
    {"c3d/btk/c3d.org/sample21/", "places 7 of 24 joints"},
    {"c3d/btk/c3d.org/sample28/type1.C3D", "places 8 of 24 joints"},
    {"c3d/btk/others/Gait.c3d", "places 8 of 24 joints"},
    {"c3d/btk/c3d.org/sample01/", kUnknownNames},
    {"c3d/btk/c3d.org/sample02/", kUnknownNames},
    {"c3d/btk/c3d.org/sample08/", kUnknownNames},
    {"c3d/btk/c3d.org/sample28/dynamic.C3D", kUnknownNames},
    {"c3d/btk/c3d.org/sample28/standing.C3D", kUnknownNames},
    {"c3d/btk/others/561xxa01_anonym.C3D", kUnknownNames},
    {"c3d/btk/others/ADemo1_rewrite_c3d_pc_float.c3d", kUnknownNames},
    {"c3d/btk/others/ADemo1_rewrite_c3d_pc_integer.c3d", kUnknownNames},
    // The upper body only.
    {"c3d/btk/others/shd01.c3d", "places 18 of 24 joints"},
    {"c3d/btk/others/Я могу есть стекло/", "places 18 of 24 joints"},
    // A whole body under names of its own; --names tells which is which.
    {"c3d/btk/c3d.org/sample06/", "places 4 of 24 joints"},
    {"c3d/btk/others/Res16bits.c3d", kUnknownNames},
    {"c3d/btk/others/mocap36.c3d", kUnknownNames},
    // Markers that nobody has named, or a few on a thing.
    {"c3d/btk/c3d.org/sample10/TYPE-2.C3D", kUnknownNames},
    {"c3d/btk/c3d.org/sample10/TYPE-4.C3D", kUnknownNames},
    {"c3d/btk/c3d.org/sample13/", kUnknownNames},
    {"c3d/btk/c3d.org/sample15/", kUnknownNames},
    {"c3d/btk/c3d.org/sample18/", kUnknownNames},
    {"c3d/btk/c3d.org/sample20/", kUnknownNames},
    {"c3d/btk/c3d.org/sample22/", kUnknownNames},
    {"c3d/btk/c3d.org/sample24/", kUnknownNames},
    {"c3d/btk/others/MyCube.c3d", kUnknownNames},
    {"c3d/btk/others/badParameterOffset.c3d", kUnknownNames},
    {"csm/assimp_malformed_zero_framerange.csm", kUnknownNames},
    // A few bones only.
    {"bvh/misc/full_precision_frame_time.bvh", "lacks bones for"},
    {"bvh/misc/rotation_first_root.bvh", "lacks bones for"},
    // No marker at all.
    {"c3d/btk/others/1123x01EMG.c3d", "there are no markers"},
    {"c3d/btk/others/Analysis.c3d", "there are no markers"},
    {"c3d/btk/others/parameterOverflow.c3d", "no marker is there in any frame"},
};

// By extension in lower case, names relative to data/.
std::map<std::string, std::vector<std::string>> FilesByKind() {
  std::map<std::string, std::vector<std::string>> files;
  const fs::path root = test::TestData("data");
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    files[ToLower(entry.path().extension().string())].push_back(
        fs::relative(entry.path(), root).string());
  }
  return files;
}

std::vector<std::string> Motions() {
  std::vector<std::string> motions;
  const auto by_kind = FilesByKind();
  for (const std::string kind : {".amc", ".bvh", ".c3d", ".csm", ".mat"}) {
    const auto& files = by_kind.at(kind);
    motions.insert(motions.end(), files.begin(), files.end());
  }
  return motions;
}

const Refused* FindRefused(const std::string& file) {
  const auto* const row = std::ranges::find(kRefused, file, &Refused::file);
  return row == std::end(kRefused) ? nullptr : row;
}

const WithoutJoints* FindWithoutJoints(const std::string& file) {
  for (const WithoutJoints& row : kWithoutJoints) {
    if (row.file.ends_with('/') ? file.starts_with(row.file) : file == row.file) return &row;
  }
  return nullptr;
}

// The standard joints of a recording, all of them finite.
void ExpectStandardJoints(const Recording& recording) {
  Diagnostics diagnostics;
  const JointTrajectories joints = StandardJoints(recording, diagnostics);
  EXPECT_EQ(joints.joint_count, kStandardJointCount);
  EXPECT_EQ(joints.frame_count(), recording.frame_count());
  EXPECT_TRUE(std::ranges::all_of(
      joints.positions_cm, [](const Eigen::Vector3d& position) { return position.allFinite(); }));
}

void ExpectNoStandardJoints(const Recording& recording, const WithoutJoints& reason) {
  Diagnostics diagnostics;
  try {
    (void)StandardJoints(recording, diagnostics);
    ADD_FAILURE() << "has standard joints";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kMismatch);
    EXPECT_THAT(error.message(), HasSubstr(reason.message));
  }
}

void ExpectRefused(const fs::path& file, const Refused& row) {
  try {
    (void)LoadRecording(file);
    ADD_FAILURE() << "is read";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), row.code);
    EXPECT_THAT(error.message(), HasSubstr(row.message));
    EXPECT_EQ(error.place().file, file);
  }
}

TEST(AllRecordings, AreReadOrRefusedForTheOneReason) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto motions = Motions();
  std::size_t refused = 0;
  std::size_t without_joints = 0;
  for (const std::string& file : motions) {
    SCOPED_TRACE(file);
    const fs::path path = test::TestData("data") / file;
    if (const Refused* row = FindRefused(file)) {
      ++refused;
      ExpectRefused(path, *row);
      continue;
    }
    try {
      const Recording recording = LoadRecording(path);
      EXPECT_GT(recording.frame_count(), 0);
      EXPECT_GT(recording.rate_hz(), 0);
      if (const WithoutJoints* reason = FindWithoutJoints(file)) {
        ++without_joints;
        ExpectNoStandardJoints(recording, *reason);
      } else {
        ExpectStandardJoints(recording);
      }
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  }
  // The figures of docs/formats/real-files.md.
  EXPECT_EQ(motions.size(), 268);
  EXPECT_EQ(refused, std::size(kRefused));
  EXPECT_EQ(without_joints, 52);
}

TEST(AllRecordings, HaveSkeletonsThatAreRead) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto skeletons = FilesByKind().at(".asf");
  EXPECT_EQ(skeletons.size(), 20);
  for (const std::string& file : skeletons) {
    SCOPED_TRACE(file);
    EXPECT_NO_THROW(EXPECT_FALSE(ReadAsf(test::TestData("data") / file).bones.empty()));
  }
}

// With the skeleton that they were made for, the two without one are read too.
TEST(AllRecordings, WithoutASkeletonBesideThemAreReadWithOneThatIsNamed) {
  KINEBASE_NEEDS_TEST_DATA();
  const fs::path skeleton = test::TestData("data/cmu/131/131.asf");
  for (const auto& [file, frames] : {std::pair(kRefused[1].file, 1086), {kRefused[2].file, 7}}) {
    const Recording recording =
        LoadRecording(test::TestData("data") / file, {.skeleton = skeleton});
    EXPECT_EQ(recording.frame_count(), frames);
    ExpectStandardJoints(recording);
  }
}

}  // namespace
}  // namespace kinebase
