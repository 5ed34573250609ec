// Force plates of the four types against one push that is known: a force, where it acts and a twist
// about that point. Each plate's channels follow from it by the sums of the User Guide of C3D.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/motion/sto_motion.h"
#include "motion/c3d_recordings.h"
#include "motion/recording_files.h"

namespace kinebase {
namespace {

using Eigen::Vector3d;
using test::Messages;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// In the plate's axes: z into the floor, so that the floor pushes back along -z.
const Vector3d kForce(30, -40, -700);  // N
const Vector3d kCentre(.08, -.12, 0);  // m from the middle of the surface.
constexpr double kTwist = 2.5;         // N·m about z.
constexpr double kDepth = .04;         // m from the surface down to the sensors.

Vector3d MomentAboutMiddle() { return kCentre.cross(kForce) + Vector3d(0, 0, kTwist); }

// About a point at `depth` below the middle of the surface, +z being down.
Vector3d MomentAboutSensor() { return MomentAboutMiddle() - Vector3d(0, 0, kDepth).cross(kForce); }

std::vector<float> Floats(std::initializer_list<double> values) {
  std::vector<float> floats;
  for (const double value : values) floats.push_back(static_cast<float>(value));
  return floats;
}

// Half a metre square, its middle at (1000, 2000, 0) mm in a world with Z up. The plate's x is the
// world's y and its y the world's x, so that z = x × y points down.
C3dRecording WithPlate(int type, const std::vector<float>& channels, const Vector3d& origin_mm) {
  C3dRecording c3d;
  c3d.rate_hz = 100;
  c3d.frame_count = 1;
  c3d.first_frame = 11;
  c3d.subframe_count = 1;
  c3d.channel_count = channels.size();
  c3d.analog = channels;
  test::SetText(c3d, "UNITS", "mm");
  const auto put = [&](std::string_view name, std::vector<std::uint8_t> dimensions,
                       C3dValues values) {
    SetParameter(c3d, "FORCE_PLATFORM",
                 {.name = std::string(name),
                  .dimensions = std::move(dimensions),
                  .values = std::move(values)});
  };
  using Integers = std::vector<std::int16_t>;
  SetParameter(c3d, "FORCE_PLATFORM", IntegerParameter("USED", 1));
  put("TYPE", {1}, Integers{static_cast<std::int16_t>(type)});
  put("CORNERS", {3, 4, 1}, Floats({1250, 2250, 0, 1250, 1750, 0, 750, 1750, 0, 750, 2250, 0}));
  put("ORIGIN", {3, 1}, Floats({origin_mm.x(), origin_mm.y(), origin_mm.z()}));
  Integers numbers;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    numbers.push_back(static_cast<std::int16_t>(i + 1));
  }
  put("CHANNEL", {static_cast<std::uint8_t>(numbers.size()), 1}, numbers);
  SetTextList(c3d, "ANALOG", "UNITS",
              std::vector<std::string>(channels.size(), type == 3 ? "N" : "Nmm"));
  return c3d;
}

StoTable ForcesOf(const C3dRecording& c3d, Diagnostics& diagnostics) {
  return ToGroundForces(c3d, {.up = UpAxis::kZ, .cm_per_unit = .1}, diagnostics);
}

// The plate's vector in our world, Y up: of the file's (x, y, z) here (y, z, x).
Vector3d World(const Vector3d& plate) { return {plate.x(), -plate.z(), plate.y()}; }

void ExpectThePush(const StoTable& table) {
  EXPECT_THAT(table.labels,
              ElementsAre("ground_force_1_vx", "ground_force_1_vy", "ground_force_1_vz",
                          "ground_force_1_px", "ground_force_1_py", "ground_force_1_pz",
                          "ground_torque_1_x", "ground_torque_1_y", "ground_torque_1_z"));
  ASSERT_EQ(table.values.size(), 9);
  EXPECT_THAT(table.times_s, ElementsAre(.1));
  const Vector3d force = World(kForce);
  const Vector3d place = World(kCentre) + Vector3d(2, 0, 1);
  const Vector3d moment = World({0, 0, kTwist});
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(table.values[i], force[i], 1e-3);
    EXPECT_NEAR(table.values[3 + i], place[i], 1e-5);
    EXPECT_NEAR(table.values[6 + i], moment[i], 1e-3);
  }
  EXPECT_GT(table.values[1], 0);  // The floor pushes up.
}

