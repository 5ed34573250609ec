#include "kinebase/library/hit_explanation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinebase/core/error.h"
#include "kinebase/library/class_learning.h"
#include "library/one_feature_takes.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using testing::HasSubstr;

using test::OneFeatureTemplate;

TakeFeatures MakeTake() { return test::OneFeatureTake(50, {{10, 14}, {30, 33}}); }

TEST(HitExplanation, IsThatOfTheBestHitUnlessOneIsNamed) {
  const HitExplanation best = ExplainHit(OneFeatureTemplate(), MakeTake());
  // Columns 9 to 15 are frames 37 to 64.
  EXPECT_EQ(best.hit.first_frame, 37);
  EXPECT_EQ(best.hit.last_frame, 64);
  EXPECT_EQ(best.hit.cost, 0);
  ASSERT_EQ(best.cells.size(), 7);
  for (const ExplainedCell& cell : best.cells) EXPECT_EQ(cell.disagreed, 0);
}

TEST(HitExplanation, IsThatOfAnyHitOfASearch) {
  const std::vector<TakeFeatures> takes = {MakeTake()};
  const std::vector<TakeHit> hits = SearchTakes(OneFeatureTemplate(), takes, {.tau = 1});
  ASSERT_GT(hits.size(), 1);
  for (const TakeHit& hit : hits) {
    EXPECT_EQ(ExplainHit(OneFeatureTemplate(), takes[0], hit.last_frame).hit, hit);
  }
  // Any frame of a column stands for it.
  EXPECT_EQ(ExplainHit(OneFeatureTemplate(), takes[0], 62).hit.last_frame, 64);
  EXPECT_EQ(ExplainHit(OneFeatureTemplate(), takes[0], 199).hit.last_frame, 199);
}

