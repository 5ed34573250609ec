// GLB, CSV, MOT and STO: written only, so what they hold is worked out here in another way.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <numbers>

#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/sto.h"
#include "kinebase/motion/kinematics.h"
#include "motion/figure.h"
#include "motion/recording_files.h"
#include "nlohmann/json.hpp"

namespace kinebase {
namespace {

using Eigen::Vector3d;
using nlohmann::json;
using test::Messages;
using testing::Contains;
using testing::HasSubstr;

Motion Smooth() {
  AsfSkeleton asf = test::FigureAsf();
  asf.root_position = {1, 2, 3};
  asf.root_orientation = {10, 20, 30};
  Diagnostics ignored;
  Motion motion = test::SmoothMotion(BuildSkeleton(asf, {}, ignored), 11, 5, 120);
  motion.first_frame = 301;
  return motion;
}

Motion Stretching() {
  Motion motion = Smooth();
  motion.extra_offsets_cm.assign(motion.rotations.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < motion.extra_offsets_cm.size(); ++i) {
    if (i % motion.joint_count() != 0) motion.extra_offsets_cm[i] = Vector3d(.1, .2, -.1) * (i % 7);
  }
  return motion;
}

// --- GLB: a header of 12 bytes, a chunk of JSON, a chunk of numbers (glTF 2.0, section 4).

std::uint32_t Word(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

class Glb {
 public:
  explicit Glb(std::string_view bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(Word(bytes, 4), 2);
    EXPECT_EQ(Word(bytes, 8), bytes.size());
    const std::size_t length = Word(bytes, 12);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(length % 4, 0);
    tree = json::parse(bytes.substr(20, length));
    EXPECT_EQ(bytes.substr(20 + length + 4, 3), "BIN");
    binary = bytes.substr(20 + length + 8, Word(bytes, 20 + length));
  }

  // The numbers of an accessor of floats.
  [[nodiscard]] std::vector<double> Numbers(const json& index) const {
    const json& accessor = tree["accessors"][index.get<std::size_t>()];
    EXPECT_EQ(accessor["componentType"], 5126);
    const json& view = tree["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::string type = accessor["type"];
    const std::size_t parts = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
    const std::size_t count = accessor["count"].get<std::size_t>() * parts;
    EXPECT_LE(count * 4, view["byteLength"].get<std::size_t>());
    std::vector<float> floats(count);
    std::memcpy(floats.data(),
                binary.data() + view.value("byteOffset", 0) + accessor.value("byteOffset", 0),
                count * 4);
    return {floats.begin(), floats.end()};
  }

  json tree;
  std::string binary;
};

// Where every node lies in a frame, by the rules of glTF: parent · translation · rotation.
class NodePlaces {
 public:
  NodePlaces(const Glb& glb, std::size_t frame) : glb_(glb), frame_(frame) {
    const std::size_t count = glb.tree["nodes"].size();
    places.resize(count);
    for (const json& root : glb.tree["scenes"][0]["nodes"]) {
      Visit(root, Eigen::Isometry3d::Identity());
    }
  }

  std::vector<Vector3d> places;  // Metres.

 private:
  // The value of a node's property in the frame: of its channel, else its own.
  std::vector<double> Value(std::size_t node, const char* path, std::vector<double> none) const {
    const json& animation = glb_.tree["animations"][0];
    for (const json& channel : animation["channels"]) {
      if (channel["target"]["node"] != node || channel["target"]["path"] != path) continue;
      const json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
      const auto all = glb_.Numbers(sampler["output"]);
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(frame_ * none.size());
      return {first, first + static_cast<std::ptrdiff_t>(none.size())};
    }
    return glb_.tree["nodes"][node].value(path, std::move(none));
  }

  void Visit(std::size_t node, const Eigen::Isometry3d& parent) {
    const auto t = Value(node, "translation", {0, 0, 0});
    const auto r = Value(node, "rotation", {0, 0, 0, 1});
    Eigen::Isometry3d here = parent;
    here.translate(Vector3d(t.data()));
    here.rotate(Eigen::Quaterniond(r[3], r[0], r[1], r[2]).normalized());
    places[node] = here.translation();
    const json& children = glb_.tree["nodes"][node].value("children", json::array());
    for (const json& child : children) Visit(child, here);
  }

  const Glb& glb_;
  std::size_t frame_;
};

using SceneFile = test::RecordingFiles;

TEST_F(SceneFile, PutsEveryJointWhereOurKinematicsDo) {
  for (const Motion& motion : {Smooth(), Stretching()}) {
    const Glb glb(Save({.motion = motion}, "a.glb", {.overwrite = Overwrite::kYes}));
    const json& nodes = glb.tree["nodes"];
    const Skeleton& skeleton = *motion.skeleton;
    int tips = 0;
    for (int j = 1; j < skeleton.joint_count(); ++j) tips += skeleton.children(j).empty() ? 1 : 0;
    ASSERT_EQ(nodes.size(), static_cast<std::size_t>(skeleton.joint_count() + tips));
    const JointTrajectories joints = ForwardKinematics(motion);
    for (int frame = 0; frame < motion.frame_count; ++frame) {
      const NodePlaces scene(glb, static_cast<std::size_t>(frame));
      for (std::size_t node = 0; node < nodes.size(); ++node) {
        // A node stands where its bone begins; "…_end" where the bone of that name ends.
        std::string name = nodes[node]["name"];
        const bool is_end = name.ends_with("_end");
        if (is_end) name.resize(name.size() - 4);
        const int bone = skeleton.FindBone(name).value();
        const int parent = skeleton.joints()[bone].parent;
        const int joint = is_end || parent < 0 ? bone : parent;
        EXPECT_LE((scene.places[node] * 100 - joints.at(frame, joint)).norm(), 1e-3) << name;
      }
    }
  }
}

TEST_F(SceneFile, HasTheTimesOfTheFrames) {
  const Motion motion = Smooth();
  const Glb glb(Save({.motion = motion}, "walk.glb"));
  const json& animation = glb.tree["animations"][0];
  ASSERT_FALSE(animation["samplers"].empty());
  for (const json& sampler : animation["samplers"]) {
    EXPECT_EQ(sampler["interpolation"], "LINEAR");
    const auto times = glb.Numbers(sampler["input"]);
    ASSERT_EQ(times.size(), 5);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(times[i], static_cast<double>(i) / 120, 1e-7);
  }
  EXPECT_EQ(animation["name"], "walk");
  EXPECT_EQ(glb.tree["asset"]["version"], "2.0");
}

TEST_F(SceneFile, IsInMetresWithYUpOnly) {
  const Recording recording{.motion = Smooth()};
  for (const SaveOptions& options : {SaveOptions{.up_axis = UpAxis::kZ}, {.units = "cm"}}) {
    EXPECT_EQ(test::ErrorOf([&] { Save(recording, "a.glb", options); }).code(),
              ErrorCode::kInvalidArgument);
    EXPECT_EQ(test::ErrorOf([&] { Save(recording, "a.mot", options); }).code(),
              ErrorCode::kInvalidArgument);
  }
  Save(recording, "a.glb", {.up_axis = UpAxis::kY, .units = "metres"});
}

// --- CSV.

TEST_F(SceneFile, OfCsvIsATableOfPlaces) {
  const MarkerCloud cloud{
      .labels = {"Ada:LFHD", "C7", "C7", ""},
      .rate_hz = 50,
      .frame_count = 2,
      .first_frame = 9,
      .positions_cm = {{1, 2, 3},
                       {.5, 98, -7},
                       {0, 0, 1},
                       {1, 1, 1},
                       MissingPosition(),
                       {4, 5, 6},
                       {7, 8, 9},
                       {2, 2, 2}},
      .states = {MarkerState::kMeasured, MarkerState::kFilled, MarkerState::kMeasured,
                 MarkerState::kMeasured, MarkerState::kMissing, MarkerState::kMeasured,
                 MarkerState::kMeasured, MarkerState::kMeasured}};
  EXPECT_EQ(Save({.markers = cloud}, "a.csv"),
            "frame,time_s,Ada:LFHD_x,Ada:LFHD_y,Ada:LFHD_z,C7_x,C7_y,C7_z,C7_2_x,C7_2_y,C7_2_z,"
            "unnamed_4_x,unnamed_4_y,unnamed_4_z\n"
            "9,0.16,1,2,3,0.5,98,-7,0,0,1,1,1,1\n"
            "10,0.18,,,,4,5,6,7,8,9,2,2,2\n");
  EXPECT_THAT(Messages(diagnostics_), Contains(HasSubstr("C7_2, unnamed_4")));
  // Our (x, y, z) is (z, x, y) where Z is up.
  EXPECT_THAT(Save({.markers = cloud}, "b.csv", {.up_axis = UpAxis::kZ, .units = "mm"}),
              HasSubstr("\n9,0.16,30,10,20,-70,5,980,"));
}

TEST_F(SceneFile, OfCsvHoldsTheJointsOfASkeleton) {
  const Motion motion = Smooth();
  const CsvTable table = ParseCsv(Save({.motion = motion}, "a.csv"), "a.csv");
  ASSERT_EQ(table.rows.size(), 5);
  ASSERT_EQ(table.columns.size(), 2 + 3 * motion.skeleton->joints().size());
  const JointTrajectories joints = ForwardKinematics(motion);
  for (int j = 0; j < motion.joint_count(); ++j) {
    const std::size_t column = 2 + 3 * static_cast<std::size_t>(j);
    EXPECT_EQ(table.columns[column], motion.skeleton->joints()[j].bone_name + "_x");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::stod(table.rows[4][column + axis]),
                joints.at(4, j)[static_cast<Eigen::Index>(axis)]);
    }
  }
}

// --- MOT and STO.

double CellOf(const StoTable& table, std::size_t row, std::string_view label) {
  const auto column = std::ranges::find(table.labels, label) - table.labels.begin();
  EXPECT_LT(column, static_cast<std::ptrdiff_t>(table.labels.size())) << label;
  return table.Cell(row, static_cast<std::size_t>(column))[0];
}

TEST_F(SceneFile, OfMotHoldsAnglesThatMakeTheRotations) {
  const Motion motion = Smooth();
  const StoTable table = ParseSto(Save({.motion = motion}, "a.mot"), "a.mot");
  EXPECT_EQ(table.in_degrees, true);
  ASSERT_EQ(table.row_count(), 5);
  for (std::size_t row = 0; row < 5; ++row) {
    EXPECT_NEAR(table.times_s[row], (300 + static_cast<double>(row)) / 120, 1e-12);
    EXPECT_NEAR(CellOf(table, row, "root_ty"), motion.root_position_cm[row].y() / 100, 1e-12);
    const int joint = motion.skeleton->FindBone("lfemur").value();
    Vector3d angles;
    for (int axis = 0; axis < 3; ++axis) {
      angles[axis] =
          CellOf(table, row, std::string("lfemur_r") + "xyz"[axis]) * std::numbers::pi / 180;
    }
    const auto& bone = motion.skeleton->axis(joint);
    const Eigen::Quaterniond rotation =
        bone * EulerToQuaternion(angles, EulerOrder::kXyz) * bone.conjugate();
    EXPECT_LE(rotation.angularDistance(motion.rotation(static_cast<int>(row), joint)), 1e-6);
  }
}

TEST_F(SceneFile, OfStoHoldsOrientationsInTheWorld) {
  const Motion motion = Smooth();
  const StoTable table = ParseSto(Save({.motion = motion}, "a.sto"), "a.sto");
  EXPECT_EQ(table.data_type, "Quaternion");
  const auto label = std::ranges::find(table.labels, "ltibia_imu") - table.labels.begin();
  const int tibia = motion.skeleton->FindBone("ltibia").value();
  const int knee = motion.skeleton->joints()[tibia].parent;
  const JointTrajectories joints = ForwardKinematics(motion);
  for (std::size_t row = 0; row < 5; ++row) {
    const auto q = table.Cell(row, static_cast<std::size_t>(label));
    const Vector3d bone =
        joints.at(static_cast<int>(row), tibia) - joints.at(static_cast<int>(row), knee);
    EXPECT_LE(
        (Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * motion.skeleton->joints()[tibia].offset_cm -
         bone)
            .norm(),
        1e-9);
  }
}

}  // namespace
}  // namespace kinebase
