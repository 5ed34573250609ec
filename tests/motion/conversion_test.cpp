// From format to format: whatever a recording passes through, its joints and markers stay where
// they are, and the standard joints are found again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "kinebase/motion/kinematics.h"
#include "motion/figure.h"
#include "motion/person.h"
#include "motion/recording_files.h"

namespace kinebase {
namespace {

using testing::AnyOf;
using testing::Contains;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;

constexpr int kFrames = 5;

// The person with every joint turned by some degrees in every frame.
std::string MovingBvh(const test::Person& person) {
  std::string text = test::BvhOf(person);
  text.resize(text.find("MOTION"));
  text += fmt::format("MOTION\nFrames: {}\nFrame Time: 0.0083333\n", kFrames);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> degrees(-25, 25);
  const Eigen::Vector3d& place = person.joints.front().place_cm;
  for (int frame = 0; frame < kFrames; ++frame) {
    text += fmt::format("{} {} {}", place.x() + frame, place.y(), place.z() - 2 * frame);
    for (std::size_t i = 0; i < 3 * person.joints.size(); ++i) {
      text += fmt::format(" {:.3f}", degrees(random));
    }
    text += "\n";
  }
  return text;
}

// People as programs name them: with a name space, with blanks, as ASF has it, and as nobody does.
std::vector<test::Person> People() {
  const auto with = [](std::string prefix, const std::array<const char*, 24>& names) {
    return test::MakePerson(
        [&](StandardJoint joint) { return prefix + names[static_cast<std::size_t>(joint)]; });
  };
  return {with("mixamorig:",
               {"Hips",       "LeftUpLeg",    "LeftLeg",   "LeftFoot",       "LeftToe_End",
                "RightUpLeg", "RightLeg",     "RightFoot", "RightToe_End",   "Spine1",
                "Spine2",     "Neck",         "Head",      "HeadTop_End",    "LeftShoulder",
                "LeftArm",    "LeftForeArm",  "LeftHand",  "LeftHandIndex4", "RightShoulder",
                "RightArm",   "RightForeArm", "RightHand", "RightHandIndex4"}),
          with("Bip01 ",
               {"Pelvis",    "L Thigh",    "L Calf",     "L Foot",     "L Toe0",    "R Thigh",
                "R Calf",    "R Foot",     "R Toe0",     "Spine1",     "Spine2",    "Neck",
                "Head",      "HeadNub",    "L Clavicle", "L UpperArm", "L Forearm", "L Hand",
                "L Finger0", "R Clavicle", "R UpperArm", "R Forearm",  "R Hand",    "R Finger0"}),
          test::MakePerson([](StandardJoint joint) { return std::string(ToString(joint)); }),
          test::MakePerson(
              [](StandardJoint joint) { return fmt::format("n{}", static_cast<int>(joint)); })};
}

JointTrajectories StandardJointsOf(const Recording& recording) {
  Diagnostics ignored;
  return StandardJoints(recording, ignored);
}

using Conversion = test::RecordingFiles;

TEST_F(Conversion, KeepsTheStandardJointsOfAnyRig) {
  for (const test::Person& person : People()) {
    SCOPED_TRACE(person.joints[2].name);
    Recording recording = LoadText("person.bvh", MovingBvh(person));
    const JointTrajectories expected = StandardJointsOf(recording);
    ASSERT_EQ(expected.frame_count(), kFrames);
    const SaveOptions anew{.overwrite = Overwrite::kYes};
    for (const char* file : {"a.npz", "a.mat", "a.amc", "a.bvh"}) {
      SCOPED_TRACE(file);
      const Recording again = SaveAndLoad(recording, file, anew);
      EXPECT_LE(test::LargestDistance(StandardJointsOf(again), expected), 1e-6);
      EXPECT_DOUBLE_EQ(again.rate_hz(), 120);
    }
    // One after the other, each made of the one before.
    for (const char* file : {"b.npz", "b.amc", "b.mat", "b.bvh", "c.npz"}) {
      SCOPED_TRACE(file);
      recording = SaveAndLoad(recording, file, anew);
      EXPECT_LE(test::LargestDistance(StandardJointsOf(recording), expected), 1e-5);
    }
  }
}

// ASF takes a name for what stands between two blanks.
TEST_F(Conversion, NamesBonesInAcclaimFilesByOneWord) {
  constexpr std::string_view kNames =
      "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\nJOINT L Up #1\n{\nOFFSET 0 5 0\n"
      "CHANNELS 1 Zrotation\nJOINT End\n{\nOFFSET 3 0 0\nCHANNELS 1 Xrotation\n}\nJOINT :units\n{\n"
      "OFFSET 0 2 0\nCHANNELS 1 Xrotation\n}\nJOINT L_Up__1\n{\nOFFSET 0 2 1\nCHANNELS 0\n}\n}\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 0.04\n1 20 30 40\n";
  const Recording loaded = LoadText("a.bvh", kNames, {.units = "cm"});
  const Recording again = SaveAndLoad(loaded, "a.amc");
  EXPECT_THAT(test::Messages(diagnostics_), Contains(HasSubstr("'L Up #1' as 'L_Up__1'")));
  std::vector<std::string> names;
  for (const Joint& joint : again.motion.skeleton->joints()) names.push_back(joint.bone_name);
  EXPECT_THAT(names, ElementsAre("root", "L_Up__1", "_End", "End_tip", "_:units", "_:units_tip",
                                 "L_Up__1_2", "L_Up__1_tip"));
  EXPECT_LE(
      test::LargestDistance(ForwardKinematics(again.motion), ForwardKinematics(loaded.motion)),
      1e-9);
}

TEST_F(Conversion, SaysHowTheJointsOfAForeignSkeletonWereFound) {
  const test::Person person = People().back();
  const Recording again = SaveAndLoad(LoadText("person.bvh", MovingBvh(person)), "a.amc");
  EXPECT_THAT(test::Messages(again.diagnostics), Contains(HasSubstr("shape of the skeleton")));
  Diagnostics ignored;
  const std::vector<JointSource> sources = FindStandardJoints(again, ignored);
  ASSERT_EQ(sources.size(), 24);
  for (const JointSource& source : sources) {
    EXPECT_EQ(source.match, JointMatch::kTopology);
    EXPECT_EQ(source.confidence, .7);
    // A leaf's tip lies where the leaf does.
    const std::string& name = person.joints[person.at(source.joint)].name;
    const bool is_root = source.joint == StandardJoint::kRoot;
    EXPECT_THAT(source.source, AnyOf(is_root ? "root" : name, name + "_tip"));
  }
}

TEST_F(Conversion, KeepsMarkersAndWhichAreMissing) {
  Recording recording{.markers = {.labels = {"LFHD", "RFHD", "C7"},
                                  .rate_hz = 120,
                                  .frame_count = kFrames,
                                  .first_frame = 9}};
  for (int i = 0; i < 3 * kFrames; ++i) {
    const bool is_missing = i % 4 == 2;
    recording.markers.positions_cm.push_back(is_missing ? MissingPosition()
                                                        : Eigen::Vector3d(i, 170.25 - i, -3.5 * i));
    recording.markers.states.push_back(is_missing ? MarkerState::kMissing : MarkerState::kMeasured);
  }
  const MarkerCloud expected = recording.markers;
  for (const char* file : {"a.c3d", "a.trc", "a.csm", "a.npz", "b.c3d", "b.csm", "b.trc", "b.mat",
                           "c.csm", "c.mat", "c.trc", "c.npz"}) {
    SCOPED_TRACE(file);
    recording = SaveAndLoad(recording, file);
    const MarkerCloud& markers = recording.markers;
    EXPECT_EQ(markers.labels, expected.labels);
    EXPECT_EQ(markers.rate_hz, 120);
    ASSERT_EQ(markers.frame_count, kFrames);
    EXPECT_THAT(markers.states, ElementsAreArray(expected.states));
    for (std::size_t i = 0; i < expected.positions_cm.size(); ++i) {
      if (expected.states[i] == MarkerState::kMissing) continue;
      EXPECT_LE((markers.positions_cm[i] - expected.positions_cm[i]).norm(), 1e-4) << i;
    }
    // MAT alone counts frames from 1.
    const bool lost_number =
        std::string_view(file).substr(0, 1) == "c" || file == std::string("b.mat");
    EXPECT_EQ(markers.first_frame, lost_number ? 1 : 9);
  }
}

}  // namespace
}  // namespace kinebase
