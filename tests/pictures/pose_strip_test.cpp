#include "kinebase/pictures/pose_strip.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/pictures/canvas.h"
#include "pictures/png_reader.h"
#include "pictures/svg_reader.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using test::ErrorOf;
using test::SvgElement;
using test::SvgReader;
using testing::Contains;
using testing::HasSubstr;

constexpr int kBonesDrawn = 22;  // 23, but for the one that the head covers.

// Somebody of 175 cm who stands at the origin, faces +Z and holds the left hand forwards.
std::vector<Eigen::Vector3d> StandingPose() {
  using enum StandardJoint;
  const std::map<StandardJoint, Eigen::Vector3d> middle = {
      {kRoot, {0, 95, 0}},       {kBelly, {0, 107, 0}},    {kChest, {0, 120, 0}},
      {kNeck, {0, 145, 0}},      {kHead, {0, 163, 0}},     {kHeadtop, {0, 173, 0}},
      {kLclavicle, {0, 145, 0}}, {kRclavicle, {0, 145, 0}}};
  const std::map<StandardJoint, Eigen::Vector3d> left = {
      {kLhip, {9, 92, 0}},      {kLknee, {9, 50, 2}},       {kLankle, {9, 8, 0}},
      {kLtoes, {9, 0, 15}},     {kLshoulder, {18, 142, 0}}, {kLelbow, {22, 115, 0}},
      {kLwrist, {22, 105, 25}}, {kLfingers, {22, 105, 35}}};
  std::vector<Eigen::Vector3d> pose(kStandardJointCount);
  for (const auto& [joint, place] : middle) pose[static_cast<int>(joint)] = place;
  for (const auto& [joint, place] : left) {
    pose[static_cast<int>(joint)] = place;
    pose[static_cast<int>(Mirrored(joint))] = place.cwiseProduct(Eigen::Vector3d(-1, 1, 1));
  }
  pose[static_cast<int>(kRwrist)] = {-22, 88, 0};
  pose[static_cast<int>(kRfingers)] = {-22, 78, 0};
  return pose;
}

// Walks along +Z at 1 m/s, arms still.
PoseStripRow WalkingRow(const std::string& title, int frames, double rate_hz = 30) {
  PoseStripRow row;
  row.title = title;
  row.standard_joints.rate_hz = rate_hz;
  row.standard_joints.joint_count = kStandardJointCount;
  const std::vector<Eigen::Vector3d> pose = StandingPose();
  for (int frame = 0; frame < frames; ++frame) {
    const Eigen::Vector3d way(0, 0, frame * 100.0 / 30);
    for (const Eigen::Vector3d& joint : pose)
      row.standard_joints.positions_cm.push_back(joint + way);
  }
  return row;
}

Eigen::Vector3d& At(PoseStripRow& row, int frame, StandardJoint joint) {
  return row.standard_joints.positions_cm[frame * kStandardJointCount + static_cast<int>(joint)];
}

struct Box {
  double left = std::numeric_limits<double>::infinity();
  double right = -std::numeric_limits<double>::infinity();
  double top = std::numeric_limits<double>::infinity();
  double bottom = -std::numeric_limits<double>::infinity();

  void Add(double x, double y, double reach_x, double reach_y) {
    left = std::min(left, x - reach_x);
    right = std::max(right, x + reach_x);
    top = std::min(top, y - reach_y);
    bottom = std::max(bottom, y + reach_y);
  }
};

std::vector<PicturePoint> PointsOf(const SvgElement& line) {
  std::istringstream text(line.attributes.at("points"));
  std::vector<PicturePoint> points;
  for (std::string pair; text >> pair;) {
    const std::size_t comma = pair.find(',');
    points.push_back({std::stod(pair.substr(0, comma)), std::stod(pair.substr(comma + 1))});
  }
  return points;
}

Box BoxOf(const std::vector<SvgElement>& elements) {
  Box box;
  for (const SvgElement& element : elements) {
    if (element.name == "polyline") {
      for (const PicturePoint& point : PointsOf(element)) box.Add(point.x, point.y, 0, 0);
    } else if (element.name == "circle") {
      const double radius = element.Number("r");
      box.Add(element.Number("cx"), element.Number("cy"), radius, radius);
    } else if (element.name == "text") {
      const double width = element.Number("textLength");
      const bool centred = element.attributes.contains("text-anchor");
      const double x = element.Number("x") + (centred ? 0 : width / 2);
      const double size = element.Number("font-size");
      box.Add(x, element.Number("y") - 0.3 * size, width / 2, 0.5 * size);
    }
  }
  return box;
}