std::vector<float> SixChannels(const Vector3d& moment_mm) {
  return Floats({kForce.x(), kForce.y(), kForce.z(), moment_mm.x(), moment_mm.y(), moment_mm.z()});
}

TEST(GroundForces, OfType1GiveTheCentreAsItIs) {
  Diagnostics diagnostics;
  ExpectThePush(
      ForcesOf(WithPlate(1, SixChannels({80, -120, kTwist * 1000}), {0, 0, 0}), diagnostics));
  EXPECT_THAT(diagnostics, IsEmpty());
}

TEST(GroundForces, OfType2GiveMomentsAboutTheSensor) {
  Diagnostics diagnostics;
  const auto channels = SixChannels(MomentAboutSensor() * 1000);
  ExpectThePush(ForcesOf(WithPlate(2, channels, {0, 0, -kDepth * 1000}), diagnostics));
  // Some writers have the origin's sign wrong.
  ExpectThePush(ForcesOf(WithPlate(2, channels, {0, 0, kDepth * 1000}), diagnostics));
  EXPECT_THAT(diagnostics, IsEmpty());
}

TEST(GroundForces, OfType2AreInTheUnitOfTheirChannels) {
  C3dRecording c3d = WithPlate(2, SixChannels(MomentAboutSensor()), {0, 0, -kDepth * 1000});
  SetTextList(c3d, "ANALOG", "UNITS", std::vector<std::string>{"N", "N", "N", "Nm", "Nm", "N.m"});
  Diagnostics diagnostics;
  ExpectThePush(ForcesOf(c3d, diagnostics));
}

// Four sensors at (±a, ±b), numbered from (+a, +b) on against the clock of x to y.
TEST(GroundForces, OfType3AreSummedOverFourSensors) {
  constexpr double kA = .2;
  constexpr double kB = .15;
  const Vector3d moment = MomentAboutSensor();
  // Of the shares of Fz: the sum, the moments about x and y, and none that twists the plate.
  const double fz = kForce.z() / 4;
  const double about_x = moment.x() / (4 * kB);
  const double about_y = moment.y() / (4 * kA);
  const double twist = moment.z() / kB;  // Fx34 - Fx12.
  const auto channels =
      Floats({kForce.x() / 2 - twist / 2, kForce.x() / 2 + twist / 2, kForce.y() / 2,
              kForce.y() / 2, fz + about_x - about_y, fz + about_x + about_y,
              fz - about_x + about_y, fz - about_x - about_y});
  Diagnostics diagnostics;
  ExpectThePush(
      ForcesOf(WithPlate(3, channels, {kA * 1000, kB * 1000, -kDepth * 1000}), diagnostics));
  EXPECT_THAT(diagnostics, IsEmpty());
}

// F = C · v, the matrix stored with the row running fastest.
TEST(GroundForces, OfType4ArePassedThroughTheirCalibration) {
  const Vector3d moment = MomentAboutSensor() * 1000;
  Eigen::Matrix<double, 6, 6> calibration = Eigen::Matrix<double, 6, 6>::Identity() * 2;
  calibration(0, 4) = .25;
  calibration(5, 2) = -3;
  Eigen::Vector<double, 6> wanted;
  wanted << kForce, moment;
  const Eigen::Vector<double, 6> volts = calibration.inverse() * wanted;
  C3dRecording c3d =
      WithPlate(4, Floats({volts[0], volts[1], volts[2], volts[3], volts[4], volts[5]}),
                {0, 0, -kDepth * 1000});
  std::vector<float> stored;
  for (int column = 0; column < 6; ++column) {
    for (int row = 0; row < 6; ++row) {
      stored.push_back(static_cast<float>(calibration(row, column)));
    }
  }
  Diagnostics none;
  EXPECT_THAT(ForcesOf(c3d, none).labels, IsEmpty());
  EXPECT_THAT(Messages(none), Contains(HasSubstr("force plate 1 has no calibration")));
  SetParameter(c3d, "FORCE_PLATFORM",
               {.name = "CAL_MATRIX", .dimensions = {6, 6, 1}, .values = stored});
  Diagnostics diagnostics;
  ExpectThePush(ForcesOf(c3d, diagnostics));
  EXPECT_THAT(diagnostics, IsEmpty());
}

