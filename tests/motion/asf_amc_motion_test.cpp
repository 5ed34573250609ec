// From records to motions and back.

#include "kinebase/motion/asf_amc_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <numbers>

#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_editing.h"
#include "kinebase/motion/motion_file.h"
#include "motion/figure.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

Motion Build(const std::string& amc, const AsfSkeleton& asf, Diagnostics& diagnostics) {
  const auto skeleton = BuildSkeleton(asf, {}, diagnostics);
  return BuildMotion(ParseAmc(amc, "m.amc"), asf, skeleton, 120, {}, diagnostics);
}

// The root and one bone of 10 units, all in human size so that lengths are read as inches.
AsfSkeleton Pole(std::vector<AsfDof> dofs) {
  AsfSkeleton asf;
  asf.file_name = "pole.asf";
  asf.length_unit = 0.45;
  asf.root_order = {AsfDof::kTx, AsfDof::kTy, AsfDof::kTz, AsfDof::kRx, AsfDof::kRy, AsfDof::kRz};
  AsfBone bone{.name = "pole", .direction = {0, 1, 0}, .length = 30};
  bone.dofs = std::move(dofs);
  asf.bones = {bone};
  asf.hierarchy = {{"root", {"pole"}}};
  return asf;
}

// What a motion becomes when it is written and read again, skeleton and all.
Motion ThereAndBack(const Motion& motion, Diagnostics& diagnostics) {
  const AsfSkeleton asf = ParseAsf(FormatAsf(ToAsf(*motion.skeleton)), "again.asf");
  const AmcMotion amc = ParseAmc(FormatAmc(ToAmc(motion, diagnostics)), "again.amc");
  const AsfBuildOptions inches{LengthReading::kDivideToInches};
  return BuildMotion(amc, asf, BuildSkeleton(asf, inches, diagnostics), motion.rate_hz, inches,
                     diagnostics);
}

TEST(AsfAmcMotion, ComesBackWithEveryRealJointInItsPlace) {
  KINEBASE_NEEDS_TEST_DATA();
  // A clip for each skeleton of HDM05, takes with acrobatics and with rolling on the ground.
  for (const char* file :
       {"data/hdm05/cut_amc/throwBasketball/HDM_bd_throwBasketball_001_120.amc",
        "data/hdm05/cut_amc/hopBothLegs1hops/HDM_bk_hopBothLegs1hops_013_120.amc",
        "data/hdm05/cut_amc/squat1Reps/HDM_dg_squat1Reps_025_120.amc", "data/cmu/49/49_18.amc",
        "data/quirks/asfamc/backflip.amc", "data/cmu/05/05_02.amc"}) {
    SCOPED_TRACE(file);
    const Motion motion = LoadRecording(test::TestData(file)).motion;
    Diagnostics diagnostics;
    const Motion again = ThereAndBack(motion, diagnostics);
    EXPECT_THAT(diagnostics, IsEmpty());
    EXPECT_LE(test::LargestDistance(ForwardKinematics(again), ForwardKinematics(motion)), 1e-9);
    EXPECT_EQ(again.first_frame, motion.first_frame);
  }
}

RC_GTEST_PROP(AsfAmcMotion, ComesBackForAnyMotionOfAMadeUpFigure, ()) {
  AsfSkeleton asf = test::FigureAsf();
  asf.root_axis = *rc::gen::element<std::string>("XYZ", "ZYX", "YXZ");
  asf.root_position = {1, -2, 3};
  asf.root_orientation = {10, 20, -30};
  for (AsfBone& bone : asf.bones) {
    bone.axis_order = *rc::gen::element<std::string>("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX");
  }
  Diagnostics diagnostics;
  const auto skeleton = BuildSkeleton(asf, {}, diagnostics);
  const Motion motion = test::SmoothMotion(skeleton, *rc::gen::arbitrary<unsigned>(), 20, 120, 9);
  const Motion again = ThereAndBack(motion, diagnostics);
  RC_ASSERT(diagnostics.empty());
  RC_ASSERT(test::LargestDistance(ForwardKinematics(again), ForwardKinematics(motion)) < 1e-9);
}

