// NPZ and MAT: what is written is read again as the same recording, and the original HDM05 cache
// files as the motion that their AMC gives.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "kinebase/core/error.h"
#include "kinebase/formats/mat.h"
#include "kinebase/motion/kinematics.h"
#include "motion/figure.h"
#include "motion/recording_files.h"
#include "support/mat_oracle.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using test::Messages;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

// A motion with everything that one can have.
Motion FullMotion() {
  AsfSkeleton asf = test::FigureAsf();
  asf.root_position = {1, 2, 3};
  asf.root_orientation = {10, 20, 30};
  asf.bones[1].limits = {{-160, 20}, {-70, 70}, {-60, 70}};
  Diagnostics ignored;
  Motion motion = test::SmoothMotion(BuildSkeleton(asf, {}, ignored), 11, 7, 59.94);
  motion.first_frame = 301;
  return motion;
}

MarkerCloud Cloud() {
  return {
      .labels = {"Ada:LFHD", "C7", "C7"},
      .rate_hz = 50,
      .frame_count = 2,
      .first_frame = 9,
      .positions_cm =
          {{1, 2, 3}, {1. / 3, 98, 7}, {4, 5, 6}, MissingPosition(), {0, 1, 0}, MissingPosition()},
      .states = {MarkerState::kMeasured, MarkerState::kFilled, MarkerState::kMeasured,
                 MarkerState::kMissing, MarkerState::kMeasured, MarkerState::kMissing}};
}

void ExpectSameSkeleton(const Skeleton& a, const Skeleton& b) {
  ASSERT_EQ(a.joint_count(), b.joint_count());
  for (int j = 0; j < a.joint_count(); ++j) {
    const Joint& x = a.joints()[j];
    const Joint& y = b.joints()[j];
    SCOPED_TRACE(x.bone_name);
    EXPECT_EQ(x.name, y.name);
    EXPECT_EQ(x.bone_name, y.bone_name);
    EXPECT_EQ(x.parent, y.parent);
    EXPECT_LE((x.offset_cm - y.offset_cm).norm(), 1e-12);
    EXPECT_LE((x.direction - y.direction).norm(), 1e-12);
    EXPECT_NEAR(x.length_cm, y.length_cm, 1e-12);
    EXPECT_LE((x.axis_rad - y.axis_rad).norm(), 1e-12);
    EXPECT_EQ(x.euler_order, y.euler_order);
    EXPECT_EQ(x.dofs, y.dofs);
    ASSERT_EQ(x.limits.size(), y.limits.size());
    for (std::size_t d = 0; d < x.limits.size(); ++d) {
      EXPECT_NEAR(x.limits[d].low, y.limits[d].low, 1e-12);
      EXPECT_NEAR(x.limits[d].high, y.limits[d].high, 1e-12);
    }
  }
  for (int j = 0; j < kStandardJointCount; ++j) {
    EXPECT_EQ(a.name_map()[j].rotation_joint, b.name_map()[j].rotation_joint);
    EXPECT_EQ(a.name_map()[j].trajectory_joint, b.name_map()[j].trajectory_joint);
  }
  EXPECT_EQ(a.chains(), b.chains());
  EXPECT_LE((a.root_position_cm() - b.root_position_cm()).norm(), 1e-12);
  EXPECT_LE((a.root_orientation_rad() - b.root_orientation_rad()).norm(), 1e-12);
}

void ExpectSameMotion(const Motion& a, const Motion& b) {
  ExpectSameSkeleton(*a.skeleton, *b.skeleton);
  EXPECT_EQ(a.rate_hz, b.rate_hz);
  ASSERT_EQ(a.frame_count, b.frame_count);
  ASSERT_EQ(a.rotations.size(), b.rotations.size());
  double turned = 0;
  for (std::size_t i = 0; i < a.rotations.size(); ++i) {
    turned = std::max(turned, (a.rotations[i].coeffs() - b.rotations[i].coeffs()).norm());
  }
  EXPECT_LE(turned, 1e-14);
  EXPECT_LE(test::LargestDistance(ForwardKinematics(a), ForwardKinematics(b)), 1e-10);
}

void ExpectSameMarkers(const MarkerCloud& a, const MarkerCloud& b) {
  EXPECT_EQ(a.labels, b.labels);
  EXPECT_EQ(a.rate_hz, b.rate_hz);
  EXPECT_EQ(a.states, b.states);
  ASSERT_EQ(a.positions_cm.size(), b.positions_cm.size());
  for (std::size_t i = 0; i < a.positions_cm.size(); ++i) {
    if (a.states[i] == MarkerState::kMissing) {
      EXPECT_TRUE(b.positions_cm[i].array().isNaN().all());
    } else {
      EXPECT_LE((a.positions_cm[i] - b.positions_cm[i]).norm(), 1e-12);
    }
  }
}

class ArrayFile : public test::RecordingFiles {};

