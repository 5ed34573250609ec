// TRC as recordings: each point of docs/formats/opensim.md about what a TRC file means.

#include "kinebase/motion/trc_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "kinebase/core/error.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_file.h"
#include "motion/figure.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view kWalk =
    "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
    "OrigNumFrames\tHall\n"
    "60\t120\t3\t2\tmm\t60\t5\t300\ttwo\n"
    "Frame#\tTime\tR.ASIS\t\t\tLeft heel\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "\n"
    "5\t0.067\t10\t20\t30\t4\t5\t6\n"
    "6\t0.083\t\t\t\t-4\t50\t6\n"
    "7\t0.1\t10\t\t30\t4\t5\t6.25\n";

std::vector<std::string> Messages(const Diagnostics& diagnostics) {
  std::vector<std::string> messages;
  for (const auto& diagnostic : diagnostics) messages.push_back(diagnostic.message);
  return messages;
}

std::string With(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class TrcFile : public testing::Test {
 protected:
  Recording Load(std::string_view text, const LoadOptions& options = {}) {
    test::WriteText(folder_.path() / "walk.trc", text);
    return LoadRecording(folder_.path() / "walk.trc", options);
  }

  // What is written, and what was said about it.
  std::string Save(const Recording& recording, const SaveOptions& options = {}) {
    const auto path = folder_.path() / ("copy" + std::to_string(copies_++) + ".trc");
    diagnostics_.clear();
    SaveRecording(recording, path, options, diagnostics_);
    return test::ReadText(path);
  }

  test::TemporaryFolder folder_;
  int copies_ = 0;
  Diagnostics diagnostics_;
};

TEST_F(TrcFile, BecomesMarkersInCentimetresWithYUp) {
  const Recording loaded = Load(kWalk);
  EXPECT_EQ(loaded.format, "TRC");
  EXPECT_EQ(loaded.units, "mm");
  EXPECT_EQ(loaded.up_axis, "Y");
  EXPECT_EQ(loaded.rate_hz(), 60);
  EXPECT_EQ(loaded.first_frame(), 5);
  EXPECT_THAT(loaded.markers.labels, ElementsAre("R.ASIS", "Left heel"));
  EXPECT_TRUE(loaded.markers.at(0, 0).isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_THAT(loaded.markers.states,
              ElementsAre(MarkerState::kMeasured, MarkerState::kMeasured, MarkerState::kMissing,
                          MarkerState::kMeasured, MarkerState::kMissing, MarkerState::kMeasured));
  EXPECT_THAT(Messages(loaded.diagnostics),
              ElementsAre("1 places with one or two values missing are taken as missing"));
}

TEST_F(TrcFile, HasTheUnitThatItTellsOrTheUser) {
  const std::string metres = With(std::string(kWalk), "\tmm\t", "\tm\t");
  EXPECT_DOUBLE_EQ(Load(metres).markers.at(0, 0).x(), 1000);
  EXPECT_DOUBLE_EQ(Load(metres, {.units = "cm"}).markers.at(0, 0).x(), 10);
  for (const char* unit : {"\t\t", "\tcubits\t"}) {
    const Recording loaded = Load(With(std::string(kWalk), "\tmm\t", unit));
    EXPECT_DOUBLE_EQ(loaded.markers.at(0, 0).x(), 1);
    EXPECT_THAT(Messages(loaded.diagnostics), Contains(HasSubstr("mm is taken")));
  }
  EXPECT_EQ(test::ErrorOf([&] { (void)Load(kWalk, {.units = "cubits"}); }).code(),
            ErrorCode::kInvalidArgument);
}

TEST_F(TrcFile, HasTheAxisUpThatTheUserSays) {
  const Recording loaded = Load(kWalk, {.up_axis = UpAxis::kZ});
  EXPECT_EQ(loaded.up_axis, "Z");
  EXPECT_DOUBLE_EQ(loaded.markers.at(0, 0).y(), 3);
}

TEST_F(TrcFile, HasTheRateOfItsHeaderElseOfItsTimes) {
  const Recording by_times = Load(With(std::string(kWalk), "\n60\t", "\n\t"));
  EXPECT_NEAR(by_times.rate_hz(), 2 / .033, 1e-9);
  EXPECT_THAT(Messages(by_times.diagnostics), Contains(HasSubstr("the times make it 60.6061 Hz")));
  const std::string snapped =
      With(With(std::string(kWalk), "\n60\t", "\n0\t"), "\t0.1\t", "\t0.10031\t");
  EXPECT_EQ(Load(snapped).rate_hz(), 60);
  std::string one = std::string(kWalk.substr(0, kWalk.find("6\t0.083")));
  EXPECT_EQ(Load(With(one, "\n60\t", "\n\t"), {.source_rate_hz = 25}).rate_hz(), 25);
}

TEST_F(TrcFile, IsWrittenBackAsItWas) {
  EXPECT_EQ(Save(Load(kWalk)), kWalk);
  EXPECT_THAT(diagnostics_, IsEmpty());
  EXPECT_EQ(Save(Load(kWalk, {.up_axis = UpAxis::kZ}), {.up_axis = UpAxis::kZ}), kWalk);
  EXPECT_EQ(Save(Load(kWalk), {.units = "millimeters"}), kWalk);
}

TEST_F(TrcFile, SaysWhatTheUserSaid) {
  const std::string text = Save(Load(With(std::string(kWalk), "\tmm\t", "\t\t"), {.units = "cm"}));
  EXPECT_EQ(text, With(std::string(kWalk), "\tmm\t", "\tcm\t"));
}

TEST_F(TrcFile, IsTurnedAndScaledAsAsked) {
  const Recording loaded = Load(kWalk);
  const TrcRecording trc = ParseTrc(Save(loaded, {.up_axis = UpAxis::kZ, .units = "m"}), "a.trc");
  EXPECT_EQ(trc.units, "m");
  EXPECT_THAT(trc.other_fields, ElementsAre(TrcField{"Hall", "two"}));
  EXPECT_THAT(trc.times_s, ElementsAre(.067, .083, .1));
  EXPECT_DOUBLE_EQ(trc.Point(0, 0)[2], .02);
  const MarkerCloud again =
      BuildMarkers(trc, {.rate_hz = 60, .cm_per_unit = 100, .up = UpAxis::kZ}, diagnostics_);
  EXPECT_LT((again.at(2, 1) - loaded.markers.at(2, 1)).norm(), 1e-9);
}

TEST_F(TrcFile, IsWrittenUnderOtherNames) {
  test::WriteText(folder_.path() / "own.mnm", "heel R.ASIS\n");
  const auto mnm = folder_.path() / "own.mnm";
  const Recording loaded = Load(kWalk, {.marker_names = mnm});
  EXPECT_THAT(loaded.markers.labels, ElementsAre("heel", "Left heel"));
  EXPECT_THAT(Save(loaded), HasSubstr("Time\theel\t\t\tLeft heel"));
  EXPECT_EQ(Save(loaded, {.marker_names = mnm}), kWalk);
}

TEST_F(TrcFile, IsMadeOfOtherMarkers) {
  Recording recording{.path = "take.c3d", .format = "C3D", .units = "m", .up_axis = "Z"};
  recording.markers = {.labels = {"Ada:LFHD", "", "a\tb", "a b"},
                       .rate_hz = 50,
                       .frame_count = 1,
                       .first_frame = 11,
                       .positions_cm = {{1. / 3, 2, -3}, MissingPosition(), {0, 0, 0}, {1, 1, 1}},
                       .states = {MarkerState::kMeasured, MarkerState::kMissing,
                                  MarkerState::kMeasured, MarkerState::kMeasured}};
  const TrcRecording trc = ParseTrc(Save(recording), "a.trc", {.strict = true});
  EXPECT_EQ(trc.units, "mm");  // What OpenSim expects, whatever the source had.
  EXPECT_EQ(trc.file_name, "copy0.trc");
  EXPECT_EQ(trc.data_rate_hz, 50);
  EXPECT_EQ(trc.original_first_frame, 11);
  EXPECT_EQ(trc.original_frame_count, 1);
  EXPECT_THAT(trc.labels, ElementsAre("Ada:LFHD", "marker2", "a b", "a b_2"));
  EXPECT_THAT(trc.times_s, ElementsAre(.2));
  EXPECT_THAT(trc.Point(0, 0), ElementsAre(3.333333, 20, -30));
  EXPECT_THAT(Messages(diagnostics_), ElementsAre(HasSubstr("3 names changed: '' as 'marker2'")));
  const MarkerCloud again = BuildMarkers(trc, {.rate_hz = 50}, diagnostics_);
  EXPECT_EQ(again.states, recording.markers.states);
}

TEST_F(TrcFile, HoldsTheJointsOfASkeletonAsPoints) {
  Recording recording{.path = "take.amc", .format = "ASF/AMC"};
  recording.motion = test::SmoothMotion(test::FigureSkeleton(), 3, 4, 60);
  const TrcRecording trc = ParseTrc(Save(recording), "a.trc", {.strict = true});
  EXPECT_THAT(Messages(diagnostics_), ElementsAre(HasSubstr("joints are written as points")));
  const JointTrajectories joints = ForwardKinematics(recording.motion);
  const MarkerCloud again = BuildMarkers(trc, {.rate_hz = 60}, diagnostics_);
  ASSERT_EQ(again.marker_count(), joints.joint_count);
  for (int joint = 0; joint < joints.joint_count; ++joint) {
    EXPECT_EQ(again.labels[joint], recording.motion.skeleton->joints()[joint].bone_name);
    for (int frame = 0; frame < 4; ++frame) {
      EXPECT_LT((again.at(frame, joint) - joints.at(frame, joint)).norm(), 1e-6);
    }
  }
}

TEST_F(TrcFile, NeedsAKnownUnit) {
  const Recording loaded = Load(kWalk);
  EXPECT_EQ(test::ErrorOf([&] { (void)Save(loaded, {.units = "cubits"}); }).code(),
            ErrorCode::kInvalidArgument);
}

TEST_F(TrcFile, HoldsRealMarkers) {
  KINEBASE_NEEDS_TEST_DATA();
  const Recording csm = LoadRecording(test::TestData("data/csm/ThomasFechten.csm"));
  const Recording trc = Load(Save(csm));
  EXPECT_THAT(trc.diagnostics, IsEmpty());
  ASSERT_EQ(trc.markers.positions_cm.size(), csm.markers.positions_cm.size());
  double largest = 0;
  for (std::size_t i = 0; i < trc.markers.positions_cm.size(); ++i) {
    largest = std::max(largest, (trc.markers.positions_cm[i] - csm.markers.positions_cm[i]).norm());
  }
  EXPECT_LT(largest, 1e-7);
  EXPECT_EQ(trc.markers.labels, csm.markers.labels);
  EXPECT_EQ(trc.rate_hz(), 120);
}

}  // namespace
}  // namespace kinebase
