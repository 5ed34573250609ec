#include "kinebase/pictures/template_picture.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "kinebase/core/error.h"
#include "pictures/png_reader.h"
#include "pictures/svg_reader.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using test::ErrorOf;
using test::SvgElement;
using test::SvgReader;
using testing::Contains;
using testing::HasSubstr;

constexpr Color kBlack = {0, 0, 0};
constexpr Color kWhite = {255, 255, 255};

FeatureSet MakeSet(int features) {
  FeatureSet set;
  set.name = "made-up";
  set.hash = 77;
  for (int i = 0; i < features; ++i) {
    Feature feature;
    feature.id = fmt::format("F{}", i + 1);
    feature.name = fmt::format("joint {} <moves> & rests", i + 1);
    feature.group = i * 2 < features ? "upper" : "lower";
    set.features.push_back(feature);
  }
  return set;
}

MotionTemplate MakeTemplate(const FeatureSet& set, int columns) {
  MotionTemplate made;
  made.name = "wave";
  made.feature_set = set.name;
  made.feature_set_hash = set.hash;
  made.matrix.rate_hz = 30;
  made.matrix.feature_count = set.feature_count();
  made.matrix.weights.assign(columns, 1);
  for (int i = 0; i < columns * set.feature_count(); ++i) {
    made.matrix.values.push_back(0.5 + 0.5 * std::sin(i * 0.37));
  }
  return made;
}

// Three features, two columns; values chosen at the stops of the colours.
MotionTemplate ThreeByTwo(const FeatureSet& set) {
  MotionTemplate made = MakeTemplate(set, 2);
  made.matrix.values = {0, 0.375, 1, 0.75, 0.05, 0.95};
  return made;
}

class TemplatePicture : public testing::Test {
 protected:
  std::filesystem::path File(const std::string& name) const { return folder_.path() / name; }

  SvgReader DrawnSvg(const MotionTemplate& drawn, const FeatureSet& set,
                     const TemplatePictureOptions& options = {}) {
    DrawTemplate(drawn, set, File("t.svg"), Overwrite::kYes, options);
    svg_ = test::ReadText(File("t.svg"));
    return SvgReader(svg_);
  }

  // Colours of the PNG in the middle of each cell, [feature][column]; the SVG says where cells are.
  std::vector<std::vector<Color>> CellColors(const MotionTemplate& drawn, const FeatureSet& set,
                                             const TemplatePictureOptions& options = {}) {
    const std::vector<SvgElement> rows = DrawnSvg(drawn, set, options).Named("rect", "cells");
    DrawTemplate(drawn, set, File("t.png"), Overwrite::kYes, options);
    const test::PngReader png(File("t.png"));
    double left = 1e9, right = 0;
    std::set<double> tops;
    for (const SvgElement& cell : rows) {
      left = std::min(left, cell.Number("x"));
      right = std::max(right, cell.Number("x") + cell.Number("width"));
      tops.insert(cell.Number("y"));
    }
    const int columns = drawn.matrix.column_count();
    std::vector<std::vector<Color>> colors;
    for (const double top : tops) {
      colors.emplace_back();
      for (int column = 0; column < columns; ++column) {
        const double x = left + (column + 0.5) * (right - left) / columns;
        colors.back().push_back(png.At(x, top + rows.at(0).Number("height") / 2));
      }
    }
    return colors;
  }

 private:
  test::TemporaryFolder folder_;
  std::string svg_;  // SvgReader looks into it.
};

TEST(TemplateColor, IsBlackRedYellowWhiteAtItsStops) {
  EXPECT_EQ(TemplateColor(0), kBlack);
  EXPECT_EQ(TemplateColor(0.375), (Color{255, 0, 0}));
  EXPECT_EQ(TemplateColor(0.75), (Color{255, 255, 0}));
  EXPECT_EQ(TemplateColor(1), kWhite);
  EXPECT_EQ(TemplateColor(0.5625), (Color{255, 128, 0}));
}

