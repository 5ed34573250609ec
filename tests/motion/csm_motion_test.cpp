// CSM and MNM as recordings: each point of docs/formats/csm.md about what a file means.

#include "kinebase/motion/csm_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/motion_file.h"
#include "motion/figure.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> Messages(const Diagnostics& diagnostics) {
  std::vector<std::string> messages;
  for (const auto& diagnostic : diagnostics) messages.push_back(diagnostic.message);
  return messages;
}

CsmRecording TwoMarkers() {
  return {.rate_hz = 60,
          .labels = {"LFHD", "RFHD"},
          .frame_numbers = {7, 8},
          .values = {10, 20, 30, 0, 0, 0, kNaN, kNaN, kNaN, kNaN, 1, 2}};
}

// Markers that hold what no format does exactly, and something missing.
MarkerCloud Cloud() {
  MarkerCloud cloud{.labels = {"Ada:LFHD", "Ada:C7"},
                    .rate_hz = 50,
                    .frame_count = 2,
                    .first_frame = 9,
                    .positions_cm = {{1, 2, 3},
                                     {1. / 3, -2. / 3, 100},
                                     MissingPosition(),
                                     {-1e-3, 98.06, -236.58}},
                    .states = {MarkerState::kMeasured, MarkerState::kFilled, MarkerState::kMissing,
                               MarkerState::kMeasured}};
  return cloud;
}

std::vector<std::string> RequiredLabels() {
  std::vector<std::string> labels;
  for (const auto& marker : PresetMarkers()) {
    using enum PresetMarker::Need;
    if (marker.need == kRequired || marker.need == kBand) labels.emplace_back(marker.name);
  }
  return labels;
}

std::string FileOf(const std::vector<std::string>& labels) {
  CsmRecording csm{.rate_hz = 60, .labels = labels, .frame_numbers = {1}};
  for (std::size_t i = 0; i < labels.size() * 3; ++i) {
    csm.values.push_back(1 + .5 * static_cast<double>(i));
  }
  return FormatCsm(csm);
}

// A file in a folder of its own.
class CsmFile : public testing::Test {
 protected:
  std::filesystem::path Write(std::string_view name, std::string_view text) {
    test::WriteText(folder_.path() / name, text);
    return folder_.path() / name;
  }

  test::TemporaryFolder folder_;
};

TEST(CsmMarkers, AreCentimetresWithYUp) {
  Diagnostics diagnostics;
  const MarkerCloud markers = BuildMarkers(TwoMarkers(), {.rate_hz = 60}, diagnostics);
  EXPECT_EQ(markers.rate_hz, 60);
  EXPECT_EQ(markers.frame_count, 2);
  EXPECT_EQ(markers.first_frame, 7);
  EXPECT_THAT(markers.labels, ElementsAre("LFHD", "RFHD"));
  // What pointed up, z, points up as y; the three axes stay right-handed.
  EXPECT_TRUE(markers.at(0, 0).isApprox(ToYUp(UpAxis::kZ) * Eigen::Vector3d(1, 2, 3)));
  EXPECT_DOUBLE_EQ(markers.at(0, 0).y(), 3);
}

TEST(CsmMarkers, AreMissingAtDropoutZeroOrInPart) {
  Diagnostics diagnostics;
  const MarkerCloud markers = BuildMarkers(TwoMarkers(), {.rate_hz = 60}, diagnostics);
  EXPECT_THAT(markers.states, ElementsAre(MarkerState::kMeasured, MarkerState::kMissing,
                                          MarkerState::kMissing, MarkerState::kMissing));
  for (const int marker : {0, 1}) EXPECT_TRUE(markers.at(1, marker).array().isNaN().all());
  EXPECT_THAT(Messages(diagnostics),
              ElementsAre("1 places at (0, 0, 0) are taken as missing",
                          "1 places with one or two values missing are taken as missing"));
}

