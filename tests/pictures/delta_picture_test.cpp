#include "kinebase/pictures/delta_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "kinebase/core/error.h"
#include "pictures/png_reader.h"
#include "pictures/svg_reader.h"
#include "pictures/text_boxes.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::SizeIs;

constexpr double kNone = std::numeric_limits<double>::infinity();

// Ten seconds at one column a second: nothing ends in the first two, a dip at the end of the
// seventh, which is a hit from 4 to 7 s.
DeltaPanel TenSeconds() {
  return {.title = "gym.amc",
          .duration_s = 10,
          .frame_rate_hz = 120,
          .rows = {{.name = "squat",
                    .cost = {kNone, kNone, 0.5, 0.4, 0.5, 0.3, 0.02, 0.3, 0.5, 0.5},
                    .rate_hz = 1,
                    .tau = 0.06,
                    .hits = {{4, 7}}}},
          .labels = {{"Squat", {{3.5, 7.5}}, {}}}};
}

std::vector<PicturePoint> PointsOf(const test::SvgElement& polyline) {
  std::istringstream text(polyline.attributes.at("points"));
  std::vector<PicturePoint> points;
  char comma = 0;
  for (PicturePoint point; text >> point.x >> comma >> point.y;) points.push_back(point);
  return points;
}

// What one row or picture shows.
struct Drawn {
  PictureBox hit;
  std::vector<PicturePoint> threshold;
  std::vector<std::vector<PicturePoint>> pieces;  // Of the curve.
};

class DeltaPicture : public ::testing::Test {
 protected:
  [[nodiscard]] test::SvgReader Draw(const DeltaPanel& panel) const {
    DrawDeltaCurves({&panel, 1}, svg_, Overwrite::kYes);
    return test::SvgReader(test::ReadText(svg_));
  }