TEST(AsfAmcMotion, ComesBackWithTranslationsAndLengths) {
  AsfSkeleton asf = Pole({AsfDof::kTx, AsfDof::kRz, AsfDof::kLength, AsfDof::kTz});
  asf.bones[0].axis = {20, 30, 40};
  Diagnostics diagnostics;
  const Motion motion =
      Build("1\nroot 1 2 3 4 5 6\npole 1 50 -2 3\n2\nroot 1 2 3 4 5 6\npole 0 10 0 -1\n", asf,
            diagnostics);
  const Motion again = ThereAndBack(motion, diagnostics);
  EXPECT_THAT(diagnostics, IsEmpty());
  EXPECT_LE(test::LargestDistance(ForwardKinematics(again), ForwardKinematics(motion)), 1e-9);
}

TEST(AsfAmcMotion, KeepsLimitsUnitsAndNames) {
  AsfSkeleton asf = Pole({AsfDof::kRx, AsfDof::kLength});
  asf.bones[0].limits = {{-90, std::numeric_limits<double>::infinity()}, {0, 9}};
  asf.documentation = {"  kept"};
  Diagnostics diagnostics;
  const auto skeleton = BuildSkeleton(asf, {}, diagnostics);
  const Joint& pole = skeleton->joints()[1];
  ASSERT_EQ(pole.limits.size(), 2);
  EXPECT_NEAR(pole.limits[0].low, -std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(pole.limits[0].high, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(pole.limits[1].high, 9 / 0.45 * 2.54, 1e-12);
  const AsfSkeleton again = ToAsf(*skeleton);
  EXPECT_EQ(again.documentation, asf.documentation);
  EXPECT_NEAR(again.bones[0].limits[1].high, 9, 1e-12);
  EXPECT_NEAR(again.bones[0].length, 30, 1e-12);
}

TEST(AsfAmcMotion, LeavesOutLimitsThatDoNotFitAndSaysSo) {
  AsfSkeleton asf = Pole({AsfDof::kRx});
  asf.bones[0].limits = {{-1, 1}, {-2, 2}};
  Diagnostics diagnostics;
  const auto skeleton = BuildSkeleton(asf, {}, diagnostics);
  EXPECT_THAT(skeleton->joints()[1].limits, IsEmpty());
  EXPECT_EQ(skeleton->joints()[1].dofs.size(), 1);
  ASSERT_EQ(diagnostics.size(), 1);
  EXPECT_THAT(diagnostics[0].message, HasSubstr("'pole' has 2 limits for 1"));
}

// 1.7 m in the numbers that each convention would write.
TEST(LengthReading, IsTheOneThatGivesAHumanStature) {
  AsfSkeleton asf = Pole({});
  asf.bones[0].length = 170 / 2.54 * 0.45;
  Diagnostics diagnostics;
  EXPECT_EQ(ChooseLengthReading(asf, LengthReading::kAuto, diagnostics),
            LengthReading::kDivideToInches);
  EXPECT_THAT(diagnostics, IsEmpty());
  EXPECT_NEAR(BuildSkeleton(asf, {}, diagnostics)->joints()[1].length_cm, 170, 1e-9);

  asf.length_unit = 100;
  asf.bones[0].length = 1.7;
  EXPECT_EQ(ChooseLengthReading(asf, LengthReading::kAuto, diagnostics),
            LengthReading::kMultiplyToCentimetres);
  ASSERT_EQ(diagnostics.size(), 1);
  EXPECT_EQ(diagnostics[0].severity, Severity::kInfo);
  EXPECT_THAT(diagnostics[0].message, HasSubstr("170 cm"));
}

TEST(LengthReading, IsInchesWithAWarningWhereNeitherIsHuman) {
  AsfSkeleton asf = Pole({});
  asf.bones[0].length = 1000;
  Diagnostics diagnostics;
  EXPECT_EQ(ChooseLengthReading(asf, LengthReading::kAuto, diagnostics),
            LengthReading::kDivideToInches);
  ASSERT_EQ(diagnostics.size(), 1);
  EXPECT_EQ(diagnostics[0].severity, Severity::kWarning);
}

TEST(LengthReading, IsTheUsersWhereGiven) {
  AsfSkeleton asf = Pole({});
  Diagnostics diagnostics;
  EXPECT_EQ(ChooseLengthReading(asf, LengthReading::kMultiplyToCentimetres, diagnostics),
            LengthReading::kMultiplyToCentimetres);
  EXPECT_NEAR(CentimetresPerUnit(asf, LengthReading::kMultiplyToCentimetres), 0.45, 1e-15);
  EXPECT_NEAR(CentimetresPerUnit(asf, LengthReading::kDivideToInches), 2.54 / 0.45, 1e-15);
  EXPECT_THAT(diagnostics, IsEmpty());
}

TEST(LengthReading, IsHumanForEveryRealSkeleton) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const auto& file : test::FilesBelow(test::TestData("data"), ".asf")) {
    Diagnostics diagnostics;
    EXPECT_EQ(ChooseLengthReading(ReadAsf(file), LengthReading::kAuto, diagnostics),
              LengthReading::kDivideToInches);
    EXPECT_THAT(diagnostics, IsEmpty()) << file;
  }
}

