#include "kinebase/library/library_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "kinebase/library/library_annotations.h"
#include "kinebase/library/library_compaction.h"
#include "kinebase/library/library_templates.h"
#include "kinebase/library/library_upkeep.h"
#include "library/library_lock.h"
#include "library/made_up_takes.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using test::ErrorOf;
using test::MadeUpTakes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Takes of 40, 70 and 100 frames.
class LabelledLibrary : public testing::Test {
 protected:
  LabelledLibrary() { takes_.Import(); }

  [[nodiscard]] std::vector<StoredLabel> Labels(std::size_t take) const {
    return TakeLibrary(takes_.library()).takes()[take].labels;
  }
  LabelReport Change(const LabelChange& change, const TakeChoice& choice = {}) const {
    return ChangeLabels(takes_.library(), choice, change);
  }
  [[nodiscard]] TakeChoice Only(std::size_t take) const {
    return {.names = {takes_.files()[take]}};
  }

  MadeUpTakes takes_;
};

TEST_F(LabelledLibrary, KeepsLabelsOfTakesAndStretches) {
  EXPECT_EQ(Change({.add = {"gym", "arms"}}).added, 6);
  const LabelReport again =
      Change({.add = {"gym", "jump"}, .first_frame = 5, .last_frame = 40}, Only(1));
  EXPECT_EQ(again.added, 2);
  EXPECT_EQ(again.takes, 1);
  EXPECT_THAT(Labels(0), ElementsAre(StoredLabel{"arms"}, StoredLabel{"gym"}));
  EXPECT_THAT(Labels(1), ElementsAre(StoredLabel{"arms"}, StoredLabel{"gym"},
                                     StoredLabel{"gym", 5, 40}, StoredLabel{"jump", 5, 40}));
  EXPECT_EQ(Change({.add = {"gym", " gym "}}).takes, 0);
  EXPECT_THAT(VerifyLibrary(takes_.library()).damaged, IsEmpty());
}

TEST_F(LabelledLibrary, LosesLabelsOfAStretchOrAll) {
  Change({.add = {"gym"}});
  Change({.add = {"gym"}, .first_frame = 5, .last_frame = 9}, Only(1));
  Change({.add = {"gym"}, .first_frame = 50, .last_frame = 60}, Only(1));
  EXPECT_EQ(Change({.remove = {"gym"}, .first_frame = 1, .last_frame = 30}, Only(1)).removed, 1);
  EXPECT_THAT(Labels(1), ElementsAre(StoredLabel{"gym"}, StoredLabel{"gym", 50, 60}));
  EXPECT_EQ(Change({.remove = {"gym", "never there"}}).removed, 4);
  EXPECT_THAT(Labels(1), IsEmpty());
}

TEST_F(LabelledLibrary, KeepsLabelsWhenTakesAreImportedAgain) {
  Change({.add = {"gym"}});
  test::WriteMadeUpTake(takes_.files()[1], 77, 44);
  EXPECT_EQ(takes_.Import().updated, 1);
  EXPECT_THAT(Labels(1), ElementsAre(StoredLabel{"gym"}));
  EXPECT_THAT(VerifyLibrary(takes_.library()).damaged, IsEmpty());
}

TEST_F(LabelledLibrary, IsLabelledAsItWasByTheTableThatItWrites) {
  // Two takes of one name: the table has their paths.
  const fs::path twin = takes_.folder() / "b" / "HDM_xx_wave_001_120.amc";
  test::WriteMadeUpTake(twin, 8, 50);
  ImportTakes(takes_.library(), std::vector<ImportSource>{{.file = twin}}, MadeUpTakes::Options());
  Change({.add = {"gym"}});
  Change({.add = {"up"}, .first_frame = 3, .last_frame = 9}, {.names = {twin}});
  Change({.add = {"all"}, .first_frame = 1, .last_frame = 50}, {.names = {twin}});
  std::vector<std::vector<StoredLabel>> before;
  for (std::size_t i = 0; i < 4; ++i) before.push_back(Labels(i));
  const TakeLibrary library(takes_.library());
  const std::string table = FormatLabelTable(library.Choose({}));
  Change({.remove = {"gym", "up", "all"}});
  AddSegmentLabels(takes_.library(), {}, ParseSegmentLabels(table, "t.csv"), "t.csv");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(Labels(i), before[i]);
}

TEST_F(LabelledLibrary, KeepsOfATakeThatBecameShorterWhatLiesWithinIt) {
  Change({.add = {"gym"}}, Only(1));
  Change({.add = {"in"}, .first_frame = 2, .last_frame = 9}, Only(1));
  Change({.add = {"over"}, .first_frame = 30, .last_frame = 60}, Only(1));
  Change({.add = {"behind"}, .first_frame = 50, .last_frame = 60}, Only(1));
  const std::string table =
      "file,class,first_frame,last_frame\nHDM_xx_wave_002_120,in,2,9\n"
      "HDM_xx_wave_002_120,over,30,60\nHDM_xx_wave_002_120,behind,50,60\n";
  StoreAnnotations(takes_.library(), {}, ParseAnnotationTable(table, "a.csv"), "a.csv");
  test::WriteMadeUpTake(takes_.files()[1], 77, 44);
  EXPECT_EQ(takes_.Import().updated, 1);
  EXPECT_THAT(Labels(1), ElementsAre(StoredLabel{"gym"}, StoredLabel{"in", 2, 9},
                                     StoredLabel{"over", 30, 44}));
  const auto annotations = ListAnnotations(takes_.library(), {}).annotations;
  ASSERT_EQ(annotations.size(), 2U);
  EXPECT_EQ(annotations[0].last_frame, 9);
  EXPECT_EQ(annotations[1].last_frame, 44);
  const VerifyReport report = VerifyLibrary(takes_.library());
  EXPECT_THAT(report.damaged, IsEmpty());
  EXPECT_THAT(report.damaged_records, IsEmpty());
}

