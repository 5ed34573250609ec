// Clips that begin where the take has no values.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinebase/library/cutting.h"
#include "library/counting_takes.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using testing::HasSubstr;
using testing::Not;

// What fills the gap is not measured, and the clip itself cannot tell.
TEST(CuttingAGap, IsSaidWhereAClipBeginsInIt) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "in" / "HDM_bd_01-01_01_120.amc";
  test::WriteCountingAmc(file, 9);
  test::WriteText(file.parent_path() / "HDM_bd.asf", test::kUpperAsf);
  AmcMotion take = ReadAmc(file);
  take.values[5 * take.column_count - 1] = std::nan("");  // The last one of frame 5.
  test::WriteText(file, FormatAmc(take));
  const auto cut = [&](int first, const std::string& clip) {
    const CutList list =
        ParseCutList(fmt::format("\"HDM_bd_01-01_01_120.amc\" {} 8 {}\n", first, clip), "cuts.txt");
    const CutReport report = CutClips(
        list, {.in = file.parent_path(), .out = folder.path() / "out", .type = ClipType::kAmc});
    EXPECT_EQ(report.clips.size(), 1);
    std::string notes;
    for (const auto& note : report.notes) notes += note.diagnostic.message + '\n';
    return notes;
  };
  EXPECT_THAT(cut(5, "HDM_bd_in_001_120"),
              HasSubstr("HDM_bd_in_001_120.amc begins in a gap: 1 values"));
  EXPECT_THAT(cut(6, "HDM_bd_after_001_120"), Not(HasSubstr("begins in a gap")));
  const AmcMotion clip = ReadAmc(folder.path() / "out" / "HDM_bd_in_001_120.amc");
  EXPECT_EQ(clip.values[clip.column_count - 1], take.values[4 * take.column_count - 1]);
}

}  // namespace
}  // namespace kinebase
