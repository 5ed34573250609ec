// Recordings that there are in two formats: how far their joints lie apart, and why.
//
// docs/formats/real-files.md has the table and what is to be said about it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_file.h"
#include "kinebase/motion/standard_skeleton.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using enum StandardJoint;

// Both files write six digits, of lengths of 5.6 cm each.
constexpr double kLastDigitCm = 1e-3;

struct Pair {
  std::string_view skeleton;  // The AMC, below data/.
  std::string_view other;
  int other_starts = 0;  // The frame of the other file that is the AMC's first.
};

constexpr std::array kPairs = {
    // Who made this BVH put a T pose before the take.
    Pair{"cmu/01/01_01.amc", "cmu/01/01_01.bvh", 1},
    Pair{"cmu/131/131_01.amc", "cmu/131/131_01.bvh"},
    Pair{"cmu/131/131_02.amc", "cmu/131/131_02.bvh"},
    Pair{"hdm05/amc_c3d_pair/HDM_dg_06-03_03_120.amc",
         "hdm05/amc_c3d_pair/HDM_dg_06-03_03_120.c3d"},
    Pair{"cmu/02/02_01.amc", "cmu/02/02_01.c3d"},
    Pair{"cmu/135/135_02.amc", "cmu/135/135_02.c3d"},
};
constexpr std::array kBvhPairs = {kPairs[0], kPairs[1], kPairs[2]};

struct Distance {
  double mean_cm;
  double p95_cm;
};

struct Row {
  std::string_view joint;
  std::array<Distance, kPairs.size()> distances;
};

// In the order of the pairs.
// clang-format off
constexpr Row kTable[] = {
    {"root", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {1.1, 1.7}, {1.5, 2.5}, {2.7, 5.9}}}},
    {"lhip", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {2.0, 2.7}, {1.1, 1.9}, {2.4, 4.9}}}},
    {"lknee", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {2.2, 4.0}, {2.1, 4.1}, {2.8, 5.1}}}},
    {"lankle", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.9, 1.1}, {0.8, 1.2}, {0.9, 1.9}}}},
    {"ltoes", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {1.6, 2.2}, {1.3, 2.1}, {1.9, 5.0}}}},
    {"rhip", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {1.8, 2.3}, {1.1, 1.9}, {2.2, 5.0}}}},
    {"rknee", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {2.2, 3.4}, {2.1, 4.1}, {3.1, 7.4}}}},
    {"rankle", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.3, 0.6}, {0.7, 1.3}, {1.0, 1.9}}}},
    {"rtoes", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {2.1, 3.2}, {1.6, 2.4}, {2.8, 6.1}}}},
    {"belly", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {1.6, 2.5}, {1.6, 2.6}, {2.3, 4.7}}}},
    {"chest", {{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {1.7, 2.2}, {1.9, 2.9}, {3.5, 5.9}}}},
    {"neck", {{{11.7, 11.7}, {11.2, 11.2}, {11.2, 11.2}, {4.1, 4.8}, {1.6, 2.6}, {6.4, 9.5}}}},
    {"head", {{{11.7, 11.7}, {11.2, 11.2}, {11.2, 11.2}, {3.3, 3.9}, {1.6, 2.5}, {4.8, 8.1}}}},
    {"headtop", {{{11.7, 11.7}, {11.2, 11.2}, {11.2, 11.2}, {2.7, 3.1}, {1.9, 3.0}, {4.1, 7.1}}}},
    {"lclavicle", {{{11.7, 11.7}, {11.2, 11.2}, {11.2, 11.2}, {4.1, 4.8}, {1.6, 2.6}, {6.4, 9.5}}}},
    {"lshoulder", {{{11.7, 11.7}, {11.2, 11.2}, {11.2, 11.2}, {2.0, 3.9}, {2.1, 3.3}, {3.7, 6.3}}}},
    {"lelbow", {{{11.7, 11.7}, {11.2, 11.2}, {11.2, 11.2}, {3.0, 4.8}, {2.8, 4.5}, {6.7, 9.9}}}},
    {"lwrist", {{{10.7, 20.7}, {7.4, 15.2}, {4.9, 7.4}, {3.5, 5.2}, {2.8, 3.6}, {5.8, 10.4}}}},
    {"lfingers", {{{10.7, 20.7}, {5.1, 15.1}, {2.8, 5.4}, {2.6, 4.1}, {3.2, 4.0}, {5.8, 10.0}}}},
    {"rclavicle", {{{11.7, 11.7}, {11.2, 11.2}, {11.2, 11.2}, {4.1, 4.8}, {1.6, 2.6}, {6.4, 9.5}}}},
    {"rshoulder", {{{11.7, 11.7}, {11.2, 11.2}, {11.2, 11.2}, {2.7, 3.6}, {2.5, 3.6}, {3.5, 6.2}}}},
    {"relbow", {{{11.7, 11.7}, {11.2, 11.2}, {11.2, 11.2}, {1.6, 2.6}, {3.6, 5.1}, {6.1, 9.7}}}},
    {"rwrist", {{{10.4, 20.3}, {14.0, 20.8}, {16.9, 19.6}, {3.0, 3.9}, {2.9, 3.6}, {4.9, 10.1}}}},
    {"rfingers", {{{10.4, 20.3}, {14.0, 24.4}, {16.1, 19.3}, {2.3, 3.6}, {3.5, 4.2}, {5.0, 9.6}}}},
};
// clang-format on