TEST(TemplateColor, GrowsLighterWithTheValue) {
  double before = -1;
  for (int i = 0; i <= 100; ++i) {
    const Color color = TemplateColor(i / 100.0);
    const double lightness = 0.2126 * color.red + 0.7152 * color.green + 0.0722 * color.blue;
    EXPECT_GT(lightness, before) << i;
    before = lightness;
  }
}

TEST_F(TemplatePicture, ShowsValuesInTheDocumentedColors) {
  const FeatureSet set = MakeSet(3);
  const std::vector<std::vector<Color>> colors = CellColors(ThreeByTwo(set), set);
  ASSERT_EQ(colors.size(), 3u);
  EXPECT_EQ(colors[0], (std::vector<Color>{kBlack, {255, 255, 0}}));
  EXPECT_EQ(colors[1], (std::vector<Color>{{255, 0, 0}, TemplateColor(0.05)}));
  EXPECT_EQ(colors[2], (std::vector<Color>{kWhite, TemplateColor(0.95)}));
}

TEST_F(TemplatePicture, ShowsZerosOnesAndAnyWhenQuantized) {
  const FeatureSet set = MakeSet(3);
  const std::vector<std::vector<Color>> colors =
      CellColors(ThreeByTwo(set), set, {.quantized = true});
  ASSERT_EQ(colors.size(), 3u);
  EXPECT_EQ(colors[0], (std::vector<Color>{kBlack, kAnyColor}));
  EXPECT_EQ(colors[1], (std::vector<Color>{kAnyColor, kBlack}));
  EXPECT_EQ(colors[2], (std::vector<Color>{kWhite, kWhite}));
}

TEST_F(TemplatePicture, NamesTitleFactsGroupsAndEveryFeature) {
  const FeatureSet set = MakeSet(39);
  MotionTemplate drawn = MakeTemplate(set, 45);
  drawn.name = "wave <&> \"hello\"";
  drawn.clips.resize(2);
  const std::vector<std::string> texts = DrawnSvg(drawn, set).Texts();
  EXPECT_THAT(texts, Contains(drawn.name));
  EXPECT_THAT(texts, Contains("2 clips · 45 columns · 1.50 s · 30 Hz · feature set made-up"));
  for (const char* text : {"upper", "lower", "time in s", "column", "weight (line at 1)"}) {
    EXPECT_THAT(texts, Contains(text).Times(1));
  }
  for (const Feature& feature : set.features) {
    EXPECT_THAT(texts, Contains(feature.id).Times(1));
    EXPECT_THAT(texts, Contains(feature.name).Times(1));
  }
}

TEST_F(TemplatePicture, LeavesTheWeightsOutWhenAsked) {
  const FeatureSet set = MakeSet(3);
  EXPECT_TRUE(DrawnSvg(ThreeByTwo(set), set, {.weights = false}).Named("rect", "weights").empty());
}

TEST_F(TemplatePicture, DrawsWeightsAsHighAsTheyAre) {
  const FeatureSet set = MakeSet(3);
  MotionTemplate drawn = ThreeByTwo(set);
  drawn.matrix.weights = {0.5, 2};
  const std::vector<SvgElement> bars = DrawnSvg(drawn, set).Named("rect", "weights");
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_NEAR(bars[1].Number("height") / bars[0].Number("height"), 4, 0.01);
  EXPECT_EQ(bars[0].Number("y") + bars[0].Number("height"),
            bars[1].Number("y") + bars[1].Number("height"));
}