TEST(BuildMotion, ReadsAFileWhoseJointsWereAllForcedToThreeDofs) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto original = LoadRecording(test::TestData("data/cmu/131/131_04.amc"));
  const auto forced =
      LoadRecording(test::TestData("data/quirks/asfamc/131_04_FORCE-ALL-JOINTS-BE-3DOF.amc"),
                    {.skeleton = original.skeleton_path});
  EXPECT_LE(test::LargestDistance(ForwardKinematics(CutMotion(forced.motion, 0, 0)),
                                  ForwardKinematics(CutMotion(original.motion, 0, 0))),
            1e-6);
}

TEST(BuildMotion, NamesABoneThatTheSkeletonLacks) {
  Diagnostics diagnostics;
  const Error error = test::ErrorOf(
      [&] { (void)Build("1\nroot 0 0 0 0 0 0\nhand 1\n", Pole({AsfDof::kRx}), diagnostics); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_EQ(error.place().line, 3);
  EXPECT_THAT(error.message(), HasSubstr("'hand' is not in the skeleton pole.asf"));
  EXPECT_THAT(error.message(), HasSubstr("--skeleton"));
}

TEST(BuildMotion, RefusesAnotherNumberOfValuesThanDofs) {
  for (const char* values : {"pole 1", "pole 1 2 3"}) {
    Diagnostics diagnostics;
    const Error error = test::ErrorOf([&] {
      (void)Build(std::string("1\nroot 0 0 0 0 0 0\n") + values + "\n",
                  Pole({AsfDof::kRx, AsfDof::kRz}), diagnostics);
    });
    EXPECT_EQ(error.code(), ErrorCode::kMismatch);
    EXPECT_EQ(error.place().line, 3);
    EXPECT_THAT(error.message(), HasSubstr("2 degrees of freedom (RX RZ)"));
  }
  Diagnostics diagnostics;
  const Error error =
      test::ErrorOf([&] { (void)Build("1\nroot 0 0 0 0 0 0\npole 1\n", Pole({}), diagnostics); });
  EXPECT_THAT(error.message(), HasSubstr("0 degrees of freedom (none)"));
}

TEST(BuildMotion, RefusesTwoNamesForOneBone) {
  Diagnostics diagnostics;
  const Error error = test::ErrorOf([&] {
    (void)Build("1\nroot 1 1 1 0 0 0\nROOT 1 1 1 0 0 0\n", Pole({AsfDof::kRx}), diagnostics);
  });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_EQ(error.place().line, 3);
}

TEST(BuildMotion, FindsBonesInAnyCase) {
  Diagnostics diagnostics;
  const Motion motion = Build("1\nROOT 1 2 3 0 0 0\nPole 90\n", Pole({AsfDof::kRx}), diagnostics);
  EXPECT_NEAR(ForwardKinematics(motion).at(0, 1).y(), 2 / 0.45 * 2.54, 1e-9);
}

TEST(BuildMotion, LeavesBonesWithoutValuesNeutralAndNamesThem) {
  Diagnostics diagnostics;
  const Motion motion = Build("1\nroot 0 0 0 0 0 0\n", Pole({AsfDof::kRx}), diagnostics);
  EXPECT_EQ(motion.rotation(0, 1).w(), 1);
  ASSERT_EQ(diagnostics.size(), 1);
  EXPECT_THAT(diagnostics[0].message, HasSubstr("pole"));
}

TEST(BuildMotion, ReplacesMissingValuesByThoseOfTheFrameBefore) {
  Diagnostics diagnostics;
  const Motion motion = Build(
      "1\nroot nan 0 0 0 0 0\npole 10\n2\nroot 5 0 0 0 0 0\npole nan\n"
      "3\nroot inf 0 0 0 0 0\npole 30\n",
      Pole({AsfDof::kRx}), diagnostics);
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_NEAR(motion.root_position_cm[frame].x(), 5 / 0.45 * 2.54, 1e-9);
  }
  EXPECT_NEAR(EulerAngles(motion, 1)[1].x(), 10 * std::numbers::pi / 180, 1e-9);
  ASSERT_EQ(diagnostics.size(), 1);
  EXPECT_THAT(diagnostics[0].message, HasSubstr("3 missing values"));
}

TEST(BuildMotion, NamesABoneWhoseValuesNoFrameHas) {
  Diagnostics diagnostics;
  const Motion motion = Build("1\nroot 0 0 0 0 0 0\npole nan\n2\nroot 0 0 0 0 0 0\npole nan\n",
                              Pole({AsfDof::kRx}), diagnostics);
  EXPECT_EQ(motion.rotation(1, 1).w(), 1);
  ASSERT_EQ(diagnostics.size(), 2);
  EXPECT_THAT(diagnostics[1].message, HasSubstr("no frame has"));
  EXPECT_THAT(diagnostics[1].message, HasSubstr("pole"));
}

TEST(BuildSkeleton, NamesABoneWithAnUnknownEulerOrder) {
  AsfSkeleton asf = Pole({AsfDof::kRx});
  asf.bones[0].axis_order = "XXY";
  Diagnostics diagnostics;
  const Error error = test::ErrorOf([&] { (void)BuildSkeleton(asf, {}, diagnostics); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_THAT(error.message(), HasSubstr("'pole'"));
  EXPECT_THAT(error.message(), HasSubstr("'XXY'"));
}

TEST(BuildSkeleton, TakesAChainThatIsDeeperThanAnyStack) {
  AsfSkeleton asf = Pole({});
  asf.bones.clear();
  asf.hierarchy.clear();
  std::string parent = "root";
  for (int i = 0; i < 20'000; ++i) {
    const std::string name = "b" + std::to_string(i);
    asf.bones.push_back({.name = name, .direction = {0, 1, 0}, .length = 0.001});
    asf.hierarchy.push_back({parent, {name}});
    parent = name;
  }
  Diagnostics diagnostics;
  const auto skeleton = BuildSkeleton(asf, {}, diagnostics);
  EXPECT_EQ(skeleton->joint_count(), 20'001);
  EXPECT_EQ(skeleton->chains().size(), 1);
}

TEST(ToAmc, NamesJointsWhoseDofsCannotHoldTheirRotation) {
  Diagnostics diagnostics;
  Motion motion = Build("1\nroot 0 0 0 0 0 0\npole 10\n", Pole({AsfDof::kRx}), diagnostics);
  motion.rotations[1] = EulerToQuaternion({0.1, 0.2, 0}, EulerOrder::kXyz);
  (void)ToAmc(motion, diagnostics);
  ASSERT_EQ(diagnostics.size(), 1);
  EXPECT_THAT(diagnostics[0].message, HasSubstr("pole (11.46°)"));
}

}  // namespace
}  // namespace kinebase