TEST(CsmMarkers, ComeBackFromACsm) {
  const MarkerCloud cloud = Cloud();
  Diagnostics diagnostics;
  const CsmRecording csm = ToCsm(cloud, diagnostics);
  EXPECT_THAT(csm.labels, ElementsAre("LFHD", "C7"));
  EXPECT_THAT(csm.frame_numbers, ElementsAre(9, 10));
  EXPECT_EQ(csm.rate_hz, 50);
  EXPECT_DOUBLE_EQ(csm.Point(0, 0)[2], 20);  // Up, in millimetres.
  EXPECT_THAT(FormatCsm(csm), HasSubstr("10 DROPOUT "));
  EXPECT_THAT(Messages(diagnostics), ElementsAre(HasSubstr("'Ada:LFHD' as 'LFHD'")));
  const MarkerCloud again =
      BuildMarkers(ParseCsm(FormatCsm(csm), "a.csm"), {.rate_hz = 50}, diagnostics);
  EXPECT_EQ(again.first_frame, cloud.first_frame);
  for (int frame = 0; frame < 2; ++frame) {
    for (int marker = 0; marker < 2; ++marker) {
      ASSERT_EQ(again.is_missing(frame, marker), cloud.is_missing(frame, marker));
      if (cloud.is_missing(frame, marker)) continue;
      EXPECT_LT((again.at(frame, marker) - cloud.at(frame, marker)).norm(), 1e-7);
    }
  }
}

TEST(CsmMarkers, GetNamesThatTheFormatCanHold) {
  MarkerCloud cloud = Cloud();
  Diagnostics diagnostics;
  const auto names = [&](const std::string& a, const std::string& b) {
    cloud.labels = {a, b};
    diagnostics.clear();
    const CsmRecording csm = ToCsm(cloud, diagnostics);
    EXPECT_EQ(ParseCsm(FormatCsm(csm), "a.csm", {.strict = true}), csm);
    return csm.labels;
  };
  EXPECT_THAT(names("left knee", "a,b$"), ElementsAre("left_knee", "a_b_"));
  EXPECT_THAT(diagnostics, Not(IsEmpty()));
  EXPECT_THAT(names("", ""), ElementsAre("marker1", "marker2"));
  EXPECT_THAT(diagnostics, Not(IsEmpty()));
  EXPECT_THAT(names("C7", "C7"), ElementsAre("C7", "C7_2"));
  EXPECT_THAT(diagnostics, Not(IsEmpty()));
  EXPECT_THAT(names("Ada:C7", "Bob:C7"), ElementsAre("Ada:C7", "Bob:C7"));
  EXPECT_THAT(diagnostics, IsEmpty());
}

TEST(CsmPreset, ReportsMissingMarkersAndWhatIsLost) {
  EXPECT_THAT(Messages(CheckPreset(RequiredLabels())),
              ElementsAre(HasSubstr("optional markers are missing: SACR (the pelvis' tilt)")));
  std::vector<std::string> labels = RequiredLabels();
  std::erase(labels, "LMT5");
  std::erase(labels, "RWRB");
  labels.emplace_back("LHEE");
  const Diagnostics diagnostics = CheckPreset(labels);
  EXPECT_EQ(diagnostics.at(0).severity, Severity::kWarning);
  EXPECT_THAT(diagnostics.at(0).message, HasSubstr("LMT5 (the left foot's roll), RWRA and RWRB, or "
                                                   "RWRE and RWRI (the right wrist)"));
  EXPECT_EQ(diagnostics.at(1).severity, Severity::kInfo);
  EXPECT_EQ(diagnostics.at(2).message, "markers that the preset lacks: 'LHEE'");
}

TEST(CsmPreset, KnowsPropMarkersAndNamesInAnyCaseWithASubject) {
  std::vector<std::string> labels = RequiredLabels();
  for (auto& label : labels) label = "ada:" + ToLower(label);
  labels.emplace_back("MPRPT");
  EXPECT_EQ(CheckPreset(labels).size(), 1);
}

