#include "kinebase/pictures/evaluation_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

#include "kinebase/core/error.h"
#include "pictures/png_reader.h"
#include "pictures/svg_reader.h"
#include "pictures/text_boxes.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::SizeIs;

std::string Svg(const Picture& picture) {
  return EncodePicture(PictureFormat::kSvg, picture.size, picture.draw);
}

std::vector<PicturePoint> PointsOf(const test::SvgElement& polyline) {
  std::istringstream text(polyline.attributes.at("points"));
  std::vector<PicturePoint> points;
  char comma = 0;
  for (PicturePoint point; text >> point.x >> comma >> point.y;) points.push_back(point);
  return points;
}

std::vector<test::SvgElement> Named(const std::vector<test::SvgElement>& elements,
                                    const std::string& name) {
  std::vector<test::SvgElement> found;
  for (const test::SvgElement& element : elements) {
    if (element.name == name) found.push_back(element);
  }
  return found;
}

// Where a value stands, by the labels of two ticks.
class Axis {
 public:
  Axis(const std::vector<test::SvgElement>& elements, std::string_view group, const char* place)
      : zero_(TickAt(elements, group, place, "0.0")), one_(TickAt(elements, group, place, "1.0")) {}

  [[nodiscard]] double At(double value) const { return zero_ + value * (one_ - zero_); }

 private:
  static double TickAt(const std::vector<test::SvgElement>& elements, std::string_view group,
                       const char* place, const std::string& label) {
    for (const test::SvgElement& element : elements) {
      if (element.name == "text" && element.IsIn(group) && element.text == label) {
        return element.Number(place);
      }
    }
    ADD_FAILURE() << "no tick " << label;
    return 0;
  }

  double zero_;
  double one_;
};

// Two methods; the second finds everything.
PrecisionPanel Panel(const std::string& title) {
  return {title, {{"mt", {1, 0.5, 0}}, {"mt+", {1, 1, 1}}}};
}

TEST(PrecisionPicture, PutsCurvesWhereTheirValuesAre) {
  const test::SvgReader svg(Svg(PrecisionPicture(Panel("All"), {Panel("squat")})));
  const auto panels = svg.Groups("panel");
  ASSERT_THAT(panels, SizeIs(2));
  for (const auto& panel : panels) {
    const Axis recall(panel, "axis-across", "x");
    const Axis precision(panel, "axis-up", "y");
    std::vector<test::SvgElement> curves;
    for (const test::SvgElement& line : Named(panel, "polyline")) {
      if (!line.IsIn("axis-across") && !line.IsIn("axis-up")) curves.push_back(line);
    }
    ASSERT_THAT(curves, SizeIs(2));
    const std::vector<PicturePoint> points = PointsOf(curves[0]);
    ASSERT_THAT(points, SizeIs(3));
    EXPECT_NEAR(points[1].x, recall.At(0.5), 0.02);
    EXPECT_NEAR(points[2].x, recall.At(1), 0.02);
    // Labels stand a little below their ticks.
    EXPECT_NEAR(points[2].y - points[1].y, precision.At(0) - precision.At(0.5), 0.02);
    EXPECT_NEAR(PointsOf(curves[1])[2].y, points[0].y, 0.02);
    EXPECT_NE(curves[0].attributes.at("stroke"), curves[1].attributes.at("stroke"));
  }
}

TEST(PrecisionPicture, NamesMethodsOnceAndAllPanels) {
  const test::SvgReader svg(Svg(PrecisionPicture(Panel("All"), {Panel("squat"), Panel("kick")})));
  EXPECT_THAT(svg.Texts(), IsSupersetOf({"All", "squat", "kick", "recall", "precision"}));
  EXPECT_THAT(svg.Named("text", "legend"), SizeIs(2));
}

TEST(PrecisionPicture, TellsManyMethodsApart) {
  PrecisionPanel panel{"All", {}};
  for (int i = 0; i < 12; ++i) panel.curves.push_back({"method " + std::to_string(i), {1, 0}});
  const test::SvgReader svg(Svg(PrecisionPicture(panel, {})));
  std::set<std::pair<std::string, bool>> looks;
  for (const test::SvgElement& swatch : svg.Named("polyline", "legend")) {
    looks.insert({swatch.attributes.at("stroke"), swatch.attributes.contains("stroke-dasharray")});
  }
  EXPECT_THAT(looks, SizeIs(12));
}

