// Skeleton and kinematics against what the original HDM05 parser stored for eight real clips.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/motion_file.h"
#include "support/files.h"
#include "support/mat_oracle.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

constexpr double kCentimetresPerInch = 2.54;
constexpr double kRadiansPerDegree = std::numbers::pi / 180;

struct Clip {
  Recording loaded;
  test::MatOracle oracle;
};

// Calls `check` for each clip that there is an oracle for.
template <typename Check>
void ForEachClip(Check check) {
  const auto oracles = test::FilesBelow(test::TestData("data/hdm05/fk_oracle"), ".mat");
  ASSERT_EQ(oracles.size(), 8);
  for (const auto& file : oracles) {
    const std::string amc = file.stem().string();
    SCOPED_TRACE(amc);
    const TakeName name = ParseTakeName(amc);
    check(Clip{LoadRecording(test::TestData("data/hdm05/cut_amc") / name.class_name / amc),
               test::ReadMatOracle(file)});
  }
}

std::vector<int> OneBased(std::vector<int> indices) {
  for (int& index : indices) ++index;
  return indices;
}

TEST(OriginalParser, PutsAllJointsWhereWePutThem) {
  KINEBASE_NEEDS_TEST_DATA();
  double largest_cm = 0;
  ForEachClip([&](const Clip& clip) {
    const JointTrajectories joints = ForwardKinematics(clip.loaded.motion);
    ASSERT_EQ(joints.joint_count, 31);
    ASSERT_EQ(joints.frame_count(), clip.oracle.trajectories_inch[0].cols());
    for (int j = 0; j < joints.joint_count; ++j) {
      for (int frame = 0; frame < joints.frame_count(); ++frame) {
        const Eigen::Vector3d expected =
            clip.oracle.trajectories_inch[j].col(frame) * kCentimetresPerInch;
        largest_cm = std::max(largest_cm, (joints.at(frame, j) - expected).norm());
      }
    }
  });
  RecordProperty("largest_error_cm", ToShortestText(largest_cm));
  EXPECT_LE(largest_cm, 1e-12);
}

TEST(OriginalParser, HasTheSameLocalRotations) {
  KINEBASE_NEEDS_TEST_DATA();
  double largest_degrees = 0;
  ForEachClip([&](const Clip& clip) {
    const Motion& motion = clip.loaded.motion;
    for (int j = 0; j < motion.joint_count(); ++j) {
      if (clip.oracle.quaternions[j].size() == 0) {
        EXPECT_TRUE(motion.skeleton->joints()[j].dofs.empty());
        continue;
      }
      for (int frame = 0; frame < motion.frame_count; ++frame) {
        const Eigen::Vector4d q = clip.oracle.quaternions[j].col(frame);
        const Eigen::Quaterniond expected(q[0], q[1], q[2], q[3]);
        largest_degrees =
            std::max(largest_degrees,
                     motion.rotation(frame, j).angularDistance(expected) / kRadiansPerDegree);
      }
    }
  });
  RecordProperty("largest_error_degrees", ToShortestText(largest_degrees));
  EXPECT_LE(largest_degrees, 1e-4);
}

std::vector<int> RotationAxes(const Joint& joint) {
  std::vector<int> axes;
  for (const Dof dof : joint.dofs) {
    if (dof >= Dof::kRx && dof <= Dof::kRz) axes.push_back(static_cast<int>(dof) - 3);
  }
  return axes;
}

// Largest difference in degrees between two sequences of triples in XYZ order, after a constant
// number of full turns a row: a take may begin with an arm that the file says is turned by 280°
// where −80° is the same.
double LargestDifference(const std::vector<Eigen::Vector3d>& angles_degrees,
                         const std::vector<int>& axes, const Eigen::MatrixXd& expected) {
  double largest = 0;
  for (std::size_t row = 0; row < axes.size(); ++row) {
    const auto difference = [&](std::size_t frame) {
      return expected(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(frame)) -
             angles_degrees[frame][axes[row]];
    };
    const double turns = 360 * std::round(difference(0) / 360);
    for (std::size_t frame = 0; frame < angles_degrees.size(); ++frame) {
      largest = std::max(largest, std::abs(difference(frame) - turns));
    }
  }
  return largest;
}

TEST(OriginalParser, HasTheSameEulerAnglesUpToFullTurns) {
  KINEBASE_NEEDS_TEST_DATA();
  ForEachClip([](const Clip& clip) {
    const Motion& motion = clip.loaded.motion;
    for (const int j : motion.skeleton->animated()) {
      const Joint& joint = motion.skeleton->joints()[j];
      SCOPED_TRACE(joint.bone_name);
      ASSERT_EQ(joint.euler_order, EulerOrder::kXyz);
      std::vector<Eigen::Vector3d> angles = EulerAngles(motion, j);
      // (x, y, z) and (x + 180°, 180° − y, z + 180°) are the same rotation; a file may hold either.
      std::vector<Eigen::Vector3d> flipped;
      for (Eigen::Vector3d& triple : angles) {
        triple /= kRadiansPerDegree;
        flipped.emplace_back(triple.x() + 180, 180 - triple.y(), triple.z() + 180);
      }
      const std::vector<int> axes = RotationAxes(joint);
      const Eigen::MatrixXd& expected = clip.oracle.euler_degrees[j];
      ASSERT_EQ(expected.rows(), static_cast<Eigen::Index>(axes.size()));
      const double unflipped_difference = LargestDifference(angles, axes, expected);
      const double difference =
          axes.size() == 3
              ? std::min(unflipped_difference, LargestDifference(flipped, axes, expected))
              : unflipped_difference;
      EXPECT_LE(difference, 1e-6);
    }
  });
}