TEST(CsmPreset, AsksForMarkerNamesWhereItKnowsNone) {
  EXPECT_THAT(Messages(CheckPreset(std::vector<std::string>{"one", "two"})),
              ElementsAre(HasSubstr("an MNM file tells which is which")));
}

TEST(CsmPreset, TellsBandAndStickTogether) {
  const auto both = [](std::vector<std::string> labels) { return HasBandAndStick(labels); };
  EXPECT_TRUE(both({"LWRA", "LWRI"}));
  EXPECT_FALSE(both({"LWRA", "LWRB", "RWRE", "RWRI"}));
  EXPECT_FALSE(both({"LFHD"}));
}

TEST_F(CsmFile, IsLoadedWithItsRateUnitsAndAxis) {
  const Recording loaded = LoadRecording(Write("a.csm", FileOf(RequiredLabels())));
  EXPECT_EQ(loaded.format, "CSM");
  EXPECT_EQ(loaded.units, "mm");
  EXPECT_EQ(loaded.up_axis, "Z");
  EXPECT_EQ(loaded.rate_hz(), 60);
  EXPECT_FALSE(loaded.has_skeleton());
  EXPECT_TRUE(std::holds_alternative<CsmRecording>(*loaded.record));
}

TEST_F(CsmFile, WithoutARateHasTheOneOfItsNameOrTheOneAskedFor) {
  const std::string text = "$Order A\n$Points\n1 1 2 3\n";
  const auto path = Write("HDM_bd_01-01_01_90.csm", text);
  EXPECT_EQ(LoadRecording(path).rate_hz(), 90);
  EXPECT_EQ(LoadRecording(path, {.source_rate_hz = 30}).rate_hz(), 30);
  const Recording wrong = LoadRecording(Write("HDM_bd_01-01_01_90.csm", "$Rate 0\n" + text));
  EXPECT_EQ(wrong.rate_hz(), 90);
  EXPECT_THAT(Messages(wrong.diagnostics), Contains(HasSubstr("'$rate' says 0 Hz")));
}

TEST_F(CsmFile, ThatBreaksTheFormatIsReadAsTheUserSays) {
  const auto path = Write("a.csm", "$Rate 60\n$Order A\n$Points\n1 1 2 3\n");
  const Recording loaded = LoadRecording(path, {.up_axis = UpAxis::kY, .units = "m"});
  EXPECT_TRUE(loaded.markers.at(0, 0).isApprox(Eigen::Vector3d(100, 200, 300)));
  Diagnostics diagnostics;
  SaveRecording(loaded, folder_.path() / "b.csm", {}, diagnostics);
  EXPECT_TRUE(LoadRecording(folder_.path() / "b.csm")
                  .markers.at(0, 0)
                  .isApprox(Eigen::Vector3d(100, 200, 300)));
  EXPECT_EQ(test::ErrorOf([&] { (void)LoadRecording(path, {.units = "furlong"}); }).code(),
            ErrorCode::kInvalidArgument);
}

TEST_F(CsmFile, WithBandAndStickIsAnErrorWhenStrict) {
  std::vector<std::string> labels = RequiredLabels();
  labels.emplace_back("LWRE");
  const auto path = Write("a.csm", FileOf(labels));
  EXPECT_THAT(Messages(LoadRecording(path).diagnostics),
              Contains(HasSubstr("band and of a stick")));
  EXPECT_EQ(test::ErrorOf([&] { (void)LoadRecording(path, {.strict = true}); }).code(),
            ErrorCode::kMalformedFile);
}

