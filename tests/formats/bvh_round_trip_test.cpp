// read(write(read(f))) equals read(f), for every BVH that there is and for any that could be.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "formats/bvh_texts.h"
#include "formats/texts.h"
#include "kinebase/core/error.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

TEST(BvhWriter, GivesBackEveryRealFile) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto files = test::FilesBelow(test::TestData("data"), ".bvh");
  EXPECT_GE(files.size(), 12);
  std::size_t frames = 0;
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const BvhMotion bvh = ReadBvh(file);
    frames += bvh.frame_count();
    const BvhMotion again = ParseBvh(FormatBvh(bvh), file);
    EXPECT_EQ(again, bvh);
    EXPECT_EQ(FormatBvh(again), FormatBvh(bvh));
  }
  EXPECT_GE(frames, 8902);
}

// One file declares 3,069 frames and has 3,070; two end without a line end.
TEST(BvhReader, FindsNothingWrongWithTheOtherRealFiles) {
  KINEBASE_NEEDS_TEST_DATA();
  const std::vector<std::string> odd = {"Boxing_Toes", "bvh_test2", "bvh_test3"};
  for (const auto& file : test::FilesBelow(test::TestData("data"), ".bvh")) {
    SCOPED_TRACE(file);
    const bool is_odd = std::ranges::find(odd, file.stem().string()) != odd.end();
    EXPECT_EQ(ReadBvh(file).diagnostics.size(), is_odd ? 1 : 0);
    if (is_odd) {
      EXPECT_THROW((void)ReadBvh(file, {.strict = true}), Error);
    } else {
      EXPECT_EQ(ReadBvh(file, {.strict = true}), ReadBvh(file));
    }
  }
  const BvhMotion boxing = ReadBvh(test::TestData("data/bvh/misc/Boxing_Toes.bvh"));
  EXPECT_EQ(boxing.declared_frame_count, 3069);
  EXPECT_EQ(boxing.frame_count(), 3070);
}

RC_GTEST_PROP(BvhWriter, GivesBackAnyRecord, ()) {
  const BvhMotion bvh = test::AnyBvh();
  const BvhMotion again = ParseBvh(FormatBvh(bvh), "any.bvh");
  RC_ASSERT(again == bvh);
  RC_ASSERT(FormatBvh(again) == FormatBvh(bvh));
}

RC_GTEST_PROP(BvhReader, IsIndifferentToLineEnds, ()) {
  const std::string text = FormatBvh(test::AnyBvh());
  const auto ending = *rc::gen::element<std::string>("\r\n", "\r");
  RC_ASSERT(ParseBvh(test::WithLineEnds(text, ending), "any.bvh") == ParseBvh(text, "any.bvh"));
}

TEST(BvhWriter, RefusesJointsThatAreNotDepthFirst) {
  BvhMotion bvh = ParseBvh(test::kArmBvh, "arm.bvh");
  bvh.joints[1].parent = 2;
  EXPECT_EQ(test::ErrorOf([&] { (void)FormatBvh(bvh); }).code(), ErrorCode::kInvalidArgument);
}

TEST(BvhMotion, IsEqualWhereTheSameValuesAreMissing) {
  const std::string text(test::kArmBvh);
  const BvhMotion a = ParseBvh(test::With(text, "40 50 60", "40 nan 60"), "a.bvh");
  EXPECT_EQ(a, ParseBvh(test::With(text, "40 50 60", "40 NAN 60"), "b.bvh"));
  EXPECT_NE(a, ParseBvh(text, "b.bvh"));
}

}  // namespace
}  // namespace kinebase