TEST_F(TemplatePicture, PlacesTimesByTheWeights) {
  const FeatureSet set = MakeSet(1);
  MotionTemplate drawn = MakeTemplate(set, 40);
  drawn.matrix.rate_hz = 10;
  std::fill(drawn.matrix.weights.begin(), drawn.matrix.weights.begin() + 20, 2);
  const SvgReader svg = DrawnSvg(drawn, set);  // 20 columns of 0.2 s, then 20 of 0.1 s.
  double zero = 0, two = 0, four = 0, six = 0;
  for (const SvgElement& tick : svg.Named("text", "axes")) {
    const double y = tick.Number("y");
    if (y > svg.Named("text", "axes").at(1).Number("y")) continue;  // The axis of columns.
    if (tick.text == "0.0") zero = tick.Number("x");
    if (tick.text == "2.0") two = tick.Number("x");
    if (tick.text == "4.0") four = tick.Number("x");
    if (tick.text == "6.0") six = tick.Number("x");
  }
  const std::vector<SvgElement> cells = svg.Named("rect", "cells");
  const double left = cells.at(0).Number("x");
  const double width = cells.back().Number("x") + cells.back().Number("width") - left;
  EXPECT_NEAR(zero, left, 0.01);
  EXPECT_NEAR(two, left + width / 4, 0.01);
  EXPECT_NEAR(four, left + width / 2, 0.01);
  EXPECT_NEAR(six, left + width, 0.01);
}

// All of a text's box, by its measured width.
struct TextBox {
  double left, right, top, bottom;
  std::string text;
};

TextBox BoxOf(const SvgElement& text) {
  const double width = text.Number("textLength");
  const double size = text.Number("font-size");
  const auto anchor = text.attributes.find("text-anchor");
  double left = text.Number("x");
  if (anchor != text.attributes.end()) left -= anchor->second == "middle" ? width / 2 : width;
  const double y = text.Number("y");
  return {left, left + width, y - 0.75 * size, y + 0.2 * size, text.text};
}

void ExpectNothingCutOffOrCovered(const SvgReader& svg) {
  const double width = svg.Named("svg").at(0).Number("width");
  const double height = svg.Named("svg").at(0).Number("height");
  std::vector<TextBox> boxes;
  for (const SvgElement& text : svg.Named("text")) boxes.push_back(BoxOf(text));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const TextBox& a = boxes[i];
    EXPECT_TRUE(a.left >= 0 && a.right <= width && a.top >= 0 && a.bottom <= height) << a.text;
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      const TextBox& b = boxes[j];
      EXPECT_TRUE(a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top)
          << a.text << " and " << b.text;
    }
  }
  for (const SvgElement& rect : svg.Named("rect")) {
    if (rect.groups.empty()) continue;
    EXPECT_GE(rect.Number("x"), 0);
    EXPECT_LE(rect.Number("x") + rect.Number("width"), width);
    EXPECT_LE(rect.Number("y") + rect.Number("height"), height);
  }
}

TEST_F(TemplatePicture, CutsAndCoversNothingAtAnySize) {
  for (const auto& [features, columns] :
       {std::pair{1, 1}, {39, 20}, {39, 89}, {64, 300}, {2, 1500}, {64, 2}}) {
    SCOPED_TRACE(fmt::format("{} features, {} columns", features, columns));
    const FeatureSet set = MakeSet(features);
    const SvgReader svg = DrawnSvg(MakeTemplate(set, columns), set);
    ExpectNothingCutOffOrCovered(svg);
    EXPECT_GE(svg.Named("rect", "cells").size(), static_cast<std::size_t>(features));
  }
}

TEST_F(TemplatePicture, ShortensWhatIsTooLong) {
  FeatureSet set = MakeSet(4);
  for (Feature& feature : set.features) {
    feature.name = std::string(300, 'n');
    feature.id = std::string(100, 'i');
    feature.group = std::string(100, 'g');
  }
  set.name = std::string(1000, 's');
  MotionTemplate drawn = MakeTemplate(set, 5);
  drawn.name = std::string(1000, 'x') + " end";
  const SvgReader svg = DrawnSvg(drawn, set);
  ExpectNothingCutOffOrCovered(svg);
  const std::string title = svg.Texts().at(0);
  EXPECT_TRUE(title.starts_with("xxxx") && title.ends_with("…")) << title;
  EXPECT_LT(svg.Named("svg").at(0).Number("width"), 1500);
}

