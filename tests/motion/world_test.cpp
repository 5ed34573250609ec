#include "kinebase/motion/world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kinebase/core/error.h"
#include "support/files.h"

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
  for (const std::string_view unit : kLengthUnits) EXPECT_TRUE(CentimetresIn(unit)) << unit;
}

TEST(CentimetresIn, KnowsPartsOfUnits) {
  EXPECT_DOUBLE_EQ(CentimetresIn(kAcclaimUnit).value_or(0), 2.54 / .45);
  EXPECT_DOUBLE_EQ(CentimetresIn("m/4").value_or(0), 25);
}

TEST(CentimetresIn, RefusesWhatIsNoUnit) {
  for (const char* unit :
       {"", "furlong", "cm /", "cm / 0", "cm / -1", "cm / x", "cm / inf", "/ 2", "cm / 1 / 2"}) {
    EXPECT_EQ(CentimetresIn(unit), std::nullopt) << unit;
    const Error error = test::ErrorOf([&] { (void)CentimetresInOrFail(unit, "a.trc"); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument) << unit;
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("a.trc"),
                                             testing::HasSubstr("mm, cm, m, inch, ft")));
  }
}

}  // namespace
}  // namespace kinebase
