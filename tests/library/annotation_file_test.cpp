#include "kinebase/library/annotation_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "kinebase/core/output_file.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class LabelFile : public ::testing::Test {
 protected:
  std::vector<SegmentLabel> Read(std::string_view text) const {
    WriteFile(path_, text, Overwrite::kYes);
    return ReadSegmentLabels(path_);
  }

  std::string ErrorOf(std::string_view text) const {
    try {
      (void)Read(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "labels.csv";
};

TEST_F(LabelFile, KnowsBothForms) {
  EXPECT_THAT(Read("class,file,first_frame,last_frame\nsquat,gym/take.amc,3,9\n"),
              ElementsAre(SegmentLabel{"take", "squat", 3, 9, 2, "gym/take.amc"}));
  EXPECT_THAT(Read("trial,source,label,first_frame_1based,last_frame_1based\n01_01,x,jump,1,2\n"),
              ElementsAre(SegmentLabel{"01_01", "jump", 1, 2, 2, "01_01"}));
}

TEST_F(LabelFile, SaysWhatIsWrongWhere) {
  EXPECT_THAT(ErrorOf("file,class,first_frame,last_frame\na,b,0,9\n"), HasSubstr("labels.csv:2"));
  EXPECT_THAT(ErrorOf("file,class,first_frame,last_frame\na,b,soon,9\n"), HasSubstr("soon"));
  EXPECT_THAT(ErrorOf("file,class,first_frame,last_frame\na,b,9,3\n"),
              HasSubstr("comes before the first"));
  EXPECT_THAT(ErrorOf("file,class\na,b\n"), HasSubstr("first_frame"));
}

TEST(RealLabels, AreRead) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto labels = ReadSegmentLabels(test::TestData("data/cmu/labels/frame_segments_120hz.csv"));
  ASSERT_FALSE(labels.empty());
  EXPECT_EQ(labels.front(), (SegmentLabel{"01_01", "jump", 165, 302, 2, "01_01"}));
}

TEST(FormatElan, HoldsTimesAndTiers) {
  const std::vector<AnnotationTier> tiers = {{"arms", {{0.5, 1.2345, "wave & <clap>"}}},
                                             {"legs", {{0, 1, "walk"}, {1, 2, "run"}}}};
  const std::string text =
      FormatElan(tiers, {.date = "2026-01-31T12:00:00+00:00", .recording = "a/take.amc"});
  // Written out by hand from the format's description.
  EXPECT_EQ(text, R"(<?xml version="1.0" encoding="UTF-8"?>
<ANNOTATION_DOCUMENT AUTHOR="kinebase" DATE="2026-01-31T12:00:00+00:00" FORMAT="3.0" VERSION="3.0"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xsi:noNamespaceSchemaLocation="http://www.mpi.nl/tools/elan/EAFv3.0.xsd">
  <HEADER MEDIA_FILE="" TIME_UNITS="milliseconds">
    <PROPERTY NAME="lastUsedAnnotationId">3</PROPERTY>
    <PROPERTY NAME="recording">take.amc</PROPERTY>
  </HEADER>
  <TIME_ORDER>
    <TIME_SLOT TIME_SLOT_ID="ts1" TIME_VALUE="0"/>
    <TIME_SLOT TIME_SLOT_ID="ts2" TIME_VALUE="500"/>
    <TIME_SLOT TIME_SLOT_ID="ts3" TIME_VALUE="1000"/>
    <TIME_SLOT TIME_SLOT_ID="ts4" TIME_VALUE="1000"/>
    <TIME_SLOT TIME_SLOT_ID="ts5" TIME_VALUE="1235"/>
    <TIME_SLOT TIME_SLOT_ID="ts6" TIME_VALUE="2000"/>
  </TIME_ORDER>
  <TIER LINGUISTIC_TYPE_REF="motion" TIER_ID="arms">
    <ANNOTATION>
      <ALIGNABLE_ANNOTATION ANNOTATION_ID="a1" TIME_SLOT_REF1="ts2" TIME_SLOT_REF2="ts5">
        <ANNOTATION_VALUE>wave &amp; &lt;clap&gt;</ANNOTATION_VALUE>
      </ALIGNABLE_ANNOTATION>
    </ANNOTATION>
  </TIER>
  <TIER LINGUISTIC_TYPE_REF="motion" TIER_ID="legs">
    <ANNOTATION>
      <ALIGNABLE_ANNOTATION ANNOTATION_ID="a2" TIME_SLOT_REF1="ts1" TIME_SLOT_REF2="ts3">
        <ANNOTATION_VALUE>walk</ANNOTATION_VALUE>
      </ALIGNABLE_ANNOTATION>
    </ANNOTATION>
    <ANNOTATION>
      <ALIGNABLE_ANNOTATION ANNOTATION_ID="a3" TIME_SLOT_REF1="ts4" TIME_SLOT_REF2="ts6">
        <ANNOTATION_VALUE>run</ANNOTATION_VALUE>
      </ALIGNABLE_ANNOTATION>
    </ANNOTATION>
  </TIER>
  <LINGUISTIC_TYPE GRAPHIC_REFERENCES="false" LINGUISTIC_TYPE_ID="motion" TIME_ALIGNABLE="true"/>
</ANNOTATION_DOCUMENT>
)");
}

TEST(FormatElan, HasNothingThatXmlCannotHold) {
  const std::vector<AnnotationTier> tiers = {{"a\x01\xFF", {}}};
  EXPECT_THAT(FormatElan(tiers, {}), HasSubstr("TIER_ID=\"a \xEF\xBF\xBD\""));
}

TEST(FormatElan, RefusesTiersThatElanWould) {
  const std::vector<AnnotationTier> twins = {{"a", {}}, {"a", {}}};
  EXPECT_THROW((void)FormatElan(twins, {}), Error);
  const std::vector<AnnotationTier> overlapping = {{"a", {{0, 1, "x"}, {0.5, 2, "y"}}}};
  EXPECT_THROW((void)FormatElan(overlapping, {}), Error);
  const std::vector<AnnotationTier> backwards = {{"a", {{1, 0, "x"}}}};
  EXPECT_THROW((void)FormatElan(backwards, {}), Error);
}

}  // namespace
}  // namespace kinebase
