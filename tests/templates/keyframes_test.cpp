#include "kinebase/templates/keyframes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "kinebase/core/error.h"
#include "support/files.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Features 1 and 2 are "arms", 3 to 5 "legs"; nothing is measured here.
FeatureSet ArmsAndLegs() {
  FeatureSet features{.name = "arms and legs", .hash = 7};
  for (const char* group : {"arms", "arms", "legs", "legs", "legs"}) {
    features.features.push_back({.group = group});
  }
  const int mirror[] = {1, 0, 3, 2, 4};
  for (std::size_t row = 0; row < 5; ++row) features.features[row].mirror = mirror[row];
  return features;
}

MotionTemplate TemplateOf(const std::vector<std::vector<double>>& columns) {
  MotionTemplate result{.name = "waving", .feature_set = "arms and legs", .feature_set_hash = 7};
  result.matrix = MakeMatrix(columns);
  return result;
}

// All free; then what `set` does.
MotionTemplate FreeTemplate(int columns) {
  return TemplateOf(std::vector(static_cast<std::size_t>(columns), std::vector<double>(5, 0.5)));
}

void Set(MotionTemplate& motion_template, int first, int last, int feature, double value) {
  for (int column = first; column <= last; ++column) {
    motion_template.matrix.values[static_cast<std::size_t>(column * 5 + feature)] = value;
  }
}

// Both arms for columns 20 to 24: entries count in 21 to 23, whose scores are 2 each; the first is
// taken and the others are the falling (or level) flank of the same peak.
TEST(Keyframes, AreChosenWhereThreeColumnsAgree) {
  MotionTemplate waving = FreeTemplate(50);
  for (const int arm : {0, 1}) Set(waving, 20, 24, arm, 1);
  EXPECT_THAT(ChooseKeyframes(waving, ArmsAndLegs()),
              ElementsAre(Keyframe{.column = 21, .tested = 0b11, .ones = 0b11}));
  Set(waving, 22, 22, 0, 0.5);  // Now feature 1 counts nowhere, feature 2 alone gives a score of 1.
  EXPECT_THAT(ChooseKeyframes(waving, ArmsAndLegs()),
              ElementsAre(Keyframe{.column = 21, .tested = 0b10, .ones = 0b10}));
  Set(waving, 22, 22, 1, 0);  // Consistent, but not the same as before and after.
  EXPECT_THAT(ChooseKeyframes(waving, ArmsAndLegs()), IsEmpty());
}

// Zeros count 1.2: two of three legs give 0.8, which is too little; with a third one 1.2.
TEST(Keyframes, NeedAScoreOfNineTenths) {
  MotionTemplate standing = FreeTemplate(50);
  Set(standing, 20, 22, 2, 0);
  Set(standing, 20, 22, 3, 0.1);
  EXPECT_THAT(ChooseKeyframes(standing, ArmsAndLegs()), IsEmpty());
  Set(standing, 20, 22, 4, 0);
  EXPECT_THAT(ChooseKeyframes(standing, ArmsAndLegs()),
              ElementsAre(Keyframe{.column = 21, .tested = 0b11100, .ones = 0}));
}

// Legs 2 in column 30, arms 1 in 24 and 38: 24 is 6 away, and both are free to be taken.
TEST(Keyframes, AreTakenBestFirstAndKeepTheirDistance) {
  MotionTemplate jumping = FreeTemplate(60);
  for (const int leg : {2, 3, 4}) Set(jumping, 29, 31, leg, 1);
  Set(jumping, 23, 25, 0, 1);
  Set(jumping, 37, 39, 1, 1);
  const Keyframe legs{.column = 30, .tested = 0b11100, .ones = 0b11100};
  const Keyframe first_arm{.column = 24, .tested = 0b01, .ones = 0b01};
  const Keyframe second_arm{.column = 38, .tested = 0b10, .ones = 0b10};
  EXPECT_THAT(ChooseKeyframes(jumping, ArmsAndLegs(), {.most = 1}), ElementsAre(legs));
  EXPECT_THAT(ChooseKeyframes(jumping, ArmsAndLegs(), {.most = 2}), ElementsAre(first_arm, legs));
  EXPECT_THAT(ChooseKeyframes(jumping, ArmsAndLegs(), {.most = 9}),
              ElementsAre(first_arm, legs, second_arm));
  Set(jumping, 23, 25, 0, 0.5);
  Set(jumping, 24, 26, 0, 1);  // Column 25 is within 5 of the legs' keyframe.
  EXPECT_THAT(ChooseKeyframes(jumping, ArmsAndLegs(), {.most = 9}), ElementsAre(legs, second_arm));
}

// Half a Hann window over ten columns of fifty: column 4 keeps (1 − cos(0.45 π)) / 2 = 0.42 of its
// score, 8 keeps 0.94.
TEST(Keyframes, AreFadedAtTheBordersOfTheTemplate) {
  MotionTemplate starting = FreeTemplate(50);
  for (const int arm : {0, 1}) Set(starting, 3, 5, arm, 1);
  EXPECT_THAT(ChooseKeyframes(starting, ArmsAndLegs()), IsEmpty());
  MotionTemplate later = FreeTemplate(50);
  for (const int arm : {0, 1}) Set(later, 7, 9, arm, 1);
  EXPECT_THAT(ChooseKeyframes(later, ArmsAndLegs()),
              ElementsAre(Keyframe{.column = 8, .tested = 0b11, .ones = 0b11}));
}

