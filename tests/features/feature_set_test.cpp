// Feature sets as data: what is read, what is refused and where, what the hash covers.

#include "kinebase/features/feature_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "kinebase/core/error.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::string_view kSet = R"(format = "kinebase-feature-set"
version = 1
name = "two"
description = "two hands"
rate_hz = 60

[lengths]
hl = [["rshoulder", "relbow"]]

[[feature]]
id = "R"
name = "right hand high"
group = "upper"
mirror = "L"
test = "at_least"
strong = 1.5
weak = 1
unit = "hl"
terms = [
  { type = "height", joints = ["rwrist"], ignore = ["rwrist"] },
]

[[feature]]
id = "L"
name = "left hand high"
group = "upper"
mirror = "R"
test = "at_least"
strong = 1.25
weak = 1.0
unit = "hl"
terms = [
  { type = "height", joints = ["lwrist"] },
]
)";

FeatureSet Parse(std::string_view text) { return ParseFeatureSet(text, "two.toml"); }

// kSet with `from` replaced by `to`.
std::string With(std::string_view from, std::string_view to) {
  std::string text(kSet);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// The message that a changed kSet gives; it must name the line where `part` stands.
std::string ErrorAt(std::string_view from, std::string_view to, std::string_view part) {
  const std::string text = With(from, to);
  const Error error = test::ErrorOf([&] { (void)Parse(text); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.place().file, "two.toml");
  EXPECT_EQ(error.place().line, std::ranges::count(text.substr(0, text.find(part)), '\n') + 1)
      << error.what();
  return error.message();
}

TEST(FeatureSet, ReadsEveryField) {
  const FeatureSet set = Parse(kSet);
  EXPECT_EQ(set.name, "two");
  EXPECT_EQ(set.description, "two hands");
  EXPECT_EQ(set.rate_hz, 60);
  ASSERT_EQ(set.lengths.size(), 1);
  EXPECT_EQ(set.lengths[0].name, "hl");
  EXPECT_THAT(set.lengths[0].segments,
              ElementsAre(std::pair(StandardJoint::kRshoulder, StandardJoint::kRelbow)));
  ASSERT_EQ(set.feature_count(), 2);
  const Feature& right = set.features[0];
  EXPECT_EQ(right.id, "R");
  EXPECT_EQ(right.name, "right hand high");
  EXPECT_EQ(right.group, "upper");
  EXPECT_EQ(right.mirror, 1);
  EXPECT_EQ(right.test, ThresholdTest::kAtLeast);
  EXPECT_EQ(right.strong.low, 1.5);
  EXPECT_EQ(right.weak.low, 1);
  EXPECT_EQ(right.length, 0);
  ASSERT_EQ(right.terms.size(), 1);
  EXPECT_EQ(right.terms[0].type, TermType::kHeight);
  EXPECT_THAT(right.terms[0].joints, ElementsAre(StandardJoint::kRwrist));
  EXPECT_THAT(right.terms[0].ignored_joints, ElementsAre(StandardJoint::kRwrist));
  EXPECT_EQ(set.Find("L"), 1);
  EXPECT_FALSE(set.Find("F1"));
  EXPECT_THAT(set.MirrorRows(), ElementsAre(1, 0));
}

TEST(FeatureSet, HasDefaultsForWhatMayBeLeftOut) {
  const FeatureSet set = Parse(R"(format = "kinebase-feature-set"
version = 1
name = "one"
[[feature]]
id = "F"
name = "fast"
strong = 10
weak = 5
unit = "cm/s"
terms = [{ type = "fast", joints = ["root"] }]
)");
  EXPECT_EQ(set.rate_hz, 120);
  EXPECT_EQ(set.features[0].test, ThresholdTest::kAbove);
  EXPECT_EQ(set.features[0].combination, TermCombination::kSum);
  EXPECT_EQ(set.features[0].mirror, 0);
  EXPECT_EQ(set.features[0].length, -1);
  EXPECT_EQ(set.features[0].terms[0].factor, 1);
  EXPECT_FALSE(set.features[0].terms[0].absolute);
}

TEST(FeatureSet, NamesTheLineOfAnErrorInToml) {
  (void)ErrorAt("rate_hz = 60", "rate_hz = = 60", "rate_hz");
  (void)ErrorAt("\"R\"", "\"R", "id = \"R");
  (void)ErrorAt("id = \"R\"", "id = \"R\"\nid = \"R\"", "id = \"R\"\nname");
}

TEST(FeatureSet, RefusesWhatIsNoFeatureSet) {
  for (const char* text :
       {"", "\n", "format = \"other\"\nversion = 1\n", "version = 1\n", "42\n"}) {
    const Error error = test::ErrorOf([&] { (void)Parse(text); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile) << text;
  }
  EXPECT_THAT(test::ErrorOf([] { (void)Parse("name = \"x\"\n"); }).message(),
              HasSubstr("format = \"kinebase-feature-set\""));
  EXPECT_THAT(ErrorAt("version = 1", "version = 2", "format"), HasSubstr("newer"));
  (void)ErrorAt("version = 1", "version = 0", "format");
  (void)ErrorAt("version = 1", "", "format");
}

TEST(FeatureSet, RefusesUnknownKeysAtEveryLevel) {
  EXPECT_THAT(ErrorAt("rate_hz = 60", "rate = 60", "rate = 60"), HasSubstr("unknown key 'rate'"));
  EXPECT_THAT(ErrorAt("group = \"upper\"", "grup = \"upper\"", "grup"),
              HasSubstr("'grup'; known:"));
  EXPECT_THAT(ErrorAt("ignore = [\"rwrist\"]", "ignored = [\"rwrist\"]", "ignored"),
              HasSubstr("'ignored'"));
}

TEST(FeatureSet, RefusesValuesOfAnotherKind) {
  for (const auto& [from, to] : std::vector<std::pair<const char*, const char*>>{
           {"rate_hz = 60", "rate_hz = \"60\""},
           {"rate_hz = 60", "rate_hz = true"},
           {"rate_hz = 60", "rate_hz = nan"},
           {"description = \"two hands\"", "description = 2"},
           {"[[\"rshoulder\", \"relbow\"]]", "\"rshoulder\""},
           {"[[\"rshoulder\", \"relbow\"]]", "[[\"rshoulder\"]]"},
           {"[[\"rshoulder\", \"relbow\"]]", "[\"rshoulder\", \"relbow\"]"},
           {"[[\"rshoulder\", \"relbow\"]]", "[]"},
           {"group = \"upper\"", "group = 1"},
           {"mirror = \"L\"", "mirror = 2"},
           {"test = \"at_least\"", "test = 1"},
           {"strong = 1.5", "strong = \"1.5\""},
           {"strong = 1.5", "strong = [1.5]"},
           {"strong = 1.5", "strong = inf"}}) {
    (void)ErrorAt(from, to, to);
  }
  (void)ErrorAt("joints = [\"rwrist\"]", "joints = \"rwrist\"", "{ type");
  (void)ErrorAt("joints = [\"rwrist\"]", "joints = [7]", "{ type");
  (void)ErrorAt("ignore = [\"rwrist\"]", "absolute = \"yes\"", "{ type");
  (void)ErrorAt("ignore = [\"rwrist\"]", "factor = \"-1\"", "{ type");
  const std::string text = With("[lengths]\nhl = [[\"rshoulder\", \"relbow\"]]", "lengths = 3");
  EXPECT_THROW((void)Parse(text), Error);
}

TEST(FeatureSet, RefusesRatesThatNoRecordingHas) {
  for (const char* rate : {"rate_hz = 0", "rate_hz = -60", "rate_hz = 1e9"}) {
    EXPECT_THAT(test::ErrorOf([&] { (void)Parse(With("rate_hz = 60", rate)); }).message(),
                HasSubstr("must lie between"));
  }
}

TEST(FeatureSet, NamesWhatThereIsWhereANameIsWrong) {
  EXPECT_THAT(ErrorAt("\"rshoulder\"", "\"shoulder\"", "\"shoulder\""),
              HasSubstr("'shoulder' is no joint of the standard skeleton; known: root, lhip"));
  EXPECT_THAT(ErrorAt("type = \"height\"", "type = \"hight\"", "hight"),
              HasSubstr("'hight'; known: plane, normal_plane"));
  EXPECT_THAT(ErrorAt("test = \"at_least\"", "test = \"more\"", "more"),
              HasSubstr("'more'; known: above, at_least"));
  EXPECT_THAT(ErrorAt("test = \"at_least\"", "combine = \"product\"", "product"),
              HasSubstr("known: sum, smallest"));
  EXPECT_THAT(ErrorAt("unit = \"hl\"", "unit = \"hw\"", "[[feature]]"), HasSubstr("[lengths]"));
  EXPECT_THAT(ErrorAt("mirror = \"L\"", "mirror = \"X\"", "[[feature]]"),
              HasSubstr("'X' does not exist"));
}

TEST(FeatureSet, RefusesLengthsThatAreUnits) {
  for (const char* name : {"cm = ", "deg = ", "\"hl/s\" = "}) {
    EXPECT_THAT(ErrorAt("hl = ", name, name), HasSubstr("is a unit already"));
  }
}

TEST(FeatureSet, RefusesPartnersThatDoNotAnswer) {
  EXPECT_THAT(ErrorAt("mirror = \"R\"", "mirror = \"L\"", "[[feature]]"),
              HasSubstr("R: mirror partner 'L' does not name it in return"));
}

TEST(FeatureSet, RefusesASecondFeatureOfOneId) {
  const std::string text = With("id = \"L\"", "id = \"R\"");
  const Error error = test::ErrorOf([&] { (void)Parse(text); });
  EXPECT_THAT(error.message(), HasSubstr("second feature 'R'"));
  EXPECT_EQ(error.place().line, 23);
}

TEST(FeatureSet, RefusesFeaturesThatLackSomething) {
  for (const char* line : {"id = \"R\"\n", "name = \"right hand high\"\n", "strong = 1.5\n",
                           "weak = 1\n", "unit = \"hl\"\n"}) {
    (void)ErrorAt(line, "", "[[feature]]");
  }
  (void)ErrorAt("id = \"R\"", "id = \"\"", "[[feature]]");
  (void)ErrorAt("[\n  { type = \"height\", joints = [\"rwrist\"], ignore = [\"rwrist\"] },\n]",
                "[]", "[[feature]]");
  EXPECT_THAT(ErrorAt("type = \"height\", ", "", "{ joints"), HasSubstr("'type'"));
}

TEST(FeatureSet, RefusesAWrongNumberOfJoints) {
  EXPECT_THAT(ErrorAt("joints = [\"rwrist\"]", "joints = [\"rwrist\", \"root\"]", "{ type"),
              HasSubstr("'height' takes 1 joints, found 2"));
  EXPECT_THAT(ErrorAt("type = \"height\"", "type = \"plane\"", "{ type"),
              HasSubstr("'plane' takes 4 joints, found 1"));
  EXPECT_THAT(ErrorAt("joints = [\"rwrist\"], ", "", "{ type"), HasSubstr("found 0"));
}

TEST(FeatureSet, RefusesUnitsThatDoNotFitTheTerms) {
  for (const char* unit : {"unit = \"hl/s\"", "unit = \"deg\"", "unit = \"cm/s\""}) {
    EXPECT_THAT(ErrorAt("unit = \"hl\"", unit, "[[feature]]"), HasSubstr("does not fit"));
  }
  EXPECT_THAT(
      ErrorAt("ignore = [\"rwrist\"] },",
              "ignore = [] },\n  { type = \"fast\", joints = [\"root\"] },", "{ type = \"fast\""),
      HasSubstr("measure different things"));
}

TEST(FeatureSet, RefusesTermOptionsThatMakeNoSense) {
  EXPECT_THAT(ErrorAt("ignore = [\"rwrist\"]", "window_ms = 100", "{ type"),
              HasSubstr("no velocity to smooth"));
  const auto fast = [](const std::string& rest) {
    return With("{ type = \"height\", joints = [\"rwrist\"], ignore = [\"rwrist\"] }",
                "{ type = \"fast\", joints = [\"rwrist\"], " + rest + " }");
  };
  for (const char* rest :
       {"window_ms = -1", "window_ms = 60001", "window_ms = 1e300", "ignore = [\"root\"]"}) {
    const Error error = test::ErrorOf([&] { (void)Parse(fast(rest)); });
    EXPECT_EQ(error.place().line, 20) << error.what();
  }
}

TEST(FeatureSet, RefusesAWeakTestThatLeavesOutPartOfTheStrongOne) {
  EXPECT_THAT(ErrorAt("weak = 1\n", "weak = 2\n", "[[feature]]"),
              HasSubstr("must pass 'weak' too"));
  (void)ErrorAt("test = \"at_least\"\nstrong = 1.5", "test = \"below\"\nstrong = 1.5",
                "[[feature]]");
  (void)ErrorAt("test = \"at_least\"\nstrong = 1.5\nweak = 1\n",
                "test = \"inside\"\nstrong = [1, 3]\nweak = [0, 2]\n", "[[feature]]");
  (void)ErrorAt("test = \"at_least\"\nstrong = 1.5\nweak = 1\n",
                "test = \"inside\"\nstrong = [3, 1]\nweak = [3, 1]\n", "[[feature]]");
  (void)ErrorAt("test = \"at_least\"", "test = \"inside\"", "[[feature]]");
}

// A set of `count` features.
std::string Many(int count) {
  std::string text = "format = \"kinebase-feature-set\"\nversion = 1\nname = \"many\"\n";
  for (int i = 0; i < count; ++i) {
    text += "[[feature]]\nid = \"F" + std::to_string(i) +
            "\"\nname = \"n\"\nstrong = 1\nweak = 1\nunit = \"cm\"\n"
            "terms = [{ type = \"height_extent\" }]\n";
  }
  return text;
}

TEST(FeatureSet, HoldsUpTo64Features) {
  EXPECT_EQ(Parse(Many(64)).feature_count(), 64);
  const Error error = test::ErrorOf([] { (void)Parse(Many(65)); });
  EXPECT_THAT(error.message(), HasSubstr("65 features; at most 64"));
  EXPECT_EQ(error.place().line, 4);
  EXPECT_THAT(test::ErrorOf([] { (void)Parse(Many(0)); }).message(), HasSubstr("[[feature]]"));
}

TEST(FeatureSetHash, IgnoresNamesAndTheWayOfWriting) {
  const std::uint64_t hash = Parse(kSet).hash;
  for (const auto& [from, to] :
       std::vector<std::pair<const char*, const char*>>{{"name = \"two\"", "name = \"2\""},
                                                        {"\"two hands\"", "\"\""},
                                                        {"\"right hand high\"", "\"x\""},
                                                        {"group = \"upper\"", "group = \"arms\""},
                                                        {"rate_hz = 60", "rate_hz = 60.0 # Hz"},
                                                        {"strong = 1.5", "strong = 15e-1"}}) {
    EXPECT_EQ(Parse(With(from, to)).hash, hash) << to;
  }
}

// Words that are added leave templates valid that were learned before.
TEST(FeatureSetHash, IgnoresTheWordsOfQueries) {
  std::string text(kSet);
  text += "[phrases]\n\"hands high\" = [\"R\", \"L\"]\n";
  const std::size_t at = text.find("group = \"upper\"");
  text.insert(at, "synonyms = [\"hand up\"]\nopposites = [\"hand down\"]\n");
  EXPECT_EQ(Parse(text).hash, Parse(kSet).hash);
}

TEST(FeatureSetWords, AreRead) {
  const FeatureSet set = Parse(With("mirror = \"L\"",
                                    "mirror = \"L\"\nsynonyms = [\"rhand up\", \"up\"]\n"
                                    "opposites = [\"rhand down\"]") +
                               "[phrases]\n\"one up\" = [\"R\", \"not L\"]\n");
  EXPECT_THAT(set.features[0].synonyms, ElementsAre("rhand up", "up"));
  EXPECT_THAT(set.features[0].opposites, ElementsAre("rhand down"));
  EXPECT_THAT(set.features[1].synonyms, testing::IsEmpty());
  ASSERT_EQ(set.phrases.size(), 1U);
  EXPECT_EQ(set.phrases[0].text, "one up");
  EXPECT_THAT(set.phrases[0].states, ElementsAre(FeatureState{0, true}, FeatureState{1, false}));
}

TEST(FeatureSetWords, MayNotMeanTwoThings) {
  const std::string at = "mirror = \"L\"";
  EXPECT_THAT(ErrorAt(at, "synonyms = [\"up\"]\nopposites = [\"up\"]\n" + at, "[[feature]]"),
              HasSubstr("'up' means two things"));
  EXPECT_THAT(ErrorAt(at, "synonyms = [\"The left hand is high\"]\n" + at, "[[feature]]"),
              HasSubstr("means two things"));
  EXPECT_THAT(ErrorAt(at, "synonyms = [\"L\"]\n" + at, "[[feature]]"), HasSubstr("'L' means"));
  EXPECT_THAT(ErrorAt(at, "synonyms = [\"...\"]\n" + at, "[[feature]]"), HasSubstr("no words"));
  // Saying the same twice is no contradiction.
  EXPECT_EQ(Parse(With(at, "synonyms = [\"R\", \"Right hand high\"]\n" + at)).feature_count(), 2);
}

TEST(FeatureSetWords, AreListsOfTextsAndPhrasesOfFeatures) {
  const std::string at = "mirror = \"L\"";
  EXPECT_THAT(ErrorAt(at, "synonyms = \"up\"\n" + at, "synonyms"), HasSubstr("list of texts"));
  EXPECT_THAT(ErrorAt(at, "opposites = [1]\n" + at, "opposites"), HasSubstr("list of texts"));
  const std::string lengths = "[lengths]";
  const auto refused = [&](const std::string& phrases, const std::string& part) {
    return ErrorAt(lengths, phrases + lengths, part);
  };
  EXPECT_THAT(refused("phrases = 1\n", "phrases"), HasSubstr("must be a table"));
  EXPECT_THAT(refused("[phrases]\n\"up\" = \"R\"\n", "\"up\""), HasSubstr("list of features"));
  EXPECT_THAT(refused("[phrases]\n\"up\" = []\n", "\"up\""), HasSubstr("list of features"));
  EXPECT_THAT(refused("[phrases]\n\"up\" = [\"no L\"]\n", "\"up\""),
              HasSubstr("'no L' is neither"));
  EXPECT_THAT(refused("[phrases]\n\"up\" = [3]\n", "\"up\""), HasSubstr("is neither"));
  EXPECT_THAT(refused("[phrases]\n\"L\" = [\"R\"]\n", "\"L\" ="), HasSubstr("'L' means two"));
}

TEST(FeatureSetHash, CoversEverythingThatDecidesABit) {
  const std::uint64_t hash = Parse(kSet).hash;
  for (const auto& [from, to] : std::vector<std::pair<const char*, const char*>>{
           {"rate_hz = 60", "rate_hz = 120"},
           {"strong = 1.5", "strong = 1.6"},
           {"weak = 1\n", "weak = 0.9\n"},
           {"test = \"at_least\"", "test = \"above\""},
           {"unit = \"hl\"", "unit = \"cm\""},
           {"\"relbow\"", "\"rwrist\""},
           {"ignore = [\"rwrist\"]", "ignore = []"},
           {"ignore = [\"rwrist\"]", "ignore = [\"rwrist\"], absolute = true"},
           {"ignore = [\"rwrist\"]", "ignore = [\"rwrist\"], factor = -1"},
           {"joints = [\"rwrist\"]", "joints = [\"rfingers\"]"},
           {"test = \"at_least\"", "test = \"at_least\"\ncombine = \"smallest\""}}) {
    EXPECT_NE(Parse(With(from, to)).hash, hash) << to;
  }
}

TEST(BuiltInFeatureSets, AreReadAndDiffer) {
  EXPECT_THAT(BuiltInFeatureSets(), ElementsAre("bonn", "paper"));
  for (const auto& name : BuiltInFeatureSets()) {
    const FeatureSet set = LoadFeatureSet(name);
    EXPECT_EQ(set.name, name);
    EXPECT_EQ(set.feature_count(), 39);
  }
  // Templates that people have learned name these: a set that changes needs another name.
  EXPECT_EQ(LoadFeatureSet("bonn").hash, 0x6A102498EF583FA9ULL);
  EXPECT_EQ(LoadFeatureSet("paper").hash, 0x3E7B4815660B8A1FULL);
  EXPECT_EQ(test::ErrorOf([] { (void)BuiltInFeatureSetText("x"); }).code(), ErrorCode::kNotFound);
}

TEST(LoadFeatureSet, TakesFilesAndNamesTheBuiltInSetsOtherwise) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "two.toml", kSet);
  EXPECT_EQ(LoadFeatureSet((folder.path() / "two.toml").string()).name, "two");
  for (const std::string& name :
       {std::string("none.toml"), std::string(5000, 'a'), std::string()}) {
    const Error error = test::ErrorOf([&] { (void)LoadFeatureSet(name); });
    EXPECT_EQ(error.code(), ErrorCode::kNotFound);
    EXPECT_THAT(error.what(), HasSubstr("bonn, paper"));
  }
  EXPECT_EQ(test::ErrorOf([&] { (void)LoadFeatureSet(folder.path().string()); }).code(),
            ErrorCode::kIoFailure);
}

TEST(FeatureSetDocument, HasAnExampleThatWorks) {
  const std::string text =
      test::ReadText(std::filesystem::path(KINEBASE_SOURCE_DIR) / "docs" / "feature-sets.md");
  const std::size_t begin = text.find("```toml\nformat");
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = text.find("\n```", begin);
  const FeatureSet set =
      ParseFeatureSet(text.substr(begin + 8, end - begin - 7), "feature-sets.md");
  EXPECT_EQ(set.feature_count(), 4);
  EXPECT_EQ(set.rate_hz, 120);
}

}  // namespace
}  // namespace kinebase
