// search --fuzzy, as scripts and people see it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "kinebase/features/feature_set.h"
#include "kinebase/library/take_search.h"
#include "kinebase/templates/quantized_template.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::test {
namespace {

class FuzzySearch : public ::testing::Test {
 protected:
  ProgramResult Search(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"search", template_, "--in", library_.folder(), "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

  // What the library finds with these features, in the order of the program.
  std::vector<TakeHit> Expected(const std::vector<int>& rows, int faults) const {
    std::uint64_t selected = 0;
    for (const int row : rows) selected |= std::uint64_t{1} << row;
    const MotionTemplate read = ReadTemplate(template_);
    const FeatureSet features = LoadFeatureSet("bonn");
    std::vector<TakeStretch> stretches;
    for (auto& file : FindMotionFiles(std::vector{library_.folder()})) {
      stretches.push_back({.file = std::move(file)});
    }
    const TakeBatch batch = LoadManyTakeFeatures(stretches, features, 30, {}, 1, {});
    return SearchTakes(
        MakeFuzzyQuery(Quantize(read.matrix, read.quantisation, read.matching), selected),
        batch.takes, {.faults = faults});
  }

  SyntheticLibrary library_;
  std::string template_ = library_.Learn("squat1Reps");
};

TEST_F(FuzzySearch, FindsWhatTheSelectedFeaturesShow) {
  for (const int faults : {0, 1}) {
    const std::vector<TakeHit> expected = Expected({19, 20}, faults);
    ASSERT_FALSE(expected.empty());
    for (const char* features : {"F20,F21", "rknee bent,lknee bent", "knees bent"}) {
      const auto hits =
          Search({"--fuzzy", "--features", features, "--faults", std::to_string(faults), "--json"})
              .Json()["hits"];
      ASSERT_EQ(hits.size(), expected.size());
      for (std::size_t i = 0; i < hits.size(); ++i) {
        EXPECT_EQ(hits[i]["first_frame"], expected[i].first_frame);
        EXPECT_EQ(hits[i]["last_frame"], expected[i].last_frame);
        EXPECT_EQ(hits[i]["cost"], expected[i].cost);
        EXPECT_TRUE(hits[i]["confidence"].is_null());
      }
    }
  }
}

// The selection belongs to the template: mirrored, the other hand is looked at.
TEST_F(FuzzySearch, MirrorsTheSelection) {
  const std::string mirrored = library_.scratch() / "mirrored.json";
  ASSERT_EQ(RunKinebase({"template", "mirror", template_, "-o", mirrored}).exit_code, 0);
  const auto by_option =
      Search({"--fuzzy", "--features", "rhand raised", "--mirror", "--json"}).Json()["hits"];
  template_ = mirrored;
  EXPECT_EQ(by_option, Search({"--fuzzy", "--features", "lhand raised", "--json"}).Json()["hits"]);
  EXPECT_FALSE(by_option.empty());
}

TEST_F(FuzzySearch, SaysInOneLineWhatIsWrong) {
  ExpectOneError(Search({"--fuzzy"}), 2, {"--features"});
  ExpectOneError(Search({"--features", "F20"}), 2, {"--fuzzy"});
  ExpectOneError(Search({"--faults", "1"}), 2, {"--fuzzy"});
  ExpectOneError(Search({"--fuzzy", "--features", "F20", "--faults", "-1"}), 2, {"--faults"});
  ExpectOneError(Search({"--fuzzy", "--features", "F20", "--faults", "99"}), 1, {"99 faults"});
  ExpectOneError(Search({"--fuzzy", "--features", "knees bnt"}), 1,
                 {"'knees bnt'", "did you mean 'knees bent'"});
  for (const std::vector<std::string>& other :
       std::vector<std::vector<std::string>>{{"--tau", "0.1"},
                                             {"--keyframes", "auto"},
                                             {"--curve", "x.csv"},
                                             {"--method", "mt"},
                                             {"--profile", "paper"}}) {
    std::vector<std::string> arguments = {"--fuzzy", "--features", "F20"};
    arguments.insert(arguments.end(), other.begin(), other.end());
    ExpectOneError(Search(arguments), 2, {other.front(), "--fuzzy"});
  }
}

}  // namespace
}  // namespace kinebase::test
