// BVH files that are read, written and read again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "kinebase/core/error.h"
#include "kinebase/motion/bvh_motion.h"
#include "kinebase/motion/kinematics.h"
#include "motion/figure.h"
#include "motion/person.h"
#include "motion/recording_files.h"

namespace kinebase {
namespace {

using test::Messages;
using test::With;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

std::string PersonText() {
  const auto name = [](StandardJoint joint) { return std::string(ToString(joint)); };
  return test::BvhOf(test::MakePerson(name));
}

// What a text written for `motion` is read as.
Motion Again(const BvhMotion& bvh, const BvhWriteOptions& options) {
  Diagnostics ignored;
  return BuildFigure(ParseBvh(FormatBvh(bvh), "a.bvh"),
                     {.units = options.units, .up_axis = options.up_axis}, ignored)
      .motion;
}

double LargestDistanceOfBones(const Motion& a, const Motion& b) {
  const JointTrajectories of_a = ForwardKinematics(a);
  const JointTrajectories of_b = ForwardKinematics(b);
  double largest = a.frame_count == b.frame_count ? 0 : INFINITY;
  for (int joint = 0; joint < a.joint_count(); ++joint) {
    // A bone of another format is a joint where it begins; where it ends another begins, or a tip.
    for (int frame = 0; frame < a.frame_count; ++frame) {
      double nearest = INFINITY;
      for (int other = 0; other < b.joint_count(); ++other) {
        nearest = std::min(nearest, (of_a.at(frame, joint) - of_b.at(frame, other)).norm());
      }
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

RC_GTEST_PROP(ToBvh, KeepsThePlacesOfAnyFigure, ()) {
  const BvhWriteOptions options{.units = *rc::gen::element<std::string>("cm", "m", "inch / 0.45"),
                                .up_axis = *rc::gen::element(UpAxis::kX, UpAxis::kY, UpAxis::kZ)};
  const Motion motion =
      test::SmoothMotion(test::FigureSkeleton(), *rc::gen::arbitrary<unsigned>(), 6, 60, 3);
  Diagnostics ignored;
  const BvhMotion bvh = ToBvh(motion, options, ignored);
  const Motion again = Again(bvh, options);
  RC_ASSERT(again.rate_hz == 60);
  RC_ASSERT(LargestDistanceOfBones(motion, again) < 1e-5);
  // What came from BVH has the same joints afterwards, so that they are compared one by one.
  const Motion third = Again(ToBvh(again, options, ignored), options);
  RC_ASSERT(third.joint_count() == again.joint_count());
  RC_ASSERT(test::LargestDistance(ForwardKinematics(third), ForwardKinematics(again)) < 1e-5);
}

TEST(ToBvh, WritesBonesThatStretchAsPositions) {
  Motion motion = test::SmoothMotion(test::FigureSkeleton(), 5, 4, 60);
  motion.extra_offsets_cm.assign(motion.rotations.size(), Eigen::Vector3d::Zero());
  const int thorax = motion.skeleton->FindBone("thorax").value();
  const int tip = motion.skeleton->FindBone("lfingers").value();
  for (int frame = 0; frame < 4; ++frame) {
    const auto row = static_cast<std::size_t>(frame) * motion.joint_count();
    motion.extra_offsets_cm[row + thorax] = {.1 * frame, 1, -.3 * frame};
    motion.extra_offsets_cm[row + tip] = {0, .5 * frame, 0};
  }
  Diagnostics diagnostics;
  const BvhWriteOptions options;
  const Motion again = Again(ToBvh(motion, options, diagnostics), options);
  EXPECT_LE(LargestDistanceOfBones(motion, again), 1e-6);
  EXPECT_FALSE(again.extra_offsets_cm.empty());
}

TEST(ToBvh, UnwindsAngles) {
  Motion motion = test::SmoothMotion(test::FigureSkeleton(), 5, 90, 60, 0);
  for (int frame = 0; frame < 90; ++frame) {
    motion.rotations[static_cast<std::size_t>(frame) * motion.joint_count()] =
        Eigen::AngleAxisd(frame * .1, Eigen::Vector3d::UnitY());
  }
  Diagnostics ignored;
  const BvhMotion bvh = ToBvh(motion, {}, ignored);
  const auto& channels = bvh.joints[0].channels;
  const auto column = static_cast<std::size_t>(std::ranges::find(channels, BvhChannel::kYRotation) -
                                               channels.begin());
  for (std::size_t frame = 0; frame < 90; ++frame) {
    EXPECT_NEAR(bvh.Frame(frame)[column], static_cast<double>(frame) * 18 / std::numbers::pi, 1e-6);
  }
}

TEST(ToBvh, SaysWhichRateReadersWillTake) {
  const Motion motion = test::SmoothMotion(test::FigureSkeleton(), 5, 3, 119.95);
  Diagnostics diagnostics;
  (void)ToBvh(motion, {}, diagnostics);
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("reads as 120 Hz")));
}

using BvhFile = test::RecordingFiles;

TEST_F(BvhFile, IsWrittenAsItWasRead) {
  const std::string text = PersonText();
  const Recording loaded = LoadText("a.bvh", text);
  EXPECT_EQ(loaded.format, "BVH");
  const std::string written = Save(loaded, "b.bvh");
  EXPECT_THAT(diagnostics_, IsEmpty());
  const Recording again = LoadRecording(PathOf("b.bvh"));
  EXPECT_EQ(std::get<BvhMotion>(*again.record), std::get<BvhMotion>(*loaded.record));
  EXPECT_EQ(Save(again, "c.bvh"), written);
}

TEST_F(BvhFile, KeepsTheTextOfAFrameTimeThatIsSnapped) {
  const std::pair<const char*, double> times[] = {
      {"0.0083333", 120}, {"0.033333", 30}, {".0166667", 60}, {"0.041708", 24000. / 1001}};
  for (const auto& [text, rate_hz] : times) {
    const Recording loaded = LoadText("a.bvh", With(PersonText(), "0.0083333", text));
    EXPECT_DOUBLE_EQ(loaded.rate_hz(), rate_hz);
    for (const char* units : {"", "m"}) {
      EXPECT_THAT(Save(loaded, "b.bvh", {.overwrite = Overwrite::kYes, .units = units}),
                  HasSubstr(fmt::format("Frame Time: {}\n", text)));
    }
  }
}

TEST_F(BvhFile, CountsRowsAndMendsTheDeclaredNumber) {
  const Recording loaded = LoadText("a.bvh", With(PersonText(), "Frames: 2", "Frames: 3069"));
  EXPECT_EQ(loaded.frame_count(), 2);
  EXPECT_THAT(Messages(loaded.diagnostics), Contains(HasSubstr("3069")));
  EXPECT_THAT(Save(loaded, "b.bvh"), HasSubstr("Frames: 2\n"));
  EXPECT_THAT(Messages(diagnostics_), Contains(HasSubstr("said 3069")));
}

TEST_F(BvhFile, TakesTheUsersRateWhereItsFrameTimeIsNone) {
  for (const char* time : {"0", "-1", "1e-9", "12345"}) {
    const std::string text = With(PersonText(), "0.0083333", time);
    const Recording asked = LoadText("a.bvh", text, {.source_rate_hz = 50});
    EXPECT_EQ(asked.rate_hz(), 50) << time;
    EXPECT_EQ(LoadText("HDM_xx_made_001_60.bvh", text).rate_hz(), 60) << time;
    const Recording guessed = LoadText("a.bvh", text);
    EXPECT_EQ(guessed.rate_hz(), 120) << time;
    EXPECT_THAT(Messages(guessed.diagnostics), Contains(HasSubstr("--source-rate"))) << time;
    // What was read so must not be lost again.
    for (const char* units : {"", "m"}) {
      Save(asked, "b.bvh", {.overwrite = Overwrite::kYes, .units = units});
      EXPECT_EQ(LoadRecording(PathOf("b.bvh")).rate_hz(), 50) << time;
    }
  }
}

TEST_F(BvhFile, ChangesUnitsAndAxesAsAskedFor) {
  const Recording loaded = LoadText("a.bvh", PersonText());
  const JointTrajectories expected = ForwardKinematics(loaded.motion);
  for (const auto& [units, up] :
       {std::pair("m", UpAxis::kZ), {"mm", UpAxis::kY}, {"", UpAxis::kZ}}) {
    const Recording again =
        SaveAndLoad(loaded, "b.bvh", {.overwrite = Overwrite::kYes, .up_axis = up, .units = units});
    EXPECT_EQ(again.units, *units == '\0' ? "cm" : units);
    EXPECT_EQ(again.up_axis, ToString(up));
    EXPECT_LE(test::LargestDistance(ForwardKinematics(again.motion), expected), 1e-6);
  }
}

TEST_F(BvhFile, OfACutHoldsTheFramesOfTheCut) {
  const Recording whole{.motion = test::SmoothMotion(test::FigureSkeleton(), 3, 12, 60)};
  const Recording loaded = SaveAndLoad(whole, "a.bvh");
  const Recording cut = CutRecording(loaded, 3, 7);
  const Recording again = SaveAndLoad(cut, "b.bvh");
  EXPECT_THAT(test::Messages(diagnostics_), ElementsAre(HasSubstr("first is number 4")));
  ASSERT_EQ(again.frame_count(), 5);
  const JointTrajectories all = ForwardKinematics(loaded.motion);
  const JointTrajectories part = ForwardKinematics(again.motion);
  ASSERT_EQ(part.joint_count, all.joint_count);
  for (int joint = 0; joint < all.joint_count; ++joint) {
    EXPECT_LE((part.at(4, joint) - all.at(7, joint)).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace kinebase