TEST_F(CsmFile, GetsThePresetsNamesFromAnMnmFileAndGivesThemBack) {
  const std::string text = FileOf({"FrontLeft", "neck", "LWRA", "LWRB", "extra"});
  const auto csm = Write("a.csm", text);
  const auto mnm =
      Write("a.mnm", "LFHD FrontLeft\nC7 Neck\nLWRE LWRA\nLWRI LWRB\nRFHD FrontRight\n");
  const Recording loaded = LoadRecording(csm, {.marker_names = mnm});
  // The band stays a band, though the file gives it the stick's names.
  EXPECT_THAT(loaded.markers.labels, ElementsAre("LFHD", "C7", "LWRA", "LWRB", "extra"));
  EXPECT_THAT(Messages(loaded.diagnostics),
              Contains(HasSubstr("'LWRA' for 'LWRE', 'LWRB' for 'LWRI'")));
  Diagnostics diagnostics;
  SaveRecording(loaded, folder_.path() / "preset.csm", {}, diagnostics);
  EXPECT_EQ(ReadCsm(folder_.path() / "preset.csm").labels, loaded.markers.labels);
  SaveRecording(loaded, folder_.path() / "own.csm", {.marker_names = mnm}, diagnostics);
  EXPECT_THAT(ReadCsm(folder_.path() / "own.csm").labels,
              ElementsAre("FrontLeft", "Neck", "LWRA", "LWRB", "extra"));
  EXPECT_THAT(diagnostics, IsEmpty());
}

TEST_F(CsmFile, TellsWhatIsOddAboutAnMnmFile) {
  const auto csm = Write("a.csm", FileOf({"a", "b"}));
  const Recording loaded =
      LoadRecording(csm, {.marker_names = Write("a.mnm", "LFHD a\nRFHD\nC7 b\n")});
  EXPECT_THAT(Messages(loaded.diagnostics), Contains(HasSubstr("a.mnm:2: only one name")));
  const auto twice = Write("b.mnm", "LFHD a\nlfhd b\n");
  EXPECT_THAT(LoadRecording(csm, {.marker_names = twice}).markers.labels, ElementsAre("LFHD", "b"));
  const auto clash = Write("c.mnm", "b a\n");
  EXPECT_THAT(Messages(LoadRecording(csm, {.marker_names = clash}).diagnostics),
              Contains("more than one marker is called 'b'"));
}

TEST_F(CsmFile, IsWrittenBackWithAllThatItHolds) {
  const std::string text =
      "$Filename a.csm\n$CaptureDate 2001/02/03\n$Comments\nwords\n$FirstFrame 3\n$LastFrame 4\n"
      "$Rate 25\n$Talent inches head 7\n$Stage left\n$Order\nA B\n$Points\n3 1 2 3 0 0 0\n"
      "4 DROPOUT 1 nan 3\n";
  Diagnostics diagnostics;
  SaveRecording(LoadRecording(Write("a.csm", text)), folder_.path() / "b.csm", {}, diagnostics);
  EXPECT_EQ(test::ReadText(folder_.path() / "b.csm"), text);
  EXPECT_THAT(diagnostics, IsEmpty());
}

TEST_F(CsmFile, KeepsWhatItHoldsWhenItsWorldIsMended) {
  const Recording loaded =
      LoadRecording(Write("a.csm", "$Actor Ada\n$Stage left\n$Order A\n$Points\n1 1 2 3\n"),
                    {.source_rate_hz = 30, .up_axis = UpAxis::kY});
  Diagnostics diagnostics;
  SaveRecording(loaded, folder_.path() / "b.csm", {}, diagnostics);
  const CsmRecording csm = ReadCsm(folder_.path() / "b.csm");
  EXPECT_EQ(csm.actor, "Ada");
  EXPECT_EQ(csm.unknown_sections.size(), 1);
  EXPECT_EQ(csm.rate_hz, 30);
  EXPECT_DOUBLE_EQ(csm.values[2], 2);
}

TEST_F(CsmFile, IsMadeOfOtherMarkers) {
  Recording recording{.path = "take.c3d", .format = "C3D", .markers = Cloud()};
  recording.name.actor = "bd";
  Diagnostics diagnostics;
  SaveRecording(recording, folder_.path() / "b.csm", {}, diagnostics);
  const CsmRecording csm = ReadCsm(folder_.path() / "b.csm");
  EXPECT_EQ(csm.file_name, "b.csm");
  EXPECT_EQ(csm.actor, "bd");
  EXPECT_EQ(csm.declared_first_frame, 9);
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("1 are written like these")));
}

