// What holds for everything that is made up: determinism, anatomy, floor, speeds.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "kinebase/core/error.h"
#include "support/files.h"
#include "synth/poses.h"

namespace kinebase::test {
namespace {

bool SameNumbers(const Motion& a, const Motion& b) {
  if (a.frame_count != b.frame_count || a.root_position_cm != b.root_position_cm) return false;
  for (std::size_t i = 0; i < a.rotations.size(); ++i) {
    if (a.rotations[i].coeffs() != b.rotations[i].coeffs()) return false;
  }
  return true;
}

// Calls check(trajectories, skeleton) for a clip of each class by each actor.
template <typename Check>
void ForEachClass(Check check) {
  for (const std::string& name : SyntheticClasses()) {
    ForEachClip(name, [&](const Motion& clip) { check(ForwardKinematics(clip), *clip.skeleton); });
  }
}

TEST(SyntheticActor, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const SyntheticActor a = MakeSyntheticActor(3, 1);
  const SyntheticActor same = MakeSyntheticActor(3, 1);
  const SyntheticActor other = MakeSyntheticActor(3, 2);
  EXPECT_EQ(a.stature_cm, same.stature_cm);
  EXPECT_EQ(a.tempo, same.tempo);
  EXPECT_EQ(a.noise_deg, same.noise_deg);
  EXPECT_NE(a.stature_cm, other.stature_cm);
}

// The generator and its draws are defined by integer arithmetic and exact sums, so these numbers
// hold on every machine.
TEST(SyntheticActor, DependsOnNothingButTheSeed) {
  const SyntheticActor actor = MakeSyntheticActor(0, 1);
  EXPECT_EQ(actor.name, "sa");
  EXPECT_DOUBLE_EQ(actor.stature_cm, 171.4);
  EXPECT_EQ(MakeSyntheticActor(25, 1).name, "sz");
  EXPECT_EQ(MakeSyntheticActor(26, 1).name, "saa");
  EXPECT_EQ(ErrorOf([] { (void)MakeSyntheticActor(-1, 1); }).code(), ErrorCode::kInvalidArgument);
}

RC_GTEST_PROP(SyntheticActor, StandsAsTallAsItIsWithinHumanRange, (std::uint64_t seed)) {
  const int number = *rc::gen::inRange(0, 200);
  const SyntheticActor actor = MakeSyntheticActor(number, seed);
  RC_ASSERT(actor.stature_cm >= 155 && actor.stature_cm <= 195);
  const auto skeleton = MakeSyntheticSkeleton(actor);
  const auto length = [&](const char* bone) {
    return skeleton->joints()[*skeleton->FindBone(bone)].length_cm;
  };
  const auto rise = [&](const char* bone) {
    return skeleton->joints()[*skeleton->FindBone(bone)].offset_cm.y();
  };
  // Upright: shank and thigh hang straight, the foot's own drop is its share of the ankle's height.
  const double foot = length("lfoot");
  const double forward = skeleton->joints()[*skeleton->FindBone("lfoot")].offset_cm.z();
  const double stature = std::sqrt(foot * foot - forward * forward) + length("ltibia") +
                         length("lfemur") - rise("lhipjoint") + rise("lowerback") +
                         rise("upperback") + rise("thorax") + rise("lowerneck") +
                         rise("upperneck") + rise("head");
  RC_ASSERT(std::abs(stature - actor.stature_cm) < 1e-3);
  RC_ASSERT(std::abs(length("lfemur") - length("rfemur")) < 1e-9);
}

TEST(SyntheticSkeleton, HasHdm05sBonesAndAllStandardJoints) {
  const auto skeleton = MakeSyntheticSkeleton(MakeSyntheticActor(1, kSeed));
  EXPECT_EQ(skeleton->joint_count(), 31);
  for (const NameMapEntry& entry : skeleton->name_map()) EXPECT_GE(entry.trajectory_joint, 0);
  EXPECT_EQ(ErrorOf([] { (void)MakeSyntheticSkeleton({.name = "nobody"}); }).code(),
            ErrorCode::kInvalidArgument);
}

TEST(SyntheticClip, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const SyntheticActor actor = MakeSyntheticActor(2, kSeed);
  for (const std::string& name : SyntheticClasses()) {
    const Motion clip = MakeSyntheticClip(name, actor, 0, kSeed);
    EXPECT_TRUE(SameNumbers(clip, MakeSyntheticClip(name, actor, 0, kSeed))) << name;
    EXPECT_FALSE(SameNumbers(clip, MakeSyntheticClip(name, actor, 1, kSeed))) << name;
    EXPECT_FALSE(SameNumbers(clip, MakeSyntheticClip(name, actor, 0, kSeed + 1))) << name;
  }
}

TEST(SyntheticClip, RefusesAnUnknownClassAndNamesTheOthers) {
  const Error error =
      ErrorOf([] { (void)MakeSyntheticClip("fly", MakeSyntheticActor(0, 1), 0, 1); });
  EXPECT_EQ(error.code(), ErrorCode::kNotFound);
  EXPECT_NE(error.message().find("squat1Reps"), std::string::npos) << error.message();
}

TEST(SyntheticClip, KeepsBoneLengths) {
  ForEachClass([](const JointTrajectories& t, const Skeleton& skeleton) {
    for (int frame = 0; frame < t.frame_count(); ++frame) {
      for (int j = 1; j < t.joint_count; ++j) {
        const Joint& joint = skeleton.joints()[j];
        ASSERT_NEAR((t.at(frame, j) - t.at(frame, joint.parent)).norm(), joint.length_cm, 1e-9);
      }
    }
  });
}

TEST(SyntheticClip, NeverGoesThroughTheFloor) {
  ForEachClass([](const JointTrajectories& t, const Skeleton&) {
    EXPECT_GT(ComputeBoundingBox(t).low_cm.y(), -0.05);
  });
}

TEST(SyntheticClip, StandsOnTheFloorUnlessItJogsOrJumps) {
  for (const std::string& name : SyntheticClasses()) {
    if (name.starts_with("jog") || name.starts_with("hop") || name.starts_with("jumping")) continue;
    ForEachClip(name, [](const Motion& clip) {
      const JointTrajectories t = ForwardKinematics(clip);
      for (int frame = 0; frame < t.frame_count(); ++frame) {
        double low = 1000;
        for (int j = 0; j < t.joint_count; ++j) low = std::min(low, t.at(frame, j).y());
        ASSERT_LT(low, 0.3) << frame;
      }
    });
  }
}

// The ball of the foot is down, to a tenth of a millimetre, in three frames running.
TEST(SyntheticClip, DoesNotSlideOnAFootThatStands) {
  ForEachClass([](const JointTrajectories& t, const Skeleton& skeleton) {
    for (const char* name : {"lfoot", "rfoot"}) {
      const int ball = *skeleton.FindBone(name);
      for (int frame = 1; frame + 1 < t.frame_count(); ++frame) {
        const auto height = [&](int at) { return t.at(at, ball).y(); };
        const double high = std::max({height(frame - 1), height(frame), height(frame + 1)});
        if (high > 0.01) continue;
        ASSERT_LT((t.at(frame, ball) - t.at(frame - 1, ball)).norm(), 0.25) << name << ' ' << frame;
      }
    }
  });
}

TEST(SyntheticClip, MovesNoFasterThanPeopleAndNeverJumps) {
  ForEachClass([](const JointTrajectories& t, const Skeleton& skeleton) {
    for (int j = 0; j < t.joint_count; ++j) {
      Eigen::Vector3d before = Eigen::Vector3d::Zero();
      for (int frame = 1; frame < t.frame_count(); ++frame) {
        const Eigen::Vector3d velocity = (t.at(frame, j) - t.at(frame - 1, j)) * t.rate_hz;
        // A hand in an overarm throw and a foot in a kick do 15 to 20 m/s.
        ASSERT_LT(velocity.norm(), 1800) << skeleton.joints()[j].name << ' ' << frame;
        if (frame > 1) {
          ASSERT_LT((velocity - before).norm(), 600) << skeleton.joints()[j].name << ' ' << frame;
        }
        before = velocity;
      }
    }
  });
}

TEST(SyntheticClip, BendsKneesAndElbowsTheRightWayAndNotTooFar) {
  for (const std::string& name : SyntheticClasses()) {
    ForEachClip(name, [](const Motion& clip) {
      for (const char* bone : {"ltibia", "rtibia", "lradius", "rradius"}) {
        for (const Eigen::Vector3d& angles : EulerAngles(clip, *clip.skeleton->FindBone(bone))) {
          ASSERT_GT(angles.x(), -0.05) << bone;
          ASSERT_LT(angles.x(), 2.75) << bone;
        }
      }
      // Seen from outside: thigh × shank points to the performer's left, so the shank goes back.
      const JointTrajectories t = StandardJoints(clip);
      for (int f = 0; f < t.frame_count(); ++f) {
        const Eigen::Vector3d hips = t.at(f, StandardJoint::kLhip) - t.at(f, StandardJoint::kRhip);
        const auto bend = [&](StandardJoint hip, StandardJoint knee, StandardJoint ankle) {
          const Eigen::Vector3d thigh = t.at(f, knee) - t.at(f, hip);
          const Eigen::Vector3d shank = t.at(f, ankle) - t.at(f, knee);
          return thigh.normalized().cross(shank.normalized()).dot(hips.normalized());
        };
        using enum StandardJoint;
        ASSERT_GT(bend(kLhip, kLknee, kLankle), 0.03) << f;
        ASSERT_GT(bend(kRhip, kRknee, kRankle), 0.03) << f;
      }
    });
  }
}

TEST(SyntheticClip, VariesFromOneRepetitionToTheNextButNotMuch) {
  const SyntheticActor actor = MakeSyntheticActor(1, kSeed);
  const Motion a = MakeSyntheticClip("squat1Reps", actor, 0, kSeed);
  const Motion b = MakeSyntheticClip("squat1Reps", actor, 1, kSeed);
  EXPECT_NE(a.frame_count, b.frame_count);
  EXPECT_NEAR(a.duration_s(), b.duration_s(), 0.35 * a.duration_s());
}

}  // namespace
}  // namespace kinebase::test
