#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>

#include "formats/generators.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/amc.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::string_view kTake =
    "# made up\n:DEGREES\n8\nroot 1 2\nhand 3\n# after 8\n9\nroot 4 5\nhand 6\n"
    "12\nroot 7 8\nhand nan\n# after 12\n13\nroot 10 11\nhand 12\n# after 13\n";

TEST(CutAmc, KeepsValuesHeaderAndRemarksAndCountsFromOne) {
  const AmcMotion clip = CutAmc(ParseAmc(kTake, "take.amc"), 1, 2);
  EXPECT_EQ(FormatAmc(clip),
            "# made up\n:DEGREES\n1\nroot 4 5\nhand 6\n4\nroot 7 8\nhand nan\n# after 12\n");
  EXPECT_EQ(clip.angle_unit, AmcAngleUnit::kDegrees);
}

TEST(CutAmc, TakesOneFrameAndAll) {
  const AmcMotion take = ParseAmc(kTake, "take.amc");
  EXPECT_THAT(CutAmc(take, 3, 3).values, ElementsAre(10, 11, 12));
  AmcMotion all = CutAmc(take, 0, 3);
  EXPECT_THAT(all.frame_numbers, ElementsAre(1, 2, 5, 6));
  all.frame_numbers = take.frame_numbers;
  EXPECT_EQ(all, take);
}

// The gap at frame 12 is filled from frame 9 when the whole is read; that at the start of the other
// take from the first frame that has the value.
TEST(CutAmc, FillsTheFirstFrameAsReadersOfTheWholeDo) {
  EXPECT_THAT(CutAmc(ParseAmc(kTake, "take.amc"), 2, 3).values, ElementsAre(7, 8, 6, 10, 11, 12));
  const AmcMotion late = ParseAmc(":DEGREES\n1\nhand nan\n2\nhand nan\n3\nhand 5\n", "late.amc");
  EXPECT_THAT(CutAmc(late, 1, 1).values, ElementsAre(5));
  const AmcMotion never = ParseAmc(":DEGREES\n1\nhand nan\n2\nhand nan\n", "never.amc");
  EXPECT_THAT(CutAmc(never, 1, 1).values, ElementsAre(testing::IsNan()));
}

TEST(CutAmc, RefusesARangeThatIsEmptyOrLeavesTheMotion) {
  const AmcMotion take = ParseAmc(kTake, "take.amc");
  for (const auto& [first, last] : {std::pair{-1, 2}, {2, 1}, {0, 4}, {4, 4}}) {
    const Error error = test::ErrorOf([&] { (void)CutAmc(take, first, last); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr("of 4"));
  }
}

RC_GTEST_PROP(CutAmc, OfAClipIsACutOfTheTake, ()) {
  const AmcMotion take = test::AnyMotion();
  const auto frames = static_cast<std::int64_t>(take.frame_count());
  const auto first = *rc::gen::inRange<std::int64_t>(0, frames);
  const auto last = *rc::gen::inRange<std::int64_t>(first, frames);
  const AmcMotion clip = CutAmc(take, first, last);
  const auto inner = *rc::gen::inRange<std::int64_t>(0, last - first + 1);
  RC_ASSERT(CutAmc(clip, inner, last - first) == CutAmc(take, first + inner, last));
  RC_ASSERT(ParseAmc(FormatAmc(clip), "clip.amc") == clip);
}

// A clip of the database with the range that its list gives, 1-based and inclusive.
struct ListedClip {
  std::filesystem::path file;
  std::int64_t first = 0;
  std::int64_t last = 0;
};

std::map<std::string, std::vector<ListedClip>> ClipsByTakeAndClass() {
  const std::filesystem::path folder = test::TestData("data/hdm05");
  const CsvTable list = test::ReadCsv(folder / "clips.csv");
  std::map<std::string, std::vector<ListedClip>> clips;
  for (const auto& row : list.rows) {
    const std::string& class_name = row[list.Column("class")];
    clips[row[list.Column("source_take")] + ' ' + class_name].push_back(
        {folder / "cut_amc" / class_name / row[list.Column("file")],
         std::stoll(row[list.Column("take_first_frame")]),
         std::stoll(row[list.Column("take_last_frame")])});
  }
  for (auto& [name, each] : clips) std::ranges::sort(each, {}, &ListedClip::first);
  return clips;
}

// Adds the frames of `next` from `skip` on.
void Append(AmcMotion& take, const AmcMotion& next, std::size_t skip) {
  for (std::size_t frame = skip; frame < next.frame_count(); ++frame) {
    take.frame_numbers.push_back(take.frame_numbers.back() + 1);
    const auto values = next.Frame(frame);
    take.values.insert(take.values.end(), values.begin(), values.end());
  }
}

// Squats that follow each other share the frame where one ends and the next begins. Put together
// they are a piece of the take, and that piece cut as the list says has to be the database's own
// clips: same frames, same values, same frame numbers.
TEST(CutAmc, MakesTheClipsOfHdm05AsTheirListSays) {
  KINEBASE_NEEDS_TEST_DATA();
  int clips_made = 0;
  for (const auto& [name, clips] : ClipsByTakeAndClass()) {
    SCOPED_TRACE(name);
    for (std::size_t begin = 0, end = 0; begin < clips.size(); begin = end) {
      AmcMotion piece = ReadAmc(clips[begin].file);
      for (end = begin + 1; end < clips.size() && clips[end].first <= clips[end - 1].last; ++end) {
        const auto shared = static_cast<std::size_t>(clips[end - 1].last - clips[end].first + 1);
        Append(piece, ReadAmc(clips[end].file), shared);
      }
      if (end == begin + 1) continue;
      const std::int64_t offset = clips[begin].first;
      ASSERT_EQ(piece.frame_count(), clips[end - 1].last - offset + 1);
      for (std::size_t i = begin; i < end; ++i) {
        const AmcMotion clip = CutAmc(piece, clips[i].first - offset, clips[i].last - offset);
        EXPECT_EQ(clip, ReadAmc(clips[i].file)) << clips[i].file;
        ++clips_made;
      }
    }
  }
  EXPECT_GT(clips_made, 60);
}

}  // namespace
}  // namespace kinebase