TEST_F(CsmFile, IsNotMadeOfASkeleton) {
  Recording recording{.path = "take.amc", .format = "ASF/AMC"};
  recording.motion = test::SmoothMotion(test::FigureSkeleton(), 1, 2, 60);
  Diagnostics diagnostics;
  const Error error =
      test::ErrorOf([&] { SaveRecording(recording, folder_.path() / "b.csm", {}, diagnostics); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.message(), HasSubstr("BVH"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "b.csm"));
}

TEST_F(CsmFile, HasOneWorldOnly) {
  Recording recording{.path = "take.c3d", .format = "C3D", .markers = Cloud()};
  Diagnostics diagnostics;
  const auto save = [&](const SaveOptions& options) {
    SaveRecording(recording, folder_.path() / "b.csm", options, diagnostics);
  };
  for (const SaveOptions& options :
       {SaveOptions{.up_axis = UpAxis::kY}, SaveOptions{.units = "cm"}}) {
    EXPECT_EQ(test::ErrorOf([&] { save(options); }).code(), ErrorCode::kInvalidArgument);
  }
  save({.up_axis = UpAxis::kZ, .units = "millimeters"});
  EXPECT_EQ(test::ErrorOf([&] { save({}); }).code(), ErrorCode::kAlreadyExists);
}

TEST(CsmRealFile, HasAManOfHumanSize) {
  KINEBASE_NEEDS_TEST_DATA();
  const Recording loaded =
      LoadRecording(test::TestData("data/csm/ThomasFechten.csm"), {.strict = true});
  EXPECT_EQ(loaded.frame_count(), 2439);
  EXPECT_EQ(loaded.rate_hz(), 120);
  EXPECT_THAT(Messages(loaded.diagnostics),
              ElementsAre(HasSubstr("optional markers are missing: SACR"),
                          "markers that the preset lacks: 'RBAC', 'LUPA', 'LFRM', 'RUPA', 'RFRM', "
                          "'LPel', 'RPel', 'LTHI', 'LSHN', 'RTHI', 'RSHN'"));
  const MarkerCloud& markers = loaded.markers;
  const double head = markers.at(0, *markers.FindMarker("LFHD")).y();
  const double toe = markers.at(0, *markers.FindMarker("LTOE")).y();
  EXPECT_NEAR(head - toe, 159.3, .1);
  // Both arms are stretched out to the sides, the left one to the actor's left.
  const Eigen::Vector3d right_to_left =
      markers.at(0, *markers.FindMarker("LFIN")) - markers.at(0, *markers.FindMarker("RFIN"));
  const Eigen::Vector3d back_to_front =
      markers.at(0, *markers.FindMarker("STRN")) - markers.at(0, *markers.FindMarker("T10"));
  EXPECT_NEAR(right_to_left.norm(), 155.5, 1);
  EXPECT_GT(Eigen::Vector3d::UnitY().cross(back_to_front.normalized()).dot(right_to_left), 100);
}

TEST(CsmRealFile, IsWrittenBackTheSame) {
  KINEBASE_NEEDS_TEST_DATA();
  const test::TemporaryFolder folder;
  for (const auto& file : test::FilesBelow(test::TestData("data"), ".csm")) {
    const auto copy = folder.path() / file.filename();
    Diagnostics diagnostics;
    SaveRecording(LoadRecording(file, {.source_rate_hz = 60}), copy, {}, diagnostics);
    CsmRecording expected = ReadCsm(file);
    if (!expected.rate_hz) expected.rate_hz = 60;
    EXPECT_EQ(ReadCsm(copy), expected) << file;
    EXPECT_THAT(diagnostics, IsEmpty());
  }
}

}  // namespace
}  // namespace kinebase
