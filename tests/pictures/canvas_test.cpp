#include "kinebase/pictures/canvas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <filesystem>
#include <numeric>
#include <string>

#include "kinebase/core/error.h"
#include "pictures/png_reader.h"
#include "pictures/svg_reader.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using test::ErrorOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr PictureSize kSize = {200, 50};

void DrawAll(Canvas& canvas) {
  canvas.BeginGroup("all");
  canvas.Rectangle({10, 10, 20, 20}, {255, 0, 0});
  canvas.Line(std::array{PicturePoint{0, 45}, PicturePoint{200, 45}},
              {.width = 4, .color = {0, 0, 255}});
  canvas.Circle({60, 20}, 8, {0, 255, 0}, {.width = 2, .color = {0, 0, 0}});
  canvas.Text({90, 25}, "Sideways < & > \"quoted\"");
  canvas.EndGroup();
}

TEST(PictureFormatOf, TakesTheExtensionInAnyCase) {
  EXPECT_EQ(PictureFormatOf("a.svg"), PictureFormat::kSvg);
  EXPECT_EQ(PictureFormatOf("b.c/a.PNG"), PictureFormat::kPng);
}

TEST(PictureFormatOf, NamesTheFormatsThatWork) {
  const Error error = ErrorOf([] { static_cast<void>(PictureFormatOf("pose.jpg")); });
  EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(error.what(), HasSubstr("pose.jpg"));
  EXPECT_THAT(error.what(), HasSubstr(".svg or .png, not as .jpg"));
  EXPECT_THAT(ErrorOf([] { static_cast<void>(PictureFormatOf("pose")); }).what(),
              HasSubstr("without an extension"));
}

TEST(Mix, GoesStraightFromOneColorToTheOther) {
  const Color from = {10, 200, 0, 1};
  const Color to = {20, 100, 255, 0};
  EXPECT_EQ(Mix(from, to, 0), from);
  EXPECT_EQ(Mix(from, to, 1), to);
  EXPECT_EQ(Mix(from, to, 0.5), (Color{15, 150, 128, 0.5}));
}

TEST(EncodePicture, WritesWellFormedSvgWithTextAsText) {
  const std::string svg = EncodePicture(PictureFormat::kSvg, kSize, DrawAll);
  const test::SvgReader reader(svg);
  EXPECT_THAT(reader.Texts(), ElementsAre("Sideways < & > \"quoted\""));
  EXPECT_EQ(reader.Named("rect", "all").size(), 1u);
  EXPECT_EQ(reader.Named("polyline", "all").size(), 1u);
  EXPECT_EQ(reader.Named("circle", "all").size(), 1u);
  EXPECT_EQ(reader.Named("svg").at(0).Number("width"), 200);
  EXPECT_EQ(reader.Named("svg").at(0).Number("height"), 50);
}

TEST(EncodePicture, DashesOnlyTheLinesThatAskForIt) {
  const auto draw = [](Canvas& canvas) {
    const Stroke dashed = {.width = 4, .round_ends = false, .dash = 10};
    canvas.Line(std::array{PicturePoint{0, 10}, PicturePoint{200, 10}}, dashed);
    canvas.Line(std::array{PicturePoint{0, 30}, PicturePoint{200, 30}}, {.width = 4});
  };
  const test::SvgReader svg(EncodePicture(PictureFormat::kSvg, kSize, draw));
  EXPECT_EQ(svg.Named("polyline").at(0).attributes.at("stroke-dasharray"), "10");
  EXPECT_FALSE(svg.Named("polyline").at(1).attributes.contains("stroke-dasharray"));
  const test::TemporaryFolder folder;
  WritePicture(folder.path() / "lines.png", kSize, Overwrite::kNo, draw);
  const test::PngReader png(folder.path() / "lines.png");
  const Color black = {0, 0, 0};
  const Color white = {255, 255, 255};
  EXPECT_EQ(png.At(5, 10), black);
  EXPECT_EQ(png.At(15, 10), white);
  EXPECT_EQ(png.At(25, 10), black);
  EXPECT_EQ(png.At(15, 30), black);
}

TEST(EncodePicture, WritesPngAtTheStatedScale) {
  const std::string png = EncodePicture(PictureFormat::kPng, {200.2, 50}, DrawAll);
  EXPECT_TRUE(png.starts_with("\x89PNG\r\n\x1a\n"));
  const auto big_endian = [&](std::size_t at) {
    return std::accumulate(png.begin() + at, png.begin() + at + 4, 0U, [](unsigned sum, char c) {
      return sum << 8 | static_cast<unsigned char>(c);
    });
  };
  EXPECT_EQ(big_endian(16), 201u * kPngScale);  // IHDR; PNG specification, Sect. 11.2.2.
  EXPECT_EQ(big_endian(20), 50u * kPngScale);
}

