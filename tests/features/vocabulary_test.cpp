// Words for features: how texts are compared, what is found, what is suggested.
#include "kinebase/features/vocabulary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using States = std::vector<FeatureState>;

// Two features with one name, between two sides of a hand.
constexpr std::string_view kSet = R"(format = "kinebase-feature-set"
version = 1
name = "words"
[[feature]]
id = "R"
name = "right hand: high, or so"
group = "hands"
mirror = "L"
strong = 1
weak = 1
unit = "cm"
terms = [{ type = "height", joints = ["rwrist"] }]
[[feature]]
id = "L"
name = "left hand: high, or so"
group = "hands"
mirror = "R"
strong = 1
weak = 1
unit = "cm"
terms = [{ type = "height", joints = ["lwrist"] }]
[[feature]]
id = "A"
name = "fast"
strong = 1
weak = 1
unit = "cm/s"
terms = [{ type = "fast", joints = ["root"] }]
[[feature]]
id = "B"
name = "fast"
strong = 2
weak = 2
unit = "cm/s"
terms = [{ type = "fast", joints = ["root"] }]
)";

TEST(Phrases, AreComparedByTheirWordsOnly) {
  for (const char* text : {"rhand raised", "right hand raised", "The Right HAND is raised.",
                           "  rhand\traised ", "right-hand raised", "a right, hand is raised!"}) {
    EXPECT_EQ(NormalizedPhrase(text), "rhand raised") << text;
  }
  EXPECT_EQ(NormalizedPhrase("shoulders rotated right"), "shoulders rotated right");
  EXPECT_EQ(NormalizedPhrase("Y-extents of body small"), "y extents of body small");
  EXPECT_EQ(NormalizedPhrase("Fuß oben"), "fuß oben");
  EXPECT_EQ(NormalizedPhrase(" ,.- "), "");
}

TEST(Phrases, KnowWhereTheirWordsStand) {
  const auto words = PhraseWords("is the right hand up?");
  ASSERT_EQ(words.size(), 2U);
  EXPECT_EQ(words[0].text, "rhand");
  EXPECT_EQ(words[0].first, 7U);
  EXPECT_EQ(words[0].count, 10U);
  EXPECT_EQ(words[1].text, "up");
  EXPECT_EQ(words[1].first, 18U);
}

TEST(Vocabulary, FindsEveryWayOfSayingAFeature) {
  const Vocabulary vocabulary(LoadFeatureSet("bonn"));
  const auto is = [](const States& states) { return ElementsAre(states); };
  EXPECT_THAT(vocabulary.Meanings("f20"), is({{19, true}}));
  EXPECT_THAT(vocabulary.Meanings("right knee bent"), is({{19, true}}));
  EXPECT_THAT(vocabulary.Meanings("rknee flexed"), is({{19, true}}));
  EXPECT_THAT(vocabulary.Meanings("right knee straight"), is({{19, false}}));
  EXPECT_THAT(vocabulary.Meanings("both knees straight"), is({{19, false}, {20, false}}));
  EXPECT_THAT(vocabulary.Meanings("hands far apart, sideways"), is({{8, true}}));
  EXPECT_THAT(vocabulary.Meanings("knee"), IsEmpty());
  EXPECT_TRUE(vocabulary.HasWord("knees"));
  EXPECT_FALSE(vocabulary.HasWord("elephant"));
}

TEST(Vocabulary, KeepsBothMeaningsOfANameThatTwoFeaturesShare) {
  const Vocabulary vocabulary(ParseFeatureSet(kSet, "words.toml"));
  EXPECT_THAT(vocabulary.Meanings("fast"), ElementsAre(States{{2, true}}, States{{3, true}}));
  EXPECT_THAT(vocabulary.Meanings("B"), ElementsAre(States{{3, true}}));
}

TEST(Vocabulary, SuggestsWhatIsSpeltAlikeOrHasTheWords) {
  const FeatureSet features = LoadFeatureSet("bonn");
  const Vocabulary vocabulary(features);
  EXPECT_EQ(vocabulary.Nearest("rhand raisd").front(), "rhand raised");
  EXPECT_THAT(vocabulary.Nearest("spine horizntal", 1), ElementsAre("spine horizontal"));
  EXPECT_THAT(vocabulary.Nearest("rknee"), Each(HasSubstr("rknee ")));
  EXPECT_THAT(vocabulary.Nearest("elephant"), IsEmpty());
  EXPECT_THAT(vocabulary.Nearest(""), IsEmpty());
  EXPECT_THAT(SuggestPhrases(vocabulary, features, "elephant"),
              HasSubstr("'F1' or 'rhand moving forwards'"));
}

