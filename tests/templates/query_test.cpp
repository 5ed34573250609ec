// The query language: what a query compiles to, and what is said of one that does not.
#include "kinebase/templates/query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <filesystem>

#include "kinebase/features/vocabulary.h"
#include "support/files.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

using ::testing::HasSubstr;

const FeatureSet& Bonn() {
  static const FeatureSet features = LoadFeatureSet("bonn");
  return features;
}

// "0-8: F3 F21 | 9-17: F19": columns, and what is asked in them; "!" before what must not hold.
std::string Phases(const std::string& query, double rate_hz = 30) {
  const CompiledQuery compiled = CompileQuery(query, Bonn(), {.rate_hz = rate_hz});
  std::string text;
  for (const auto& [columns, states] : compiled.phases) {
    text += text.empty() ? "" : " | ";
    text += std::to_string(columns.first) + '-' + std::to_string(columns.last) + ':';
    for (const auto& [feature, holds] : states) {
      text += (holds ? " F" : " !F") + std::to_string(feature + 1);
    }
  }
  return text;
}

TEST(Query, IsPhasesOfPhrases) {
  EXPECT_EQ(Phases("rhand raised & lknee bent for 0.3s then both feet apart"),
            "0-8: F3 F21 | 9-17: F19");
  EXPECT_EQ(Phases("F3"), "0-8: F3");
  EXPECT_EQ(Phases("The right hand is raised AND the left knee is bent FOR 1 s"), "0-29: F3 F21");
  EXPECT_EQ(Phases("both knees bent&rhand slow for 100ms"), "0-2: !F13 F20 F21");
  EXPECT_EQ(Phases("hands far apart, sideways for 5 columns"), "0-4: F9");
  EXPECT_EQ(Phases("F3 for 1 column THEN F4 for 1 column"), "0-0: F3 | 1-1: F4");
  EXPECT_EQ(Phases("F3 & F3 & rhand up"), "0-8: F3");
}

TEST(Query, DeniesWithNotAndWithOpposites) {
  EXPECT_EQ(Phases("not F20"), "0-8: !F20");
  EXPECT_EQ(Phases("rknee is not bent"), "0-8: !F20");
  EXPECT_EQ(Phases("rknee is straight"), "0-8: !F20");
  EXPECT_EQ(Phases("not rknee straight"), "0-8: F20");
  EXPECT_EQ(Phases("both hands slow"), "0-8: !F13 !F14");
}

TEST(Query, HasAnyForWhatDoesNotMatter) {
  EXPECT_EQ(Phases("F3 then any for 0.5s then F4"), "0-8: F3 | 9-23: | 24-32: F4");
  EXPECT_EQ(Phases("any & F3"), "0-8: F3");
}

TEST(Query, TurnsDurationsIntoColumnsAtItsRate) {
  EXPECT_EQ(Phases("F3 for 0.3s", 120), "0-35: F3");
  EXPECT_EQ(Phases("F3", 60), "0-17: F3");
  EXPECT_EQ(Phases("F3 for 0.001s"), "0-0: F3");
  // The geometric mean: 0.2 s = 0.4 s / 2 and 0.8 s = 0.4 s · 2.
  EXPECT_EQ(Phases("F3 for 0.2-0.8s"), "0-11: F3");
  EXPECT_EQ(Phases("F3 for 200 - 800 ms"), "0-11: F3");
  EXPECT_EQ(Phases("F3 for 0.3-0.3s"), "0-8: F3");
}

TEST(Query, PutsFreeColumnsIntoGaps) {
  EXPECT_EQ(Phases("F3 then after 0.5s F4"), "0-8: F3 | 9-23: | 24-32: F4");
  EXPECT_EQ(Phases("F3 then after 0.2-0.8s F4"), "0-8: F3 | 9-20: | 21-29: F4");
  EXPECT_EQ(Phases("F3 then within 1s F4"), "0-8: F3 | 9-23: | 24-32: F4");
  EXPECT_EQ(Phases("F3 then within 1 column F4"), "0-8: F3 | 9-9: | 10-18: F4");
}

// The paper's "sweeping with a hand brush", drawn there by hand: 50 columns, three rows one.
TEST(Query, SaysThePapersTemplate) {
  const MotionTemplate brush =
      CompileQuery("rhand fast & spine horizontal & rhand lowered for 1.67s", Bonn()).templates[0];
  std::vector<double> column(39, 0.5);
  for (const int feature : {13, 32, 33}) column[feature - 1] = 1;
  EXPECT_EQ(brush.matrix, MakeMatrix(std::vector<std::vector<double>>(50, column)));
  EXPECT_EQ(brush.feature_set, "bonn");
  EXPECT_EQ(brush.feature_set_hash, Bonn().hash);
  EXPECT_EQ(brush.quantisation, 0.1);
  EXPECT_EQ(brush.tau, std::nullopt);
}

TEST(Query, EntersOnesZerosAndAny) {
  const TemplateMatrix matrix =
      CompileQuery("F1 & not F3 for 2 columns then F2 for 1 column", Bonn()).templates[0].matrix;
  std::vector<double> first(39, 0.5);
  std::vector<double> second = first;
  first[0] = 1;
  first[2] = 0;
  second[1] = 1;
  EXPECT_EQ(matrix, MakeMatrix({first, first, second}));
}

