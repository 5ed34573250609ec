// What the arrays of a skeleton must hold.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/formats/npz.h"
#include "kinebase/motion/motion_file.h"
#include "motion/figure.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using testing::HasSubstr;

// What is said of a skeleton whose bones have these parents instead of their own.
std::string ErrorOfParent(std::size_t bone, std::int32_t parent) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "figure.npz";
  Recording recording{.path = "figure.amc"};
  recording.motion = test::SmoothMotion(test::FigureSkeleton(), 1, 3, 120);
  Diagnostics diagnostics;
  SaveRecording(recording, path, {}, diagnostics);
  NpzArchive archive = ReadNpz(path);
  const auto parents = std::ranges::find(archive.arrays, "parents", &NpzArray::name);
  std::get<std::vector<std::int32_t>>(parents->items).at(bone) = parent;
  test::WriteText(path, FormatNpz(archive));
  const Error error = test::ErrorOf([&] { (void)LoadRecording(path); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  return error.message();
}

TEST(NpzSkeleton, HasOneFirstBoneAndOthersBelowEarlierOnes) {
  EXPECT_THAT(ErrorOfParent(0, 1), HasSubstr("bone 0 has the parent 1"));
  EXPECT_THAT(ErrorOfParent(2, -1), HasSubstr("bone 2 has the parent -1"));
  EXPECT_THAT(ErrorOfParent(2, -2), HasSubstr("bone 2 has the parent -2"));
  EXPECT_THAT(ErrorOfParent(2, 2), HasSubstr("bone 2 has the parent 2"));
}

}  // namespace
}  // namespace kinebase