JointTrajectories JointsOf(std::string_view file) {
  Diagnostics ignored;
  return StandardJoints(LoadRecording(test::TestData("data") / file), ignored);
}

// The same frames of both files.
class SameTake {
 public:
  explicit SameTake(const Pair& pair)
      : skeleton_(JointsOf(pair.skeleton)),
        other_(JointsOf(pair.other)),
        other_starts_(pair.other_starts) {
    EXPECT_EQ(other_.frame_count(), frame_count() + other_starts_) << pair.other;
  }

  [[nodiscard]] int frame_count() const { return skeleton_.frame_count(); }
  [[nodiscard]] const Eigen::Vector3d& skeleton(int frame, StandardJoint joint) const {
    return skeleton_.at(frame, joint);
  }
  [[nodiscard]] const Eigen::Vector3d& other(int frame, StandardJoint joint) const {
    return other_.at(frame + other_starts_, joint);
  }

  // Of one joint, sorted; `shift(frame)` is what the other file lacks.
  template <typename Shift>
  [[nodiscard]] std::vector<double> Distances(StandardJoint joint, Shift shift) const {
    std::vector<double> distances;
    for (int frame = 0; frame < frame_count(); ++frame) {
      distances.push_back(
          (skeleton(frame, joint) - other(frame, joint) - Eigen::Vector3d(shift(frame))).norm());
    }
    std::ranges::sort(distances);
    return distances;
  }
  [[nodiscard]] std::vector<double> Distances(StandardJoint joint) const {
    return Distances(joint, [](int) { return Eigen::Vector3d::Zero(); });
  }

  // The bone from the spine to the neck, as the AMC has it.
  [[nodiscard]] Eigen::Vector3d Thorax(int frame) const {
    return skeleton(frame, kNeck) - skeleton(frame, kChest);
  }
  // The bone that ends at the wrist: a third of the way from the elbow, straight on.
  [[nodiscard]] Eigen::Vector3d WristBone(int frame, bool left) const {
    return (skeleton(frame, left ? kLwrist : kRwrist) - skeleton(frame, left ? kLelbow : kRelbow)) /
           3;
  }

 private:
  JointTrajectories skeleton_;
  JointTrajectories other_;
  int other_starts_;
};

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double P95(const std::vector<double>& sorted) { return sorted[sorted.size() * 95 / 100]; }

TEST(SameTake, LiesAsFarApartAsDocumented) {
  KINEBASE_NEEDS_TEST_DATA();
  ASSERT_EQ(std::size(kTable), static_cast<std::size_t>(kStandardJointCount));
  for (std::size_t p = 0; p < kPairs.size(); ++p) {
    SCOPED_TRACE(kPairs[p].other);
    const SameTake take(kPairs[p]);
    for (const Row& row : kTable) {
      SCOPED_TRACE(row.joint);
      const auto distances = take.Distances(ParseStandardJoint(row.joint).value());
      // A tenth of a millimetre of slack for what lies between two rounded figures.
      EXPECT_NEAR(Mean(distances), row.distances[p].mean_cm, .06);
      EXPECT_NEAR(P95(distances), row.distances[p].p95_cm, .06);
    }
  }
}

TEST(SameTakeAsBvh, IsTheAmcBelowTheChest) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const Pair& pair : kBvhPairs) {
    SCOPED_TRACE(pair.other);
    const SameTake take(pair);
    for (const StandardJoint joint :
         {kRoot, kLhip, kLknee, kLankle, kLtoes, kRhip, kRknee, kRankle, kRtoes, kBelly, kChest}) {
      EXPECT_LT(take.Distances(joint).back(), kLastDigitCm) << ToString(joint);
    }
  }
}

TEST(SameTakeAsBvh, LacksTheBoneBelowTheNeckAndNothingElseDownToTheElbows) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const Pair& pair : kBvhPairs) {
    SCOPED_TRACE(pair.other);
    const SameTake take(pair);
    const auto thorax = [&](int frame) { return take.Thorax(frame); };
    EXPECT_GT(take.Thorax(0).norm(), 11);
    for (const StandardJoint joint : {kNeck, kHead, kHeadtop, kLclavicle, kLshoulder, kLelbow,
                                      kRclavicle, kRshoulder, kRelbow}) {
      EXPECT_LT(take.Distances(joint, thorax).back(), kLastDigitCm) << ToString(joint);
    }
  }
}