// The lines of bones, without their rims of paper.
std::vector<SvgElement> Bones(const std::vector<SvgElement>& slot) {
  std::vector<SvgElement> bones;
  for (const SvgElement& element : slot) {
    if (element.name == "polyline" && element.IsIn("pose") &&
        element.attributes.at("stroke") != "#ffffff") {
      bones.push_back(element);
    }
  }
  return bones;
}

class PoseStrip : public testing::Test {
 protected:
  std::filesystem::path File(const std::string& name) const { return folder_.path() / name; }

  SvgReader Drawn(const std::vector<PoseStripRow>& rows, const PoseStripOptions& options = {}) {
    DrawPoseStrip(rows, File("s.svg"), Overwrite::kYes, options);
    svg_ = test::ReadText(File("s.svg"));
    return SvgReader(svg_);
  }

 private:
  test::TemporaryFolder folder_;
  std::string svg_;  // SvgReader looks into it.
};

void ExpectNothingOverlaps(const SvgReader& svg) {
  const double width = svg.Named("svg").at(0).Number("width");
  const double height = svg.Named("svg").at(0).Number("height");
  double above = BoxOf(svg.Groups("legend").at(0)).bottom;
  for (const std::vector<SvgElement>& row : svg.Groups("row")) {
    const Box box = BoxOf(row);
    EXPECT_GT(box.top, above);
    EXPECT_TRUE(box.left >= 0 && box.right <= width);
    above = box.bottom;
  }
  EXPECT_LT(above, height);
  const std::vector<std::vector<SvgElement>> slots = svg.Groups("slot");
  for (std::size_t i = 1; i < slots.size(); ++i) {
    const bool same_row = slots[i - 1].front().inside.front() == slots[i].front().inside.front();
    if (same_row) {
      EXPECT_GT(BoxOf(slots[i]).left, BoxOf(slots[i - 1]).right) << "slot " << i;
    }
  }
}

TEST(PoseViews, HaveNamesThatAreReadBack) {
  for (const PoseView view :
       {PoseView::kFront, PoseView::kSide, PoseView::kTop, PoseView::kThreeQuarter}) {
    EXPECT_EQ(ParsePoseView(ToString(view)), view);
  }
  EXPECT_EQ(ParsePoseView("behind"), std::nullopt);
}

TEST_F(PoseStrip, NamesRowsFramesAndTimes) {
  PoseStripRow second = WalkingRow("take <2> & more", 61);
  second.first_frame = 1001;
  const SvgReader svg = Drawn({WalkingRow("take 1", 31), second}, {.poses = 3});
  const std::vector<std::string> texts = svg.Texts();
  for (const char* text :
       {"take 1", "31 frames · 1.03 s · 30 Hz", "frame 1", "0.00 s", "frame 16", "0.50 s",
        "frame 31", "1.00 s", "take <2> & more", "frame 1001", "frame 1031", "frame 1061", "2.00 s",
        "left", "right", "middle", "three-quarter view · floor squares of 50 cm"}) {
    EXPECT_THAT(texts, Contains(text));
  }
  EXPECT_EQ(svg.Groups("slot").size(), 6u);
}

TEST_F(PoseStrip, DrawsNoMorePosesThanFrames) {
  const SvgReader svg = Drawn({WalkingRow("short", 4)}, {.poses = 10});
  EXPECT_EQ(svg.Groups("slot").size(), 4u);
}

TEST_F(PoseStrip, DrawsARecordingOfOneFrame) {
  for (const PoseView view :
       {PoseView::kFront, PoseView::kSide, PoseView::kTop, PoseView::kThreeQuarter}) {
    const SvgReader svg =
        Drawn({WalkingRow("pose", 1)}, {.view = view, .trails = {StandardJoint::kHead}});
    EXPECT_EQ(svg.Groups("slot").size(), 1u);
    EXPECT_THAT(svg.Texts(), Contains("frame 1"));
    ExpectNothingOverlaps(svg);
  }
}

TEST_F(PoseStrip, LeavesTimesOutWithoutARate) {
  const SvgReader svg = Drawn({WalkingRow("no rate", 5, 0)});
  for (const std::string& text : svg.Texts()) EXPECT_FALSE(text.ends_with(" s")) << text;
}

TEST_F(PoseStrip, DrawsEveryBoneTheHeadAndEveryJoint) {
  const std::vector<SvgElement> slot =
      Drawn({WalkingRow("pose", 1)}, {.view = PoseView::kFront}).Groups("slot").at(0);
  EXPECT_EQ(Bones(slot).size(), static_cast<std::size_t>(kBonesDrawn));
  // 23 dots (none at the headtop) and the head, which is the largest.
  EXPECT_EQ(std::ranges::count(slot, "circle", &SvgElement::name), 24);
}