TEST(PrecisionPicture, RefusesWhatNoPrecisionCanBe) {
  EXPECT_THROW((void)PrecisionPicture({"none", {}}, {}), Error);
  EXPECT_THROW((void)PrecisionPicture({"short", {{"mt", {1}}}}, {}), Error);
  EXPECT_THROW((void)PrecisionPicture({"high", {{"mt", {1, 1.5}}}}, {}), Error);
  EXPECT_THROW((void)PrecisionPicture({"no number", {{"mt", {1, std::nan("")}}}}, {}), Error);
  EXPECT_THROW((void)PrecisionPicture(Panel("two"), {{"one", {{"mt", {1, 1}}}}}), Error);
}

ConfusionCounts Confusion() {
  return {.title = "mt: 15 of 18 clips",
          .counted = "clips",
          .classes = {"jump", "kick"},
          .counts = {{9, 1, 2}, {0, 6, 0}}};
}

TEST(ConfusionPicture, HasACellForEachPairAndANumberWhereThereIsOne) {
  const test::SvgReader svg(Svg(ConfusionPicture(Confusion())));
  const auto rows = svg.Groups("row");
  ASSERT_THAT(rows, SizeIs(2));
  std::vector<std::vector<std::string>> texts;
  for (const auto& row : rows) {
    EXPECT_THAT(Named(row, "rect"), SizeIs(3));
    std::vector<std::string>& of_row = texts.emplace_back();
    for (const test::SvgElement& text : Named(row, "text")) of_row.push_back(text.text);
  }
  EXPECT_EQ(texts[0], (std::vector<std::string>{"1", "jump", "9", "1", "2", "12", "0.75"}));
  EXPECT_EQ(texts[1], (std::vector<std::string>{"2", "kick", "6", "6", "1.00"}));
  EXPECT_THAT(svg.Texts(), IsSupersetOf({"mt: 15 of 18 clips", "clips", "right", "none"}));
}

TEST(ConfusionPicture, ShadesByShareInTwoColours) {
  const test::SvgReader svg(Svg(ConfusionPicture(Confusion())));
  const auto cells = Named(svg.Groups("row").at(0), "rect");
  const auto other = Named(svg.Groups("row").at(1), "rect");
  const std::string full_right = other[1].attributes.at("fill");
  EXPECT_EQ(full_right, "#0072b2");
  EXPECT_NE(cells[0].attributes.at("fill"), full_right);  // Nine of twelve.
  EXPECT_NE(cells[1].attributes.at("fill"), cells[2].attributes.at("fill"));
  EXPECT_NE(cells[1].attributes.at("fill"), other[0].attributes.at("fill"));  // Empty.
}

TEST(ConfusionPicture, KeepsTextsApartWithManyLongNamesAndNumbers) {
  for (const std::size_t count : {1U, 8U, 40U}) {
    ConfusionCounts confusion{.title = "x", .counted = "frames", .classes = {}, .counts = {}};
    for (std::size_t i = 0; i < count; ++i) {
      confusion.classes.push_back(std::string(60, 'W') + std::to_string(i));
      confusion.counts.emplace_back(count + 1, 12345);
    }
    test::ExpectTextsApart(test::SvgReader(Svg(ConfusionPicture(confusion))));
  }
}

TEST(ConfusionPicture, RefusesRowsThatDoNotFit) {
  ConfusionCounts confusion = Confusion();
  confusion.counts.pop_back();
  EXPECT_THROW((void)ConfusionPicture(confusion), Error);
  confusion.counts.push_back({1, 2});
  EXPECT_THROW((void)ConfusionPicture(confusion), Error);
  confusion.counts.back() = {1, 2, -1};
  EXPECT_THROW((void)ConfusionPicture(confusion), Error);
  EXPECT_THROW((void)ConfusionPicture({}), Error);
}