TEST_F(TemplatePicture, IsTheSamePictureInBothFormats) {
  const FeatureSet set = MakeSet(39);
  const MotionTemplate drawn = MakeTemplate(set, 33);
  const SvgReader svg = DrawnSvg(drawn, set);
  DrawTemplate(drawn, set, File("t.png"), Overwrite::kNo);
  const test::PngReader png(File("t.png"));
  EXPECT_EQ(png.width(), kPngScale * svg.Named("svg").at(0).Number("width"));
  EXPECT_EQ(png.height(), kPngScale * svg.Named("svg").at(0).Number("height"));
}

TEST_F(TemplatePicture, IsTheSameBytesAgain) {
  const FeatureSet set = MakeSet(39);
  const MotionTemplate drawn = MakeTemplate(set, 33);
  for (const std::string extension : {".svg", ".png"}) {
    DrawTemplate(drawn, set, File("a" + extension), Overwrite::kNo);
    DrawTemplate(drawn, set, File("b" + extension), Overwrite::kNo);
    EXPECT_EQ(test::ReadText(File("a" + extension)), test::ReadText(File("b" + extension)));
  }
}

TEST_F(TemplatePicture, NeverOverwritesUnasked) {
  const FeatureSet set = MakeSet(3);
  test::WriteText(File("t.png"), "precious");
  EXPECT_EQ(
      ErrorOf([&] { DrawTemplate(ThreeByTwo(set), set, File("t.png"), Overwrite::kNo); }).code(),
      ErrorCode::kAlreadyExists);
  EXPECT_EQ(test::ReadText(File("t.png")), "precious");
}

TEST_F(TemplatePicture, RefusesWhatIsNotTheTemplatesSet) {
  const FeatureSet set = MakeSet(3);
  FeatureSet other = set;
  other.hash = 78;
  EXPECT_EQ(
      ErrorOf([&] { DrawTemplate(ThreeByTwo(set), other, File("t.svg"), Overwrite::kNo); }).code(),
      ErrorCode::kMismatch);
}

