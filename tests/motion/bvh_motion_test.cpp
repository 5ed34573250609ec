// What a BVH file means: channels, roots, tips, units and axes against sums done by hand.

#include "kinebase/motion/bvh_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"
#include "motion/person.h"
#include "motion/recording_files.h"

namespace kinebase {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::Messages;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A turn by degrees about an axis of the file.
Quaterniond Turn(char axis, double degrees) {
  const Vector3d axes = Vector3d::Unit(axis - 'x');
  return Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axes));
}

BvhFigure Build(std::string_view text, Diagnostics& diagnostics,
                const BvhBuildOptions& options = {.units = "cm", .up_axis = UpAxis::kY}) {
  return BuildFigure(ParseBvh(text, "a.bvh"), options, diagnostics);
}

BvhFigure Build(std::string_view text) {
  Diagnostics ignored;
  return Build(text, ignored);
}

// Where the bone of that name ends.
Vector3d PlaceOf(const Motion& motion, int frame, std::string_view bone) {
  const auto joint = motion.skeleton->FindBone(bone);
  EXPECT_TRUE(joint) << bone;
  return ForwardKinematics(motion).at(frame, joint.value_or(0));
}

// An arm of two joints whose tables of channels are filled in.
std::string Arm(std::string_view root_channels, std::string_view upper_channels,
                std::string_view values) {
  return fmt::format(
      "HIERARCHY\nROOT Base\n{{\nOFFSET 0 0 0\nCHANNELS {}\nJOINT Upper\n{{\nOFFSET 1 10 0\n"
      "CHANNELS {}\nJOINT Lower\n{{\nOFFSET 0 20 3\nCHANNELS 1 Xrotation\nEnd Site\n{{\n"
      "OFFSET 4 0 5\n}}\n}}\n}}\n}}\nMOTION\nFrames: 1\nFrame Time: 0.04\n{}\n",
      root_channels, upper_channels, values);
}

void ExpectArm(const Motion& motion, const Vector3d& base, const Quaterniond& root,
               const Quaterniond& upper, double lower_degrees) {
  const Vector3d at_upper = base + root * Vector3d(1, 10, 0);
  const Vector3d at_lower = at_upper + root * (upper * Vector3d(0, 20, 3));
  const Vector3d tip = at_lower + root * (upper * (Turn('x', lower_degrees) * Vector3d(4, 0, 5)));
  EXPECT_LE((PlaceOf(motion, 0, "root") - base).norm(), 1e-12);
  EXPECT_LE((PlaceOf(motion, 0, "Upper") - at_upper).norm(), 1e-12);
  EXPECT_LE((PlaceOf(motion, 0, "Lower") - at_lower).norm(), 1e-12);
  EXPECT_LE((PlaceOf(motion, 0, "Lower_tip") - tip).norm(), 1e-12);
}

TEST(BvhMotion, TurnsInTheOrderOfEachJointsOwnChannels) {
  const Motion motion = Build(Arm("6 Xposition Yposition Zposition Zrotation Xrotation Yrotation",
                                  "3 Yrotation Zrotation Xrotation", "7 8 9 10 20 30 40 50 60 70"))
                            .motion;
  ExpectArm(motion, {7, 8, 9}, Turn('z', 10) * Turn('x', 20) * Turn('y', 30),
            Turn('y', 40) * Turn('z', 50) * Turn('x', 60), 70);
}

TEST(BvhMotion, ReadsRootsThatTurnBeforeTheyMove) {
  const Motion motion = Build(Arm("6 Yrotation Xrotation Zrotation Zposition Xposition Yposition",
                                  "1 Zrotation", "10 20 30 9 7 8 50 70"))
                            .motion;
  ExpectArm(motion, {7, 8, 9}, Turn('y', 10) * Turn('x', 20) * Turn('z', 30), Turn('z', 50), 70);
}

TEST(BvhMotion, MixesJointsOfAnyNumberOfChannels) {
  const Motion none = Build(Arm("3 Zrotation Yrotation Xrotation", "0", "10 20 30 70")).motion;
  ExpectArm(none, {0, 0, 0}, Turn('z', 10) * Turn('y', 20) * Turn('x', 30), Quaterniond::Identity(),
            70);
  const Motion two = Build(Arm("1 Yposition", "2 Xrotation Zrotation", "5 20 30 70")).motion;
  ExpectArm(two, {0, 5, 0}, Quaterniond::Identity(), Turn('x', 20) * Turn('z', 30), 70);
  // Both ends about one axis, as proper Euler angles have it.
  const Motion proper =
      Build(Arm("1 Yposition", "3 Zrotation Xrotation Zrotation", "5 20 30 40 70")).motion;
  ExpectArm(proper, {0, 5, 0}, Quaterniond::Identity(),
            Turn('z', 20) * Turn('x', 30) * Turn('z', 40), 70);
}