TEST(OriginalParser, BuildsTheSameSkeleton) {
  KINEBASE_NEEDS_TEST_DATA();
  ForEachClip([](const Clip& clip) {
    const Skeleton& skeleton = *clip.loaded.motion.skeleton;
    const test::MatOracle& oracle = clip.oracle;
    std::vector<std::string> joint_names;
    std::vector<std::string> bone_names;
    for (const Joint& joint : skeleton.joints()) {
      joint_names.push_back(joint.name);
      bone_names.push_back(joint.bone_name);
    }
    EXPECT_EQ(joint_names, oracle.joint_names);
    EXPECT_EQ(bone_names, oracle.bone_names);
    EXPECT_EQ(OneBased(skeleton.animated()), oracle.animated);
    EXPECT_EQ(OneBased(skeleton.unanimated()), oracle.unanimated);
    ASSERT_EQ(skeleton.chains().size(), oracle.paths.size());
    for (std::size_t i = 0; i < oracle.paths.size(); ++i) {
      EXPECT_EQ(OneBased(skeleton.chains()[i]), oracle.paths[i]);
    }
    EXPECT_EQ(skeleton.source().documentation, oracle.documentation);
    EXPECT_EQ(clip.loaded.motion.rate_hz, oracle.sampling_rate);
  });
}

TEST(OriginalParser, HasTheSameNodes) {
  KINEBASE_NEEDS_TEST_DATA();
  ForEachClip([](const Clip& clip) {
    const Skeleton& skeleton = *clip.loaded.motion.skeleton;
    for (int j = 0; j < skeleton.joint_count(); ++j) {
      const Joint& joint = skeleton.joints()[j];
      const test::MatOracle::Node& node = clip.oracle.nodes[j];
      SCOPED_TRACE(joint.bone_name);
      EXPECT_EQ(OneBased(skeleton.children(j)), node.children);
      EXPECT_EQ(joint.parent + 1, node.parent);
      EXPECT_LE((joint.offset_cm - node.offset_inch * kCentimetresPerInch).norm(), 1e-9);
      // The file's six digits make its directions a little longer or shorter than 1.
      EXPECT_LE((joint.direction - node.direction).norm(), j == 0 ? 0 : 2e-6);
      EXPECT_NEAR(joint.length_cm, node.length_inch * kCentimetresPerInch, 1e-9);
      EXPECT_LE((joint.axis_rad / kRadiansPerDegree - node.axis_degrees).norm(), 1e-9);
      EXPECT_EQ(ToString(joint.euler_order), node.rotation_order);
      ASSERT_EQ(joint.dofs.size(), node.dofs.size());
      for (std::size_t d = 0; d < node.dofs.size(); ++d) {
        EXPECT_TRUE(EqualsIgnoringCase(ToString(static_cast<AsfDof>(joint.dofs[d])), node.dofs[d]));
      }
      ASSERT_EQ(joint.limits.size(), static_cast<std::size_t>(node.limits_degrees.size() == 0
                                                                  ? 0
                                                                  : node.limits_degrees.rows()));
      for (std::size_t d = 0; d < joint.limits.size(); ++d) {
        const auto row = static_cast<Eigen::Index>(d);
        EXPECT_NEAR(joint.limits[d].low / kRadiansPerDegree, node.limits_degrees(row, 0), 1e-9);
        EXPECT_NEAR(joint.limits[d].high / kRadiansPerDegree, node.limits_degrees(row, 1), 1e-9);
      }
    }
  });
}

TEST(OriginalParser, MapsTheStandardJointsTheSameWay) {
  KINEBASE_NEEDS_TEST_DATA();
  ForEachClip([](const Clip& clip) {
    const auto& map = clip.loaded.motion.skeleton->name_map();
    ASSERT_EQ(clip.oracle.name_map_rotation.size(), map.size());
    for (std::size_t j = 0; j < map.size(); ++j) {
      EXPECT_EQ(map[j].rotation_joint + 1, clip.oracle.name_map_rotation[j]);
      EXPECT_EQ(map[j].trajectory_joint + 1, clip.oracle.name_map_trajectory[j]);
    }
  });
}

TEST(OriginalParser, HasTheSameBoundingBoxAndRootTranslation) {
  KINEBASE_NEEDS_TEST_DATA();
  ForEachClip([](const Clip& clip) {
    const BoundingBox box = ComputeBoundingBox(ForwardKinematics(clip.loaded.motion));
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double low = clip.oracle.bounding_box_inch[2 * axis] * kCentimetresPerInch;
      const double high = clip.oracle.bounding_box_inch[2 * axis + 1] * kCentimetresPerInch;
      EXPECT_NEAR(box.low_cm[axis], low, 1e-6);
      EXPECT_NEAR(box.high_cm[axis], high, 1e-6);
    }
    for (int frame = 0; frame < clip.loaded.motion.frame_count; ++frame) {
      const Eigen::Vector3d expected =
          clip.oracle.root_translation_inch.col(frame) * kCentimetresPerInch;
      EXPECT_LE((clip.loaded.motion.root_position_cm[frame] - expected).norm(), 1e-9);
    }
  });
}

}  // namespace
}  // namespace kinebase
