// What formats cannot carry is refused or told, and what a cut cannot keep does not go along.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"
#include "motion/c3d_recordings.h"
#include "motion/figure.h"
#include "motion/recording_files.h"

namespace kinebase {
namespace {

using test::Messages;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

using RecordingLimits = test::RecordingFiles;

Recording Markers() {
  Recording markers{.path = "walk.c3d",
                    .markers = {.labels = {"C7"}, .rate_hz = 50, .frame_count = 3}};
  markers.markers.positions_cm = {{1, 2, 3}, {2, 2, 3}, {3, 2, 3}};
  markers.markers.states.assign(3, MarkerState::kMeasured);
  return markers;
}

Recording Skeletal() {
  return {.path = "walk.amc", .motion = test::SmoothMotion(test::FigureSkeleton(), 3, 12, 60)};
}

TEST_F(RecordingLimits, NameWhatWouldHoldMarkers) {
  for (const char* file : {"a.amc", "a.bvh", "a.glb"}) {
    const Error error = test::ErrorOf([&] { Save(Markers(), file); });
    EXPECT_EQ(error.code(), ErrorCode::kMismatch);
    EXPECT_THAT(error.what(), AllOf(HasSubstr(file), HasSubstr("'walk.c3d' holds markers only"),
                                    HasSubstr("C3D, CSM, TRC, NPZ, MAT and CSV")));
    EXPECT_FALSE(std::filesystem::exists(PathOf(file)));
  }
  for (const char* file : {"a.mot", "a.sto"}) {
    const Error error = test::ErrorOf([&] { Save(Markers(), file); });
    EXPECT_EQ(error.code(), ErrorCode::kMismatch);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("'walk.c3d' has markers only"), HasSubstr("TRC")));
  }
}

TEST_F(RecordingLimits, LetASkeletonBecomePointsAndSaySo) {
  const Recording walk = Skeletal();
  for (const char* file : {"a.c3d", "a.trc", "a.csv"}) {
    SCOPED_TRACE(file);
    Save(walk, file);
    EXPECT_THAT(Messages(diagnostics_),
                Contains(HasSubstr(fmt::format("the {} joints are written as points",
                                               walk.motion.joint_count()))));
  }
  const MarkerCloud points = LoadRecording(PathOf("a.c3d")).markers;
  const JointTrajectories joints = ForwardKinematics(walk.motion);
  ASSERT_EQ(points.marker_count(), joints.joint_count);
  for (int joint = 0; joint < joints.joint_count; ++joint) {
    EXPECT_EQ(points.labels[joint], walk.motion.skeleton->joints()[joint].bone_name);
    EXPECT_LE((points.at(11, joint) - joints.at(11, joint)).norm(), 1e-4);
  }
}

TEST_F(RecordingLimits, LetNoSkeletonIntoCsm) {
  const Error error = test::ErrorOf([&] { Save(Skeletal(), "a.csm"); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), AllOf(HasSubstr("CSM holds markers"), HasSubstr("C3D and TRC")));
}

TEST_F(RecordingLimits, RefuseARecordingOfNothingButChannels) {
  for (const char* file : {"a.trc", "a.csv", "a.npz", "a.bvh"}) {
    const Error error =
        test::ErrorOf([&] { Save({.path = "emg.c3d", .markers = {.rate_hz = 50}}, file); });
    EXPECT_EQ(error.code(), ErrorCode::kMismatch);
    EXPECT_THAT(error.what(), HasSubstr("'emg.c3d' holds neither markers nor a skeleton"));
  }
}

TEST_F(RecordingLimits, NeverWriteOverAFileUnasked) {
  const Recording walk = Skeletal();
  const Recording markers = Markers();
  for (const MotionFormat& format : MotionFormats()) {
    if (format.save == nullptr) continue;
    const std::string file = "a" + std::string(format.extension);
    test::WriteText(PathOf(file), "mine");
    const Recording& recording = format.name == "CSM" ? markers : walk;
    EXPECT_EQ(test::ErrorOf([&] { Save(recording, file); }).code(), ErrorCode::kAlreadyExists)
        << file;
    EXPECT_EQ(test::ReadText(PathOf(file)), "mine") << file;
  }
}

TEST_F(RecordingLimits, RefuseUnitsThatNobodyKnows) {
  for (const char* file :
       {"a.bvh", "a.c3d", "a.trc", "a.npz", "a.mat", "a.csv", "a.glb", "a.mot"}) {
    EXPECT_EQ(test::ErrorOf([&] { Save(Skeletal(), file, {.units = "cubit"}); }).code(),
              ErrorCode::kInvalidArgument)
        << file;
    EXPECT_FALSE(std::filesystem::exists(PathOf(file))) << file;
  }
}

// Two frames, the second with an event, and two analog channels that count on.
C3dRecording WithChannels() {
  C3dRecording c3d = test::C3dOf({"C7"}, {{{1, 2, 3}}, {{1, 2, 4}}});
  c3d.channel_count = 2;
  c3d.subframe_count = 1;
  c3d.analog = {1, 2, 3, 4};
  SetEvents(c3d, std::vector<C3dEvent>{{.time_s = .01, .label = "Foot Strike"}});
  return c3d;
}

CsmRecording WithSizes() {
  return {.actor = "Ada",
          .comments = {"Feet left."},
          .rate_hz = 60,
          .talent = CsmTalent{CsmTalent::Unit::kMillimetres, {{"head", 200}}},
          .labels = {"C7"},
          .frame_numbers = {7, 8, 9},
          .values = {1, 2, 3, 4, 5, 6, 7, 8, 9}};
}