TEST(SameTakeAsBvh, LacksTheBoneBeforeTheWristToo) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const Pair& pair : kBvhPairs) {
    SCOPED_TRACE(pair.other);
    const SameTake take(pair);
    for (const bool left : {true, false}) {
      const auto missing = [&](int frame) -> Eigen::Vector3d {
        return take.Thorax(frame) + take.WristBone(frame, left);
      };
      EXPECT_GT(take.WristBone(0, left).norm(), 9);
      EXPECT_LT(take.Distances(left ? kLwrist : kRwrist, missing).back(), kLastDigitCm);
    }
  }
}

// The AMC twists the wrist about the forearm and then bends the hand. The BVH of 131 seems to have
// the twist as a turn about another axis, so that its hands point elsewhere; their length is the
// same.
TEST(SameTakeAsBvh, HasItsHandsTurnedElsewhereInOneOfTwoRigs) {
  KINEBASE_NEEDS_TEST_DATA();
  for (const Pair& pair : kBvhPairs) {
    SCOPED_TRACE(pair.other);
    const bool same = pair.other_starts == 1;
    const SameTake take(pair);
    for (const bool left : {true, false}) {
      const StandardJoint wrist = left ? kLwrist : kRwrist;
      const StandardJoint fingers = left ? kLfingers : kRfingers;
      const auto missing = [&](int frame) -> Eigen::Vector3d {
        return take.Thorax(frame) + take.WristBone(frame, left);
      };
      const auto rest = take.Distances(fingers, missing);
      if (same) {
        EXPECT_LT(rest.back(), kLastDigitCm);
      } else {
        EXPECT_GT(Mean(rest), 2);
        EXPECT_LT(Mean(rest), 4);
        EXPECT_LT(P95(rest), 8.5);
      }
      for (int frame = 0; frame < take.frame_count(); ++frame) {
        const double length = (take.skeleton(frame, fingers) - take.skeleton(frame, wrist)).norm();
        const double other = (take.other(frame, fingers) - take.other(frame, wrist)).norm();
        ASSERT_NEAR(length, other, kLastDigitCm);
      }
    }
  }
}

TEST(SameTakeAsBvh, BeginsWithATPoseIn0101) {
  KINEBASE_NEEDS_TEST_DATA();
  const JointTrajectories bvh = JointsOf(kPairs[0].other);
  for (const auto& [shoulder, fingers] :
       {std::pair(kLshoulder, kLfingers), std::pair(kRshoulder, kRfingers)}) {
    const Eigen::Vector3d arm = bvh.at(0, fingers) - bvh.at(0, shoulder);
    EXPECT_GT(std::abs(arm.x()) / arm.norm(), .99);
    const Eigen::Vector3d next = bvh.at(1, fingers) - bvh.at(1, shoulder);
    EXPECT_LT(std::abs(next.x()) / next.norm(), .9);
  }
}

// How far a joint lies above the middle of some markers along the spine, in the mean.
double HeightAbove(const Pair& pair, StandardJoint joint,
                   const std::vector<std::string_view>& names) {
  const JointTrajectories skeleton = JointsOf(pair.skeleton);
  const MarkerCloud markers = LoadRecording(test::TestData("data") / pair.other).markers;
  std::vector<double> heights;
  for (int frame = 0; frame < skeleton.frame_count(); ++frame) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::string_view name : names) {
      middle += markers.at(frame, markers.FindMarker(name).value());
    }
    middle /= static_cast<double>(names.size());
    const Eigen::Vector3d spine = skeleton.at(frame, kChest) - skeleton.at(frame, kRoot);
    const double height = (skeleton.at(frame, joint) - middle).dot(spine.normalized());
    if (std::isfinite(height)) heights.push_back(height);  // Markers may be missing.
  }
  return Mean(heights);
}

TEST(SameTakeAsC3d, HasASkeletonThatLiesLowerInTheBodyIn13502) {
  KINEBASE_NEEDS_TEST_DATA();
  struct Heights {
    Pair pair;
    double root_cm;
    double neck_cm;
  };
  for (const auto& [pair, root_cm, neck_cm] :
       {Heights{kPairs[3], -2.1, -9.8}, {kPairs[4], -1.0, -9.9}, {kPairs[5], -5.1, -18.6}}) {
    SCOPED_TRACE(pair.other);
    EXPECT_NEAR(HeightAbove(pair, kRoot, {"LFWT", "RFWT", "LBWT", "RBWT"}), root_cm, .06);
    EXPECT_NEAR(HeightAbove(pair, kNeck, {"C7", "CLAV"}), neck_cm, .06);
  }
}

}  // namespace
}  // namespace kinebase