constexpr std::string_view kSix = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation";

TEST(BvhMotion, TakesPositionsOfAJointForItsWholePlaceOrForWhatIsAdded) {
  Diagnostics diagnostics;
  const std::string whole = Arm("3 Zrotation Xrotation Yrotation", kSix, "0 0 0 1.5 9 .25 0 0 0 0");
  Motion motion = Build(whole, diagnostics).motion;
  EXPECT_LE((PlaceOf(motion, 0, "Upper") - Vector3d(1.5, 9, .25)).norm(), 1e-12);
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("1 joints have position channels, read as "
                                                        "the whole place")));
  diagnostics.clear();
  const std::string added = Arm("3 Zrotation Xrotation Yrotation", kSix, "0 0 0 .5 -1 .25 0 0 0 0");
  motion = Build(added, diagnostics).motion;
  EXPECT_LE((PlaceOf(motion, 0, "Upper") - Vector3d(1.5, 9, .25)).norm(), 1e-12);
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("what is added to the offset")));
}

TEST(BvhMotion, KeepsTheRotationOfALeafWithoutEndSite) {
  std::string text = Arm("3 Zrotation Xrotation Yrotation", "1 Zrotation", "0 0 0 50 70");
  text = test::With(text, "End Site\n{\nOFFSET 4 0 5\n}\n", "");
  const Motion motion = Build(text).motion;
  const int tip = motion.skeleton->FindBone("Lower_tip").value();
  EXPECT_EQ(motion.skeleton->joints()[tip].length_cm, 0);
  EXPECT_LE(motion.rotation(0, tip).angularDistance(Turn('x', 70)), 1e-7);
}

TEST(BvhMotion, IsThatOfTheFirstRootAndNamesTheOthers) {
  const std::string text =
      "HIERARCHY\nROOT Ada\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\nJOINT Arm\n{\nOFFSET 0 5 0\n"
      "CHANNELS 1 Zrotation\n}\n}\nROOT Bob\n{\nOFFSET 9 0 0\nCHANNELS 1 Xposition\n}\n"
      "ROOT Eve: two\n{\nOFFSET 9 0 0\nCHANNELS 1 Xposition\n}\n"
      "MOTION\nFrames: 2\nFrame Time: 0.04\n1 0 70 80\n2 90 71 81\n";
  Diagnostics diagnostics;
  const Motion motion = Build(text, diagnostics).motion;
  EXPECT_EQ(motion.joint_count(), 3);  // Ada, where her arm begins, and the arm's tip.
  EXPECT_EQ(motion.root_position_cm[1], Vector3d(2, 0, 0));
  EXPECT_THAT(Messages(diagnostics),
              Contains("several roots: the motion is that of 'Ada'; left out: 'Bob', 'Eve: two'"));
}

TEST(BvhMotion, FillsWhatIsNoNumberFromTheFrameBefore) {
  std::string text = Arm("1 Yposition", "1 Zrotation", "nan 10 20\n5 nan 21\n6 12 nan");
  Diagnostics diagnostics;
  const Motion motion = Build(test::With(text, "Frames: 1", "Frames: 3"), diagnostics).motion;
  EXPECT_EQ(motion.root_position_cm[0].y(), 5);
  const int lower = motion.skeleton->FindBone("Lower").value();
  EXPECT_LE(motion.rotation(1, lower).angularDistance(Turn('z', 10)), 1e-7);
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("3 missing values")));
}

TEST(BvhMotion, NamesBonesOnceAndOnlyTheRootRoot) {
  const std::string text =
      "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\nJOINT Root\n{\nOFFSET 0 1 0\n"
      "CHANNELS 1 Xrotation\n}\nJOINT a\n{\nOFFSET 1 0 0\nCHANNELS 1 Xrotation\n}\n"
      "JOINT a\n{\nOFFSET 1 0 0\nCHANNELS 1 Xrotation\n}\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 0.04\n0 1 2 3\n";
  const Skeleton skeleton = *Build(text).motion.skeleton;
  std::vector<std::string> names;
  for (const Joint& joint : skeleton.joints()) names.push_back(joint.bone_name);
  EXPECT_THAT(names, ElementsAre("root", "Root_2", "Root_tip", "a", "a_tip", "a_2", "a_tip_2"));
}

