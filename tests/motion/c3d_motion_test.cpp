// What the points of a C3D mean: units, axes, and which are there.

#include "kinebase/motion/c3d_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "fmt/format.h"
#include "motion/c3d_recordings.h"
#include "motion/recording_files.h"

namespace kinebase {
namespace {

using Eigen::Vector3d;
using test::C3dOf;
using test::Messages;
using test::SetText;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Two markers that lie `size` apart along z.
C3dRecording Apart(float size) { return C3dOf({"a", "b"}, {{{1, 2, 3}, {1, 2, 3 + size}}}); }

std::string UnitsOf(const C3dRecording& c3d, std::string_view told = {}) {
  C3dRecording copy = c3d;
  if (!told.empty()) SetText(copy, "UNITS", told);
  Diagnostics diagnostics;
  std::string units = FindUnits(copy, diagnostics);
  // A guess is reported, and only that.
  const bool is_guess = copy.points.empty() || told.empty() || told == "cubit";
  EXPECT_EQ(diagnostics.size(), is_guess ? 1 : 0) << told;
  return units;
}

TEST(C3dUnits, AreThoseOfTheFile) {
  const std::pair<const char*, const char*> units[] = {{"mm", "mm"}, {"MM ", "mm"}, {"cm", "cm"},
                                                       {"m", "m"},   {"mete", "m"}, {"mill", "mm"},
                                                       {"in", "in"}, {"cent", "cm"}};
  for (const auto& [told, read] : units) EXPECT_EQ(UnitsOf(Apart(1800), told), read);
}

TEST(C3dUnits, AreGuessedByTheSizeOfWhatIsThere) {
  EXPECT_EQ(UnitsOf(Apart(1800)), "mm");
  EXPECT_EQ(UnitsOf(Apart(180)), "cm");
  EXPECT_EQ(UnitsOf(Apart(1.8F)), "m");
  EXPECT_EQ(UnitsOf(Apart(180), "cubit"), "cm");
}

UpAxis UpOf(const C3dRecording& c3d, std::size_t messages) {
  Diagnostics diagnostics;
  const UpAxis up = FindUpAxis(c3d, diagnostics);
  EXPECT_EQ(diagnostics.size(), messages);
  return up;
}

TEST(C3dUpAxis, IsThatOfTheScreen) {
  C3dRecording c3d = Apart(1800);
  const std::pair<const char*, UpAxis> screens[] = {
      {"+Z", UpAxis::kZ}, {"+Y", UpAxis::kY}, {"X", UpAxis::kX}, {"+z ", UpAxis::kZ}};
  for (const auto& [screen, up] : screens) {
    SetText(c3d, "X_SCREEN", "+X");
    SetText(c3d, "Y_SCREEN", screen);
    EXPECT_EQ(UpOf(c3d, 0), up) << screen;
  }
  SetText(c3d, "Y_SCREEN", "-Z");
  EXPECT_EQ(UpOf(c3d, 1), UpAxis::kZ);
}

TEST(C3dUpAxis, IsToldByHeadAndFeetElseBySpread) {
  EXPECT_EQ(
      UpOf(C3dOf({"Ada:LFHD", "Ada:RTOE", "x"}, {{{9, 1700, 5}, {8, 50, 3}, {9e3F, 1, 2}}}), 1),
      UpAxis::kY);
  EXPECT_EQ(UpOf(C3dOf({"a", "b"}, {{{1, 2, 3}, {1900, 2, 3}}}), 1), UpAxis::kX);
}

MarkerCloud Markers(const C3dRecording& c3d, Diagnostics& diagnostics,
                    const C3dBuildOptions& options = {.rate_hz = 100}) {
  return BuildMarkers(c3d, options, diagnostics);
}

TEST(C3dMarkers, AreCentimetresWithYUpAndKeepTheirLabels) {
  C3dRecording c3d = C3dOf({"Ada:LFHD", "Ada:LFHD", "C7"}, {{{10, 20, 30}, {1, 1, 1}, {2, 2, 2}}});
  c3d.first_frame = 301;
  Diagnostics diagnostics;
  const MarkerCloud markers = Markers(c3d, diagnostics);
  EXPECT_THAT(markers.labels, ElementsAre("Ada:LFHD", "Ada:LFHD", "C7"));
  EXPECT_EQ(markers.FindMarker("lfhd"), 0);
  EXPECT_EQ(markers.first_frame, 301);
  EXPECT_EQ(markers.rate_hz, 100);
  EXPECT_TRUE(markers.at(0, 0).isApprox(Vector3d(2, 3, 1)));
  EXPECT_TRUE(Markers(c3d, diagnostics, {.rate_hz = 100, .cm_per_unit = 100, .up = UpAxis::kY})
                  .at(0, 0)
                  .isApprox(Vector3d(1000, 2000, 3000)));
  EXPECT_THAT(diagnostics, IsEmpty());
}

TEST(C3dMarkers, AreMissingOrFilledAsTheirFourthWordAndPlaceSay) {
  C3dRecording c3d = C3dOf({"a"}, {{{1, 1, 1}},
                                   {{1, 1, 1}},
                                   {{0, 0, 0}},
                                   {{kNaN, 1, 1}},
                                   {{1, 1, 1}},
                                   {{1, 1, 1}},
                                   {{1, kNaN, 1}}});
  c3d.points[1].quality = -1;
  c3d.points[4].quality = 0;        // Filled.
  c3d.points[5].quality = 3 * 256;  // Filled although two cameras saw it.
  c3d.points[6].quality = -1;       // Not there, whatever stands there.
  Diagnostics diagnostics;
  const MarkerCloud markers = Markers(c3d, diagnostics);
  using enum MarkerState;
  EXPECT_THAT(markers.states,
              ElementsAre(kMeasured, kMissing, kMissing, kMissing, kFilled, kFilled, kMissing));
  for (const int frame : {1, 2, 3, 6}) EXPECT_TRUE(markers.at(frame, 0).array().isNaN().all());
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("(0, 0, 0)")));
}