  static Drawn RowOf(const test::SvgReader& svg) {
    Drawn drawn;
    const std::vector<test::SvgElement> row = svg.Groups("curve").at(0);
    for (const test::SvgElement& element : row) {
      if (element.name == "rect") {
        drawn.hit = {element.Number("x"), element.Number("y"), element.Number("width"),
                     element.Number("height")};
      }
      if (element.name != "polyline" || element.IsIn("axis-up")) continue;
      if (element.attributes.contains("stroke-dasharray")) {
        drawn.threshold = PointsOf(element);
      } else {
        drawn.pieces.push_back(PointsOf(element));
      }
    }
    return drawn;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path svg_ = folder_.path() / "delta.svg";
};

TEST_F(DeltaPicture, PutsCostsAtTheEndsOfMatches) {
  const Drawn drawn = RowOf(Draw(TenSeconds()));
  ASSERT_THAT(drawn.threshold, SizeIs(2));
  const double left = drawn.threshold[0].x;
  const double second = (drawn.threshold[1].x - left) / 10;
  EXPECT_NEAR(drawn.hit.left, left + 4 * second, 0.02);
  EXPECT_NEAR(drawn.hit.width, 3 * second, 0.02);
  ASSERT_THAT(drawn.pieces, SizeIs(1));
  ASSERT_THAT(drawn.pieces[0], SizeIs(8));  // Without those where nothing ends.
  EXPECT_NEAR(drawn.pieces[0][0].x, left + 3 * second, 0.02);
  EXPECT_NEAR(drawn.pieces[0][4].x, left + 7 * second, 0.02);
  // From the costs .02 and .5 and their places, where .06 must be.
  const double unit = (drawn.pieces[0][4].y - drawn.pieces[0][0].y) / 0.48;
  EXPECT_NEAR(drawn.threshold[0].y, drawn.pieces[0][4].y - 0.04 * unit, 0.05);
}

TEST_F(DeltaPicture, SaysWhatItShows) {
  const test::SvgReader svg = Draw(TenSeconds());
  EXPECT_THAT(svg.Texts(), IsSupersetOf({"gym.amc", "squat", "τ = 0.06 · 1 hit", "Squat", "10.0",
                                         "1200", "threshold τ", "hit", "labelled so"}));
  EXPECT_THAT(svg.Groups("label"), SizeIs(1));
  DeltaPanel bare = TenSeconds();
  bare.labels.clear();
  bare.rows[0].hits.clear();
  const test::SvgReader without = Draw(bare);
  EXPECT_THAT(without.Texts(), Contains("τ = 0.06 · 0 hits"));
  EXPECT_THAT(without.Texts(), Not(Contains("labelled so")));
}

TEST_F(DeltaPicture, KeepsDipsOfLongRecordings) {
  DeltaPanel panel = TenSeconds();
  panel.duration_s = 1000;
  panel.rows[0] = {.name = "squat",
                   .cost = std::vector<double>(100000, 0.5),
                   .rate_hz = 100,
                   .tau = 0.06,
                   .hits = {}};
  panel.rows[0].cost[51234] = 0;
  panel.rows[0].cost[51235] = 0.4;
  const Drawn drawn = RowOf(Draw(panel));
  ASSERT_THAT(drawn.pieces, SizeIs(1));
  EXPECT_LT(drawn.pieces[0].size(), 4000);
  const auto lowest = std::ranges::max_element(drawn.pieces[0], {}, &PicturePoint::y);
  const double left = drawn.threshold[0].x;
  EXPECT_NEAR(lowest->x, left + (drawn.threshold[1].x - left) * 0.51235, 0.02);
  EXPECT_GT(lowest->y, drawn.threshold[0].y);
}

TEST_F(DeltaPicture, BreaksTheCurveWhereNothingEnds) {
  DeltaPanel panel = TenSeconds();
  panel.rows[0].cost[4] = kNone;
  EXPECT_THAT(RowOf(Draw(panel)).pieces, SizeIs(2));
  panel.rows[0].cost.assign(10, kNone);  // Shorter than half the template.
  EXPECT_THAT(RowOf(Draw(panel)).pieces, SizeIs(0));
}

TEST_F(DeltaPicture, KeepsTextsApart) {
  DeltaPanel panel = TenSeconds();
  panel.title = std::string(300, 'W');
  panel.rows[0].name = std::string(200, 'W');
  panel.rows.push_back(panel.rows[0]);
  panel.labels.push_back({std::string(100, 'W'), {{0, 1}}, {}});
  const std::vector<DeltaPanel> panels = {panel, TenSeconds()};
  DrawDeltaCurves(panels, svg_, Overwrite::kNo);
  test::ExpectTextsApart(test::SvgReader(test::ReadText(svg_)));
}

TEST_F(DeltaPicture, HasItsColoursAsPng) {
  const DeltaPanel panel = TenSeconds();
  const Drawn drawn = RowOf(Draw(panel));
  const std::filesystem::path path = folder_.path() / "delta.png";
  DrawDeltaCurves({&panel, 1}, path, Overwrite::kNo);
  const test::PngReader png(path);
  EXPECT_EQ(png.At(drawn.hit.left + 3, drawn.hit.top + 5), kDeltaHit);
  EXPECT_EQ(png.At(drawn.hit.left - 3, drawn.hit.top + 5), (Color{255, 255, 255}));
}

TEST_F(DeltaPicture, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(DrawDeltaCurves({}, svg_, Overwrite::kNo), Error);
  std::vector<DeltaPanel> bad(7, TenSeconds());
  bad[0].rows.clear();
  bad[1].duration_s = 0;
  bad[2].rows[0].hits = {{2, 1}};
  bad[3].rows[0].cost[5] = std::nan("");
  bad[4].rows[0].tau = kNone;
  bad[5].rows[0].rate_hz = 0;
  bad[6].labels[0].truth = {{2, 1}};
  for (const DeltaPanel& panel : bad) {
    EXPECT_THROW(DrawDeltaCurves({&panel, 1}, svg_, Overwrite::kNo), Error);
  }
  EXPECT_FALSE(std::filesystem::exists(svg_));
}

}  // namespace
}  // namespace kinebase