// --- Units and axes.

std::string StandingPerson(double scale, const std::array<int, 3>& axes = {0, 1, 2}) {
  const auto name = [](StandardJoint joint) { return std::string(ToString(joint)); };
  return test::BvhOf(test::MakePerson(name), scale, axes);
}

void ExpectPerson(const Motion& motion) {
  const JointTrajectories joints = StandardJoints(motion);
  for (int j = 0; j < kStandardJointCount; ++j) {
    const auto joint = static_cast<StandardJoint>(j);
    EXPECT_LE((joints.at(0, joint) - test::PlaceOnPerson(joint)).norm(), 1e-6) << ToString(joint);
  }
}

TEST(BvhUnits, AreToldByStature) {
  const std::pair<const char*, double> units[] = {
      {"cm", 1},    {"mm", .1}, {"m", 100}, {"inch", 2.54}, {"inch / 0.45", 2.54 / .45},
      {"ft", 30.48}};
  for (const auto& [unit, centimetres] : units) {
    Diagnostics diagnostics;
    const BvhFigure figure = Build(StandingPerson(1 / centimetres), diagnostics, {});
    EXPECT_EQ(figure.units, unit);
    EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("lengths are read as")));
    ExpectPerson(figure.motion);
  }
}

TEST(BvhUnits, AreTakenAsAskedForWithoutAWord) {
  Diagnostics diagnostics;
  const BvhFigure figure = Build(StandingPerson(10), diagnostics, {.units = "mm"});
  EXPECT_EQ(figure.units, "mm");
  EXPECT_THAT(diagnostics, IsEmpty());
  ExpectPerson(figure.motion);
  EXPECT_EQ(
      test::ErrorOf([&] { (void)Build(StandingPerson(1), diagnostics, {.units = "ell"}); }).code(),
      ErrorCode::kInvalidArgument);
}

TEST(BvhUnits, OfAFigureThatIsHumanInNoneAreSaidToBeDoubtful) {
  Diagnostics diagnostics;
  EXPECT_EQ(Build(StandingPerson(1e-5), diagnostics, {}).units, "cm");
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("in no unit is it human")));
}

// With Z up (x, y, z) of the file is (y, z, x) here, so ours is written as (z, x, y).
TEST(BvhUpAxis, IsToldByHowThePersonStands) {
  Diagnostics diagnostics;
  const BvhFigure figure = Build(StandingPerson(1, {2, 0, 1}), diagnostics, {});
  EXPECT_EQ(figure.up_axis, UpAxis::kZ);
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("Z is taken as up")));
  ExpectPerson(figure.motion);
}

TEST(BvhUpAxis, IsTakenAsAskedFor) {
  Diagnostics diagnostics;
  const std::pair<UpAxis, std::array<int, 3>> worlds[] = {
      {UpAxis::kX, {1, 2, 0}}, {UpAxis::kY, {0, 1, 2}}, {UpAxis::kZ, {2, 0, 1}}};
  for (const auto& [up, axes] : worlds) {
    ExpectPerson(
        Build(StandingPerson(1, axes), diagnostics, {.units = "cm", .up_axis = up}).motion);
  }
  EXPECT_THAT(diagnostics, IsEmpty());
}

// In a world with Z up the channels keep their axes: Xrotation turns about the file's x, our z.
TEST(BvhUpAxis, TurnsTheAxesOfChannels) {
  Diagnostics ignored;
  const Motion motion = Build(Arm("1 Zposition", "2 Xrotation Yrotation", "5 20 30 0"), ignored,
                              {.units = "cm", .up_axis = UpAxis::kZ})
                            .motion;
  const int lower = motion.skeleton->FindBone("Lower").value();
  EXPECT_LE(motion.rotation(0, lower).angularDistance(Turn('z', 20) * Turn('x', 30)), 1e-7);
  EXPECT_EQ(motion.root_position_cm[0], Vector3d(0, 5, 0));
}

}  // namespace
}  // namespace kinebase