TEST(HitExplanation, NeedsAPathThere) {
  const auto error_of = [](std::int64_t frame) {
    return test::ErrorOf([&] { (void)ExplainHit(OneFeatureTemplate(), MakeTake(), frame); });
  };
  EXPECT_EQ(error_of(8).code(), ErrorCode::kNotFound);
  EXPECT_THAT(error_of(8).what(), HasSubstr("nothing that ends at frame 8"));
  EXPECT_EQ(error_of(0).code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(error_of(200).what(), HasSubstr("take.amc: has frames 1 to 199, not 200"));
  TakeFeatures brief = MakeTake();
  brief.features.columns.resize(2);
  EXPECT_THAT(test::ErrorOf([&] { (void)ExplainHit(OneFeatureTemplate(), brief); }).what(),
              HasSubstr("too short"));
}

// The template of one feature with its weights, and with the first value of the pose at 1.
MotionTemplate Contrasting(const std::string& name) {
  MotionTemplate result{.name = name, .feature_set = "one", .feature_set_hash = 1};
  result.matrix = {.rate_hz = 30,
                   .feature_count = 1,
                   .values = {0, 1, 1, 1, 1, 1, 0},
                   .weights = std::vector<double>(7, 1)};
  Contrast contrast{.entry_weights = std::vector<double>(7, 1)};
  contrast.places.mean.resize(std::size_t{7} * kPoseValues);
  contrast.places.weight.resize(std::size_t{7} * kPoseValues);
  contrast.places.spread.assign(kPoseValues, 1);
  for (std::size_t column = 0; column < 7; ++column) {
    contrast.places.mean[column * kPoseValues] = 1;
    contrast.places.weight[column * kPoseValues] = 1;
  }
  result.contrast = std::move(contrast);
  result.calibration = Calibration{.slope = 10, .offset = -1};
  return result;
}

// The first value of its pose is 1 in the first half, then 0.
TakeFeatures TakeWithPoses() {
  TakeFeatures take = test::OneFeatureTake(50, {{10, 14}, {30, 34}});
  take.poses.rate_hz = 30;
  take.poses.values.resize(std::size_t{50} * kPoseValues);
  for (std::size_t column = 0; column < 25; ++column) take.poses.values[column * kPoseValues] = 1;
  return take;
}

TEST(RankedHitExplanation, AddsUpToWhatASearchFinds) {
  const std::vector<MotionTemplate> templates = {Contrasting("a"), Contrasting("b")};
  const std::vector<TakeFeatures> takes = {TakeWithPoses()};
  const std::vector<TakeHit> hits = RankTakes(templates, takes, {.tau = 9}).front();
  ASSERT_GT(hits.size(), 1);
  for (const TakeHit& hit : hits) {
    const HitExplanation explained = ExplainRankedHit(templates, takes[0], hit.last_frame);
    EXPECT_EQ(explained.hit, hit);
    double features = 0;
    double poses = 0;
    for (const ExplainedCell& cell : explained.cells) features += cell.cost;
    for (const ExplainedPlace& place : explained.places) poses += place.cost;
    EXPECT_NEAR(features, explained.matching, 1e-12);
    EXPECT_NEAR(poses, explained.places_cost, 1e-12);
    EXPECT_NEAR(features + poses, hit.cost, 1e-12);
    EXPECT_EQ(explained.rival.has_value(), hit.score > hit.cost);
    if (!explained.rival) continue;
    EXPECT_EQ(explained.rival->motion_template, 1);
    EXPECT_NEAR(hit.score - hit.cost, 0.5 * (0.5 - explained.rival->hit.cost), 1e-12);
  }
  // The second half has the wrong poses: each cell one off, of a variance of 1, by a tenth.
  EXPECT_NEAR(ExplainRankedHit(templates, takes[0], 144).places_cost, 0.1, 1e-12);
  EXPECT_EQ(ExplainRankedHit(templates, takes[0], 144).lookalikes_cost, 0);
  // Look-alikes that do just that.
  std::vector<MotionTemplate> knowing = templates;
  knowing[0].contrast->places.lookalikes.resize(std::size_t{7} * kPoseValues);
  EXPECT_NEAR(ExplainRankedHit(knowing, takes[0], 144).places_cost, 0.1, 1e-12);
  EXPECT_NEAR(ExplainRankedHit(knowing, takes[0], 144).lookalikes_cost, 0.1, 1e-12);
  EXPECT_EQ(ExplainRankedHit(templates, takes[0]).hit, hits[0]);
  EXPECT_TRUE(ExplainRankedHit(templates, takes[0]).rival);
  EXPECT_FALSE(ExplainRankedHit(std::span(templates).first(1), takes[0]).rival);
}

TEST(RankedHitExplanation, IsThatOfTheBestBelowTheThresholdIfThereIsOne) {
  std::vector<MotionTemplate> templates = {Contrasting("a")};
  const std::vector<TakeFeatures> takes = {TakeWithPoses()};
  templates[0].tau = 0.01;
  EXPECT_EQ(ExplainRankedHit(templates, takes[0]).hit, RankTakes(templates, takes)[0][0]);
  TakeFeatures wrong_poses = takes[0];
  for (float& value : wrong_poses.poses.values) value = 0;
  EXPECT_TRUE(RankTakes(templates, std::span(&wrong_poses, 1))[0].empty());
  EXPECT_NEAR(ExplainRankedHit(templates, wrong_poses).hit.cost, 0.1, 1e-12);
}

TEST(RankedHitExplanation, TakesTemplatesOfOneKindOnly) {
  const auto error_of = [](const std::vector<MotionTemplate>& templates) {
    return test::ErrorOf([&] { (void)ExplainRankedHit(templates, TakeWithPoses()); });
  };
  EXPECT_EQ(error_of({}).code(), ErrorCode::kInvalidArgument);
  MotionTemplate plain = Contrasting("plain");
  plain.contrast.reset();
  EXPECT_THAT(error_of({Contrasting("a"), plain}).what(), HasSubstr("'plain' is a plain one"));
  MotionTemplate other = Contrasting("other");
  other.feature_set_hash = 2;
  EXPECT_EQ(error_of({Contrasting("a"), other}).code(), ErrorCode::kMismatch);
  TakeFeatures brief = TakeWithPoses();
  brief.features.columns.resize(2);
  brief.poses.values.resize(std::size_t{2} * kPoseValues);
  EXPECT_THAT(
      test::ErrorOf([&] { (void)ExplainRankedHit(std::vector{Contrasting("a")}, brief); }).what(),
      HasSubstr("too short"));
}

// Templates of two actors' clips in clips of a third and in a take that shows other motion.
TEST(RankedHitExplanation, AddsUpInRealRecordings) {
  KINEBASE_NEEDS_TEST_DATA();
  const FeatureSet features = LoadFeatureSet("bonn");
  const LabelledBatch batch = LoadLabelledClips(
      ReadClipList(test::TestData("data/hdm05/clips.csv"), {}), features, 30, {}, 0, {});
  std::vector<const LabelledClip*> learned_from;
  std::vector<TakeFeatures> takes = {LoadTakeFeatures(
      {.file = test::TestData("data/cmu/86/86_01.amc")}, features, 30, {}, {.poses = true})};
  for (const LabelledClip& clip : batch.clips) {
    if (clip.actor != "bd") {
      learned_from.push_back(&clip);
    } else if (takes.size() < 5) {
      takes.push_back(clip.take);
    }
  }
  std::vector<MotionTemplate> templates = LearnClasses(learned_from, features);
  for (std::size_t i = 0; i < templates.size(); ++i) {
    const std::vector<TakeHit> hits = RankTakes(templates, takes, {.tau = 9, .most_hits = 5})[0];
    ASSERT_FALSE(hits.empty());
    for (const TakeHit& hit : hits) {
      const HitExplanation explained = ExplainRankedHit(templates, takes[hit.take], hit.last_frame);
      EXPECT_EQ(explained.hit.first_frame, hit.first_frame);
      EXPECT_EQ(explained.hit.cost, hit.cost);
      EXPECT_EQ(explained.hit.score, hit.score);
      double sum = 0;
      for (const ExplainedCell& cell : explained.cells) sum += cell.cost;
      for (const ExplainedPlace& place : explained.places) sum += place.cost;
      EXPECT_NEAR(sum + explained.lookalikes_cost, hit.cost, 1e-12);
    }
    std::ranges::rotate(templates, templates.begin() + 1);  // Each is explained once.
  }
}

}  // namespace
}  // namespace kinebase