TEST(EncodePicture, PaintsWhatWasDrawnOnWhite) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "all.png";
  WritePicture(path, kSize, Overwrite::kNo, DrawAll);
  const test::PngReader png(path);
  EXPECT_EQ(png.At(20, 20), (Color{255, 0, 0}));
  EXPECT_EQ(png.At(100, 45), (Color{0, 0, 255}));
  EXPECT_EQ(png.At(60, 20), (Color{0, 255, 0}));
  EXPECT_EQ(png.At(5, 5), (Color{255, 255, 255}));
}

TEST(EncodePicture, GivesTheSameBytesAgain) {
  for (const PictureFormat format : {PictureFormat::kSvg, PictureFormat::kPng}) {
    EXPECT_EQ(EncodePicture(format, kSize, DrawAll), EncodePicture(format, kSize, DrawAll));
  }
}

TEST(EncodePicture, RefusesSizesThatCannotBe) {
  for (const PictureSize size : {PictureSize{0, 10}, {10, -1}, {std::nan(""), 1}, {1, INFINITY}}) {
    for (const PictureFormat format : {PictureFormat::kSvg, PictureFormat::kPng}) {
      EXPECT_EQ(ErrorOf([&] { static_cast<void>(EncodePicture(format, size, DrawAll)); }).code(),
                ErrorCode::kInvalidArgument);
    }
  }
  const Error error = ErrorOf([] {
    static_cast<void>(EncodePicture(PictureFormat::kPng, {40000, 10}, DrawAll));
  });
  EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(error.what(), HasSubstr("write an SVG, or draw less"));
  EXPECT_FALSE(EncodePicture(PictureFormat::kSvg, {40000, 10}, DrawAll).empty());
}

TEST(WritePicture, NeverOverwritesUnasked) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.svg", "a.png"}) {
    const std::filesystem::path path = folder.path() / name;
    test::WriteText(path, "precious");
    bool drawn = false;
    const Error error =
        ErrorOf([&] { WritePicture(path, kSize, Overwrite::kNo, [&](Canvas&) { drawn = true; }); });
    EXPECT_EQ(error.code(), ErrorCode::kAlreadyExists);
    EXPECT_FALSE(drawn);
    EXPECT_EQ(test::ReadText(path), "precious");
    WritePicture(path, kSize, Overwrite::kYes, DrawAll);
    EXPECT_NE(test::ReadText(path), "precious");
  }
}

TEST(WritePicture, LeavesNothingBehindWhenDrawingFails) {
  const test::TemporaryFolder folder;
  const auto fail = [](Canvas&) { throw Error(ErrorCode::kCancelled, "stopped"); };
  for (const char* name : {"a.svg", "a.png"}) {
    EXPECT_EQ(
        ErrorOf([&] { WritePicture(folder.path() / name, kSize, Overwrite::kNo, fail); }).code(),
        ErrorCode::kCancelled);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(CanvasText, KeepsBytesOutThatAreNoTextOrNoXml) {
  const std::string svg = EncodePicture(PictureFormat::kSvg, kSize, [](Canvas& canvas) {
    canvas.Text({0, 10}, "K\xF6ln");                // Latin-1.
    canvas.Text({0, 20}, "  a\tb\n\x01\x7F c ");    // Control characters and spaces.
    canvas.Text({0, 30}, "\xC0\xAF \xED\xA0\x80");  // Overlong; surrogate.
    canvas.Text({0, 40}, "größer · 標本 · \U0001F3C3");
  });
  const std::string bad = "\uFFFD";
  EXPECT_THAT(test::SvgReader(svg).Texts(),
              ElementsAre("K" + bad + "ln", "a b c", bad + bad + " " + bad + bad + bad,
                          "größer · 標本 · \U0001F3C3"));
}

RC_GTEST_PROP(CanvasText, MakesWellFormedSvgOfAnyBytes, (const std::string& bytes)) {
  const std::string svg = EncodePicture(PictureFormat::kSvg, kSize, [&](Canvas& canvas) {
    canvas.Text({0, 10}, bytes);
  });
  RC_ASSERT(test::SvgReader(svg).Named("text").size() <= 1u);
  RC_ASSERT(!EncodePicture(PictureFormat::kPng, kSize, [&](Canvas& canvas) {
               canvas.Text({0, 10}, bytes);
             }).empty());
}

RC_GTEST_PROP(ShortenText, FitsAndIsABeginning, (const std::string& text)) {
  const double width = *rc::gen::inRange(20, 200);
  const std::string shortened = ShortenText(text, width);
  RC_ASSERT(TextWidth(shortened) <= width);
  if (TextWidth(text) > width) RC_ASSERT(shortened.ends_with("…"));
}

TEST(ShortenText, KeepsWhatFitsAndCutsBetweenCharacters) {
  EXPECT_EQ(ShortenText("cartwheel", 500), "cartwheel");
  const std::string umlauts = "äöüäöüäöüäöü";
  const std::string shortened = ShortenText(umlauts, TextWidth("äöü…"));
  EXPECT_EQ(shortened, "äöü…");
  EXPECT_EQ(ShortenText("too long by far", 0), "…");
}

}  // namespace
}  // namespace kinebase