TEST_F(LabelledLibrary, RefusesWhatMakesNoSenseAndChangesNothing) {
  const auto refused = [&](const LabelChange& change) {
    const Error error = ErrorOf([&] { Change(change); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    return std::string(error.what());
  };
  EXPECT_THAT(refused({.add = {"gym", " "}}), HasSubstr("empty"));
  EXPECT_THAT(refused({.add = {"gym"}, .first_frame = 9, .last_frame = 8}), HasSubstr("9-8"));
  EXPECT_THAT(refused({.add = {"gym"}, .first_frame = 1, .last_frame = 41}),
              testing::AllOf(HasSubstr("wave_001"), HasSubstr("has 40 frames")));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_THAT(Labels(i), IsEmpty());
  EXPECT_EQ(ErrorOf([&] { Change({.add = {"gym"}}, {.names = {"nobody.amc"}}); }).code(),
            ErrorCode::kNotFound);
}

TEST_F(LabelledLibrary, IsLeftAloneWhileSomebodyElseWrites) {
  const internal::LibraryLock lock(takes_.library());
  const std::vector<std::function<void()>> changes = {
      [&] { Change({.add = {"gym"}}); },
      [&] { CompactLibrary(takes_.library()); },
      [&] { StoreTemplates(takes_.library(), {}, Overwrite::kNo); },
      [&] { RemoveAnnotations(takes_.library(), {}, {}); },
  };
  for (const auto& change : changes) {
    const Error refused = ErrorOf(change);
    EXPECT_EQ(refused.code(), ErrorCode::kIoFailure);
    EXPECT_THAT(refused.what(), HasSubstr("is writing to this library"));
  }
  EXPECT_THAT(VerifyLibrary(takes_.library()).damaged, IsEmpty());
}

TEST_F(LabelledLibrary, TakesLabelsFromTables) {
  const std::vector<SegmentLabel> labels = ParseSegmentLabels(
      "file,class,first_frame,last_frame\n"
      "/elsewhere/HDM_xx_wave_001_120.amc,up,3,9\n"
      "HDM_xx_wave_001_120,down,10,45\n"
      "HDM_yy_wave_001_120,up,3,9\n",
      "labels.csv");
  const LabelReport report = AddSegmentLabels(takes_.library(), {}, labels, "labels.csv");
  EXPECT_EQ(report.added, 2);
  EXPECT_EQ(report.takes, 1);
  EXPECT_EQ(report.passed_over, 1);
  EXPECT_THAT(Labels(0), ElementsAre(StoredLabel{"down", 10, 40}, StoredLabel{"up", 3, 9}));
  EXPECT_EQ(AddSegmentLabels(takes_.library(), {}, labels, "labels.csv").added, 0);
}

TEST_F(LabelledLibrary, NamesTheLineOfATableThatItCannotFollow) {
  const auto refused = [&](const std::string& row, const TakeChoice& choice = {}) {
    const auto labels =
        ParseSegmentLabels("file,class,first_frame,last_frame\n" + row + "\n", "labels.csv");
    return std::string(
        ErrorOf([&] { AddSegmentLabels(takes_.library(), choice, labels, "labels.csv"); }).what());
  };
  EXPECT_THAT(refused("HDM_xx_wave_001_120,up,41,50"),
              testing::AllOf(HasSubstr("labels.csv:2"), HasSubstr("has 40 frames")));
  EXPECT_THAT(refused("HDM_xx_wave_001_120,,1,5"), HasSubstr("labels.csv:2: the label is empty"));
  EXPECT_THAT(refused("nobody,up,1,5"), HasSubstr("no recording that the library holds"));
  const fs::path twin = takes_.folder() / "b" / "HDM_xx_wave_001_120.amc";
  test::WriteMadeUpTake(twin, 8, 40);
  ImportTakes(takes_.library(), std::vector<ImportSource>{{.file = twin}}, MadeUpTakes::Options());
  EXPECT_THAT(refused("HDM_xx_wave_001_120,up,1,5"),
              testing::AllOf(HasSubstr("labels.csv:2"), HasSubstr("name the folder or --formats")));
  const auto labels = ParseSegmentLabels(
      "file,class,first_frame,last_frame\nHDM_xx_wave_001_120,up,1,5\n", "labels.csv");
  EXPECT_EQ(
      AddSegmentLabels(takes_.library(), {.names = {twin.parent_path()}}, labels, "labels.csv")
          .added,
      1);
}

}  // namespace
}  // namespace kinebase
