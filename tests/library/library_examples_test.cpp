#include "kinebase/library/library_examples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <vector>

#include "kinebase/library/library_labels.h"
#include "library/made_up_takes.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using test::ErrorOf;
using test::ExecuteSql;
using test::MadeUpTakes;
using testing::HasSubstr;
using testing::SizeIs;

class LibraryExamples : public testing::Test {
 protected:
  LibraryExamples() {
    ImportOptions options = MadeUpTakes::Options();
    options.with_poses = true;
    takes_.Import(options);
  }

  [[nodiscard]] ExampleRequest Request(std::int64_t memory_bytes) const {
    return {.features = &features_, .memory_bytes = memory_bytes};
  }

  FeatureSet features_ = LoadFeatureSet("bonn");
  MadeUpTakes takes_{8};
};

TEST_F(LibraryExamples, AreTheTakesThatHaveAClass) {
  const TakeLibrary library(takes_.library());
  const LabelledBatch batch = LoadLabelledTakes(library, {.actors = {"xx"}}, Request(1 << 30));
  ASSERT_THAT(batch.clips, SizeIs(8));
  EXPECT_EQ(batch.clips[0].class_name, "wave");
  EXPECT_EQ(batch.clips[0].actor, "xx");
  EXPECT_EQ(batch.clips[0].take.poses.column_count(), batch.clips[0].take.features.column_count());
}

TEST_F(LibraryExamples, ThatNeedMoreMemoryAreRefusedWithTheOption) {
  const TakeLibrary library(takes_.library());
  const Error error = ErrorOf([&] { (void)LoadLabelledTakes(library, {}, Request(1000)); });
  EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(error.what(), HasSubstr("raise --memory"));
}

TEST_F(LibraryExamples, AreStretchesWithALabel) {
  const fs::path file = fs::canonical(takes_.files()[5]);
  ChangeLabels(takes_.library(), {.names = {file}},
               {.add = {"jump"}, .first_frame = 41, .last_frame = 120});
  ChangeLabels(takes_.library(), {.names = {takes_.files()[1]}}, {.add = {"jump"}});
  const TakeLibrary library(takes_.library());
  const LabelledBatch batch = LoadLabelledStretches(library, "jump", {}, Request(1 << 30));
  ASSERT_THAT(batch.clips, SizeIs(2));
  const TakeFeatures whole = LoadTakeFeatures({file}, features_, 30, {}, {.poses = true});
  const TakeFeatures& cut = batch.clips[1].take;
  EXPECT_EQ(batch.clips[1].class_name, "jump");
  EXPECT_EQ(cut.stretch.first_frame, 41);
  EXPECT_EQ(cut.stretch.last_frame, 120);
  // 120 Hz, four frames a column: frame 41 is column 10, frame 117 is column 29.
  ASSERT_EQ(cut.features.column_count(), 20);
  ASSERT_EQ(cut.poses.column_count(), 20);
  for (int column = 0; column < 20; ++column) {
    const auto i = static_cast<std::size_t>(column);
    EXPECT_EQ(cut.features.columns[i], whole.features.columns[i + 10]);
    for (std::size_t value = 0; value < kPoseValues; ++value) {
      ASSERT_NEAR(cut.poses.Column(column)[value], whole.poses.Column(column + 10)[value], 1e-3);
    }
  }
  const TakeFeatures all = LoadTakeFeatures({takes_.files()[1]}, features_, 30, {});
  EXPECT_EQ(batch.clips[0].take.features.columns, all.features.columns);
  EXPECT_EQ(
      ErrorOf([&] { (void)LoadLabelledStretches(library, "hop", {}, Request(1 << 30)); }).code(),
      ErrorCode::kNotFound);
}

// A row that lost its label may have been one of them.
TEST_F(LibraryExamples, NameDamagedRowsWhateverTheirLabels) {
  ChangeLabels(takes_.library(), {.names = {takes_.files()[1], takes_.files()[5]}},
               {.add = {"jump"}});
  ExecuteSql(takes_.library(), "UPDATE labels SET label = 'jumq' WHERE take = 2");
  const LabelledBatch batch =
      LoadLabelledStretches(TakeLibrary(takes_.library()), "jump", {}, Request(1 << 30));
  EXPECT_THAT(batch.clips, SizeIs(1));
  ASSERT_THAT(batch.failures, SizeIs(1));
  EXPECT_EQ(batch.failures[0].path, fs::canonical(takes_.files()[1]));
}

TEST_F(LibraryExamples, OfABackgroundAreAsManyAsFitAndAlwaysTheSame) {
  const TakeLibrary library(takes_.library());
  const BackgroundTakes all = LoadBackgroundTakes(library, {}, Request(1 << 30));
  EXPECT_EQ(all.chosen, 8U);
  const std::int64_t half = ExampleBytes(all.batch.takes) / 2;
  const BackgroundTakes some = LoadBackgroundTakes(library, {}, Request(half));
  EXPECT_EQ(some.available, 8U);
  EXPECT_LT(some.chosen, 8U);
  EXPECT_GE(some.chosen, 3U);
  EXPECT_LE(ExampleBytes(some.batch.takes), half);
  const BackgroundTakes again = LoadBackgroundTakes(library, {}, Request(half));
  ASSERT_EQ(again.batch.takes.size(), some.batch.takes.size());
  for (std::size_t i = 0; i < some.batch.takes.size(); ++i) {
    EXPECT_EQ(again.batch.takes[i].path, some.batch.takes[i].path);
  }
  const std::set<fs::path> without = {fs::canonical(takes_.files()[3])};
  EXPECT_EQ(LoadBackgroundTakes(library, without, Request(1 << 30)).chosen, 7U);
}

}  // namespace
}  // namespace kinebase