TEST_F(TemplatePicture, RefusesMatricesThatNoTemplateHas) {
  const FeatureSet set = MakeSet(3);
  const auto message = [&](auto spoil) {
    MotionTemplate drawn = ThreeByTwo(set);
    spoil(drawn.matrix);
    const Error error = ErrorOf([&] { DrawTemplate(drawn, set, File("t.svg"), Overwrite::kNo); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    return std::string(error.what());
  };
  EXPECT_THAT(message([](TemplateMatrix& m) { m.weights.clear(), m.values.clear(); }),
              HasSubstr("\"wave\" has no columns"));
  EXPECT_THAT(message([](TemplateMatrix& m) { m.rate_hz = 0; }), HasSubstr("0 Hz"));
  EXPECT_THAT(message([](TemplateMatrix& m) { m.values.pop_back(); }),
              HasSubstr("5 values; 2 columns of 3 features need 6"));
  EXPECT_THAT(message([](TemplateMatrix& m) { m.values[4] = 1.5; }),
              HasSubstr("the value 1.5 for F2 in column 1"));
  EXPECT_THAT(message([](TemplateMatrix& m) { m.values[0] = std::nan(""); }),
              HasSubstr("for F1 in column 0"));
  EXPECT_THAT(message([](TemplateMatrix& m) { m.weights[1] = 0; }),
              HasSubstr("the weight 0 in column 1"));
}

FeatureMatrix MakeBits(int features, int columns) {
  FeatureMatrix bits;
  bits.rate_hz = 30;
  bits.feature_count = features;
  for (int i = 0; i < columns; ++i) {
    bits.columns.push_back((0x9E3779B97F4A7C15U * static_cast<unsigned>(i + 1)) >> (64 - features));
  }
  return bits;
}

TEST_F(TemplatePicture, ShowsFeatureMatricesInBlackAndWhite) {
  const FeatureSet set = MakeSet(3);
  FeatureMatrix bits = MakeBits(3, 2);
  bits.columns = {0b001, 0b110};
  DrawFeatureMatrix(bits, set, "take <1>", File("m.svg"), Overwrite::kNo);
  const std::string text = test::ReadText(File("m.svg"));
  const SvgReader svg(text);
  std::vector<std::string> fills;
  for (const SvgElement& cell : svg.Named("rect", "cells")) {
    fills.push_back(cell.attributes.at("fill"));
  }
  EXPECT_EQ(fills, (std::vector<std::string>{"#ffffff", "#000000", "#000000", "#ffffff", "#000000",
                                             "#ffffff"}));
  EXPECT_THAT(svg.Texts(), Contains("take <1>"));
  EXPECT_TRUE(svg.Named("rect", "weights").empty());
}

TEST_F(TemplatePicture, DrawsLongRecordingsSeveralColumnsAtATime) {
  const FeatureSet set = MakeSet(64);
  FeatureMatrix bits = MakeBits(64, 4001);  // Three columns a step; the last step has two.
  bits.columns[0] = 1;
  bits.columns[1] = 0;
  bits.columns[2] = 1;
  DrawFeatureMatrix(bits, set, "long", File("m.svg"), Overwrite::kNo);
  const std::string text = test::ReadText(File("m.svg"));
  const SvgReader svg(text);
  ExpectNothingCutOffOrCovered(svg);
  EXPECT_THAT(svg.Texts(), Contains(HasSubstr("4001 columns · 133.37 s")));
  EXPECT_THAT(svg.Texts(), Contains(HasSubstr("drawn 3 columns at a time")));
  const Color share = TemplateColor(2.0 / 3);
  EXPECT_EQ(svg.Named("rect", "cells").at(0).attributes.at("fill"),
            fmt::format("#{:02x}{:02x}{:02x}", share.red, share.green, share.blue));
}

TEST_F(TemplatePicture, RefusesFeatureMatricesThatCannotBeDrawn) {
  const FeatureSet set = MakeSet(3);
  const auto code = [&](const FeatureMatrix& bits) {
    return ErrorOf([&] { DrawFeatureMatrix(bits, set, "", File("m.svg"), Overwrite::kNo); }).code();
  };
  EXPECT_EQ(code(MakeBits(4, 2)), ErrorCode::kMismatch);
  EXPECT_EQ(code(MakeBits(3, 0)), ErrorCode::kInvalidArgument);
  FeatureMatrix no_rate = MakeBits(3, 2);
  no_rate.rate_hz = 0;
  EXPECT_EQ(code(no_rate), ErrorCode::kInvalidArgument);
}

TEST_F(TemplatePicture, OfAComparisonMarksWhatIsNotAsAsked) {
  const FeatureSet set = MakeSet(2);
  // The first feature must hold, then must not; the second is free.
  const std::vector<ComparedColumn> columns = {
      {0b01, 0b01, 0b11}, {0b01, 0b01, 0b00}, {0b01, 0b00, 0b01}, {0b01, 0b00, 0b00}};
  DrawComparison(columns, 30, set, "why", File("c.png"), Overwrite::kNo);
  DrawComparison(columns, 30, set, "why", File("c.svg"), Overwrite::kNo);
  const std::string svg = test::ReadText(File("c.svg"));
  const std::vector<SvgElement> cells = SvgReader(svg).Named("rect", "cells");
  std::set<double> tops;
  double left = 1e9, right = 0;
  for (const SvgElement& cell : cells) {
    tops.insert(cell.Number("y"));
    left = std::min(left, cell.Number("x"));
    right = std::max(right, cell.Number("x") + cell.Number("width"));
  }
  ASSERT_EQ(tops.size(), 4);  // Two rows, each asked and found.
  const test::PngReader png(File("c.png"));
  std::vector<std::vector<Color>> colors;
  for (const double top : tops) {
    auto& row = colors.emplace_back();
    for (int c = 0; c < 4; ++c) {
      row.push_back(png.At(left + (c + .5) * (right - left) / 4, top + 4));
    }
  }
  constexpr Color kWrong = {214, 39, 40};
  constexpr Color kLacking = {255, 152, 150};
  EXPECT_EQ(colors[0], (std::vector<Color>{kWhite, kWhite, kBlack, kBlack}));
  EXPECT_EQ(colors[1], (std::vector<Color>{kWhite, kLacking, kWrong, kBlack}));
  EXPECT_EQ(colors[2], (std::vector<Color>(4, kAnyColor)));
  EXPECT_EQ(colors[3], (std::vector<Color>{kWhite, kBlack, kBlack, kBlack}));
  EXPECT_EQ(ErrorOf([&] { DrawComparison({}, 30, set, "", File("d.svg"), Overwrite::kNo); }).code(),
            ErrorCode::kInvalidArgument);
}

// Below the features a row a joint, shaded by how far it is off; costs at the right of each row.
TEST_F(TemplatePicture, OfAComparisonShowsWhatPosesCost) {
  const FeatureSet set = MakeSet(2);
  const std::vector<ComparedColumn> columns = {{0b01, 0b01, 0b11}, {0b01, 0b01, 0b00}};
  const ComparedCosts costs = {
      .features = {0.0125, 0},
      .joints = {{.joint = StandardJoint::kRwrist, .cost = 0.0417, .off = {0, 1}},
                 {.joint = StandardJoint::kHead, .cost = 0.25, .off = {2, 9}}}};
  DrawComparison(columns, 30, set, "why", File("p.png"), Overwrite::kNo, costs);
  DrawComparison(columns, 30, set, "why", File("p.svg"), Overwrite::kNo, costs);
  const std::string svg = test::ReadText(File("p.svg"));
  for (const char* text : {"rwrist", "head", "poses", "0.0125", "0.0417", "0.2500", "1 spread off",
                           "cost of features 0.0125 and of poses 0.2917"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(svg.find("look-alikes"), std::string::npos);
  ComparedCosts with_lookalikes = costs;
  with_lookalikes.lookalikes = 0.05;
  DrawComparison(columns, 30, set, "why", File("l.svg"), Overwrite::kNo, with_lookalikes);
  EXPECT_NE(test::ReadText(File("l.svg")).find(", of look-alikes 0.0500"), std::string::npos);
  EXPECT_EQ(svg.find("0.0000"), std::string::npos);  // Rows that cost nothing say nothing.
  const std::vector<SvgElement> cells = SvgReader(svg).Named("rect", "cells");
  std::set<double> tops;
  double left = 1e9, right = 0;
  for (const SvgElement& cell : cells) {
    tops.insert(cell.Number("y"));
    left = std::min(left, cell.Number("x"));
    right = std::max(right, cell.Number("x") + cell.Number("width"));
  }
  ASSERT_EQ(tops.size(), 6);  // Two features, each asked and found, and two joints.
  const test::PngReader png(File("p.png"));
  const auto color = [&](std::size_t row, int column) {
    return png.At(left + (column + .5) * (right - left) / 2,
                  *std::next(tops.begin(), static_cast<std::ptrdiff_t>(row)) + 4);
  };
  constexpr Color kRed = {214, 39, 40};
  EXPECT_EQ(color(4, 0), kWhite);
  EXPECT_EQ(color(4, 1), Mix(kWhite, kRed, 0.5));
  EXPECT_EQ(color(5, 0), kRed);
  EXPECT_EQ(color(5, 1), kRed);
  // A comparison without costs is what it was.
  DrawComparison(columns, 30, set, "why", File("plain.svg"), Overwrite::kNo);
  EXPECT_EQ(test::ReadText(File("plain.svg")).find("poses"), std::string::npos);
  ComparedCosts wrong = costs;
  wrong.joints[0].off.resize(1);
  EXPECT_EQ(ErrorOf([&] {
              DrawComparison(columns, 30, set, "", File("w.svg"), Overwrite::kNo, wrong);
            }).code(),
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace kinebase
