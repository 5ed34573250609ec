// What a file holds besides its motion: it goes along where it can, and is named where it cannot.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "motion/c3d_recordings.h"
#include "motion/figure.h"
#include "motion/person.h"
#include "motion/recording_files.h"

namespace kinebase {
namespace {

using test::Messages;
using test::With;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class RecordLoss : public test::RecordingFiles {
 protected:
  // A pair of files with something to lose in every place where there can be.
  Recording Acclaim() {
    AsfSkeleton asf = test::FigureAsf();
    asf.comments = {"# by hand"};
    asf.mass_unit = 2;
    asf.documentation = {"Seen on Monday."};
    asf.unknown_root = {{"colour red"}};
    test::WriteText(PathOf("a.asf"), FormatAsf(asf));
    const Recording plain{.motion = test::SmoothMotion(test::FigureSkeleton(), 3, 6, 60)};
    const Recording saved =
        SaveAndLoad(plain, "b.amc", {.overwrite = Overwrite::kYes}, {.source_rate_hz = 60});
    AmcMotion amc = std::get<AcclaimRecord>(*saved.record).amc;
    amc.remarks = {{1, "# here he stumbles"}, {4, "# here he falls"}};
    amc.header.emplace_back(":MY-EXTENSION 7");
    return LoadText("a.amc", FormatAmc(amc), {.source_rate_hz = 60});
  }

  Recording Bvh() {
    const std::string text = test::BvhOf(
        test::MakePerson([](StandardJoint joint) { return std::string(ToString(joint)); }));
    return LoadText("a.bvh", With(text, "MOTION\n", "MOTION\nTake: 7\n"),
                    {.up_axis = UpAxis::kY, .units = "cm"});
  }

  // Four frames, the first of which is number 3.
  Recording Trc() {
    return LoadText("a.trc",
                    "PathFileType\t4\t(X/Y/Z)\ta.trc\n"
                    "DataRate\tNumFrames\tNumMarkers\tUnits\tOperator\n"
                    "60\t4\t1\tmm\tAda\nFrame#\tTime\tC7\t\t\n\t\tX1\tY1\tZ1\n\n"
                    "3\t0.0333\t1\t2\t3\n4\t0.05\t4\t5\t6\n5\t0.0667\t7\t8\t9\n"
                    "6\t0.0833\t1\t1\t1\n");
  }

  // Files are told apart by their numbers.
  std::vector<std::string> SaidOf(const Recording& recording, std::string_view extension,
                                  const SaveOptions& options = {}) {
    Save(recording, fmt::format("out{}{}", ++count_, extension), options);
    return Messages(diagnostics_);
  }

  int count_ = 0;
};

TEST_F(RecordLoss, OfAnAcclaimPairIsNamed) {
  const Recording pair = Acclaim();
  for (const char* extension : {".bvh", ".c3d", ".trc", ".csv", ".mot", ".sto", ".glb"}) {
    EXPECT_THAT(SaidOf(pair, extension),
                Contains(AllOf(HasSubstr("has no place for: the skeleton's documentation, its unit "
                                         "of mass, comments, lines of the ASF that are not "
                                         "understood, lines of the AMC that are not"))))
        << extension;
  }
  for (const char* extension : {".npz", ".mat"}) {
    EXPECT_THAT(SaidOf(pair, extension),
                Contains(HasSubstr("has no place for: comments, lines of the ASF")))
        << extension;
  }
  EXPECT_THAT(SaidOf(pair, ".amc"), Not(Contains(HasSubstr("no place"))));
}

TEST_F(RecordLoss, OfADocumentedSkeletonIsNamedWhereverItComesFrom) {
  const Recording from_npz = SaveAndLoad(Acclaim(), "c.npz");
  EXPECT_THAT(SaidOf(from_npz, ".bvh"), Contains(HasSubstr("BVH has no place for: the skeleton's "
                                                           "documentation, its unit of mass")));
  EXPECT_THAT(SaidOf(from_npz, ".amc"), Not(Contains(HasSubstr("no place"))));
}

TEST_F(RecordLoss, OfABvhIsNamed) {
  for (const char* extension : {".amc", ".npz", ".mat", ".glb", ".c3d"}) {
    EXPECT_THAT(SaidOf(Bvh(), extension),
                Contains(HasSubstr("no place for: lines that are not understood")))
        << extension;
  }
  EXPECT_THAT(SaidOf(Bvh(), ".bvh", {.units = "m"}),
              Contains(HasSubstr("in another world has no place for: lines that are not")));
  EXPECT_THAT(SaidOf(Bvh(), ".bvh"), Not(Contains(HasSubstr("no place"))));
}

TEST_F(RecordLoss, OfATrcIsNamed) {
  for (const char* extension : {".c3d", ".csm", ".npz", ".mat", ".csv"}) {
    EXPECT_THAT(SaidOf(Trc(), extension), Contains(HasSubstr("no place for: field 'Operator'")))
        << extension;
  }
  EXPECT_THAT(SaidOf(Trc(), ".trc"), Not(Contains(HasSubstr("no place"))));
}

TEST_F(RecordLoss, OfAC3dInATableOfChannelsIsNamed) {
  C3dRecording c3d = test::C3dOf({"C7"}, {{{1, 2, 3}}, {{1, 2, 4}}});
  c3d.channel_count = 1;
  c3d.subframe_count = 1;
  c3d.analog = {1, 2};
  SetEvents(c3d, std::vector<C3dEvent>{{.time_s = .01, .label = "Foot Strike"}});
  SetTextList(c3d, "SUBJECTS", "NAMES", std::vector<std::string>{"Ada"});
  test::WriteText(PathOf("a.c3d"), FormatC3d(c3d));
  const Recording loaded = LoadRecording(PathOf("a.c3d"));
  for (const char* extension : {".mot", ".sto"}) {
    EXPECT_THAT(SaidOf(loaded, extension),
                AllOf(Contains(HasSubstr("no place for: 1 events, residuals, parameters of "
                                         "SUBJECTS")),
                      Contains(HasSubstr("the 1 markers are not in this file"))));
  }
  EXPECT_THAT(SaidOf(loaded, ".c3d"), Not(Contains(HasSubstr("no place"))));
}

TEST_F(RecordLoss, OfPointsThatAreNoPlacesIsNamed) {
  C3dRecording c3d = test::C3dOf({"C7", "LHipAngles"}, {{{1, 2, 3}, {10, 0, 5}}});
  SetTextList(c3d, "POINT", "ANGLES", std::vector<std::string>{"LHipAngles"});
  test::WriteText(PathOf("a.c3d"), FormatC3d(c3d));
  const Recording loaded = LoadRecording(PathOf("a.c3d"));
  ASSERT_EQ(loaded.markers.marker_count(), 1);
  for (const char* extension : {".trc", ".csm", ".npz", ".mat", ".csv"}) {
    EXPECT_THAT(SaidOf(loaded, extension),
                Contains(HasSubstr("1 points that are angles, forces and the like")))
        << extension;
  }
  EXPECT_THAT(SaidOf(loaded, ".c3d"), Not(Contains(HasSubstr("no place"))));
}

TEST_F(RecordLoss, OfWhatDoesNotSayHowPointsAreStoredIsNamed) {
  C3dRecording c3d = test::C3dOf({"C7"}, {{{1, 2, 3}}});
  SetTextList(c3d, "POINT", "DESCRIPTIONS", std::vector<std::string>{" "});
  SetTextList(c3d, "SUBJECTS", "NAMES", std::vector<std::string>{"Ada"});
  test::WriteText(PathOf("a.c3d"), FormatC3d(c3d));
  EXPECT_THAT(SaidOf(LoadRecording(PathOf("a.c3d")), ".csm"),
              Contains(HasSubstr("no place for: residuals, parameters of SUBJECTS")));
  EXPECT_THAT(SaidOf(LoadRecording(PathOf("a.c3d")), ".csm"), Not(Contains(HasSubstr("POINT ("))));
  SetTextList(c3d, "POINT", "DESCRIPTIONS", std::vector<std::string>{"seventh vertebra"});
  test::WriteText(PathOf("b.c3d"), FormatC3d(c3d));
  EXPECT_THAT(SaidOf(LoadRecording(PathOf("b.c3d")), ".csm"),
              Contains(HasSubstr("parameters of SUBJECTS, POINT (DESCRIPTIONS)")));
}

TEST_F(RecordLoss, OfSpineLinksIsNamed) {
  const Recording csm =
      LoadText("a.csm", "$SpineLinks\n2\n$Rate\n60\n$Order\nC7\n$Points\n1 1 2 3\n");
  EXPECT_THAT(SaidOf(csm, ".c3d"), Contains(HasSubstr("no place for: the number of spine links")));
  EXPECT_THAT(SaidOf(csm, ".csm"), Not(Contains(HasSubstr("no place"))));
}

TEST_F(RecordLoss, OfNamesThatFitNothingOrRepeatIsNamed) {
  test::WriteText(PathOf("none.mnm"), "QQQQ ZZZZ\n");
  test::WriteText(PathOf("twice.mnm"), "LFHD RFHD\n");
  const Recording csm = LoadText("a.csm", "$Rate\n60\n$Order\nLFHD RFHD\n$Points\n1 1 2 3 4 5 6\n");
  for (const char* extension : {".c3d", ".trc", ".csm"}) {
    EXPECT_THAT(SaidOf(csm, extension, {.marker_names = PathOf("none.mnm")}),
                Contains(HasSubstr("fit none of the markers")))
        << extension;
    EXPECT_THAT(SaidOf(csm, extension, {.marker_names = PathOf("twice.mnm")}),
                Contains(HasSubstr("more than one marker is called 'RFHD'")))
        << extension;
  }
}

TEST_F(RecordLoss, OfTheWorldOfABvhIsNamedWhereReadersGuessWrong) {
  // A figure of one arm tells neither its unit nor what is up.
  const Recording arm =
      LoadText("arm.bvh",
               "HIERARCHY\nROOT Base\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n"
               "End Site\n{\nOFFSET 0 20 3\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.04\n0 0 0\n",
               {.up_axis = UpAxis::kY, .units = "cm"});
  EXPECT_THAT(SaidOf(arm, ".bvh", {.up_axis = UpAxis::kZ, .units = "m"}),
              Contains(HasSubstr("read this file with --source-up z --source-units m")));
  EXPECT_THAT(SaidOf(Bvh(), ".bvh", {.up_axis = UpAxis::kZ, .units = "m"}),
              Not(Contains(HasSubstr("read this file with"))));
}

TEST_F(RecordLoss, OfAnotherRateIsNamed) {
  EXPECT_THAT(Messages(ResampleRecording(Acclaim(), 30).diagnostics),
              Contains(HasSubstr("at another rate has no place for: comments, lines of the ASF")));
  EXPECT_THAT(Messages(ResampleRecording(Trc(), 30).diagnostics),
              Contains(HasSubstr("at another rate has no place for: field 'Operator'")));
}

TEST_F(RecordLoss, IsNoneInAStretchOfAnAcclaimPair) {
  const Recording again =
      SaveAndLoad(CutRecording(Acclaim(), 3, 5), "cut.amc", {}, {.source_rate_hz = 60});
  const auto& [asf, amc] = std::get<AcclaimRecord>(*again.record);
  EXPECT_THAT(asf.comments, ElementsAre("# by hand"));
  EXPECT_THAT(asf.unknown_root, ElementsAre(AsfUnknown{"colour red"}));
  ASSERT_EQ(amc.remarks.size(), 1);
  EXPECT_EQ(amc.remarks[0].text, "# here he falls");
  EXPECT_EQ(amc.remarks[0].frame, 1);
  EXPECT_THAT(amc.frame_numbers, ElementsAre(4, 5, 6));
  const Recording before = Acclaim();
  const AmcMotion& whole = std::get<AcclaimRecord>(*before.record).amc;
  const std::size_t skipped = 3 * whole.column_count;
  EXPECT_EQ(amc.values, std::vector(whole.values.begin() + static_cast<std::ptrdiff_t>(skipped),
                                    whole.values.end()));
}

TEST_F(RecordLoss, IsNoneInAStretchOfABvh) {
  const Recording whole =
      SaveAndLoad({.motion = test::SmoothMotion(test::FigureSkeleton(), 3, 6, 60)}, "a.bvh");
  const std::string text = With(test::ReadText(PathOf("a.bvh")), "MOTION\n", "MOTION\nTake: 7\n");
  const Recording again = SaveAndLoad(CutRecording(LoadText("b.bvh", text), 1, 4), "c.bvh");
  EXPECT_THAT(Messages(diagnostics_), ElementsAre(HasSubstr("first is number 2")));
  const auto& bvh = std::get<BvhMotion>(*again.record);
  EXPECT_THAT(bvh.unknown, ElementsAre("Take: 7"));
  EXPECT_EQ(bvh.declared_frame_count, 4);
  const auto& all = std::get<BvhMotion>(*whole.record);
  const auto columns = static_cast<std::ptrdiff_t>(all.column_count);
  EXPECT_EQ(bvh.values, std::vector(all.values.begin() + columns, all.values.end() - columns));
}

// What fills the gap stands before the stretch.
TEST_F(RecordLoss, IsNoneInAStretchThatBeginsInAGap) {
  const Recording whole = Acclaim();
  AmcMotion amc = std::get<AcclaimRecord>(*whole.record).amc;
  for (std::size_t frame = 2; frame < 4; ++frame) {
    for (std::size_t i = 0; i < 6; ++i) {
      amc.values[frame * amc.column_count + i] = std::nan("");
    }
  }
  const Recording gap = LoadText("a.amc", FormatAmc(amc), {.source_rate_hz = 60});
  const Recording again =
      SaveAndLoad(CutRecording(gap, 3, 5), "cut.amc", {}, {.source_rate_hz = 60});
  EXPECT_EQ(std::get<AcclaimRecord>(*again.record).asf.comments,
            std::get<AcclaimRecord>(*whole.record).asf.comments);
  EXPECT_LE((again.motion.root_position_cm[0] - gap.motion.root_position_cm[1]).norm(), 1e-6);
}

TEST_F(RecordLoss, IsNoneInAStretchOfATrc) {
  const Recording again = SaveAndLoad(CutRecording(Trc(), 1, 2), "cut.trc");
  const auto& trc = std::get<TrcRecording>(*again.record);
  EXPECT_THAT(trc.other_fields, ElementsAre(TrcField{"Operator", "Ada"}));
  EXPECT_THAT(trc.frame_numbers, ElementsAre(4, 5));
  EXPECT_THAT(trc.times_s, ElementsAre(.05, .0667));
  EXPECT_THAT(trc.values, ElementsAre(4, 5, 6, 7, 8, 9));
}

TEST_F(RecordLoss, OfOptionsThatAnAcclaimPairDoesNotNeedIsNamed) {
  (void)Acclaim();
  const Recording told =
      LoadRecording(PathOf("a.amc"), {.source_rate_hz = 60, .up_axis = UpAxis::kZ, .units = "mm"});
  EXPECT_THAT(Messages(told.diagnostics), Contains(HasSubstr("--source-up are not followed")));
}

}  // namespace
}  // namespace kinebase
