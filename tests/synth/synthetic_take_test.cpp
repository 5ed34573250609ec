#include <gtest/gtest.h>

#include <set>

#include "kinebase/core/error.h"
#include "support/files.h"
#include "synth/poses.h"

namespace kinebase::test {
namespace {

using enum StandardJoint;

constexpr int kClips = 16;

SyntheticTake MakeTake(int actor) {
  return MakeSyntheticTake(MakeSyntheticActor(actor, kSeed), kClips, 0, kSeed);
}

TEST(SyntheticTake, TellsWhatHappensWhenInOrderAndWithoutOverlap) {
  for (int actor = 0; actor < kActors; ++actor) {
    const SyntheticTake take = MakeTake(actor);
    ASSERT_EQ(take.segments.size(), static_cast<std::size_t>(kClips));
    int end = 0;
    for (const SyntheticSegment& segment : take.segments) {
      EXPECT_GT(segment.first_frame, end);
      EXPECT_GT(segment.last_frame, segment.first_frame + 60);
      end = segment.last_frame;
    }
    EXPECT_LE(end, take.motion.frame_count);
  }
}

TEST(SyntheticTake, ShowsEveryClassBeforeOneComesAgain) {
  const SyntheticTake take = MakeTake(0);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < SyntheticClasses().size(); ++i) {
    seen.insert(take.segments[i].class_name);
  }
  EXPECT_EQ(seen.size(), SyntheticClasses().size());
}

TEST(SyntheticTake, BeginsAndEndsInATPose) {
  for (int actor = 0; actor < kActors; ++actor) {
    const JointTrajectories t = StandardJoints(MakeTake(actor).motion);
    for (const int frame : {0, t.frame_count() - 1}) {
      const double span = Distance(t, frame, kLfingers, kRfingers);
      const double arms = Distance(t, frame, kLshoulder, kLelbow) +
                          Distance(t, frame, kLelbow, kLwrist) +
                          Distance(t, frame, kLwrist, kLfingers);
      EXPECT_GT(span, 2 * arms);
      EXPECT_NEAR(t.at(frame, kLwrist).y(), t.at(frame, kLshoulder).y(), 10);
    }
  }
}

TEST(SyntheticTake, HasNoJumpsWhereOnePieceMeetsTheNext) {
  for (int actor = 0; actor < kActors; ++actor) {
    const JointTrajectories t = ForwardKinematics(MakeTake(actor).motion);
    EXPECT_GT(ComputeBoundingBox(t).low_cm.y(), -0.05);
    for (int j = 0; j < t.joint_count; ++j) {
      for (int frame = 2; frame < t.frame_count(); ++frame) {
        const Eigen::Vector3d change = t.at(frame, j) - 2 * t.at(frame - 1, j) + t.at(frame - 2, j);
        ASSERT_LT((t.at(frame, j) - t.at(frame - 1, j)).norm(), 16) << j << ' ' << frame;
        ASSERT_LT(change.norm(), 5) << j << ' ' << frame;
      }
    }
  }
}

TEST(SyntheticTake, StandsStillOrTurnsBetweenTheClips) {
  const SyntheticTake take = MakeTake(2);
  const JointTrajectories t = StandardJoints(take.motion);
  for (const SyntheticSegment& segment : take.segments) {
    // The segment holds the motion: what a squat's frames show is a squat.
    if (segment.class_name != "squat1Reps") continue;
    double lowest = 1000;
    for (int frame = segment.first_frame - 1; frame < segment.last_frame; ++frame) {
      lowest = std::min(lowest, t.at(frame, kRoot).y());
    }
    EXPECT_LT(lowest, 0.75 * t.at(segment.first_frame - 1, kRoot).y());
  }
  const int begin = take.segments.back().last_frame;
  EXPECT_LT((t.at(begin + 60, kRoot) - t.at(t.frame_count() - 1, kRoot)).norm(), 60);
}

TEST(SyntheticTake, IsTheSameForTheSameSeedAndAnotherForAnotherNumber) {
  const SyntheticActor actor = MakeSyntheticActor(0, kSeed);
  const Motion a = MakeSyntheticTake(actor, 3, 0, kSeed).motion;
  const Motion same = MakeSyntheticTake(actor, 3, 0, kSeed).motion;
  const Motion other = MakeSyntheticTake(actor, 3, 1, kSeed).motion;
  EXPECT_EQ(a.root_position_cm, same.root_position_cm);
  EXPECT_NE(a.root_position_cm, other.root_position_cm);
}

TEST(SyntheticTake, ChoosesAmongTheClassesThatAreNamed) {
  const SyntheticActor actor = MakeSyntheticActor(0, kSeed);
  const SyntheticTake take = MakeSyntheticTake(actor, 3, 0, kSeed, {"squat1Reps"});
  for (const SyntheticSegment& segment : take.segments) {
    EXPECT_EQ(segment.class_name, "squat1Reps");
  }
  EXPECT_EQ(ErrorOf([&] { (void)MakeSyntheticTake(actor, 3, 0, kSeed, {"fly"}); }).code(),
            ErrorCode::kNotFound);
}

TEST(LongSyntheticTake, HasExactlyTheFramesThatWereAskedForAtAnyRate) {
  const SyntheticActor actor = MakeSyntheticActor(1, kSeed);
  for (const double rate_hz : {30.0, 120.0}) {
    const SyntheticTake take =
        MakeLongSyntheticTake(actor, {.duration_s = 60, .rate_hz = rate_hz, .seed = kSeed});
    EXPECT_EQ(take.motion.frame_count, 60 * rate_hz);
    EXPECT_EQ(take.motion.rate_hz, rate_hz);
    EXPECT_GT(take.segments.size(), 8U);
    EXPECT_LE(take.segments.back().last_frame, take.motion.frame_count);
  }
  EXPECT_EQ(MakeLongSyntheticTake(actor, {.duration_s = 1.0 / 120}).motion.frame_count, 1);
}

TEST(LongSyntheticTake, IsTheSameMotionWithFewerFramesAtALowerRate) {
  const SyntheticActor actor = MakeSyntheticActor(2, kSeed);
  const auto take = [&](double rate_hz) {
    return MakeLongSyntheticTake(actor, {.duration_s = 20, .rate_hz = rate_hz, .seed = kSeed});
  };
  const SyntheticTake fine = take(120);
  const SyntheticTake coarse = take(30);
  ASSERT_EQ(coarse.segments.size(), fine.segments.size());
  for (std::size_t i = 0; i < fine.segments.size(); ++i) {
    EXPECT_EQ(coarse.segments[i].class_name, fine.segments[i].class_name);
    // Every piece before it is rounded to frames.
    EXPECT_NEAR(coarse.segments[i].first_frame / 30.0, fine.segments[i].first_frame / 120.0,
                0.05 * static_cast<double>(i + 3));
  }
}

TEST(LongSyntheticTake, RefusesWhatIsNoTake) {
  const SyntheticActor actor = MakeSyntheticActor(0, kSeed);
  for (const LongTakeOptions& options : {LongTakeOptions{.duration_s = 0},
                                         {.duration_s = -5},
                                         {.duration_s = std::nan("")},
                                         {.duration_s = 1e9},
                                         {.rate_hz = 0},
                                         {.rate_hz = 1e9}}) {
    EXPECT_EQ(ErrorOf([&] { (void)MakeLongSyntheticTake(actor, options); }).code(),
              ErrorCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace kinebase::test