TEST_F(ArrayFile, OfNumPyHoldsAMotion) {
  const Recording recording{.motion = FullMotion()};
  const Recording again = SaveAndLoad(recording, "a.npz");
  EXPECT_EQ(again.format, "NPZ");
  EXPECT_EQ(again.first_frame(), 301);
  EXPECT_THAT(again.diagnostics, IsEmpty());
  ExpectSameMotion(again.motion, recording.motion);
  Save(again, "b.npz");
  ExpectSameMotion(LoadRecording(PathOf("b.npz")).motion, again.motion);
}

TEST_F(ArrayFile, OfNumPyHoldsBonesThatStretch) {
  Recording recording{.motion = FullMotion()};
  recording.motion.extra_offsets_cm.assign(recording.motion.rotations.size(), {.1, -2, 1. / 3});
  const Recording again = SaveAndLoad(recording, "a.npz");
  EXPECT_EQ(again.motion.extra_offsets_cm, recording.motion.extra_offsets_cm);
}

TEST_F(ArrayFile, OfNumPyHoldsMarkersAndTheirStates) {
  const Recording again = SaveAndLoad({.markers = Cloud()}, "a.npz");
  EXPECT_EQ(again.first_frame(), 9);
  ExpectSameMarkers(Cloud(), again.markers);
}

TEST_F(ArrayFile, ComesBackFromOtherUnitsAndAxes) {
  const Recording motion{.motion = FullMotion()};
  const Recording markers{.markers = Cloud()};
  for (const UpAxis up : {UpAxis::kX, UpAxis::kZ}) {
    const SaveOptions save{.overwrite = Overwrite::kYes, .up_axis = up, .units = "m"};
    // NPZ tells its world, MAT does not.
    const LoadOptions told{.up_axis = up, .units = "m"};
    for (const auto& [file, load] : {std::pair("a.npz", LoadOptions()), {"a.mat", told}}) {
      SCOPED_TRACE(file);
      const Recording again = SaveAndLoad(motion, file, save, load);
      EXPECT_LE(
          test::LargestDistance(ForwardKinematics(again.motion), ForwardKinematics(motion.motion)),
          1e-9);
      const MarkerCloud cloud = SaveAndLoad(markers, file, save, load).markers;
      EXPECT_LE((cloud.at(0, 1) - markers.markers.at(0, 1)).norm(), 1e-12);
    }
  }
}

TEST_F(ArrayFile, OfMatlabHoldsAMotion) {
  const Recording recording{.motion = FullMotion()};
  const Recording again = SaveAndLoad(recording, "a.mat");
  EXPECT_THAT(Messages(diagnostics_), Contains(HasSubstr("the first was 301")));
  EXPECT_EQ(again.format, "MAT");
  EXPECT_THAT(again.diagnostics, IsEmpty());
  ExpectSameMotion(again.motion, recording.motion);
}

TEST_F(ArrayFile, OfMatlabHoldsMarkersButNotWhichWereFilled) {
  MarkerCloud expected = Cloud();
  const Recording again = SaveAndLoad({.markers = expected}, "a.mat");
  EXPECT_THAT(Messages(diagnostics_), Contains(HasSubstr("filled markers")));
  expected.states[1] = MarkerState::kMeasured;
  ExpectSameMarkers(expected, again.markers);
}

// Calls `check` with a cache file of the original parser and the recording of its AMC.
template <typename Check>
void ForEachOriginal(Check check) {
  const auto files = test::FilesBelow(test::TestData("data/hdm05/fk_oracle"), ".mat");
  ASSERT_EQ(files.size(), 8);
  for (const auto& file : files) {
    const std::string amc = file.stem().string();
    SCOPED_TRACE(amc);
    check(file, LoadRecording(test::TestData("data/hdm05/cut_amc") / ParseTakeName(amc).class_name /
                              amc));
  }
}

TEST(OriginalMat, GivesTheMotionOfItsAmc) {
  KINEBASE_NEEDS_TEST_DATA();
  ForEachOriginal([](const std::filesystem::path& file, const Recording& amc) {
    const Recording mat = LoadRecording(file);
    EXPECT_EQ(mat.units, "inch");
    EXPECT_EQ(mat.name.class_name, amc.name.class_name);
    EXPECT_EQ(mat.rate_hz(), 120);
    EXPECT_LE(test::LargestDistance(ForwardKinematics(mat.motion), ForwardKinematics(amc.motion)),
              1e-6);
    EXPECT_LE(test::LargestDistance(StandardJoints(mat.motion), StandardJoints(amc.motion)), 1e-6);
  });
}

std::set<std::string> FieldsOf(const MatFile& mat, std::string_view variable) {
  const MatArray* found = mat.Find(variable);
  EXPECT_NE(found, nullptr) << variable;
  if (found == nullptr) return {};
  return {found->fields.begin(), found->fields.end()};
}