TEST(C3dMarkers, AreOnlyThePointsThatArePlaces) {
  C3dRecording c3d = C3dOf({"LKNE", "LKneeAngles", "LGRF"}, {{{1, 2, 3}, {45, 0, 0}, {0, 0, 800}}});
  SetTextList(c3d, "POINT", "ANGLES", std::vector<std::string>{"LKneeAngles"});
  SetTextList(c3d, "POINT", "FORCES", std::vector<std::string>{"LGRF"});
  Diagnostics diagnostics;
  EXPECT_THAT(Markers(c3d, diagnostics).labels, ElementsAre("LKNE"));
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("2 of 3 points")));
}

// --- The way back.

MarkerCloud Cloud() {
  return {.labels = {"Ada:LFHD", "C7"},
          .rate_hz = 50,
          .frame_count = 2,
          .first_frame = 9,
          .positions_cm = {{1, 2, 3}, {-4.5, 98, 7}, MissingPosition(), {0, 1, 0}},
          .states = {MarkerState::kMeasured, MarkerState::kFilled, MarkerState::kMissing,
                     MarkerState::kMeasured}};
}

void ExpectSame(const MarkerCloud& a, const MarkerCloud& b, double tolerance_cm) {
  EXPECT_EQ(a.labels, b.labels);
  EXPECT_EQ(a.rate_hz, b.rate_hz);
  EXPECT_EQ(a.frame_count, b.frame_count);
  EXPECT_EQ(a.first_frame, b.first_frame);
  EXPECT_EQ(a.states, b.states);
  ASSERT_EQ(a.positions_cm.size(), b.positions_cm.size());
  for (std::size_t i = 0; i < a.positions_cm.size(); ++i) {
    if (a.states[i] == MarkerState::kMissing) continue;
    EXPECT_LE((a.positions_cm[i] - b.positions_cm[i]).norm(), tolerance_cm) << i;
  }
}

TEST(ToC3d, KeepsPlacesStatesAndNumbersInAnyWorld) {
  for (const auto& [units, cm] : {std::pair("mm", .1), {"m", 100.}, {"inch", 2.54}}) {
    for (const UpAxis up : {UpAxis::kX, UpAxis::kY, UpAxis::kZ}) {
      Diagnostics diagnostics;
      const C3dRecording c3d = ToC3d(Cloud(), {.units = units, .up = up}, diagnostics);
      const C3dRecording read = ParseC3d(FormatC3d(c3d), "a.c3d");
      EXPECT_EQ(FindUnits(read, diagnostics), units);
      EXPECT_EQ(FindUpAxis(read, diagnostics), up);
      EXPECT_THAT(diagnostics, IsEmpty());
      EXPECT_THAT(read.diagnostics, IsEmpty());
      // A float has 24 bits: 98 cm to within 4e-6 cm.
      ExpectSame(Markers(read, diagnostics, {.rate_hz = 50, .cm_per_unit = cm, .up = up}), Cloud(),
                 1e-5);
    }
  }
}

TEST(ToC3d, KeepsWhatABaseKnowsAboutMeasuredPoints) {
  C3dRecording base = C3dOf({"a", "angle"}, {{{10, 20, 30}, {45, 0, 0}}});
  SetTextList(base, "POINT", "ANGLES", std::vector<std::string>{"angle"});
  SetText(base, "UNITS", "mm");
  SetText(base, "X_SCREEN", "+Y");
  SetText(base, "Y_SCREEN", "+Z");
  Diagnostics diagnostics;
  const MarkerCloud markers = Markers(base, diagnostics);
  const C3dRecording written =
      ToC3d(markers, {.units = "cm", .base = {.recording = &base, .cm_per_unit = .1}}, diagnostics);
  EXPECT_EQ(written.point(0, 0), (C3dPoint{.x = 1, .y = 2, .z = 3, .quality = 256 + 2}));
  EXPECT_EQ(written.point(0, 1), base.point(0, 1));  // 45 degrees are 45 degrees in centimetres.
  EXPECT_FLOAT_EQ(written.scale, base.scale / 10);   // Residuals are lengths.
  // The axes did not change, so what the file says of its screen stays.
  EXPECT_EQ(FindParameter(written, "POINT", "X_SCREEN")->Strings().front(), "+Y");
  EXPECT_EQ(FindParameter(written, "POINT", "Y_SCREEN")->Strings().front(), "+Z");
}

