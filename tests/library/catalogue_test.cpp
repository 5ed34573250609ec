// What the catalogue keeps of takes beside their features: how it is found, and that damage which
// SQLite does not see is seen.
#include "library/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinebase/library/library_annotations.h"
#include "kinebase/library/library_compaction.h"
#include "kinebase/library/library_labels.h"
#include "kinebase/library/library_upkeep.h"
#include "library/made_up_takes.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using test::ErrorOf;
using test::ExecuteSql;
using test::MadeUpTakes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<std::string> NamesOf(const std::vector<const StoredTake*>& takes) {
  std::vector<std::string> names;
  names.reserve(takes.size());
  for (const StoredTake* take : takes) names.push_back(take->path.stem().string());
  return names;
}

TEST(Catalogue, KnowsWhereATakeCameFrom) {
  const MadeUpTakes takes(1);
  ImportOptions options = MadeUpTakes::Options();
  options.load.strict = true;
  options.load.source_rate_hz = 120;
  takes.Import(options);
  const TakeLibrary library(takes.library());
  const StoredTake& take = library.takes().front();
  EXPECT_EQ(take.skeleton.path, fs::canonical(takes.folder() / "HDM_xx.asf"));
  EXPECT_NE(take.skeleton.key, ContentKey());
  EXPECT_EQ(take.origin.file_bytes, static_cast<std::int64_t>(fs::file_size(takes.files()[0])));
  EXPECT_GE(take.origin.imported_s, take.origin.file_time_s);
  EXPECT_GT(take.origin.file_time_s, 1'700'000'000);  // Of this test, so after November 2023.
  EXPECT_THAT(take.origin.program, testing::StartsWith("kinebase "));
  EXPECT_EQ(take.origin.options, "--source-rate 120 --strict");
}

TEST(Catalogue, TakesOfOneSkeletonHaveItsKey) {
  const MadeUpTakes takes(2);
  const fs::path other = takes.folder() / "other" / "HDM_xx_wave_009_120.amc";
  test::WriteMadeUpTake(other, 9, 50);
  test::WriteText(takes.folder() / "other" / "HDM_xx.asf",
                  test::ReadText(takes.folder() / "HDM_xx.asf") + "\n");
  takes.Import();
  ImportTakes(takes.library(), std::vector<ImportSource>{{.file = other}}, MadeUpTakes::Options());
  const TakeLibrary library(takes.library());
  ASSERT_THAT(library.takes(), SizeIs(3));
  EXPECT_EQ(library.takes()[0].skeleton, library.takes()[1].skeleton);
  EXPECT_NE(library.takes()[0].skeleton.key, library.takes()[2].skeleton.key);
}

TEST(Catalogue, FindsTakesByTheirWords) {
  const MadeUpTakes takes(3);
  std::vector<ImportSource> sources = takes.Sources();
  sources[0].description = "Grabs an item from the shelf";
  sources[1].description = "Café; walks on";
  sources[1].class_name = "kickRFront1Reps";
  ImportTakes(takes.library(), sources, MadeUpTakes::Options());
  ChangeLabels(takes.library(), {.names = {takes.files()[2]}}, {.add = {"warm-up \"gym\""}});
  const TakeLibrary library(takes.library());
  const auto found = [&](const std::string& text) {
    return NamesOf(library.Choose({.text = text}));
  };
  const std::string first = "HDM_xx_wave_001_120";
  const std::string second = "HDM_xx_wave_002_120";
  const std::string third = "HDM_xx_wave_003_120";
  EXPECT_THAT(found("shelf GRAB"), ElementsAre(first));
  EXPECT_THAT(found("cafe"), ElementsAre(second));
  EXPECT_THAT(found("front kick"), ElementsAre(second));
  EXPECT_THAT(found("kickrfront1"), ElementsAre(second));
  EXPECT_THAT(found("gym xx"), ElementsAre(third));
  EXPECT_THAT(found(third + ".amc"), ElementsAre(third));
}

TEST(Catalogue, TakesMarksInAQueryForWhatPartsWords) {
  const MadeUpTakes takes(1);
  takes.Import();
  ChangeLabels(takes.library(), {}, {.add = {"warm-up \"gym\""}});
  const TakeLibrary library(takes.library());
  for (const char* text : {"warm-up", "\"gym\"", "gym\"", "GYM warm", "hdm_xx", "wave* 001"}) {
    EXPECT_THAT(library.Choose({.text = text}), SizeIs(1)) << text;
  }
  for (const char* text : {"gym kick", "\"\"\"", "- *", "gym OR kick", "col:gym"}) {
    EXPECT_THAT(ErrorOf([&] { (void)library.Choose({.text = text}); }).what(),
                HasSubstr("has no take with the words"))
        << text;
  }
}

TEST(Catalogue, ForgetsTheWordsOfTakesThatAreRemovedOrChanged) {
  const MadeUpTakes takes(2);
  takes.Import();
  ChangeLabels(takes.library(), {}, {.add = {"gym"}});
  ChangeLabels(takes.library(), {.names = {takes.files()[0]}}, {.remove = {"gym"}});
  EXPECT_THAT(TakeLibrary(takes.library()).Choose({.text = "gym"}), SizeIs(1));
  RemoveTakes(takes.library(), {.names = {takes.files()[1]}});
  EXPECT_EQ(ErrorOf([&] { (void)TakeLibrary(takes.library()).Choose({.text = "gym"}); }).code(),
            ErrorCode::kNotFound);
  EXPECT_FALSE(VerifyLibrary(takes.library()).words_are_damaged);
}

TEST(Catalogue, FiltersByLabelAndFormat) {
  const MadeUpTakes takes(3);
  takes.Import();
  ChangeLabels(takes.library(), {.names = {takes.files()[0]}}, {.add = {"gym", "legs"}});
  ChangeLabels(takes.library(), {.names = {takes.files()[1]}},
               {.add = {"legs"}, .first_frame = 3, .last_frame = 9});
  const TakeLibrary library(takes.library());
  EXPECT_THAT(library.Choose({.labels = {"legs"}}), SizeIs(2));
  EXPECT_THAT(library.Choose({.labels = {"gym"}, .text = "001"}), SizeIs(1));
  for (const char* format : {"amc", "ASF", "asf/amc"}) {
    EXPECT_THAT(library.Choose({.formats = {format}}), SizeIs(3)) << format;
  }
  EXPECT_THAT(ErrorOf([&] { (void)library.Choose({.labels = {"leg"}}); }).what(),
              HasSubstr("label 'leg'; there are: gym, legs"));
  EXPECT_THAT(ErrorOf([&] { (void)library.Choose({.formats = {"c3d"}}); }).what(),
              HasSubstr("format 'c3d'; there are: ASF/AMC"));
}

// Every value of a take's rows, changed behind SQLite's back as a flipped bit would.
TEST(DamagedCatalogue, NamesTheTakeWhateverIsChangedOfIt) {
  const MadeUpTakes takes(2);
  takes.Import();
  ChangeLabels(takes.library(), {.names = {takes.files()[0]}},
               {.add = {"gym"}, .first_frame = 3, .last_frame = 9});
  const fs::path catalogue = takes.library() / "catalogue.sqlite";
  const std::string good = test::ReadText(catalogue);
  const std::string first = " WHERE path LIKE '%wave_001%'";
  for (const std::string& change :
       {"UPDATE takes SET actor = 'yx'" + first,
        "UPDATE takes SET class = 'wawe'" + first,
        "UPDATE takes SET format = 'BVH'" + first,
        "UPDATE takes SET take = '003'" + first,
        "UPDATE takes SET frames = 41" + first,
        "UPDATE takes SET rate_hz = 60" + first,
        "UPDATE takes SET content = replace(content, substr(content, 1, 1), 'x')" + first,
        "UPDATE takes SET description = 'x'" + first,
        "UPDATE takes SET skeleton = 'x'" + first,
        "UPDATE takes SET skeleton_key = ''" + first,
        "UPDATE takes SET imported_s = 1" + first,
        "UPDATE takes SET file_time_s = 1" + first,
        "UPDATE takes SET file_bytes = 1" + first,
        "UPDATE takes SET program = ''" + first,
        "UPDATE takes SET options = '--strict'" + first,
        "UPDATE takes SET checksum = checksum + 1" + first,
        std::string("UPDATE features SET slot = 1 WHERE take = 1"),
        std::string("UPDATE features SET poses = 1 WHERE take = 1"),
        std::string("UPDATE features SET rate_hz = 60 WHERE take = 1"),
        std::string("DELETE FROM features WHERE take = 1"),
        std::string("UPDATE labels SET label = 'gim'"),
        std::string("UPDATE labels SET last_frame = 10"),
        std::string("DELETE FROM labels")}) {
    SCOPED_TRACE(change);
    test::WriteText(catalogue, good);
    ExecuteSql(takes.library(), change);
    const VerifyReport report = VerifyLibrary(takes.library());
    ASSERT_THAT(report.damaged, SizeIs(1));
    EXPECT_THAT(report.damaged[0].path.string(), HasSubstr("wave_001"));
    EXPECT_THAT(report.damaged[0].error.what(),
                testing::AllOf(HasSubstr("catalogue.sqlite"), HasSubstr("--damaged")));
  }
}

TEST(DamagedCatalogue, IsNotTrustedAndMendedByRemovingAndImporting) {
  const MadeUpTakes takes(2);
  takes.Import();
  ExecuteSql(takes.library(), "UPDATE takes SET class = 'wawe' WHERE path LIKE '%wave_001%'");
  const TakeBatch batch =
      test::LoadAll(TakeLibrary(takes.library()), MadeUpTakes::Options().features, 30);
  EXPECT_THAT(batch.takes, SizeIs(1));
  ASSERT_THAT(batch.failures, SizeIs(1));
  EXPECT_THAT(batch.failures[0].error.what(), HasSubstr("is damaged in what it says of"));
  // Nobody writes over what may still tell something: it is removed by a word.
  const ImportReport refused = takes.Import();
  EXPECT_EQ(refused.unchanged, 1);
  ASSERT_THAT(refused.failures, SizeIs(1));
  EXPECT_THAT(refused.failures[0].error.what(), HasSubstr("--damaged"));
  EXPECT_EQ(ErrorOf([&] { ChangeLabels(takes.library(), {}, {.add = {"gym"}}); }).code(),
            ErrorCode::kMalformedFile);
  EXPECT_THAT(RemoveTakes(takes.library(), {.damaged = true}), SizeIs(1));
  EXPECT_EQ(takes.Import().added, 1);
  EXPECT_THAT(VerifyLibrary(takes.library()).damaged, IsEmpty());
}

// Nobody knows whether a filter means a take whose row is damaged: so each names it.
TEST(DamagedCatalogue, NamesItsTakesWhateverIsAskedFor) {
  const MadeUpTakes takes(3);
  takes.Import();
  ChangeLabels(takes.library(), {}, {.add = {"gym"}});
  ExecuteSql(takes.library(), "UPDATE takes SET class = 'wawe', actor = 'yx' WHERE id = 1");
  const TakeLibrary library(takes.library());
  for (const TakeFilter& filter :
       {TakeFilter{.classes = {"wave"}}, TakeFilter{.classes = {"kick"}}, TakeFilter{.text = "002"},
        TakeFilter{.text = "nowhere"}, TakeFilter{.labels = {"gym"}}}) {
    const ChosenTakes chosen = ChooseIntactTakes(library, {.filter = filter});
    ASSERT_THAT(chosen.failures, SizeIs(1));
    EXPECT_THAT(chosen.failures[0].error.what(), HasSubstr("wave_001"));
    EXPECT_THAT(test::LoadAll(library, MadeUpTakes::Options().features, 30, filter).failures,
                SizeIs(1));
  }
  EXPECT_THAT(ChooseIntactTakes(library, {.names = {takes.files()[2]}}).takes, SizeIs(1));
  EXPECT_THAT(ChooseIntactTakes(library, {.names = {takes.files()[2]}}).failures, SizeIs(1));
  // What is changed is changed whole, or not at all.
  for (const TakeFilter& filter : {TakeFilter{.classes = {"wave"}}, TakeFilter{.actors = {"yx"}}}) {
    EXPECT_EQ(ErrorOf([&] { RemoveTakes(takes.library(), {.filter = filter}); }).code(),
              ErrorCode::kMalformedFile);
  }
  EXPECT_THAT(TakeLibrary(takes.library()).takes(), SizeIs(3));
}

TEST(DamagedCatalogue, FindsAllTakesWhereWordsAreMissing) {
  const MadeUpTakes takes(3);
  takes.Import();
  for (const char* change : {"DELETE FROM take_text WHERE rowid = 2", "DROP TABLE take_text"}) {
    ExecuteSql(takes.library(), change);
    EXPECT_THAT(TakeLibrary(takes.library()).Choose({.text = "wave"}), SizeIs(3)) << change;
    EXPECT_TRUE(VerifyLibrary(takes.library()).words_are_damaged);
  }
  ChangeLabels(takes.library(), {}, {.add = {"gym"}});  // Whoever writes gets them made.
  EXPECT_FALSE(VerifyLibrary(takes.library()).words_are_damaged);
  ExecuteSql(takes.library(), "DROP TABLE take_text");
  CompactLibrary(takes.library());
  EXPECT_FALSE(VerifyLibrary(takes.library()).words_are_damaged);
  EXPECT_THAT(TakeLibrary(takes.library()).Choose({.text = "wave gym"}), SizeIs(3));
}

// Rows that refer to what is not there; SQLite's own check of that would condemn the catalogue.
TEST(DamagedCatalogue, IsMendedByRemovingWhereRowsReferToNothing) {
  const MadeUpTakes takes(2);
  for (const char* change :
       {"UPDATE features SET segment = 999 WHERE take = 1",
        "UPDATE features SET feature_set = 999 WHERE take = 1",
        "UPDATE features SET take = 999 WHERE take = 1", "UPDATE annotations SET take = 999",
        "UPDATE labels SET take = 999 WHERE take = 1", "UPDATE segments SET id = 999"}) {
    SCOPED_TRACE(change);
    fs::remove_all(takes.library());
    takes.Import();
    ChangeLabels(takes.library(), {}, {.add = {"gym"}});
    StoreAnnotations(takes.library(), {},
                     std::vector<AnnotationRow>{{{.path = takes.files()[0].stem(),
                                                  .class_name = "wave",
                                                  .first_frame = 1,
                                                  .last_frame = 2}}},
                     "a.csv");
    ExecuteSql(takes.library(), change);
    const VerifyReport report = VerifyLibrary(takes.library());
    EXPECT_GT(report.damaged.size() + report.damaged_records.size(), 0U);
    RemoveTakes(takes.library(), {.damaged = true});
    RemoveDamagedRecords(takes.library());
    const VerifyReport mended = VerifyLibrary(takes.library());
    EXPECT_THAT(mended.damaged, IsEmpty());
    EXPECT_THAT(mended.damaged_records, IsEmpty());
    EXPECT_EQ(mended.orphaned_rows, 0);
    takes.Import();
    EXPECT_THAT(TakeLibrary(takes.library()).takes(), SizeIs(2));
    EXPECT_THAT(VerifyLibrary(takes.library()).damaged, IsEmpty());
  }
}

TEST(DamagedCatalogue, BlamesNoWordsForTheTakesThatTheyAreOf) {
  const MadeUpTakes takes(2);
  takes.Import();
  ChangeLabels(takes.library(), {.names = {takes.files()[0]}}, {.add = {"gym"}});
  ExecuteSql(takes.library(), "UPDATE labels SET label = 'gim'");
  const VerifyReport report = VerifyLibrary(takes.library());
  EXPECT_THAT(report.damaged, SizeIs(1));
  EXPECT_FALSE(report.words_are_damaged);
}

TEST(DamagedCatalogue, GetsItsWordsAnewByCompacting) {
  const MadeUpTakes takes(2);
  takes.Import();
  for (const char* change :
       {"UPDATE take_text SET class = 'wawe' WHERE rowid = 1", "DELETE FROM take_text",
        "UPDATE take_text_data SET block = zeroblob(40) WHERE id > 10",
        "DELETE FROM take_text_content WHERE id = 2"}) {
    SCOPED_TRACE(change);
    ExecuteSql(takes.library(), change);
    EXPECT_TRUE(VerifyLibrary(takes.library()).words_are_damaged);
    CompactLibrary(takes.library());
    EXPECT_FALSE(VerifyLibrary(takes.library()).words_are_damaged);
    EXPECT_THAT(TakeLibrary(takes.library()).Choose({.text = "wave 002"}), SizeIs(1));
  }
}

// Somebody else's SQL is not run, where it could run for ever.
TEST(DamagedCatalogue, WithViewsOrTriggersIsRefused) {
  const MadeUpTakes takes(1);
  takes.Import();
  const fs::path catalogue = takes.library() / "catalogue.sqlite";
  const std::string good = test::ReadText(catalogue);
  for (const char* change :
       {"CREATE TRIGGER more AFTER DELETE ON takes BEGIN DELETE FROM segments; END",
        "DROP TABLE features; CREATE VIEW features AS WITH RECURSIVE n(take) AS (SELECT 1 UNION "
        "ALL SELECT take + 1 FROM n) SELECT take, 1 AS feature_set, 1 AS rate_hz, 1 AS segment, "
        "1 AS slot, 1 AS poses FROM n"}) {
    test::WriteText(catalogue, good);
    ExecuteSql(takes.library(), change);
    const Error error = ErrorOf([&] { TakeLibrary opened(takes.library()); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    EXPECT_THAT(error.what(), HasSubstr("which Kinebase did not make"));
  }
}

}  // namespace
}  // namespace kinebase