// "rhand" and "left" of the other side: words that the vocabulary has as well.
std::string OtherSide(const std::string& text, const Vocabulary& vocabulary) {
  std::string out;
  for (PhraseWord& word : PhraseWords(text)) {
    std::string swapped = word.text;
    if (swapped == "right" || swapped == "left") {
      swapped = swapped == "right" ? "left" : "right";
    } else if (swapped[0] == 'r' || swapped[0] == 'l') {
      swapped[0] = swapped[0] == 'r' ? 'l' : 'r';
    }
    out.append(out.empty() ? "" : " ").append(vocabulary.HasWord(swapped) ? swapped : word.text);
  }
  return out;
}

std::vector<std::string> OtherSides(const std::vector<std::string>& texts,
                                    const Vocabulary& vocabulary) {
  std::vector<std::string> out;
  out.reserve(texts.size());
  for (const std::string& text : texts) out.push_back(OtherSide(text, vocabulary));
  return out;
}

std::vector<std::string> Normalized(const std::vector<std::string>& texts) {
  std::vector<std::string> out;
  out.reserve(texts.size());
  for (const std::string& text : texts) out.push_back(NormalizedPhrase(text));
  return out;
}

TEST(BuiltInVocabulary, HasTheSameWordsForBothSides) {
  for (const std::string& name : BuiltInFeatureSets()) {
    const FeatureSet features = LoadFeatureSet(name);
    const Vocabulary vocabulary(features);
    std::size_t sided = 0;
    for (const Feature& feature : features.features) {
      const Feature& other = features.features[static_cast<std::size_t>(feature.mirror)];
      if (other.id == feature.id) continue;
      EXPECT_EQ(OtherSides(feature.synonyms, vocabulary), Normalized(other.synonyms));
      EXPECT_EQ(OtherSides(feature.opposites, vocabulary), Normalized(other.opposites));
      sided += feature.synonyms.size();
    }
    EXPECT_GT(sided, 50U);
  }
}

TEST(FeatureLists, TakeIdsNamesGroupsAndAll) {
  const FeatureSet features = LoadFeatureSet("bonn");
  EXPECT_THAT(FindFeatures(features, "F13,F32, F33"), ElementsAre(12, 31, 32));
  EXPECT_THAT(FindFeatures(features, "F33,right hand fast,F33"), ElementsAre(12, 32));
  EXPECT_THAT(FindFeatures(features, "hands far apart, sideways"), ElementsAre(8));
  EXPECT_THAT(FindFeatures(features, "both knees bent"), ElementsAre(19, 20));
  EXPECT_EQ(FindFeatures(features, "upper").size(), 14U);
  EXPECT_EQ(FindFeatures(features, "lower,mix").size(), 25U);
  EXPECT_EQ(FindFeatures(features, "all").size(), 39U);
}

TEST(FeatureLists, SayWhatIsWrongWithAName) {
  const FeatureSet bonn = LoadFeatureSet("bonn");
  const FeatureSet words = ParseFeatureSet(kSet, "words.toml");
  const auto refusal = [](const FeatureSet& features, const char* list) {
    return ErrorOf([&] { (void)FindFeatures(features, list); });
  };
  EXPECT_EQ(refusal(bonn, "F1,rknee bnt").code(), ErrorCode::kNotFound);
  EXPECT_THAT(refusal(bonn, "F1,rknee bnt").what(), HasSubstr("did you mean 'rknee bent'"));
  EXPECT_THAT(refusal(bonn, "F1,,F2").what(), HasSubstr("'' is no feature"));
  EXPECT_THAT(refusal(bonn, "rknee straight").what(), HasSubstr("name F20 itself"));
  EXPECT_EQ(refusal(words, "fast").code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(refusal(words, "fast").what(), HasSubstr("use ids"));
}

}  // namespace
}  // namespace kinebase::test