TEST_F(PoseStrip, LeavesLimbsWithMissingJointsOut) {
  PoseStripRow row = WalkingRow("gaps", 1);
  At(row, 0, StandardJoint::kRelbow).x() = std::nan("");
  const auto without_elbow = Drawn({row}).Groups("slot").at(0);
  EXPECT_EQ(Bones(without_elbow).size(), kBonesDrawn - 2u);
  EXPECT_EQ(std::ranges::count(without_elbow, "circle", &SvgElement::name), 23);
  At(row, 0, StandardJoint::kHeadtop).z() = INFINITY;
  EXPECT_EQ(std::ranges::count(Drawn({row}).Groups("slot").at(0), "circle", &SvgElement::name), 22);
}

TEST_F(PoseStrip, DrawsRecordingsWithoutRootHipsOrAnyJoint) {
  PoseStripRow row = WalkingRow("gaps", 20);
  for (int frame = 0; frame < 20; ++frame) {
    At(row, frame, StandardJoint::kRoot).setConstant(std::nan(""));
    At(row, frame, StandardJoint::kLhip).setConstant(std::nan(""));
  }
  ExpectNothingOverlaps(Drawn({row}, {.trails = {StandardJoint::kLhip, StandardJoint::kHead}}));
  for (Eigen::Vector3d& place : row.standard_joints.positions_cm) place.setConstant(std::nan(""));
  const SvgReader nothing = Drawn({row}, {.trails = {StandardJoint::kHead}});
  EXPECT_EQ(nothing.Groups("slot").size(), 10u);
  EXPECT_TRUE(nothing.Named("circle").empty());
}

// The end of a bone that reaches farthest in a direction of the picture.
PicturePoint Extreme(const std::vector<SvgElement>& slot, double x, double y) {
  PicturePoint best;
  double most = -std::numeric_limits<double>::infinity();
  for (const SvgElement& bone : Bones(slot)) {
    for (const PicturePoint& point : PointsOf(bone)) {
      const double value = x * point.x + y * point.y;
      if (value > most) most = value, best = point;
    }
  }
  return best;
}

std::string ColorOfBoneAt(const std::vector<SvgElement>& slot, const PicturePoint& place) {
  for (const SvgElement& bone : Bones(slot)) {
    for (const PicturePoint& point : PointsOf(bone)) {
      if (std::hypot(point.x - place.x, point.y - place.y) < 0.01) {
        return bone.attributes.at("stroke");
      }
    }
  }
  return "";
}

bool IsBlue(const std::string& color) { return std::stoi(color.substr(5), nullptr, 16) > 0xA0; }

TEST_F(PoseStrip, ShowsEachViewFromItsSide) {
  const std::vector<PoseStripRow> rows = {WalkingRow("pose", 1)};
  const auto slot = [&](PoseView view) { return Drawn(rows, {.view = view}).Groups("slot")[0]; };
  // Before the performer, the left arm is at our right; from above, facing up, at our left.
  const auto front = slot(PoseView::kFront);
  EXPECT_TRUE(IsBlue(ColorOfBoneAt(front, Extreme(front, 1, 0))));
  EXPECT_FALSE(IsBlue(ColorOfBoneAt(front, Extreme(front, -1, 0))));
  const auto top = slot(PoseView::kTop);
  EXPECT_TRUE(IsBlue(ColorOfBoneAt(top, Extreme(top, -1, 0))));
  // The left hand points forwards: right in the side view, up from above.
  const auto side = slot(PoseView::kSide);
  EXPECT_TRUE(IsBlue(ColorOfBoneAt(side, Extreme(side, 1, 0))));
  EXPECT_TRUE(IsBlue(ColorOfBoneAt(top, Extreme(top, 0, -1))));
  const auto three_quarter = slot(PoseView::kThreeQuarter);
  EXPECT_TRUE(IsBlue(ColorOfBoneAt(three_quarter, Extreme(three_quarter, 1, 0))));
}

