// Templates and annotations that are kept in a library.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kinebase/library/library_annotations.h"
#include "kinebase/library/library_templates.h"
#include "kinebase/library/library_upkeep.h"
#include "library/made_up_takes.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using test::ErrorOf;
using test::MadeUpTakes;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

MotionTemplate TemplateCalled(const std::string& name) {
  MotionTemplate made{.name = name, .feature_set = "bonn"};
  made.feature_set_hash = LoadFeatureSet("bonn").hash;
  made.matrix.rate_hz = 30;
  made.matrix.feature_count = 39;
  made.matrix.values.assign(std::size_t{2} * 39, 0.25);
  made.matrix.values[3] = 1.0 / 3;
  made.matrix.weights.assign(2, 1);
  return made;
}

TEST(StoredTemplates, AreThoseThatWereStored) {
  const MadeUpTakes takes(1);
  takes.Import();
  const std::vector<MotionTemplate> made = {TemplateCalled("wave"), TemplateCalled("kick")};
  StoreTemplates(takes.library(), made, Overwrite::kNo);
  EXPECT_EQ(LoadTemplate(takes.library(), "wave"), made[0]);
  const auto listed = ListTemplates(takes.library());
  ASSERT_THAT(listed, SizeIs(2));
  EXPECT_EQ(listed[0].name, "kick");
  EXPECT_EQ(listed[0].feature_set_hash, made[1].feature_set_hash);
  EXPECT_GT(listed[0].stored_s, 1'700'000'000);
  RemoveTemplates(takes.library(), std::vector<std::string>{"kick"});
  EXPECT_THAT(ListTemplates(takes.library()), SizeIs(1));
}

TEST(StoredTemplates, AreReplacedOnlyWhereThatIsAskedFor) {
  const MadeUpTakes takes(1);
  takes.Import();
  MotionTemplate made = TemplateCalled("wave");
  StoreTemplates(takes.library(), std::vector{made}, Overwrite::kNo);
  made.tau = 0.125;
  const Error taken =
      ErrorOf([&] { StoreTemplates(takes.library(), std::vector{made}, Overwrite::kNo); });
  EXPECT_EQ(taken.code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(taken.what(), AllOf(HasSubstr("'wave'"), HasSubstr("--force")));
  StoreTemplates(takes.library(), std::vector{made}, Overwrite::kYes);
  EXPECT_EQ(LoadTemplate(takes.library(), "wave").tau, 0.125);
  EXPECT_EQ(ErrorOf([&] {
              StoreTemplates(takes.library(), std::vector{made, made}, Overwrite::kYes);
            }).code(),
            ErrorCode::kInvalidArgument);
  EXPECT_THAT(ErrorOf([&] { (void)LoadTemplate(takes.library(), "kick"); }).what(),
              HasSubstr("no template 'kick'; there are: wave"));
}

class StoredAnnotationsTest : public testing::Test {
 protected:
  StoredAnnotationsTest() {
    takes_.Import();
    StoreTemplates(takes_.library(), std::vector{TemplateCalled("waving")}, Overwrite::kNo);
  }

  AnnotationReport Store(const std::string& rows, const TakeChoice& choice = {}) const {
    const std::string table = "file,class,first_frame,last_frame,cost,confidence,template\n" + rows;
    return StoreAnnotations(takes_.library(), choice, ParseAnnotationTable(table, "a.csv"),
                            "a.csv");
  }
  [[nodiscard]] std::vector<StoredAnnotation> List(const TakeChoice& choice = {}) const {
    return ListAnnotations(takes_.library(), choice).annotations;
  }

  MadeUpTakes takes_;
  std::string first_ = fs::canonical(takes_.files()[0]).string();
};

TEST_F(StoredAnnotationsTest, AreThoseOfTheTable) {
  const AnnotationReport report =
      Store(first_ + ",wave,3,9,0.025,0.75,waving\n" + "HDM_xx_wave_002_120.amc,wave,1,70,,,\n" +
            "HDM_xx_wave_002_120.amc,unknown,1,2,,,\n" + "elsewhere.amc,wave,1,7,,,\n");
  EXPECT_EQ(report.stored, 2);
  EXPECT_EQ(report.passed_over, 1);
  const auto listed = List();
  ASSERT_THAT(listed, SizeIs(2));
  EXPECT_EQ(listed[0].path, first_);
  EXPECT_EQ(listed[0].first_frame, 3);
  EXPECT_EQ(listed[0].last_frame, 9);
  EXPECT_EQ(listed[0].cost, 0.025);
  EXPECT_EQ(listed[0].confidence, 0.75);
  EXPECT_EQ(listed[0].template_name, "waving");
  EXPECT_EQ(listed[0].feature_set_hash, LoadFeatureSet("bonn").hash);
  EXPECT_EQ(listed[1].cost, std::nullopt);
  EXPECT_EQ(listed[1].feature_set_hash, 0U);
  // The table that is written is read again as it was.
  const TakeLibrary library(takes_.library());
  const std::string table = FormatAnnotationTable(listed, library.takes());
  EXPECT_THAT(table, HasSubstr(first_ + ",wave,3,9,0.016666666666666666,0.075,0.025,0.75,waving"));
  RemoveAnnotations(takes_.library(), {}, {});
  EXPECT_THAT(List(), IsEmpty());
  StoreAnnotations(takes_.library(), {}, ParseAnnotationTable(table, "b.csv"), "b.csv");
  EXPECT_EQ(FormatAnnotationTable(List(), library.takes()), table);
}

TEST_F(StoredAnnotationsTest, AreReplacedByThoseOfTheSameStretchAndTemplate) {
  Store(first_ + ",wave,3,9,0.025,,waving\n");
  Store(first_ + ",wave,3,9,-0.0,,waving\n" + first_ + ",wave,3,9,0.5,,other\n");
  ASSERT_THAT(List(), SizeIs(2));
  EXPECT_THAT(VerifyLibrary(takes_.library()).damaged_records, IsEmpty());
}

TEST_F(StoredAnnotationsTest, AreOfTheTemplateThatTheClassIsCalledAfter) {
  Store(first_ + ",waving,3,9,,,\n" + first_ + ",kick,3,9,,,\n");
  const auto listed = List();
  ASSERT_THAT(listed, SizeIs(2));
  EXPECT_EQ(listed[0].template_name, "");  // kick
  EXPECT_EQ(listed[1].template_name, "waving");
  EXPECT_EQ(listed[1].feature_set_hash, LoadFeatureSet("bonn").hash);
}

TEST_F(StoredAnnotationsTest, GoWithTheirTakeOrByChoice) {
  Store(
      "HDM_xx_wave_001_120,wave,3,9,,,\nHDM_xx_wave_002_120,wave,3,9,,,\n"
      "HDM_xx_wave_002_120,kick,3,9,,,\nHDM_xx_wave_003_120,wave,3,9,,,\n");
  EXPECT_EQ(RemoveAnnotations(takes_.library(), {.names = {takes_.files()[1]}},
                              std::vector<std::string>{"kick"}),
            1);
  RemoveTakes(takes_.library(), {.names = {takes_.files()[0]}});
  EXPECT_THAT(List(), SizeIs(2));
  EXPECT_THAT(List({.names = {takes_.files()[2]}}), SizeIs(1));
  test::WriteMadeUpTake(takes_.files()[2], 77, 44);
  EXPECT_EQ(takes_.Import().updated, 1);
  EXPECT_THAT(List(), SizeIs(2)) << "who imports a changed file is not asked to annotate it again";
}

TEST_F(StoredAnnotationsTest, OfTablesThatMakeNoSenseAreRefusedWithTheLine) {
  const auto refused = [&](const std::string& row) {
    return std::string(ErrorOf([&] { Store(row + "\n"); }).what());
  };
  EXPECT_THAT(refused(first_ + ",wave,0,9,,,"), HasSubstr("a.csv:2: first_frame '0'"));
  EXPECT_THAT(refused(first_ + ",wave,9,8,,,"), HasSubstr("a.csv:2: last_frame '8'"));
  EXPECT_THAT(refused(first_ + ",wave,1,41,,,"), HasSubstr("a.csv:2: frames 1-41"));
  EXPECT_THAT(refused(first_ + ",wave,1,4,much,,"), HasSubstr("cost 'much'"));
  EXPECT_THAT(refused(first_ + ",,1,4,,,"), HasSubstr("without a class"));
  EXPECT_THAT(refused("nobody,wave,1,4,,,"), HasSubstr("no recording that the library holds"));
  EXPECT_THAT(List(), IsEmpty());
}

TEST_F(StoredAnnotationsTest, WithDamageAreNamed) {
  Store(first_ + ",wave,3,9,0.025,,waving\n");
  test::ExecuteSql(takes_.library(), "UPDATE annotations SET cost = 0.0");
  test::ExecuteSql(takes_.library(), "UPDATE templates SET json = replace(json, '0.25', '0.75')");
  const VerifyReport report = VerifyLibrary(takes_.library());
  EXPECT_THAT(report.damaged, IsEmpty());
  EXPECT_THAT(report.damaged_records,
              ElementsAre("template 'waving'", HasSubstr("annotation 'wave', frames 3-9")));
  EXPECT_EQ(ErrorOf([&] { (void)LoadTemplate(takes_.library(), "waving"); }).code(),
            ErrorCode::kMalformedFile);
  // Of whatever take they are asked for: what they belong to is not known either.
  for (const auto& choice : {TakeChoice(), TakeChoice{.names = {takes_.files()[2]}}}) {
    const AnnotationList list = ListAnnotations(takes_.library(), choice);
    EXPECT_THAT(list.annotations, IsEmpty());
    ASSERT_THAT(list.failures, SizeIs(1));
    EXPECT_THAT(list.failures[0].error.what(), AllOf(HasSubstr("'wave'"), HasSubstr("--damaged")));
  }
  EXPECT_THAT(RemoveDamagedRecords(takes_.library()), SizeIs(2));
  EXPECT_THAT(VerifyLibrary(takes_.library()).damaged_records, IsEmpty());
  EXPECT_THAT(ListAnnotations(takes_.library(), {}).failures, IsEmpty());
  EXPECT_THAT(ListTemplates(takes_.library()), IsEmpty());
}

}  // namespace
}  // namespace kinebase
