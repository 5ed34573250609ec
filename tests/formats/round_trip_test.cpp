// read(write(read(f))) equals read(f), for every file that there is and for any that could be.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "formats/generators.h"
#include "formats/texts.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

TEST(AsfWriter, GivesBackEveryRealSkeleton) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto files = test::FilesBelow(test::TestData("data"), ".asf");
  EXPECT_GE(files.size(), 20);
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const AsfSkeleton asf = ReadAsf(file);
    EXPECT_GE(asf.bones.size(), 30);
    const AsfSkeleton again = ParseAsf(FormatAsf(asf), file);
    EXPECT_EQ(again, asf);
    EXPECT_EQ(FormatAsf(again), FormatAsf(asf));
  }
}

TEST(AmcWriter, GivesBackEveryRealMotion) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto files = test::FilesBelow(test::TestData("data"), ".amc");
  EXPECT_GE(files.size(), 187);
  std::size_t frames = 0;
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const AmcMotion amc = ReadAmc(file, {.strict = true});
    frames += amc.frame_count();
    EXPECT_EQ(ParseAmc(FormatAmc(amc), file, {.strict = true}), amc);
  }
  EXPECT_GE(frames, 29'966 + 54'197);
}

RC_GTEST_PROP(AsfWriter, GivesBackAnySkeleton, ()) {
  const AsfSkeleton asf = test::AnySkeleton();
  RC_ASSERT(ParseAsf(FormatAsf(asf), "any.asf") == asf);
}

RC_GTEST_PROP(AmcWriter, GivesBackAnyMotion, ()) {
  const AmcMotion amc = test::AnyMotion();
  RC_ASSERT(ParseAmc(FormatAmc(amc), "any.amc", {.strict = true}) == amc);
}

RC_GTEST_PROP(AmcReader, IsIndifferentToLineEnds, ()) {
  const std::string text = FormatAmc(test::AnyMotion());
  const auto ending = *rc::gen::element<std::string>("\r\n", "\r");
  RC_ASSERT(ParseAmc(test::WithLineEnds(text, ending), "any.amc") == ParseAmc(text, "any.amc"));
}

TEST(AmcMotion, IsEqualWhereTheSameValuesAreMissing) {
  const AmcMotion a = ParseAmc("1\na nan 1\n", "a.amc");
  EXPECT_EQ(a, ParseAmc("1\na NAN 1\n", "b.amc"));
  EXPECT_NE(a, ParseAmc("1\na 1 1\n", "b.amc"));
  EXPECT_NE(a, ParseAmc("2\na nan 1\n", "b.amc"));
}

}  // namespace
}  // namespace kinebase