TEST_F(PoseStrip, LooksTheSameWhereverThePerformerStandsAndFaces) {
  const PoseStripRow row = WalkingRow("turned", 20);
  PoseStripRow turned = row;
  const Eigen::AngleAxisd turn(2.1, Eigen::Vector3d::UnitY());
  for (Eigen::Vector3d& place : turned.standard_joints.positions_cm) {
    place = turn * place + Eigen::Vector3d(300, 0, -70);
  }
  for (const PoseView view :
       {PoseView::kFront, PoseView::kSide, PoseView::kTop, PoseView::kThreeQuarter}) {
    const PoseStripOptions options = {.view = view, .trails = {StandardJoint::kLwrist}};
    const auto before = Drawn({row}, options).Groups("slot");
    const auto after = Drawn({turned}, options).Groups("slot");
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Box a = BoxOf(before[i]);
      const Box b = BoxOf(after[i]);
      EXPECT_NEAR(a.left, b.left, 0.05);
      EXPECT_NEAR(a.right, b.right, 0.05);
      EXPECT_NEAR(a.top, b.top, 0.05);
    }
  }
}

double DrawnHeight(const std::vector<SvgElement>& slot) {
  return Extreme(slot, 0, 1).y - Extreme(slot, 0, -1).y;
}

TEST_F(PoseStrip, DrawsAllRowsInOneScale) {
  PoseStripRow child = WalkingRow("child", 1);
  for (Eigen::Vector3d& place : child.standard_joints.positions_cm) place *= 0.5;
  const auto slots =
      Drawn({WalkingRow("adult", 1), child}, {.view = PoseView::kSide}).Groups("slot");
  EXPECT_NEAR(DrawnHeight(slots[0]) / DrawnHeight(slots[1]), 2, 0.01);
}

TEST_F(PoseStrip, KeepsHeightsOverTheFloor) {
  PoseStripRow jump = WalkingRow("jump", 2);
  for (int i = 0; i < kStandardJointCount; ++i) {
    jump.standard_joints.positions_cm[kStandardJointCount + i].y() += 40;
  }
  const auto slots = Drawn({jump}, {.view = PoseView::kFront}).Groups("slot");
  const double rise = Extreme(slots[0], 0, 1).y - Extreme(slots[1], 0, 1).y;
  EXPECT_NEAR(rise / DrawnHeight(slots[0]), 40.0 / 163, 0.001);  // Bones reach up to the head.
}

TEST_F(PoseStrip, DrawsEveryStepOfATrailOnce) {
  PoseStripRow row = WalkingRow("wave", 50);
  for (int frame = 0; frame < 50; ++frame) {
    At(row, frame, StandardJoint::kRwrist).y() += 20 * std::sin(frame * 0.4);
  }
  At(row, 20, StandardJoint::kRwrist).setConstant(std::nan(""));
  const auto steps = [&](int poses) {
    const SvgReader svg = Drawn({row}, {.poses = poses, .trails = {StandardJoint::kRwrist}});
    EXPECT_THAT(svg.Texts(), Contains(HasSubstr("trails: rwrist")));
    return std::ranges::count_if(svg.Named("polyline", "slot"),
                                 [](const SvgElement& line) { return !line.IsIn("pose"); });
  };
  EXPECT_EQ(steps(7), 49 - 2);  // A missing place takes two steps away.
  EXPECT_EQ(steps(1), 49 - 2);
}

TEST_F(PoseStrip, KeepsRowsAndPosesApart) {
  std::vector<PoseStripRow> rows;
  for (int i = 0; i < 4; ++i) {
    rows.push_back(WalkingRow(fmt::format("row {}", i), 40 + 30 * i));
    for (int frame = 0; frame < 40; ++frame) {
      At(rows.back(), frame, StandardJoint::kLfingers) +=
          Eigen::Vector3d(40 * std::sin(frame + i), 60 * std::cos(frame * 0.3), 50 * i);
    }
  }
  for (const PoseView view :
       {PoseView::kFront, PoseView::kSide, PoseView::kTop, PoseView::kThreeQuarter}) {
    for (const int poses : {1, 2, 10, 37}) {
      SCOPED_TRACE(fmt::format("{} poses, {} view", poses, ToString(view)));
      ExpectNothingOverlaps(
          Drawn(rows, {.view = view, .poses = poses, .trails = {StandardJoint::kLfingers}}));
    }
  }
}

TEST_F(PoseStrip, ShortensLongTitles) {
  const SvgReader svg = Drawn({WalkingRow(std::string(1000, 'w'), 30)});
  ExpectNothingOverlaps(svg);
  EXPECT_THAT(svg.Texts(),
              Contains(testing::AllOf(testing::StartsWith("www"), testing::EndsWith("…"))));
}