TEST(Keyframes, AllowMissesButNeverAsManyAsTheyTest) {
  MotionTemplate jumping = FreeTemplate(60);
  for (const int leg : {2, 3, 4}) Set(jumping, 29, 31, leg, 1);
  Set(jumping, 40, 42, 0, 1);
  const std::vector<Keyframe> keyframes =
      ChooseKeyframes(jumping, ArmsAndLegs(), {.most = 2, .misses = 2});
  ASSERT_EQ(keyframes.size(), 2U);
  EXPECT_EQ(keyframes[0].misses, 2);
  EXPECT_EQ(keyframes[1].misses, 0);
}

// By the definition, entry by entry.
RC_GTEST_PROP(Keyframes, HaveEnoughConsistentEntriesAndKeepApart, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  MotionTemplate some = TemplateOf({std::vector<double>(5)});
  some.matrix = RandomMatrix(random, 3 + random.Below(80), 5);
  const FeatureSet features = ArmsAndLegs();
  const int most = 1 + random.Below(6);
  const std::vector<Keyframe> keyframes = ChooseKeyframes(some, features, {.most = most});
  RC_ASSERT(std::ssize(keyframes) <= most);
  RC_ASSERT(ProblemOfKeyframes(keyframes, some.matrix.column_count(), 5).empty());
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const int k = keyframes[i].column;
    if (i > 0) RC_ASSERT(k - keyframes[i - 1].column > 5);
    double score = 0;
    const bool is_arms = (keyframes[i].tested & 0b11U) != 0;
    for (int row = is_arms ? 0 : 2; row < (is_arms ? 2 : 5); ++row) {
      const auto state = [&](int column) {
        const double value = some.matrix.Column(column)[static_cast<std::size_t>(row)];
        return value <= 0.1 ? 0 : value >= 0.9 ? 1 : -1;
      };
      const bool counts = state(k) >= 0 && state(k - 1) == state(k) && state(k + 1) == state(k);
      RC_ASSERT(counts == (((keyframes[i].tested >> row) & 1U) != 0));
      if (!counts) continue;
      RC_ASSERT((state(k) == 1) == (((keyframes[i].ones >> row) & 1U) != 0));
      score += state(k) == 1 ? 2 : 1.2;
    }
    RC_ASSERT(score / (is_arms ? 2 : 3) >= 0.9);
  }
}

TEST(Keyframes, ChosenByHandTestWhatIsConsistentInTheirColumn) {
  MotionTemplate waving = FreeTemplate(10);
  Set(waving, 9, 9, 0, 1);
  Set(waving, 9, 9, 3, 0);
  EXPECT_EQ(MakeKeyframe(waving, 9, 0b01111, 1),
            (Keyframe{.column = 9, .tested = 0b01001, .ones = 0b00001, .misses = 1}));
  const auto message = [&](int column, std::uint64_t tested, int misses) {
    const Error error = ErrorOf([&] { (void)MakeKeyframe(waving, column, tested, misses); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    return std::string(error.what());
  };
  EXPECT_THAT(message(10, 1, 0), HasSubstr("has no column 10; it has 0 to 9"));
  EXPECT_THAT(message(8, 1, 0), HasSubstr("leaves all of these features free in column 8"));
  EXPECT_THAT(message(9, 1, 1), HasSubstr("1 misses; expected 0 to 0"));
}

TEST(Keyframes, ChangeSidesWithTheTemplate) {
  MotionTemplate waving = FreeTemplate(10);
  waving.keyframes = {{.column = 2, .tested = 0b01, .ones = 0b01},
                      {.column = 5, .tested = 0b11100, .ones = 0b10100, .misses = 2}};
  const MotionTemplate mirrored = MirrorTemplate(waving, ArmsAndLegs());
  EXPECT_THAT(mirrored.keyframes,
              ElementsAre(Keyframe{.column = 2, .tested = 0b10, .ones = 0b10},
                          Keyframe{.column = 5, .tested = 0b11100, .ones = 0b11000, .misses = 2}));
  EXPECT_EQ(MirrorTemplate(mirrored, ArmsAndLegs()), waving);
}

TEST(Keyframes, RefuseAnotherFeatureSetAndOddOptions) {
  FeatureSet other = ArmsAndLegs();
  other.hash = 8;
  EXPECT_EQ(ErrorOf([&] { (void)ChooseKeyframes(FreeTemplate(9), other); }).code(),
            ErrorCode::kMismatch);
  for (const KeyframeOptions& options : {KeyframeOptions{.most = 0}, {.misses = -1}}) {
    EXPECT_EQ(
        ErrorOf([&] { (void)ChooseKeyframes(FreeTemplate(9), ArmsAndLegs(), options); }).code(),
        ErrorCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace kinebase::test