TEST(GroundForces, AreTurnedWhereThePlateTellsWhatPushesOnIt) {
  std::vector<float> channels = SixChannels({80, -120, kTwist * 1000});
  for (const std::size_t i : {0, 1, 2, 5}) channels[i] = -channels[i];
  Diagnostics diagnostics;
  ExpectThePush(ForcesOf(WithPlate(1, channels, {0, 0, 0}), diagnostics));
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("signs are turned")));
}

TEST(GroundForces, HaveNoCentreWhereNothingPushes) {
  Diagnostics diagnostics;
  const StoTable table =
      ForcesOf(WithPlate(1, Floats({1, 2, -3, 80, -120, 0}), {0, 0, 0}), diagnostics);
  ASSERT_EQ(table.values.size(), 9);
  EXPECT_THAT((std::vector(table.values.begin() + 3, table.values.begin() + 6)),
              ElementsAre(2, 0, 1));
}

TEST(GroundForces, LeaveOutPlatesThatTellTooLittle) {
  const auto messages = [](const C3dRecording& c3d) {
    Diagnostics diagnostics;
    EXPECT_THAT(ForcesOf(c3d, diagnostics).labels, IsEmpty());
    return Messages(diagnostics);
  };
  const auto six = SixChannels({0, 0, 0});
  EXPECT_THAT(messages(WithPlate(7, six, {0, 0, 0})), Contains(HasSubstr("type 7 is unknown")));
  EXPECT_THAT(messages(WithPlate(3, six, {0, 0, 0})), Contains(HasSubstr("has 6 channels of 8")));
  C3dRecording flat = WithPlate(1, six, {0, 0, 0});
  SetParameter(flat, "FORCE_PLATFORM",
               {.name = "CORNERS", .dimensions = {3, 4, 1}, .values = std::vector<float>(12)});
  EXPECT_THAT(messages(flat), Contains(HasSubstr("has no corners")));
  C3dRecording missing = WithPlate(1, six, {0, 0, 0});
  missing.channel_count = 5;
  missing.analog.pop_back();
  EXPECT_THAT(messages(missing), Contains(HasSubstr("has channel 6 of 5")));
}

using MotFile = test::RecordingFiles;

TEST_F(MotFile, OfAC3dHoldsTheGroundForces) {
  C3dRecording c3d = WithPlate(1, SixChannels({80, -120, kTwist * 1000}), {0, 0, 0});
  c3d.point_count = 1;
  c3d.points = {{.x = 1, .y = 2, .z = 3, .quality = 1}};
  SetTextList(c3d, "POINT", "LABELS", std::vector<std::string>{"a"});
  test::SetText(c3d, "Y_SCREEN", "+Z");
  test::WriteText(PathOf("a.c3d"), FormatC3d(c3d));
  const Recording loaded = LoadRecording(PathOf("a.c3d"));
  ExpectThePush(ParseSto(Save(loaded, "a.mot"), "a.mot"));
  // All channels as they are, in the other table.
  const StoTable channels = ParseSto(Save(loaded, "a.sto"), "a.sto");
  EXPECT_EQ(channels.column_count(), 6);
  EXPECT_NEAR(channels.values[2], kForce.z(), 1e-3);
  EXPECT_THAT(Messages(diagnostics_), Contains(HasSubstr("1 markers are not in this file")));
}

}  // namespace
}  // namespace kinebase
