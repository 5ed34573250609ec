#include "kinebase/pictures/timeline_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "pictures/png_reader.h"
#include "pictures/svg_reader.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using ::testing::IsSupersetOf;

// Ten seconds: true from 2 to 5, found from 4 to 6.
Timeline TenSeconds() {
  return {.title = "gym.amc",
          .duration_s = 10,
          .rows = {{"squat", {{2, 5}}, {{4, 6}}}, {"kick", {}, {}}},
          .has_truth = true};
}

class TimelinePicture : public ::testing::Test {
 protected:
  // The bars of the first row: the background is the first rectangle.
  std::vector<test::SvgElement> Bars(const Timeline& timeline) const {
    DrawTimelines({&timeline, 1}, svg_, Overwrite::kYes);
    return test::SvgReader(test::ReadText(svg_)).Groups("row").at(0);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path svg_ = folder_.path() / "timeline.svg";
};

std::vector<test::SvgElement> Rectangles(const std::vector<test::SvgElement>& elements) {
  std::vector<test::SvgElement> rectangles;
  for (const auto& element : elements) {
    if (element.name == "rect") rectangles.push_back(element);
  }
  return rectangles;
}

TEST_F(TimelinePicture, PutsBarsWhereTheirTimesAre) {
  const auto rectangles = Rectangles(Bars(TenSeconds()));
  ASSERT_EQ(rectangles.size(), 4U);  // Background, truth, found, and what is right of it.
  const double left = rectangles[0].Number("x");
  const double second = rectangles[0].Number("width") / 10;
  const std::vector<std::pair<double, double>> spans = {{2, 5}, {4, 6}, {4, 5}};
  for (std::size_t i = 0; i < spans.size(); ++i) {
    EXPECT_NEAR(rectangles[i + 1].Number("x"), left + spans[i].first * second, 0.01);
    EXPECT_NEAR(rectangles[i + 1].Number("width"), (spans[i].second - spans[i].first) * second,
                0.01);
  }
  EXPECT_LT(rectangles[1].Number("y") + rectangles[1].Number("height"),
            rectangles[2].Number("y") + 0.01);  // Truth stands above.
}

TEST_F(TimelinePicture, IsBlueWhereItIsRightAndRedWhereNot) {
  const auto rectangles = Rectangles(Bars(TenSeconds()));
  const std::filesystem::path png = folder_.path() / "timeline.png";
  const Timeline timeline = TenSeconds();
  DrawTimelines({&timeline, 1}, png, Overwrite::kNo);
  const test::PngReader picture(png);
  const double left = rectangles[0].Number("x");
  const double second = rectangles[0].Number("width") / 10;
  const double found = rectangles[2].Number("y") + rectangles[2].Number("height") / 2;
  EXPECT_EQ(picture.At(left + 4.5 * second, found), kTimelineRight);
  EXPECT_EQ(picture.At(left + 5.5 * second, found), kTimelineWrong);
  EXPECT_EQ(picture.At(left + 3 * second, rectangles[1].Number("y") + 3), kTimelineTruth);
}

TEST_F(TimelinePicture, CallsNothingWrongWithoutTruth) {
  Timeline timeline = TenSeconds();
  timeline.has_truth = false;
  timeline.rows[0].truth.clear();
  EXPECT_EQ(Rectangles(Bars(timeline)).size(), 2U);
  const std::vector<std::string> texts = test::SvgReader(test::ReadText(svg_)).Texts();
  EXPECT_THAT(texts, IsSupersetOf({"gym.amc", "squat", "kick", "time in s", "found", "10.0"}));
  EXPECT_THAT(texts, ::testing::Not(::testing::Contains("found, and not true")));
}

TEST_F(TimelinePicture, CutsBarsAtTheEnd) {
  Timeline timeline = TenSeconds();
  timeline.rows[0] = {"squat", {{8, 12}, {20, 30}}, {}};
  const auto rectangles = Rectangles(Bars(timeline));
  ASSERT_EQ(rectangles.size(), 2U);
  EXPECT_NEAR(rectangles[1].Number("width"), rectangles[0].Number("width") / 5, 0.01);
}

TEST_F(TimelinePicture, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(DrawTimelines({}, svg_, Overwrite::kNo), Error);
  std::vector<Timeline> bad(3, TenSeconds());
  bad[0].rows.clear();
  bad[1].duration_s = 0;
  bad[2].rows[0].found = {{2, 1}};
  for (const Timeline& timeline : bad) {
    EXPECT_THROW(DrawTimelines({&timeline, 1}, svg_, Overwrite::kNo), Error);
  }
  EXPECT_FALSE(std::filesystem::exists(svg_));
}

}  // namespace
}  // namespace kinebase
