#include "kinebase/motion/loose_markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinebase/motion/motion_file.h"
#include "motion/recording_files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A chest with four markers that turns and travels, at 100 Hz.
MarkerCloud Chest(int frames) {
  MarkerCloud chest{.labels = {"C7", "T10", "CLAV", "STRN"}, .rate_hz = 100};
  chest.frame_count = frames;
  const std::array<Eigen::Vector3d, 4> places = {
      Eigen::Vector3d{0, 20, -8}, {0, 0, -10}, {0, 18, 8}, {0, 0, 12}};
  for (int frame = 0; frame < frames; ++frame) {
    const Eigen::AngleAxisd turn(0.03 * frame, Eigen::Vector3d::UnitY());
    for (const Eigen::Vector3d& place : places) {
      chest.positions_cm.emplace_back(turn * place + Eigen::Vector3d(0.5 * frame, 120, 0));
      chest.states.push_back(MarkerState::kMeasured);
    }
  }
  return chest;
}

TEST(LooseMarkers, AreNoneOnARigidBody) {
  EXPECT_THAT(FindLooseMarkers(Chest(200), BuiltInMarkerSets()), IsEmpty());
  EXPECT_THAT(FindLooseMarkers(Chest(0), BuiltInMarkerSets()), IsEmpty());
  EXPECT_THAT(FindLooseMarkers({.rate_hz = 100}, BuiltInMarkerSets()), IsEmpty());
}

TEST(LooseMarkers, AreFoundWhileTheyAreOff) {
  MarkerCloud chest = Chest(200);
  for (int frame = 20; frame < 110; ++frame) {  // In less than half of the frames.
    chest.positions_cm[chest.Index(frame, 3)].y() -= 0.2 * (frame - 20);
  }
  const std::vector<LooseMarker> loose = FindLooseMarkers(chest, BuiltInMarkerSets());
  ASSERT_EQ(loose.size(), 1);
  EXPECT_EQ(loose[0].label, "STRN");
  EXPECT_THAT(loose[0].others, ElementsAre("C7", "T10", "CLAV"));
  EXPECT_GT(loose[0].first, 20);
  EXPECT_EQ(loose[0].last, 109);
  EXPECT_EQ(loose[0].frames, loose[0].last - loose[0].first + 1);
  // CLAV lies 18 cm above it and 4 cm behind; at the end it is 17.8 cm lower.
  EXPECT_NEAR(loose[0].farthest_cm, std::hypot(35.8, 4) - std::hypot(18, 4), 1e-9);
}

TEST(LooseMarkers, MayBeSwapped) {
  MarkerCloud chest = Chest(200);
  for (int frame = 100; frame < 150; ++frame) {
    std::swap(chest.positions_cm[chest.Index(frame, 0)], chest.positions_cm[chest.Index(frame, 1)]);
  }
  const std::vector<LooseMarker> loose = FindLooseMarkers(chest, BuiltInMarkerSets());
  // Distances do not tell which two of the four it was.
  ASSERT_EQ(loose.size(), 4);
  for (const LooseMarker& each : loose) {
    EXPECT_EQ(each.first, 100);
    EXPECT_EQ(each.last, 149);
  }
}

TEST(LooseMarkers, AreOfOnePerson) {
  MarkerCloud two = Chest(100);
  two.labels = {"A:C7", "A:T10", "B:CLAV", "A:STRN"};
  for (int frame = 0; frame < 40; ++frame) two.positions_cm[two.Index(frame, 2)].x() += 200;
  EXPECT_THAT(FindLooseMarkers(two, BuiltInMarkerSets()), IsEmpty());
}

TEST(LooseMarkers, AreNotThoseThatAreMissingOrOffForAMoment) {
  MarkerCloud chest = Chest(200);
  for (int frame = 50; frame < 120; ++frame) {
    chest.states[chest.Index(frame, 0)] = MarkerState::kMissing;
    chest.positions_cm[chest.Index(frame, 0)] = MissingPosition();
  }
  for (int frame = 150; frame < 170; ++frame) chest.positions_cm[chest.Index(frame, 3)].x() += 40;
  EXPECT_THAT(FindLooseMarkers(chest, BuiltInMarkerSets()), IsEmpty());
}

// design: RANK is off to about frame 1,200 by up to 30 cm, STRN to about 500 by 7 to 12 cm.
TEST(LooseMarkers, OfTheRealRecordingAreFound) {
  KINEBASE_NEEDS_TEST_DATA();
  Recording csm = LoadRecording(test::TestData("data/csm/ThomasFechten.csm"));
  const std::vector<LooseMarker> loose = FindLooseMarkers(csm.markers, BuiltInMarkerSets());
  const auto of = [&](std::string_view label) {
    const auto found = std::ranges::find(loose, label, &LooseMarker::label);
    return found == loose.end() ? LooseMarker{} : *found;
  };
  EXPECT_EQ(of("RANK").first, 0);
  EXPECT_GT(of("RANK").frames, 900);
  EXPECT_GT(of("RANK").last, 950);
  EXPECT_LT(of("RANK").last, 1200);
  EXPECT_GT(of("RANK").farthest_cm, 25);
  EXPECT_EQ(of("STRN").first, 0);
  EXPECT_GT(of("STRN").last, 380);
  EXPECT_LT(of("STRN").last, 520);
  Diagnostics diagnostics;
  (void)FindStandardJoints(csm, diagnostics);
  EXPECT_THAT(test::Messages(diagnostics),
              Contains(HasSubstr("marker RANK does not keep its distance from")));
}

// Takes of HDM05 as they were published.
TEST(LooseMarkers, AreNoneInCleanRecordings) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const char* file : {"data/hdm05/take_c3d/HDM_bd_05-01_01_120.c3d",
                           "data/hdm05/amc_c3d_pair/HDM_dg_06-03_03_120.c3d"}) {
    const Recording recording = LoadRecording(test::TestData(file));
    EXPECT_THAT(FindLooseMarkers(recording.markers, BuiltInMarkerSets()), IsEmpty()) << file;
  }
}

}  // namespace
}  // namespace kinebase
