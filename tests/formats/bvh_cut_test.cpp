#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/bvh_texts.h"
#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::string_view kSlide =
    "HIERARCHY\nROOT Slide\n{\nOFFSET 0 0 0\nCHANNELS 2 Xposition Yposition\n}\nMOTION\n"
    "Frames: 4\nFrame Time: 0.1\n1 nan\n2 5\ninf 6\nnan -inf\n";

TEST(CutBvh, KeepsValuesAndSaysHowManyFramesThereAre) {
  const BvhMotion clip = CutBvh(ParseBvh(test::kArmBvh, "arm.bvh"), 1, 1);
  EXPECT_THAT(clip.values, ElementsAre(1.5, 2.5, 3.5, 11, 21, 31, 41, 51, 61, 7.5));
  EXPECT_EQ(clip.declared_frame_count, 1);
  EXPECT_EQ(ParseBvh(FormatBvh(clip), "clip.bvh"), clip);
}

// The last value before, or else the first after: as the whole is read.
TEST(CutBvh, FillsTheFirstFrameAsReadersOfTheWholeDo) {
  const BvhMotion take = ParseBvh(kSlide, "slide.bvh");
  EXPECT_THAT(CutBvh(take, 0, 0).values, ElementsAre(1, 5));
  EXPECT_THAT(CutBvh(take, 2, 3).values, ElementsAre(2, 6, testing::IsNan(), testing::Lt(-1e300)));
}

TEST(CutBvh, RefusesARangeThatIsEmptyOrLeavesTheMotion) {
  const BvhMotion take = ParseBvh(kSlide, "slide.bvh");
  for (const auto& [first, last] : {std::pair{-1, 2}, {2, 1}, {0, 4}, {4, 4}}) {
    const Error error = test::ErrorOf([&] { (void)CutBvh(take, first, last); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr("of 4"));
  }
}

}  // namespace
}  // namespace kinebase