TEST(Query, NamesItsTemplate) {
  const auto compiled = [](const QueryOptions& options) {
    return CompileQuery(" F3\n then   F4 ", Bonn(), options).templates[0];
  };
  EXPECT_EQ(compiled({}).name, "F3 then F4");
  EXPECT_EQ(compiled({.name = "mine"}).name, "mine");
  EXPECT_EQ(compiled({.name = "mine"}).origin, "query: F3 then F4");
  EXPECT_EQ(compiled({.matching = Profile::kPaper}).matching, Profile::kPaper);
}

TEST(Query, ExchangesSidesWhenMirrored) {
  EXPECT_EQ(Phases("mirrored: F3 & lknee bent then not F13"), "0-8: F4 F20 | 9-17: !F14");
  EXPECT_EQ(CompileQuery("mirrored: F3", Bonn()).templates[0].matrix,
            CompileQuery("F4", Bonn()).templates[0].matrix);
}

TEST(Query, GivesATemplateForEachSide) {
  const CompiledQuery kick = CompileQuery("either side: rknee bent then rfoot fast", Bonn());
  ASSERT_EQ(kick.templates.size(), 2U);
  EXPECT_EQ(kick.templates[0].matrix,
            CompileQuery("rknee bent then rfoot fast", Bonn()).templates[0].matrix);
  EXPECT_EQ(kick.templates[1].matrix,
            CompileQuery("lknee bent then lfoot fast", Bonn()).templates[0].matrix);
  EXPECT_EQ(kick.templates[1].name, kick.templates[0].name + " mirrored");
  EXPECT_EQ(CompileQuery("either side: both knees bent", Bonn()).templates.size(), 1U);
}

struct Refusal {
  std::string query;
  int column;
  std::string word;  // Under the marks.
  std::string part;  // Of the message.
};

void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.query; }

class RefusedQuery : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedQuery, PointsAtTheWord) {
  const auto& [query, column, word, part] = GetParam();
  try {
    (void)CompileQuery(query, Bonn());
    FAIL() << "was compiled";
  } catch (const QueryError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_EQ(error.column(), column);
    EXPECT_THAT(error.what(), HasSubstr("query, column " + std::to_string(column) + ": "));
    EXPECT_THAT(error.what(), HasSubstr(part));
    std::string marks(static_cast<std::size_t>(column) - 1, ' ');
    marks += '^' + std::string(word.empty() ? 0 : word.size() - 1, '~');
    EXPECT_EQ(error.marked(), query + '\n' + marks);
    EXPECT_EQ(query.substr(static_cast<std::size_t>(column) - 1, word.size()), word);
  }
}

const std::vector<Refusal> kRefusals = {
    {"", 1, "", "the query is empty; say for example 'rhand moving forwards'"},
    {"rhand raisd & lknee bent", 7, "raisd", "'raisd' is unknown; did you mean 'rhand raised'"},
    {"F3 & right hnad raised", 6, "right hnad", "'right hnad' is unknown; did you mean"},
    {"F3 then the rknee", 9, "the rknee", "'the rknee' is no phrase; did you mean 'rknee bent'"},
    {"xyzzy", 1, "xyzzy", "feature set 'bonn' knows, for example"},
    {"F3 F4", 4, "F4", "a second phrase begins here; put '&' or 'then'"},
    {"rhand raised the lknee bent", 18, "lknee", "a second phrase begins here"},
    {"F3 & & F4", 6, "&", "expected a phrase before '&'"},
    {"& F3", 1, "&", "expected a phrase before '&'"},
    {"F3 then", 8, "", "expected a phrase at the end"},
    {"F3 then then F4", 9, "then", "expected a phrase before 'then'"},
    {"not not F3", 5, "not", "a second 'not'"},
    {"both knees bent & rknee straight", 19, "rknee straight", "F20 cannot hold and not hold"},
    {"not both knees bent", 1, "not both knees bent", "'not' goes with one feature"},
    {"F3 or F4", 4, "or", "a template cannot choose"},
    {"either hand raised", 1, "either", "either side:"},
    {"any F3", 1, "any", "'any' stands alone"},
    {"not any", 5, "any", "'any' stands alone"},
    {"any for 2s", 1, "any for 2s", "asks for nothing"},
    {"F3 for", 4, "for", "expected a duration"},
    {"F3 for long", 8, "long", "expected a duration, as 0.3s"},
    {"F3 for 5 miles", 8, "5 miles", "expected a duration"},
    {"F3 for 0.5", 8, "0.5", "expected a duration"},
    {"F3 for 1.2.3s", 8, "1.2.3s", "expected a duration"},
    {"F3 for -1s", 8, "-1s", "expected a duration"},
    {"F3 for 0s", 8, "0s", "expected more than 0"},
    {"F3 for 1e3s", 8, "1e3s", "expected a duration"},
    {"F3 for 9999s", 8, "9999s", "at most"},
    {"F3 for 0.2-2s", 8, "0.2-2s", "the range is too wide"},
    {"F3 for 2-1s", 8, "2-1s", "runs backwards"},
    {"F3 for 2- s", 8, "2- s", "expected a duration"},
    {"F3 for 1s & F4", 11, "&", "'for' is the last of a phase"},
    {"F3 for 1s F4", 11, "F4", "expected 'then' or the end"},
    {"F3 then within 1-2s F4", 16, "1-2s", "'within' takes one duration"},
    {"F3 within 1s", 4, "within", "'within' follows 'then'"},
    {"F3 then after F4", 15, "F4", "expected a duration"},
    {"F3: F4", 3, ":", "expected 'then' or the end"},
    {"mirrored:", 10, "", "expected a phrase at the end"},
    {"F3 & (F4)", 6, "(", "'(' means nothing here"},
    {"F3 for 2000s then F4 for 2000s", 1, "F3 for 2000s then F4 for 2000s", "100000 columns"},
};

