#include "kinebase/motion/world.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace kinebase {
namespace {

TEST(ToYUp, IsARotationThatTakesTheNamedAxisUp) {
  const std::pair<UpAxis, Eigen::Vector3d> axes[] = {{UpAxis::kX, Eigen::Vector3d::UnitX()},
                                                     {UpAxis::kY, Eigen::Vector3d::UnitY()},
                                                     {UpAxis::kZ, Eigen::Vector3d::UnitZ()}};
  for (const auto& [up, axis] : axes) {
    const Eigen::Matrix3d rotation = ToYUp(up);
    EXPECT_EQ(rotation * axis, Eigen::Vector3d::UnitY()) << ToString(up);
    EXPECT_EQ(rotation.determinant(), 1) << ToString(up);
    EXPECT_EQ(rotation * rotation.transpose(), Eigen::Matrix3d::Identity()) << ToString(up);
  }
  EXPECT_EQ(ToYUp(UpAxis::kZ) * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(2, 3, 1));
}

TEST(UpAxis, IsReadInAnyCase) {
  EXPECT_EQ(ParseUpAxis("z"), UpAxis::kZ);
  EXPECT_EQ(ParseUpAxis("X"), UpAxis::kX);
  EXPECT_EQ(ParseUpAxis(ToString(UpAxis::kY)), UpAxis::kY);
  EXPECT_EQ(ParseUpAxis("up"), std::nullopt);
}

TEST(CentimetresIn, KnowsUnitsByAllTheirNames) {
  EXPECT_EQ(CentimetresIn("mm"), 0.1);
  EXPECT_EQ(CentimetresIn(" Millimetres "), 0.1);
  EXPECT_EQ(CentimetresIn("CM"), 1);
  EXPECT_EQ(CentimetresIn("meters"), 100);
  EXPECT_EQ(CentimetresIn("in"), 2.54);
  EXPECT_EQ(CentimetresIn("ft"), 30.48);
  EXPECT_EQ(CentimetresIn("furlong"), std::nullopt);
  EXPECT_EQ(CentimetresIn(""), std::nullopt);
}

}  // namespace
}  // namespace kinebase