TEST_F(RecordingLimits, TellWhatARecordHoldsThatHasNoPlace) {
  test::WriteText(PathOf("a.c3d"), FormatC3d(WithChannels()));
  const Recording loaded = LoadRecording(PathOf("a.c3d"));
  for (const char* file : {"a.trc", "a.csm", "a.csv", "a.npz", "a.mat"}) {
    Save(loaded, file);
    EXPECT_THAT(Messages(diagnostics_),
                Contains(AllOf(HasSubstr("has no place for"), HasSubstr("2 analog channels"),
                               HasSubstr("1 events"))))
        << file;
  }
}

TEST_F(RecordingLimits, TellWhatACsmHoldsThatHasNoPlace) {
  test::WriteText(PathOf("a.csm"), FormatCsm(WithSizes()));
  const Recording loaded = LoadRecording(PathOf("a.csm"));
  for (const char* file : {"a.c3d", "a.trc", "a.csv", "a.npz", "a.mat"}) {
    Save(loaded, file);
    EXPECT_THAT(Messages(diagnostics_),
                Contains(AllOf(HasSubstr("has no place for"), HasSubstr("the performer's sizes"),
                               HasSubstr("the performer's name"), HasSubstr("comments"))))
        << file;
  }
}

TEST_F(RecordingLimits, TellThatFilledSamplesLookLikeMeasuredOnes) {
  Recording filled = Markers();
  filled.markers.states[1] = MarkerState::kFilled;
  for (const char* file : {"a.trc", "a.csm", "a.csv"}) {
    Save(filled, file);
    EXPECT_THAT(Messages(diagnostics_), Contains(HasSubstr("1 are written like these"))) << file;
  }
}

TEST_F(RecordingLimits, LetAStretchOfAC3dKeepWhatBelongsToItsFrames) {
  test::WriteText(PathOf("a.c3d"), FormatC3d(WithChannels()));
  const Recording again =
      SaveAndLoad(CutRecording(LoadRecording(PathOf("a.c3d")), 1, 1), "cut.c3d");
  EXPECT_THAT(diagnostics_, testing::IsEmpty());
  const auto& c3d = std::get<C3dRecording>(*again.record);
  EXPECT_EQ(c3d.first_frame, 2);
  EXPECT_THAT(c3d.analog, testing::ElementsAre(3, 4));
  EXPECT_EQ(Events(c3d).size(), 1);
  EXPECT_EQ(c3d.point(0, 0), WithChannels().point(1, 0));  // Residual and cameras too.
  const Recording before = CutRecording(LoadRecording(PathOf("a.c3d")), 0, 0);
  EXPECT_TRUE(Events(std::get<C3dRecording>(*before.record)).empty());
}

TEST_F(RecordingLimits, LetAStretchOfACsmKeepWhoMoved) {
  test::WriteText(PathOf("a.csm"), FormatCsm(WithSizes()));
  const Recording again =
      SaveAndLoad(CutRecording(LoadRecording(PathOf("a.csm")), 1, 2), "cut.csm");
  const auto& csm = std::get<CsmRecording>(*again.record);
  EXPECT_EQ(csm.actor, "Ada");
  EXPECT_EQ(csm.talent, WithSizes().talent);
  EXPECT_THAT(csm.frame_numbers, testing::ElementsAre(8, 9));
  EXPECT_THAT(csm.values, testing::ElementsAre(4, 5, 6, 7, 8, 9));
}

TEST(CutRecording, KeepsFrameNumbersAndWhereTheyCameFrom) {
  Recording whole = Markers();
  whole.format = "C3D";
  whole.units = "mm";
  whole.up_axis = "Z";
  whole.markers.first_frame = 40;
  const Recording cut = CutRecording(whole, 1, 2);
  EXPECT_EQ(cut.record, nullptr);
  EXPECT_EQ(cut.frame_count(), 2);
  EXPECT_EQ(cut.first_frame(), 41);
  EXPECT_EQ(cut.markers.at(0, 0), whole.markers.at(1, 0));
  EXPECT_EQ(cut.path, whole.path);
  EXPECT_EQ(cut.format, "C3D");
  EXPECT_EQ(cut.units, "mm");
  EXPECT_EQ(cut.up_axis, "Z");
  for (const auto& [first, last] : {std::pair(-1, 1), {2, 1}, {0, 3}}) {
    EXPECT_EQ(test::ErrorOf([&] { (void)CutRecording(whole, first, last); }).code(),
              ErrorCode::kInvalidArgument);
  }
}

TEST(ResampleRecording, TakesTheRateAndLeavesTheRecordBehind) {
  Recording whole = Markers();
  whole.record = std::make_shared<const FileRecord>(test::C3dOf({"C7"}, {{{1, 2, 3}}}));
  const Recording fast = ResampleRecording(whole, 100);
  EXPECT_EQ(fast.record, nullptr);
  EXPECT_THAT(Messages(fast.diagnostics),
              Contains(HasSubstr("at another rate has no place for: residuals")));
  EXPECT_EQ(fast.rate_hz(), 100);
  ASSERT_EQ(fast.frame_count(), 5);
  EXPECT_EQ(fast.markers.at(1, 0), Eigen::Vector3d(1.5, 2, 3));
  const Recording slow = ResampleRecording(Skeletal(), 30);
  EXPECT_EQ(slow.frame_count(), 6);
  EXPECT_EQ(slow.motion.rate_hz, 30);
}

}  // namespace
}  // namespace kinebase