TEST(ToC3d, LeavesOutWhatBelongsToOtherFrames) {
  C3dRecording base = C3dOf({"a"}, {{{1, 2, 3}}, {{1, 2, 4}}});
  base.channel_count = 2;
  base.subframe_count = 3;
  base.analog.assign(12, 1);
  SetEvents(base, std::vector<C3dEvent>{{.time_s = .01, .label = "Foot Strike"}});
  Diagnostics diagnostics;
  const MarkerCloud half = CutMarkers(Markers(base, diagnostics), 1, 1);
  const C3dRecording written = ToC3d(half, {.base = {.recording = &base}}, diagnostics);
  EXPECT_EQ(written.channel_count, 0);
  EXPECT_THAT(Events(written), IsEmpty());
  EXPECT_EQ(written.first_frame, 2);
  EXPECT_THAT(Messages(diagnostics), Contains(HasSubstr("2 analog channels and 1 events")));
}

// --- Through files.

using C3dFile = test::RecordingFiles;

TEST_F(C3dFile, HoldsMoreFramesAndLabelsThanItsHeaderCounts) {
  constexpr int kFrames = 70'000;
  Recording long_one{.markers = {.labels = {"a"}, .rate_hz = 200, .frame_count = kFrames}};
  for (int frame = 0; frame < kFrames; ++frame) {
    long_one.markers.positions_cm.emplace_back(1, 2, frame + 1);
  }
  long_one.markers.states.assign(kFrames, MarkerState::kMeasured);
  long_one.markers.first_frame = 5;
  ExpectSame(SaveAndLoad(long_one, "long.c3d").markers, long_one.markers, 1e-2);

  constexpr int kLabels = 700;
  Recording wide{.markers = {.rate_hz = 200, .frame_count = 1}};
  for (int i = 0; i < kLabels; ++i) {
    wide.markers.labels.push_back(fmt::format("Ada:marker{}", i));
    wide.markers.positions_cm.emplace_back(i, 2, 3);
  }
  wide.markers.states.assign(kLabels, MarkerState::kMeasured);
  const Recording again = SaveAndLoad(wide, "wide.c3d");
  ExpectSame(again.markers, wide.markers, 1e-4);
  // And as it was read.
  ExpectSame(SaveAndLoad(again, "copy.c3d").markers, wide.markers, 1e-4);
  EXPECT_EQ(test::ReadText(PathOf("copy.c3d")), test::ReadText(PathOf("wide.c3d")));
}

TEST_F(C3dFile, KeepsWhatTheUserSaidOfIt) {
  test::WriteText(PathOf("a.c3d"), FormatC3d(C3dOf({"a", "b"}, {{{1, 2, 3}, {1, 2, 903}}})));
  const Recording asked = LoadRecording(PathOf("a.c3d"), {.up_axis = UpAxis::kX, .units = "inch"});
  EXPECT_THAT(asked.diagnostics, IsEmpty());
  EXPECT_TRUE(asked.markers.at(0, 0).isApprox(Vector3d(3, 1, 2) * 2.54));
  const Recording again = SaveAndLoad(asked, "b.c3d");
  EXPECT_EQ(again.units, "inch");
  EXPECT_EQ(again.up_axis, "X");
  ExpectSame(again.markers, asked.markers, 1e-4);
}

TEST_F(C3dFile, KeepsEventsOfACutRightAndThoseOutsideOut) {
  C3dRecording c3d = C3dOf({"a"}, std::vector(10, std::vector<std::array<float, 3>>{{1, 2, 3}}));
  c3d.first_frame = 101;  // Frames 101 … 110 at 100 Hz: 1 s … 1.09 s.
  SetEvents(c3d, std::vector<C3dEvent>{{.time_s = 1.01, .label = "early"},
                                       {.time_s = 1.05, .label = "kept"},
                                       {.time_s = 1.09, .label = "late"},
                                       {.time_s = 1.06, .label = "head", .is_in_header = true}});
  test::WriteText(PathOf("cut.c3d"), FormatC3d(CutC3d(c3d, 4, 7)));
  const Recording cut = LoadRecording(PathOf("cut.c3d"));
  EXPECT_EQ(cut.first_frame(), 105);
  EXPECT_EQ(cut.frame_count(), 4);
  const auto events = Events(std::get<C3dRecording>(*cut.record));
  ASSERT_EQ(events.size(), 2);
  EXPECT_EQ(events[0].label, "kept");
  EXPECT_NEAR(events[0].time_s, 1.05, 1e-6);
  EXPECT_EQ(events[1].label, "head");
  EXPECT_NEAR(events[1].time_s, 1.06, 1e-6);
}

}  // namespace
}  // namespace kinebase
