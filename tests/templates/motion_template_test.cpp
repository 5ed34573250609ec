#include "kinebase/templates/motion_template.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "support/files.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

using ::testing::HasSubstr;

MotionTemplate RandomTemplate(const FeatureSet& features) {
  Random random(11);
  MotionTemplate result;
  result.name = "wave";
  result.feature_set = features.name;
  result.feature_set_hash = features.hash;
  result.matrix = RandomMatrix(random, 25, features.feature_count());
  result.tau = 0.04;
  return result;
}

TEST(TemplateMatrix, TakesFeaturesWithWeightsOfOne) {
  const FeatureMatrix features{.rate_hz = 30, .feature_count = 3, .columns = {0b001, 0b110}};
  EXPECT_EQ(ToTemplateMatrix(features), MakeMatrix({{1, 0, 0}, {0, 1, 1}}));
  EXPECT_EQ(ToTemplateMatrix(features).total_weight(), 2);
}

TEST(Profiles, ReadBackWhatTheyAreCalled) {
  for (const Profile profile : {Profile::kBonn, Profile::kPaper}) {
    EXPECT_EQ(ParseProfile(ToString(profile)), profile);
  }
  EXPECT_EQ(ParseProfile("Bonn"), std::nullopt);
}

// The published exchange of rows, 1-based.
TEST(TemplateMirroring, ExchangesTheRowsOfLeftAndRight) {
  constexpr int kRows[] = {2,  1,  4,  3,  6,  5,  8,  7,  9,  10, 12, 11, 14,
                           13, 16, 15, 18, 17, 19, 21, 20, 22, 23, 24, 26, 25,
                           28, 27, 30, 29, 31, 32, 34, 33, 36, 35, 37, 38, 39};
  const FeatureSet features = LoadFeatureSet("bonn");
  const MotionTemplate original = RandomTemplate(features);
  const MotionTemplate mirrored = MirrorTemplate(original, features);
  for (int c = 0; c < original.matrix.column_count(); ++c) {
    for (int row = 0; row < 39; ++row) {
      EXPECT_EQ(mirrored.matrix.Column(c)[row], original.matrix.Column(c)[kRows[row] - 1]);
    }
  }
  EXPECT_EQ(mirrored.matrix.weights, original.matrix.weights);
}

TEST(TemplateMirroring, GivesTheTemplateBackWhenDoneTwice) {
  for (const char* name : {"bonn", "paper"}) {
    const FeatureSet features = LoadFeatureSet(name);
    const MotionTemplate original = RandomTemplate(features);
    EXPECT_EQ(MirrorTemplate(MirrorTemplate(original, features), features), original);
  }
}

TEST(FeatureSetCheck, NamesBothSetsWhenTheyDiffer) {
  const MotionTemplate made_with_bonn = RandomTemplate(LoadFeatureSet("bonn"));
  const FeatureSet paper = LoadFeatureSet("paper");
  EXPECT_NO_THROW(CheckFeatureSet(made_with_bonn, LoadFeatureSet("bonn")));
  const Error error = ErrorOf([&] { CheckFeatureSet(made_with_bonn, paper); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), HasSubstr("'bonn'"));
  EXPECT_THAT(error.what(), HasSubstr("'paper'"));
  EXPECT_EQ(ErrorOf([&] { (void)MirrorTemplate(made_with_bonn, paper); }).code(),
            ErrorCode::kMismatch);
}

}  // namespace
}  // namespace kinebase::test
