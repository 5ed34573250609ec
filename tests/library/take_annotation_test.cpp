#include "kinebase/library/take_annotation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "kinebase/templates/quantized_template.h"
#include "library/two_sets_of_takes.h"

namespace kinebase {
namespace {

using test::TwoSetsOfTakes;
using testing::Contains;
using testing::Field;
using testing::SizeIs;

constexpr double kTau = 0.3;

class AnnotationWithTwoSets : public testing::Test {
 protected:
  [[nodiscard]] AnnotationQuery Query(const FeatureSet& features, int motion_class) const {
    AnnotationQuery query{.motion_template = sets_.Template(features, kTau),
                          .features = features,
                          .class_name = features.name};
    query.search = {
        .motion_class = motion_class, .quantized = Quantize(query.motion_template), .tau = kTau};
    return query;
  }

  TwoSetsOfTakes sets_;
  std::vector<AnnotationQuery> queries_ = {Query(sets_.bonn(), 0), Query(sets_.paper(), 1)};
};

// Each take's segments as the choice of what its files' features give, of the sets that it has.
TEST_F(AnnotationWithTwoSets, ChoosesAmongWhatCouldBeReadOfEachTake) {
  const std::vector<TakeFeatures> bonn = sets_.Read(sets_.bonn(), 0, 5);
  const std::vector<TakeFeatures> paper = sets_.Read(sets_.paper(), 0, 5);
  for (const std::int64_t memory_bytes : {std::int64_t{1}, kDefaultMemoryBytes}) {
    SCOPED_TRACE(memory_bytes);
    const AnnotatedTakes annotated =
        AnnotateTakes({sets_.library(), {}, memory_bytes}, queries_, {});
    ASSERT_THAT(annotated.takes, SizeIs(6));
    bool is_any_found_with_one_set = false;
    for (std::size_t i = 0; i < 6; ++i) {
      SCOPED_TRACE(i);
      EXPECT_EQ(annotated.takes[i].path, sets_.File(i));
      std::vector<AnnotationCandidate> candidates;
      if (i < 4) candidates = FindCandidates(queries_[0].search, TakeView(bonn[i]));
      if (i >= 2) {
        const auto more = FindCandidates(queries_[1].search, TakeView(paper[i]));
        candidates.insert(candidates.end(), more.begin(), more.end());
      }
      EXPECT_EQ(annotated.takes[i].segments, ChooseSegments(candidates));
      if (i >= 4) is_any_found_with_one_set |= !annotated.takes[i].segments.empty();
    }
    EXPECT_TRUE(is_any_found_with_one_set);
    EXPECT_THAT(annotated.failures, SizeIs(4));
    for (const std::size_t i : {0, 1, 4, 5}) {
      EXPECT_THAT(annotated.failures, Contains(Field(&TakeFailure::path, sets_.File(i))));
    }
  }
}

TEST_F(AnnotationWithTwoSets, TakesThresholdsFromWhatCouldBeReadOfTheBackground) {
  const TakeSource background(sets_.library(), {}, 1);
  const BackgroundThresholds found = FindThresholds({&background, 1}, queries_);
  EXPECT_THAT(found.failures, SizeIs(4));
  const auto expected = [&](const AnnotationQuery& query, std::size_t first) {
    const std::vector<TakeFeatures> takes = sets_.Read(query.features, first, first + 3);
    std::vector<RecordingStreams> recordings;
    recordings.reserve(takes.size());
    for (const TakeFeatures& take : takes) recordings.push_back({.features = take.features});
    return ThresholdFromBackground(query.motion_template, recordings);
  };
  EXPECT_EQ(found.tau.at(0), expected(queries_[0], 0));
  EXPECT_EQ(found.tau.at(1), expected(queries_[1], 2));
}

}  // namespace
}  // namespace kinebase