TEST_F(PoseStrip, SurvivesAFrameThatIsFarAway) {
  for (const double height_cm : {1e7, 1e14}) {
    PoseStripRow row = WalkingRow("glitch", 30);
    At(row, 7, StandardJoint::kRoot).y() = height_cm;
    EXPECT_FALSE(Drawn({row}).Texts().empty());
  }
}

TEST_F(PoseStrip, LeavesTheFloorOutWhenAsked) {
  const std::vector<PoseStripRow> rows = {WalkingRow("pose", 30)};
  EXPECT_FALSE(Drawn(rows).Groups("floor").empty());
  EXPECT_TRUE(Drawn(rows, {.floor = false}).Groups("floor").empty());
}

TEST_F(PoseStrip, IsTheSameBytesAgainAndTheSameSizeInBothFormats) {
  const std::vector<PoseStripRow> rows = {WalkingRow("a", 30), WalkingRow("b", 60)};
  const PoseStripOptions options = {.trails = {StandardJoint::kLtoes}};
  for (const std::string extension : {".svg", ".png"}) {
    DrawPoseStrip(rows, File("a" + extension), Overwrite::kNo, options);
    DrawPoseStrip(rows, File("b" + extension), Overwrite::kNo, options);
    EXPECT_EQ(test::ReadText(File("a" + extension)), test::ReadText(File("b" + extension)));
  }
  const SvgElement svg = Drawn(rows, options).Named("svg").at(0);
  const test::PngReader png(File("a.png"));
  EXPECT_EQ(png.width(), kPngScale * svg.Number("width"));
  EXPECT_EQ(png.height(), kPngScale * svg.Number("height"));
}

TEST_F(PoseStrip, NeverOverwritesUnasked) {
  test::WriteText(File("s.svg"), "precious");
  const std::vector<PoseStripRow> rows = {WalkingRow("a", 3)};
  EXPECT_EQ(ErrorOf([&] { DrawPoseStrip(rows, File("s.svg"), Overwrite::kNo); }).code(),
            ErrorCode::kAlreadyExists);
  EXPECT_EQ(test::ReadText(File("s.svg")), "precious");
}

TEST_F(PoseStrip, RefusesWhatCannotBeDrawn) {
  const auto message = [&](const std::vector<PoseStripRow>& rows,
                           const PoseStripOptions& options = {}) {
    const Error error =
        ErrorOf([&] { DrawPoseStrip(rows, File("s.png"), Overwrite::kNo, options); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    return std::string(error.what());
  };
  EXPECT_THAT(message({}), HasSubstr("no recording"));
  EXPECT_THAT(message({WalkingRow("fine", 3), WalkingRow("empty", 0)}),
              HasSubstr("\"empty\" has no frames"));
  PoseStripRow all_joints = WalkingRow("raw", 3);
  all_joints.standard_joints.joint_count = 31;
  EXPECT_THAT(message({all_joints}), HasSubstr("31 joints; a strip is drawn from the 24"));
  EXPECT_THAT(message({WalkingRow("fine", 3)}, {.poses = 0}), HasSubstr("at least one"));
  EXPECT_THAT(message({WalkingRow("long", 3000)}, {.poses = 3000}), HasSubstr("draw less"));
  EXPECT_FALSE(std::filesystem::exists(File("s.png")));
}

JointTrajectories GoldenJoints(const std::filesystem::path& path) {
  std::istringstream text(test::ReadText(path));
  JointTrajectories joints;
  joints.rate_hz = 12;  // Every tenth frame of 120 Hz.
  joints.joint_count = kStandardJointCount;
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream numbers(line);
    double frame = 0;
    numbers >> frame;
    for (int i = 0; i < kStandardJointCount; ++i) {
      Eigen::Vector3d place;
      numbers >> place.x() >> place.y() >> place.z();
      joints.positions_cm.push_back(place);
    }
  }
  return joints;
}

TEST_F(PoseStrip, KeepsRealMotionsApart) {
  KINEBASE_NEEDS_TEST_DATA();
  std::vector<PoseStripRow> rows;
  for (const auto& path : test::FilesBelow(test::TestData("golden/clips"), ".csv")) {
    if (!path.filename().string().ends_with(".joints.csv")) continue;
    rows.push_back({path.stem().string(), GoldenJoints(path)});
  }
  ASSERT_GT(rows.size(), 5u);
  for (const PoseView view :
       {PoseView::kFront, PoseView::kSide, PoseView::kTop, PoseView::kThreeQuarter}) {
    SCOPED_TRACE(ToString(view));
    ExpectNothingOverlaps(Drawn(rows, {.view = view, .trails = {StandardJoint::kRwrist}}));
  }
}

}  // namespace
}  // namespace kinebase