// Ten groups: many wrong ones of low confidence, nothing between, 40 of high confidence, and 29.
ReliabilityPanel Confidences() {
  ReliabilityPanel panel{"mt: calibration error 0.010", std::vector<ReliabilityGroup>(10)};
  panel.groups[0] = {.hits = 9000, .confidence = 0.01, .right = 0};
  panel.groups[5] = {.hits = 29, .confidence = 0.55, .right = 0.25};
  panel.groups[9] = {.hits = 40, .confidence = 0.95, .right = 0.9};
  return panel;
}

TEST(ReliabilityPicture, PutsGroupsWhereTheirSharesAre) {
  const test::SvgReader svg(Svg(ReliabilityPicture({Confidences()})));
  const auto dots = svg.Named("circle", "shares");
  ASSERT_THAT(dots, SizeIs(3));
  const auto panel = svg.Groups("panel").at(0);
  const Axis confidence(panel, "axis-across", "x");
  const Axis right(panel, "axis-up", "y");
  EXPECT_NEAR(dots[0].Number("cx"), confidence.At(0.01), 0.02);
  EXPECT_NEAR(dots[1].Number("cx"), confidence.At(0.55), 0.02);
  EXPECT_NEAR(dots[1].Number("cy") - dots[2].Number("cy"), right.At(0.25) - right.At(0.9), 0.02);
  EXPECT_FALSE(dots[0].attributes.contains("fill-opacity"));
  EXPECT_TRUE(dots[1].attributes.contains("fill-opacity"));  // Few hits.
  EXPECT_FALSE(dots[2].attributes.contains("fill-opacity"));
}

TEST(ReliabilityPicture, CountsHitsBelow) {
  const test::SvgReader svg(Svg(ReliabilityPicture({Confidences()})));
  const auto bars = svg.Named("rect", "numbers");
  ASSERT_THAT(bars, SizeIs(3));
  EXPECT_NEAR(bars[0].Number("height") / bars[2].Number("height"),
              std::log10(9001) / std::log10(41), 0.01);
  EXPECT_THAT(svg.Texts(), IsSupersetOf({"9000", "29", "40", "mt: calibration error 0.010"}));
  EXPECT_THAT(svg.Texts(), Not(Contains("0")));  // Empty groups have no number.
  ReliabilityPanel many = Confidences();
  many.groups[0].hits = 123456;
  EXPECT_THAT(test::SvgReader(Svg(ReliabilityPicture({many}))).Texts(), Contains("123k"));
}

TEST(ReliabilityPicture, RefusesWhatNoShareCanBe) {
  EXPECT_THROW((void)ReliabilityPicture({}), Error);
  EXPECT_THROW((void)ReliabilityPicture({{"empty", {}}}), Error);
  EXPECT_THROW((void)ReliabilityPicture({{"high", {{1, 1.5, 0}}}}), Error);
  EXPECT_THROW((void)ReliabilityPicture({{"no number", {{1, 0.5, std::nan("")}}}}), Error);
}

TEST(EvaluationPictures, KeepTextsApartAndAreReadAsPng) {
  std::vector<PrecisionPanel> parts;
  parts.reserve(9);
  for (int i = 0; i < 9; ++i) parts.push_back(Panel(std::string(50, 'W') + std::to_string(i)));
  std::vector<ReliabilityGroup> crowded(10, {.hits = 123456, .confidence = 0.5, .right = 0.5});
  const std::vector<Picture> pictures = {
      PrecisionPicture(Panel("All"), parts), ConfusionPicture(Confusion()),
      ReliabilityPicture(
          {Confidences(), {std::string(90, 'W'), crowded}, Confidences(), Confidences()})};
  const test::TemporaryFolder folder;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    test::ExpectTextsApart(test::SvgReader(Svg(pictures[i])));
    const std::filesystem::path path = folder.path() / (std::to_string(i) + ".png");
    WritePicture(path, pictures[i].size, Overwrite::kNo, pictures[i].draw);
    const test::PngReader png(path);
    EXPECT_NEAR(png.width(), pictures[i].size.width * kPngScale, kPngScale);
    EXPECT_NEAR(png.height(), pictures[i].size.height * kPngScale, kPngScale);
    EXPECT_EQ(png.At(1, 1), (Color{255, 255, 255}));
  }
}

}  // namespace
}  // namespace kinebase