// q and -q are one rotation. 4 × frames each, or empty.
void ExpectSameRotations(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  ASSERT_EQ(a.cols(), b.cols());
  for (Eigen::Index frame = 0; frame < a.cols(); ++frame) {
    EXPECT_LE(std::min((a.col(frame) - b.col(frame)).norm(), (a.col(frame) + b.col(frame)).norm()),
              1e-9);
  }
}

// Up to full turns; of three, (x, y, z) is also (x + 180°, 180° − y, z + 180°).
void ExpectSameAngles(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const auto difference = [](const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
    return (x - y).unaryExpr([](double d) { return std::abs(std::remainder(d, 360)); }).maxCoeff();
  };
  for (Eigen::Index frame = 0; a.rows() > 0 && frame < a.cols(); ++frame) {
    double least = difference(a.col(frame), b.col(frame));
    if (a.rows() == 3) {
      const Eigen::Vector3d flipped(a(0, frame) + 180, 180 - a(1, frame), a(2, frame) + 180);
      least = std::min(least, difference(flipped, b.col(frame)));
    }
    EXPECT_LE(least, 1e-6) << frame;
  }
}

TEST_F(ArrayFile, OfMatlabHasTheFieldsAndValuesOfTheOriginal) {
  KINEBASE_NEEDS_TEST_DATA();
  ForEachOriginal([&](const std::filesystem::path& file, const Recording& amc) {
    Save(amc, "ours.mat", {.overwrite = Overwrite::kYes});
    const MatFile ours = ReadMat(PathOf("ours.mat"));
    const MatFile theirs = ReadMat(file);
    EXPECT_EQ(FieldsOf(ours, "skel"), FieldsOf(theirs, "skel"));
    // A later version of the tools added three for markers that the documentation does not have.
    std::set<std::string> documented = FieldsOf(theirs, "mot");
    for (const char* field : {"Data", "Labels", "csvFile"}) documented.erase(field);
    EXPECT_EQ(FieldsOf(ours, "mot"), documented);
    const test::MatOracle a = test::ReadMatOracle(PathOf("ours.mat"));
    const test::MatOracle b = test::ReadMatOracle(file);
    EXPECT_EQ(a.joint_names, b.joint_names);
    EXPECT_EQ(a.bone_names, b.bone_names);
    EXPECT_EQ(a.paths, b.paths);
    EXPECT_EQ(a.animated, b.animated);
    EXPECT_EQ(a.unanimated, b.unanimated);
    EXPECT_EQ(a.name_map_rotation, b.name_map_rotation);
    EXPECT_EQ(a.name_map_trajectory, b.name_map_trajectory);
    EXPECT_EQ(a.documentation, b.documentation);
    EXPECT_EQ(a.sampling_rate, b.sampling_rate);
    EXPECT_LE((a.bounding_box_inch - b.bounding_box_inch).norm(), 1e-6);
    EXPECT_LE((a.root_translation_inch - b.root_translation_inch).norm(), 1e-6);
    ASSERT_EQ(a.trajectories_inch.size(), b.trajectories_inch.size());
    for (std::size_t j = 0; j < a.trajectories_inch.size(); ++j) {
      SCOPED_TRACE(a.bone_names[j]);
      const auto difference = (a.trajectories_inch[j] - b.trajectories_inch[j]).eval();
      EXPECT_LE(difference.cwiseAbs().maxCoeff(), 1e-9);
      ExpectSameRotations(a.quaternions[j], b.quaternions[j]);
      ASSERT_EQ(a.euler_degrees[j].rows(), b.euler_degrees[j].rows());
      ASSERT_EQ(a.euler_degrees[j].cols(), b.euler_degrees[j].cols());
      ExpectSameAngles(a.euler_degrees[j], b.euler_degrees[j]);
      EXPECT_EQ(a.nodes[j].dofs, b.nodes[j].dofs);
      // Theirs is as long as seven digits of text make it.
      EXPECT_LE((a.nodes[j].direction - b.nodes[j].direction).norm(), 1e-6);
      EXPECT_EQ(a.nodes[j].children, b.nodes[j].children);
      EXPECT_EQ(a.nodes[j].parent, b.nodes[j].parent);
      EXPECT_LE((a.nodes[j].offset_inch - b.nodes[j].offset_inch).norm(), 1e-9);
      EXPECT_NEAR(a.nodes[j].length_inch, b.nodes[j].length_inch, 1e-9);
      EXPECT_LE((a.nodes[j].axis_degrees - b.nodes[j].axis_degrees).norm(), 1e-9);
      EXPECT_EQ(a.nodes[j].rotation_order, b.nodes[j].rotation_order);
      ASSERT_EQ(a.nodes[j].limits_degrees.size(), b.nodes[j].limits_degrees.size());
      if (a.nodes[j].limits_degrees.size() > 0) {
        EXPECT_LE((a.nodes[j].limits_degrees - b.nodes[j].limits_degrees).norm(), 1e-9);
      }
    }
  });
}

}  // namespace
}  // namespace kinebase
