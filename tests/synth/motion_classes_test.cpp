// Each class shows what its name says, for every actor and repetition.
#include <gtest/gtest.h>

#include "synth/poses.h"

namespace kinebase::test {
namespace {

using enum StandardJoint;

double KneeBend(const JointTrajectories& t, int frame, bool left) {
  return left ? BendDegrees(t, frame, kLhip, kLknee, kLankle)
              : BendDegrees(t, frame, kRhip, kRknee, kRankle);
}

// Which foot is ahead, each time that it changes: step after step, without the one before.
std::vector<bool> StepsOfTheLeftFoot(const JointTrajectories& t) {
  std::vector<bool> sides;
  const Eigen::Vector3d way = Ahead(t, 0);
  for (int frame = 0; frame < t.frame_count(); ++frame) {
    const double gap = (t.at(frame, kLankle) - t.at(frame, kRankle)).dot(way);
    if (std::abs(gap) < 15) continue;  // Feet are passing each other.
    if (sides.empty() || sides.back() != (gap > 0)) sides.push_back(gap > 0);
  }
  // The left foot may still be ahead as the right one sets off.
  if (!sides.empty() && sides.front()) sides.erase(sides.begin());
  return sides;
}

TEST(Squat, LowersThePelvisByAQuarterAndComesBackUp) {
  ForEachPerformance("squat1Reps", [](const JointTrajectories& t) {
    const auto height = [&](int frame) { return t.at(frame, kRoot).y(); };
    const double standing = height(0);
    EXPECT_LT(Smallest(t, height), 0.75 * standing);
    EXPECT_NEAR(height(t.frame_count() - 1), standing, 0.03 * standing);
    EXPECT_GT(Largest(t, [&](int f) { return KneeBend(t, f, true); }), 90);
    EXPECT_GT(Largest(t, [&](int f) { return KneeBend(t, f, false); }), 90);
  });
}

TEST(JumpingJack, HasTheHandsAboveTheHeadWhileTheFeetAreApart) {
  ForEachPerformance("jumpingJack1Reps", [](const JointTrajectories& t) {
    const auto feet = [&](int frame) { return Distance(t, frame, kLankle, kRankle); };
    const int open = FrameOfLargest(t, feet);
    const double hips = Distance(t, 0, kLhip, kRhip);
    EXPECT_GT(feet(open), 2.5 * hips);
    EXPECT_GT(t.at(open, kLwrist).y(), t.at(open, kHeadtop).y());
    EXPECT_GT(t.at(open, kRwrist).y(), t.at(open, kHeadtop).y());
    for (const int end : {0, t.frame_count() - 1}) {
      EXPECT_LT(feet(end), 2 * hips);
      EXPECT_LT(t.at(end, kLwrist).y(), t.at(end, kChest).y());
      EXPECT_LT(t.at(end, kRwrist).y(), t.at(end, kChest).y());
    }
  });
}

TEST(JumpingJack, LeavesTheFloorTwice) {
  ForEachPerformance("jumpingJack1Reps", [](const JointTrajectories& t) {
    int flights = 0;
    bool flew = false;
    for (int frame = 0; frame < t.frame_count(); ++frame) {
      const bool flies = std::min(t.at(frame, kLtoes).y(), t.at(frame, kRtoes).y()) > 0.5;
      flights += flies && !flew;
      flew = flies;
    }
    EXPECT_EQ(flights, 2);
  });
}

TEST(ElbowToKnee, BringsFirstTheLeftElbowToTheRightKneeThenTheOtherWayRound) {
  ForEachPerformance("elbowToKnee1RepsLelbowStart", [](const JointTrajectories& t) {
    const auto left = [&](int frame) { return Distance(t, frame, kLelbow, kRknee); };
    const auto right = [&](int frame) { return Distance(t, frame, kRelbow, kLknee); };
    EXPECT_LT(Smallest(t, left), 16);
    EXPECT_LT(Smallest(t, right), 16);
    EXPECT_GT(left(0), 60);
    const int first = FrameOfLargest(t, [&](int f) { return -left(f); });
    const int second = FrameOfLargest(t, [&](int f) { return -right(f); });
    EXPECT_LT(first, t.frame_count() / 2);
    EXPECT_GT(second, t.frame_count() / 2);
    EXPECT_GT(t.at(first, kRankle).y(), t.at(first, kLankle).y() + 20);
    EXPECT_GT(t.at(second, kLankle).y(), t.at(second, kRankle).y() + 20);
  });
}

TEST(ElbowToKnee, KeepsTheHandsAtTheHead) {
  ForEachPerformance("elbowToKnee1RepsLelbowStart", [](const JointTrajectories& t) {
    for (int frame = 0; frame < t.frame_count(); ++frame) {
      const Eigen::Vector3d head = (t.at(frame, kHead) + t.at(frame, kHeadtop)) / 2;
      EXPECT_LT((t.at(frame, kLfingers) - head).norm(), 28) << frame;
      EXPECT_LT((t.at(frame, kRfingers) - head).norm(), 28) << frame;
    }
    for (const int end : {0, t.frame_count() - 1}) {
      EXPECT_LT((t.at(end, kLfingers) - t.at(end, kHead)).dot(Ahead(t, end)), 0);
      EXPECT_LT((t.at(end, kRfingers) - t.at(end, kHead)).dot(Ahead(t, end)), 0);
    }
  });
}

void ExpectKick(const std::string& class_name, StandardJoint ankle, StandardJoint other_ankle,
                StandardJoint other_knee) {
  ForEachPerformance(class_name, [&](const JointTrajectories& t) {
    const int high = FrameOfLargest(t, [&](int f) { return t.at(f, ankle).y(); });
    EXPECT_GT(t.at(high, ankle).y(), t.at(high, other_knee).y() + 10);
    EXPECT_GT((t.at(high, ankle) - t.at(high, kRoot)).dot(Ahead(t, high)), 40);
    EXPECT_LT(Largest(t, [&](int f) { return t.at(f, other_ankle).y(); }), 12);
  });
}

TEST(KickRFront, RaisesTheRightAnkleInFrontAboveTheLeftKnee) {
  ExpectKick("kickRFront1Reps", kRankle, kLankle, kLknee);
}

TEST(KickLFront, RaisesTheLeftAnkleInFrontAboveTheRightKnee) {
  ExpectKick("kickLFront1Reps", kLankle, kRankle, kRknee);
}

TEST(RotateArmsRForward, TurnsTheRightArmOnceForwardsAndNotTheLeft) {
  ForEachPerformance("rotateArmsRForward1Reps", [](const JointTrajectories& t) {
    EXPECT_NEAR(ArmTurns(t, kRshoulder, kRwrist), -1, 0.06);
    EXPECT_NEAR(ArmTurns(t, kLshoulder, kLwrist), 0, 0.06);
    // Forwards: at the top the hand goes ahead.
    const int top = FrameOfLargest(t, [&](int f) { return t.at(f, kRwrist).y(); });
    EXPECT_GT((t.at(top + 3, kRwrist) - t.at(top - 3, kRwrist)).dot(Ahead(t, top)), 0);
  });
}

TEST(ThrowOverarmR, BringsTheRightHandFromBehindTheShoulderToTheFrontFast) {
  ForEachPerformance("throwOverarmR", [](const JointTrajectories& t) {
    const Eigen::Vector3d way = Ahead(t, 0);
    const auto speed = [&](StandardJoint joint) {
      return [&t, joint](int frame) {
        return frame == 0 ? 0 : (t.at(frame, joint) - t.at(frame - 1, joint)).norm() * t.rate_hz;
      };
    };
    EXPECT_GT(Largest(t, speed(kRfingers)), 700);
    EXPECT_GT(Largest(t, speed(kRfingers)), 1.3 * Largest(t, speed(kLfingers)));
    const auto ahead = [&](int f) { return (t.at(f, kRwrist) - t.at(f, kRshoulder)).dot(way); };
    EXPECT_LT(Smallest(t, ahead), -10);
    EXPECT_GT(Largest(t, ahead), 35);
    // It comes past the shoulder above it.
    int passing = FrameOfLargest(t, [&](int f) { return -ahead(f); });
    while (ahead(passing) < 0) ++passing;
    EXPECT_GT(t.at(passing, kRwrist).y(), t.at(passing, kRshoulder).y() + 20);
    // The left foot steps ahead, as right-handers throw.
    EXPECT_GT(Largest(t, [&](int f) { return (t.at(f, kLankle) - t.at(f, kRankle)).dot(way); }),
              20);
  });
}

TEST(GrabHighR, ReachesAboveTheHeadWithTheRightHandAlone) {
  ForEachPerformance("grabHighR", [](const JointTrajectories& t) {
    const int high = FrameOfLargest(t, [&](int f) { return t.at(f, kRwrist).y(); });
    EXPECT_GT(t.at(high, kRwrist).y(), t.at(high, kHeadtop).y() + 10);
    EXPECT_LT(Largest(t, [&](int f) { return t.at(f, kLwrist).y() - t.at(f, kChest).y(); }), 0);
  });
}

TEST(ClapAboveHead, BringsTheHandsTogetherAboveTheHead) {
  ForEachPerformance("clapAboveHead1Reps", [](const JointTrajectories& t) {
    const int clap = FrameOfLargest(t, [&](int f) { return t.at(f, kLwrist).y(); });
    const auto above = [&](int f) {
      return t.at(f, kLfingers).y() > t.at(f, kHeadtop).y() &&
             t.at(f, kRfingers).y() > t.at(f, kHeadtop).y();
    };
    EXPECT_TRUE(above(clap));
    EXPECT_LT(
        Smallest(t,
                 [&](int f) { return above(f) ? Distance(t, f, kLfingers, kRfingers) : 1000.0; }),
        20);
    EXPECT_GT(Distance(t, 0, kLfingers, kRfingers), 30);
  });
}

TEST(DepositFloorR, TakesTheRightHandToTheFloor) {
  ForEachPerformance("depositFloorR", [](const JointTrajectories& t) {
    const int low = FrameOfLargest(t, [&](int f) { return -t.at(f, kRfingers).y(); });
    EXPECT_LT(t.at(low, kRfingers).y(), 30);
    EXPECT_GT(t.at(low, kRfingers).y(), 0);
    EXPECT_GT(t.at(low, kLfingers).y(), t.at(low, kRfingers).y() + 15);
    EXPECT_GT(t.at(0, kRfingers).y(), 50);
  });
}

TEST(PunchRFront, StretchesTheRightArmAheadAndNotTheLeft) {
  ForEachPerformance("punchRFront1Reps", [](const JointTrajectories& t) {
    const Eigen::Vector3d way =
        (t.at(0, kLtoes) - t.at(0, kLankle)).cwiseProduct(Eigen::Vector3d(1, 0, 1)).normalized();
    const int out = FrameOfLargest(t, [&](int f) { return Distance(t, f, kRshoulder, kRwrist); });
    EXPECT_LT(BendDegrees(t, out, kRshoulder, kRelbow, kRwrist), 25);
    EXPECT_GT((t.at(out, kRwrist) - t.at(out, kRshoulder)).dot(way), 35);
    for (int frame = 0; frame < t.frame_count(); ++frame) {
      EXPECT_GT(BendDegrees(t, frame, kLshoulder, kLelbow, kLwrist), 60) << frame;
    }
  });
}

TEST(Walk, MakesFourStepsTheRightFootFirst) {
  ForEachPerformance("walk4StepsRstart", [](const JointTrajectories& t) {
    EXPECT_EQ(StepsOfTheLeftFoot(t), std::vector<bool>({false, true, false, true}));
    const Eigen::Vector3d way = t.at(t.frame_count() - 1, kRoot) - t.at(0, kRoot);
    EXPECT_GT(way.dot(Ahead(t, 0)), 150);
  });
}

TEST(Walk, AlwaysHasAFootOnTheFloorAndSwingsOppositeArms) {
  ForEachClip("walk4StepsRstart", [](const Motion& clip) {
    const JointTrajectories all = ForwardKinematics(clip);
    const JointTrajectories t = StandardJoints(clip);
    double together = 0;
    for (int frame = 0; frame < t.frame_count(); ++frame) {
      const double low = std::min(all.at(frame, *clip.skeleton->FindBone("lfoot")).y(),
                                  all.at(frame, *clip.skeleton->FindBone("rfoot")).y());
      EXPECT_LT(low, 2.5) << frame;
      const Eigen::Vector3d way = Ahead(t, frame);
      together += (t.at(frame, kLwrist) - t.at(frame, kRwrist)).dot(way) *
                  (t.at(frame, kLankle) - t.at(frame, kRankle)).dot(way);
    }
    EXPECT_LT(together, 0);
  });
}

TEST(Jog, MakesFourStepsTheRightFootFirstAndFliesInBetween) {
  ForEachPerformance("jog4StepsRstart", [](const JointTrajectories& t) {
    const Eigen::Vector3d way = t.at(t.frame_count() - 1, kRoot) - t.at(0, kRoot);
    const double speed = way.norm() / (t.frame_count() / t.rate_hz);
    EXPECT_GT(speed, 170);
    EXPECT_GT(way.normalized().dot(Ahead(t, 0)), 0.95);
    EXPECT_GT(Largest(t, [&](int f) { return std::min(t.at(f, kLtoes).y(), t.at(f, kRtoes).y()); }),
              0.5);
    EXPECT_EQ(StepsOfTheLeftFoot(t), std::vector<bool>({false, true, false, true}));
  });
}

TEST(HopBothLegs, FliesWithBothFeetUnderGravity) {
  ForEachPerformance("hopBothLegs1hops", [](const JointTrajectories& t) {
    const auto low = [&](int f) { return std::min(t.at(f, kLtoes).y(), t.at(f, kRtoes).y()); };
    EXPECT_GT(Largest(t, low), 4);
    int flying = 0;
    for (int f = 0; f < t.frame_count(); ++f) flying += low(f) > 0.3;
    const double flight_s = flying / t.rate_hz;
    // A flight of T seconds rises by g·T²/8.
    EXPECT_NEAR(Largest(t, low), 981 * flight_s * flight_s / 8, 5);
    EXPECT_LT(std::abs((t.at(t.frame_count() - 1, kRoot) - t.at(0, kRoot)).dot(ToTheLeft(t, 0))),
              10);
  });
}

TEST(SyntheticClasses, AreAtLeastEightAndEachHasItsOwnName) {
  std::vector<std::string> names = SyntheticClasses();
  EXPECT_GE(names.size(), 8U);
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

}  // namespace
}  // namespace kinebase::test
