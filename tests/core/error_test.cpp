#include "kinebase/core/error.h"

#include <gtest/gtest.h>

#include "kinebase/core/diagnostic.h"

namespace kinebase {
namespace {

TEST(Place, NamesWhatIsKnown) {
  EXPECT_EQ(Place{}.ToString(), "");
  EXPECT_EQ((Place{.line = 3}.ToString()), "");
  EXPECT_EQ((Place{"take.amc"}.ToString()), "take.amc");
  EXPECT_EQ((Place{"take.amc", 12}.ToString()), "take.amc:12");
  EXPECT_EQ((Place{.file = "take.c3d", .byte = 512}.ToString()), "take.c3d at byte 512");
  EXPECT_EQ((Place{.file = "take.c3d", .byte = 0}.ToString()), "take.c3d at byte 0");
}

TEST(Error, PutsThePlaceBeforeTheMessage) {
  const Error error(ErrorCode::kMalformedFile, "is odd", {"take.amc", 12});
  EXPECT_STREQ(error.what(), "take.amc:12: is odd");
  EXPECT_EQ(error.message(), "is odd");
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.place().line, 12);
}

TEST(Error, IsTheMessageAloneWithoutAPlace) {
  EXPECT_STREQ(Error(ErrorCode::kCancelled, "cancelled").what(), "cancelled");
}

TEST(Diagnostic, HasANameForItsSeverity) {
  EXPECT_EQ(ToString(Severity::kInfo), "info");
  EXPECT_EQ(ToString(Severity::kWarning), "warning");
}

}  // namespace
}  // namespace kinebase