INSTANTIATE_TEST_SUITE_P(Query, RefusedQuery, ::testing::ValuesIn(kRefusals));

TEST(QueryError, CountsCharactersAndShowsOneLine) {
  try {
    (void)CompileQuery("F3 then\nFüße hoch", Bonn());
    FAIL() << "was compiled";
  } catch (const QueryError& error) {
    EXPECT_EQ(error.column(), 9);
    EXPECT_EQ(error.marked(), "F3 then Füße hoch\n        ^~~~");
  }
}

TEST(QueryError, SaysWhichFeaturesShareAName) {
  const std::string feature =
      "name = \"up\"\nstrong = 1\nweak = 1\nunit = \"cm\"\n"
      "terms = [{ type = \"height\", joints = [\"root\"] }]\n";
  const FeatureSet features = ParseFeatureSet(
      "format = \"kinebase-feature-set\"\nversion = 1\nname = \"two\"\n[[feature]]\nid = \"A\"\n" +
          feature + "[[feature]]\nid = \"B\"\n" + feature,
      "two.toml");
  EXPECT_THAT(ErrorOf([&] { (void)CompileQuery("up", features); }).what(),
              HasSubstr("say which: A, B"));
  EXPECT_EQ(CompileQuery("B", features).phases[0].states[0].feature, 1);
}

TEST(Query, RefusesRatesThatTheSetDoesNotHave) {
  EXPECT_EQ(ErrorOf([] { (void)CompileQuery("F3", Bonn(), {.rate_hz = 50}); }).code(),
            ErrorCode::kInvalidArgument);
}

// Whatever the words: a sound template, or one clear error inside the query.
RC_GTEST_PROP(Query, OfAnyWordsGivesATemplateOrAPlace, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const char* const words[] = {"rhand", "raised",      "F3",    "both knees bent",
                               "&",     "and",         "then",  "for",
                               "0.3s",  "any",         "not",   "0.1-",
                               "0.2s",  "within",      "after", ":",
                               "ü",     "either side", "1",     "\xff",
                               "\x01"};
  std::string query;
  for (int i = random.Below(12); i > 0; --i) {
    query += words[random.Below(std::size(words))];
    if (random.Below(4) != 0) query += ' ';
  }
  try {
    const CompiledQuery compiled = CompileQuery(query, Bonn());
    RC_ASSERT(!compiled.templates.empty());
    RC_ASSERT(compiled.phases.back().columns.last + 1 ==
              compiled.templates[0].matrix.column_count());
  } catch (const QueryError& error) {
    RC_ASSERT(error.column() >= 1);
    RC_ASSERT(error.column() <= static_cast<int>(query.size()) + 1);
  }
}

// Everything that the vocabulary lists can be said, and means what it lists.
TEST(Query, TakesEveryPhraseOfTheBuiltInSets) {
  for (const std::string& name : BuiltInFeatureSets()) {
    const FeatureSet features = LoadFeatureSet(name);
    const Vocabulary vocabulary(features);
    for (const FeaturePhrase& phrase : vocabulary.phrases()) {
      const auto states = CompileQuery(phrase.text, features).phases[0].states;
      EXPECT_EQ(states, phrase.states) << phrase.text;
    }
  }
}

// Files named good_… compile; all others are refused, and the place is in the query.
TEST(QueryCorpus, CompilesOrIsRefusedAsItsNamesSay) {
  int good = 0;
  int bad = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(KINEBASE_SOURCE_DIR) / "fuzz" / "corpus" / "query")) {
    const std::string name = entry.path().filename();
    SCOPED_TRACE(name);
    const std::string query = ReadText(entry.path());
    if (name.starts_with("good_")) {
      EXPECT_FALSE(CompileQuery(query, Bonn()).templates.empty());
      ++good;
      continue;
    }
    try {
      (void)CompileQuery(query, Bonn());
      ADD_FAILURE() << "was not refused";
    } catch (const QueryError& error) {
      EXPECT_GE(error.column(), 1);
      EXPECT_LE(error.column(), static_cast<int>(query.size()) + 1);
    }
    ++bad;
  }
  EXPECT_GE(good, 5);
  EXPECT_GE(bad, 10);
}

}  // namespace
}  // namespace kinebase::test
