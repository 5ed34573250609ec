#include "kinebase/motion/marker_cloud.h"

#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

// Two markers on lines: A moves 1 cm a frame along x, B 2 cm along y; B is missing in frame 2.
MarkerCloud TwoMarkers(int frames) {
  MarkerCloud cloud{.labels = {"Anna:A", "B"}, .rate_hz = 100, .frame_count = frames};
  cloud.first_frame = 50;
  for (int frame = 0; frame < frames; ++frame) {
    cloud.positions_cm.emplace_back(frame, 0, 0);
    cloud.states.push_back(MarkerState::kMeasured);
    cloud.positions_cm.emplace_back(frame == 2 ? MissingPosition()
                                               : Eigen::Vector3d(0, 2 * frame, 0));
    cloud.states.push_back(frame == 2   ? MarkerState::kMissing
                           : frame == 4 ? MarkerState::kFilled
                                        : MarkerState::kMeasured);
  }
  return cloud;
}

TEST(MarkerCloud, FindsMarkersWithAndWithoutTheirSubject) {
  const MarkerCloud cloud = TwoMarkers(1);
  EXPECT_EQ(cloud.FindMarker("a"), 0);
  EXPECT_EQ(cloud.FindMarker("ANNA:A"), 0);
  EXPECT_EQ(cloud.FindMarker("B"), 1);
  EXPECT_EQ(cloud.FindMarker("Anna"), std::nullopt);
  EXPECT_EQ(BareLabel("x:y:LFHD"), "LFHD");
  EXPECT_EQ(BareLabel("LFHD"), "LFHD");
}

TEST(CutMarkers, KeepsCountingFrames) {
  const MarkerCloud cut = CutMarkers(TwoMarkers(6), 2, 4);
  EXPECT_EQ(cut.frame_count, 3);
  EXPECT_EQ(cut.first_frame, 52);
  EXPECT_EQ(cut.at(0, 0), Eigen::Vector3d(2, 0, 0));
  EXPECT_TRUE(cut.is_missing(0, 1));
  EXPECT_EQ(cut.at(2, 1), Eigen::Vector3d(0, 8, 0));
  EXPECT_EQ(cut.states.back(), MarkerState::kFilled);
}

TEST(CutMarkers, RefusesFramesThatAreNotThere) {
  for (const auto& [first, last] : {std::pair(-1, 2), {3, 2}, {0, 6}}) {
    EXPECT_EQ(test::ErrorOf([&] { (void)CutMarkers(TwoMarkers(6), first, last); }).code(),
              ErrorCode::kInvalidArgument);
  }
}

TEST(ResampleMarkers, IsLinearAndNeverInventsWhatIsMissing) {
  const MarkerCloud twice = ResampleMarkers(TwoMarkers(6), 200);
  ASSERT_EQ(twice.frame_count, 11);
  for (int sample = 0; sample < 11; ++sample) {
    EXPECT_LT((twice.at(sample, 0) - Eigen::Vector3d(sample / 2.0, 0, 0)).norm(), 1e-12);
    const bool near_gap = sample >= 3 && sample <= 5;
    EXPECT_EQ(twice.is_missing(sample, 1), near_gap) << sample;
    if (near_gap) {
      EXPECT_TRUE(twice.at(sample, 1).hasNaN());
    } else {
      EXPECT_LT((twice.at(sample, 1) - Eigen::Vector3d(0, sample, 0)).norm(), 1e-12);
    }
  }
  EXPECT_EQ(twice.states[twice.Index(7, 1)], MarkerState::kFilled);  // Next to one that is.
}

TEST(ResampleMarkers, PicksFramesExactlyAtAPartOfTheRate) {
  MarkerCloud cloud = TwoMarkers(6);
  cloud.first_frame = 1;
  const MarkerCloud half = ResampleMarkers(cloud, 50);
  ASSERT_EQ(half.frame_count, 3);
  EXPECT_EQ(half.at(2, 0), cloud.at(4, 0));
  EXPECT_EQ(half.at(2, 1), cloud.at(4, 1));
  EXPECT_TRUE(half.is_missing(1, 1));
}

TEST(BoundingBox, PassesOverMissingMarkers) {
  const BoundingBox box = ComputeBoundingBox(TwoMarkers(6));
  EXPECT_EQ(box.low_cm, Eigen::Vector3d::Zero());
  EXPECT_EQ(box.high_cm, Eigen::Vector3d(5, 10, 0));
  MarkerCloud none = TwoMarkers(3);
  none = CutMarkers(none, 2, 2);
  none.states.assign(2, MarkerState::kMissing);
  EXPECT_EQ(ComputeBoundingBox(none).high_cm, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace kinebase
