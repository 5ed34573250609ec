#include "kinebase/library/take_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "library/made_up_takes.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using test::ErrorOf;
using test::MadeUpTakes;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

class StoredTakes : public testing::Test {
 protected:
  StoredTakes() {
    ImportOptions options = MadeUpTakes::Options();
    options.takes_per_batch = 2;
    options.with_poses = true;
    takes_.Import(options);
    for (const fs::path& file : takes_.files()) {
      expected_.push_back(
          LoadTakeFeatures({fs::canonical(file)}, features_, 30, {}, {.poses = true}));
    }
  }

  // Memory that so many columns without poses may use.
  static std::int64_t MemoryFor(std::int64_t columns) { return columns * 4 * 64; }

  FeatureSet features_ = LoadFeatureSet("bonn");
  MadeUpTakes takes_{6};  // 10, 18, 25, 33, 40 and 48 columns.
  std::vector<TakeFeatures> expected_;
};

TEST_F(StoredTakes, AreVisitedInOrderAndNoMoreAtATimeThanFit) {
  for (const std::int64_t columns : {1, 50, 100, 100'000}) {
    SCOPED_TRACE(columns);
    const TakeSource source(takes_.library(), {}, MemoryFor(columns));
    std::vector<fs::path> visited;
    std::vector<std::size_t> sizes;
    const auto failures = source.Visit({.features = &features_}, [&](const TakesAtHand& at_hand) {
      sizes.push_back(at_hand.takes.size());
      EXPECT_TRUE(at_hand.takes.size() == 1 || at_hand.columns <= columns);
      std::size_t i = 0;
      for (const TakeView& take : at_hand.takes) {
        const TakeFeatures& expected = expected_.at(visited.size());
        EXPECT_EQ(take.frame_count, expected.frame_count);
        EXPECT_TRUE(std::ranges::equal(take.features.columns, expected.features.columns));
        EXPECT_EQ(take.name->class_name, "wave");
        EXPECT_EQ(at_hand.places.at(i++), visited.size());
        visited.push_back(*take.path);
      }
    });
    EXPECT_THAT(failures, IsEmpty());
    EXPECT_THAT(visited, SizeIs(6));
    EXPECT_TRUE(columns != 1 || sizes.size() == 6);
    EXPECT_TRUE(columns != 100'000 || sizes.size() == 1);
  }
}

TEST_F(StoredTakes, ComeWithPosesWhereTheseAreAskedFor) {
  const TakeSource source(takes_.library(), {});
  (void)source.Visit({.features = &features_, .with_poses = true}, [&](const TakesAtHand& at_hand) {
    ASSERT_THAT(at_hand.takes, SizeIs(6));
    for (std::size_t i = 0; i < 6; ++i) {
      const PoseStream& poses = *at_hand.takes[i].poses;
      ASSERT_EQ(poses.values.size(), expected_[i].poses.values.size());
      for (std::size_t value = 0; value < poses.values.size(); ++value) {
        ASSERT_NEAR(poses.values[value], expected_[i].poses.values[value], 1e-3);
      }
    }
  });
}

TEST_F(StoredTakes, ThatAreDamagedAreFailuresAmongTheOthers) {
  test::Spoil(takes_.Segment(2), 64 + 2 * 64 + 3);  // The first word of the third take.
  const TakeSource source(takes_.library(), {}, MemoryFor(30));
  std::vector<std::size_t> visited;
  const auto failures = source.Visit({.features = &features_}, [&](const TakesAtHand& at_hand) {
    EXPECT_EQ(at_hand.places.size(), at_hand.takes.size());
    visited.insert(visited.end(), at_hand.places.begin(), at_hand.places.end());
  });
  EXPECT_THAT(visited, ElementsAre(0, 1, 3, 4, 5));
  ASSERT_THAT(failures, SizeIs(1));
  EXPECT_EQ(failures.front().path, expected_[2].path);
}

// Some feature that takes show and others do not is a keyframe.
TEST_F(StoredTakes, ArePreselectedAsTheFilesAre) {
  for (int feature = 0; feature < features_.feature_count(); ++feature) {
    const std::uint64_t bit = std::uint64_t{1} << feature;
    const std::vector<Keyframe> keyframes = {{.column = 2, .tested = bit, .ones = bit}};
    const TakeRequest request{
        .features = &features_, .keyframes = {{keyframes, 5}}, .only_preselected = true};
    std::vector<Stretch> of_files;
    std::vector<TakeStretch> stretches;
    stretches.reserve(expected_.size());
    for (const TakeFeatures& take : expected_) stretches.push_back(take.stretch);
    (void)TakeSource(stretches, {}).Visit(request, [&](const TakesAtHand& at_hand) {
      of_files = at_hand.stretches.front();
    });
    std::vector<Stretch> of_library;
    std::int64_t columns = 0;
    (void)TakeSource(takes_.library(), {}, MemoryFor(50))
        .Visit(request, [&](const TakesAtHand& at_hand) {
          columns += at_hand.columns;
          std::vector<int> shown(at_hand.takes.size(), 0);
          for (Stretch stretch : at_hand.stretches.front()) {
            shown[static_cast<std::size_t>(stretch.recording)] = 1;
            stretch.recording =
                static_cast<int>(at_hand.places[static_cast<std::size_t>(stretch.recording)]);
            of_library.push_back(stretch);
          }
          for (std::size_t i = 0; i < shown.size(); ++i) {
            // Words that nobody will look at are not there.
            EXPECT_EQ(at_hand.takes[i].features.columns.empty(), shown[i] == 0);
          }
        });
    EXPECT_EQ(of_library, of_files);
    std::int64_t all = 0;
    for (const TakeFeatures& take : expected_) all += take.features.column_count();
    EXPECT_EQ(columns, all);
  }
}

TEST_F(StoredTakes, CanBeLeftBeforeTheEnd) {
  std::size_t visited = 0;
  const TakeRequest request{.features = &features_,
                            .progress = [](std::string_view, std::size_t done, std::size_t total) {
                              EXPECT_EQ(total, 6U);
                              return done < 2;
                            }};
  const Error error = ErrorOf([&] {
    (void)TakeSource(takes_.library(), {}, 1).Visit(request, [&](const TakesAtHand& at_hand) {
      visited += at_hand.takes.size();
    });
  });
  EXPECT_EQ(error.code(), ErrorCode::kCancelled);
  EXPECT_EQ(visited, 2U);
}

TEST(Import, MakesSmallerBatchesWhereMemoryIsShort) {
  const MadeUpTakes takes;
  ImportOptions options = MadeUpTakes::Options();
  options.memory_bytes = 1;
  options.threads = 4;
  EXPECT_EQ(takes.Import(options).added, 3);
  EXPECT_THAT(TakeLibrary(takes.library()).segments(), SizeIs(3));
}

TEST(SourcesIn, ArePathsThatAreLibrariesAndTheFilesOfTheOthers) {
  const MadeUpTakes takes;
  takes.Import();
  const FeatureSet features = LoadFeatureSet("bonn");
  std::vector<std::size_t> sizes;
  for (const TakeSource& source : SourcesIn(std::vector{takes.library(), takes.folder()}, {})) {
    (void)source.Visit({.features = &features},
                       [&](const TakesAtHand& at_hand) { sizes.push_back(at_hand.takes.size()); });
  }
  EXPECT_THAT(sizes, ElementsAre(3, 3));
  EXPECT_TRUE(IsLibrary(takes.library()));
  EXPECT_FALSE(IsLibrary(takes.folder()));
}

}  // namespace
}  // namespace kinebase
