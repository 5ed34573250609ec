// Parameters: damaged chains, lists that go on, editing; events and force plates made of them.

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "formats/c3d_bytes.h"
#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

using test::ErrorOf;
using test::RawC3d;

bool HasDiagnostic(const C3dRecording& c3d, std::string_view part) {
  for (const Diagnostic& each : c3d.diagnostics) {
    if (each.message.find(part) != std::string::npos) return true;
  }
  return false;
}

// A file of one frame, to which a test adds parameters.
RawC3d OneFrame() {
  RawC3d raw;
  raw.points = {{1, 2, 3, 0}};
  raw.AddUsualParameters();
  return raw;
}

C3dRecording Read(const RawC3d& raw) { return ParseC3d(raw.Bytes(), "raw.c3d"); }

TEST(C3dParameters, KeepTypesDimensionsDescriptionsAndLocks) {
  RawC3d raw = OneFrame();
  raw.Group(9, "MINE", "what it is for");
  raw.Parameter(9, "Bytes", 1, {2, 2}, "\1\2\3\xff", -1, "four");
  raw.Integers(9, "WORDS", {3}, {1, -2, 40000});
  raw.Reals(9, "REALS", {}, {2.5});
  raw.Texts(9, "TEXTS", 4, {"ab", "", "cd  ", "efgh"});
  raw.Text(9, "EMPTY", "");
  // A negative length of the name is a lock.
  raw.records += std::string{static_cast<char>(-3), 9} + "KEY" + raw.numbers().Word(7) +
                 std::string{1, 0, 5, 1, 'k'};
  const C3dRecording c3d = Read(raw);
  const C3dGroup* group = FindGroup(c3d, "mine");
  ASSERT_NE(group, nullptr);
  EXPECT_EQ(group->id, 9);
  EXPECT_EQ(group->description, "what it is for");
  const C3dParameter* bytes = FindParameter(c3d, "MINE", "bytes");
  ASSERT_NE(bytes, nullptr);
  EXPECT_EQ(bytes->name, "Bytes");
  EXPECT_EQ(bytes->description, "four");
  EXPECT_EQ(bytes->dimensions, (std::vector<std::uint8_t>{2, 2}));
  EXPECT_EQ(bytes->Number(3), -1);
  EXPECT_EQ(bytes->UnsignedNumber(3), 255);
  EXPECT_EQ(bytes->Number(4), std::nullopt);
  EXPECT_EQ(FindParameter(c3d, "MINE", "WORDS")->UnsignedNumber(2), 40000);
  EXPECT_EQ(FindParameter(c3d, "MINE", "REALS")->Number(), 2.5);
  EXPECT_EQ(FindParameter(c3d, "MINE", "TEXTS")->Strings(),
            (std::vector<std::string>{"ab", "", "cd", "efgh"}));
  EXPECT_EQ(FindParameter(c3d, "MINE", "TEXTS")->Number(), std::nullopt);
  EXPECT_EQ(FindParameter(c3d, "MINE", "EMPTY")->size(), 0);
  ASSERT_NE(FindParameter(c3d, "MINE", "KEY"), nullptr);
  EXPECT_TRUE(FindParameter(c3d, "MINE", "KEY")->is_locked);
  EXPECT_EQ(FindParameter(c3d, "MINE", "KEY")->description, "k");
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d"), c3d);
}

TEST(C3dParameters, EndWhereARecordHasNoSuccessor) {
  RawC3d raw = OneFrame();
  raw.Parameter(1, "LAST", 2, {}, raw.numbers().Word(5), 0);
  raw.Integer(1, "GHOST", 6);
  const C3dRecording c3d = Read(raw);
  EXPECT_NE(FindParameter(c3d, "POINT", "LAST"), nullptr);
  EXPECT_EQ(FindParameter(c3d, "POINT", "GHOST"), nullptr);
}

TEST(C3dParameters, GoOnBeyondTheBlocksThatAreDeclared) {
  RawC3d raw = OneFrame();
  for (int i = 0; i < 9; ++i) raw.Text(1, "FILL" + std::to_string(i), std::string(100, 'x'));
  raw.declared_blocks = 1;
  const C3dRecording c3d = Read(raw);
  EXPECT_NE(FindParameter(c3d, "POINT", "FILL8"), nullptr);
  EXPECT_TRUE(HasDiagnostic(c3d, "more than the 1 blocks"));
  EXPECT_EQ(c3d.points[0].x, 1.F);
}

TEST(C3dParameters, MayLackTheLengthOfADescription) {
  RawC3d raw = OneFrame();
  raw.records += std::string{5, 1} + "UNITS" + raw.numbers().Word(7) + std::string{-1, 1, 2} + "mm";
  raw.Integer(1, "AFTER", 6);
  const C3dRecording c3d = Read(raw);
  EXPECT_EQ(FindParameter(c3d, "POINT", "UNITS")->Strings(), (std::vector<std::string>{"mm"}));
  EXPECT_EQ(FindParameter(c3d, "POINT", "AFTER")->Number(), 6);
}

TEST(C3dParameters, EndByTheirOwnLengthWhereTheLinkIsImpossible) {
  for (const int offset : {1, 40000, 65535}) {
    SCOPED_TRACE(offset);
    RawC3d raw = OneFrame();
    raw.Parameter(1, "ODD", 2, {}, raw.numbers().Word(5), offset);
    raw.Integer(1, "AFTER", 6);
    const C3dRecording c3d = Read(raw);
    EXPECT_EQ(FindParameter(c3d, "POINT", "ODD")->Number(), 5);
    EXPECT_EQ(FindParameter(c3d, "POINT", "AFTER")->Number(), 6);
    EXPECT_TRUE(HasDiagnostic(c3d, "its own length is taken"));
  }
}

TEST(C3dParameters, AreLeftOutWhereTheyMakeNoSense) {
  RawC3d raw = OneFrame();
  raw.Parameter(1, "MANY", -1, {255, 255, 255, 255, 255, 255, 255}, "abc");
  raw.Parameter(1, "TYPE", 7, {1}, "abc");
  raw.Parameter(1, "NONE", 4, {255, 0, 255}, "");
  raw.Integer(1, "AFTER", 6);
  const C3dRecording c3d = Read(raw);
  EXPECT_EQ(FindParameter(c3d, "POINT", "MANY"), nullptr);
  EXPECT_TRUE(HasDiagnostic(c3d, "'MANY' has more values than there is room for"));
  EXPECT_EQ(FindParameter(c3d, "POINT", "TYPE"), nullptr);
  EXPECT_TRUE(HasDiagnostic(c3d, "'TYPE' has the unknown type 7"));
  EXPECT_EQ(FindParameter(c3d, "POINT", "NONE")->size(), 0);
  EXPECT_EQ(FindParameter(c3d, "POINT", "AFTER")->Number(), 6);
}

TEST(C3dParameters, AreKeptWithoutTheirGroupAndBeforeIt) {
  RawC3d raw = OneFrame();
  raw.Integer(40, "ORPHAN", 4);
  raw.Integer(41, "EARLY", 5);
  raw.Group(41, "LATE");
  const C3dRecording c3d = Read(raw);
  EXPECT_EQ(FindParameter(c3d, "LATE", "EARLY")->Number(), 5);
  EXPECT_TRUE(HasDiagnostic(c3d, "belong to a group 40 that is not there"));
  const C3dRecording again = ParseC3d(FormatC3d(c3d), "again.c3d");
  EXPECT_EQ(again, c3d);
  EXPECT_EQ(again.groups[2].parameters[0].name, "ORPHAN");
}

TEST(C3dParameters, AreAllKeptWhereNamesRepeat) {
  RawC3d raw = OneFrame();
  raw.Group(5, "TWICE");
  raw.Integer(5, "A", 1);
  raw.Integer(5, "A", 2);
  raw.Group(6, "TWICE");
  const C3dRecording c3d = Read(raw);
  EXPECT_EQ(FindParameter(c3d, "TWICE", "A")->Number(), 1);
  EXPECT_TRUE(HasDiagnostic(c3d, "two groups are named 'TWICE'"));
  EXPECT_TRUE(HasDiagnostic(c3d, "1 parameters of group 'TWICE' repeat a name"));
  EXPECT_EQ(ParseC3d(FormatC3d(c3d), "again.c3d"), c3d);
}

TEST(C3dParameters, StopWhereTheDataBegin) {
  RawC3d raw = OneFrame();
  raw.Text(1, "FILL", std::string(250, 'x'));
  raw.Parameter(1, "OVER", -1, {250}, std::string(250, 'y'));
  std::string bytes = raw.Bytes();
  bytes.replace(16, 2, raw.numbers().Word(3));  // The data begin within OVER.
  const C3dRecording c3d = ParseC3d(bytes, "raw.c3d");
  EXPECT_NE(FindParameter(c3d, "POINT", "FILL"), nullptr);
  EXPECT_EQ(FindParameter(c3d, "POINT", "OVER"), nullptr);
  EXPECT_TRUE(HasDiagnostic(c3d, "'OVER' has more values than there is room for"));
}

TEST(C3dParameters, GoOnInFurtherListsBeyond255Values) {
  RawC3d raw;
  raw.point_count = 600;
  raw.points.resize(600);
  raw.AddUsualParameters();
  std::vector<std::string> all;
  for (int i = 0; i < 600; ++i) all.push_back("P" + std::to_string(i));
  raw.Texts(1, "LABELS", 4, {all.begin(), all.begin() + 255});
  raw.Texts(1, "LABELS2", 4, {all.begin() + 255, all.begin() + 510});
  raw.Texts(1, "LABELS3", 4, {all.begin() + 510, all.end()});
  C3dRecording c3d = Read(raw);
  EXPECT_EQ(PointLabels(c3d), all);

  C3dRecording fresh = Read(OneFrame());
  fresh.point_count = 600;
  fresh.points.resize(600);
  SetTextList(fresh, "POINT", "LABELS", all);
  fresh = ParseC3d(FormatC3d(fresh), "fresh.c3d");
  EXPECT_EQ(PointLabels(fresh), all);
  EXPECT_EQ(FindParameter(fresh, "POINT", "LABELS")->dimensions,
            (std::vector<std::uint8_t>{4, 255}));
  EXPECT_EQ(FindParameter(fresh, "POINT", "LABELS3")->dimensions,
            (std::vector<std::uint8_t>{4, 90}));

  SetTextList(fresh, "POINT", "LABELS", std::vector<std::string>(all.begin(), all.begin() + 300));
  EXPECT_EQ(FindParameter(fresh, "POINT", "LABELS3"), nullptr);
  const std::vector<float> scales(300, 2.F);
  SetRealList(fresh, "ANALOG", "SCALE", scales);
  EXPECT_EQ(NumberList(fresh, "ANALOG", "SCALE"), std::vector<double>(300, 2));
}

TEST(C3dParameters, CanBeAddedChangedAndRemoved) {
  C3dRecording c3d = Read(OneFrame());
  SetParameter(c3d, "SUBJECTS", TextParameter("NAME", "Somebody"));
  SetParameter(c3d, "subjects", IntegerParameter("Used", 1));
  SetParameter(c3d, "SUBJECTS", IntegerParameter("USED", 2));
  EXPECT_EQ(FindGroup(c3d, "SUBJECTS")->id, 3) << "the first number that is free";
  EXPECT_EQ(FindGroup(c3d, "SUBJECTS")->parameters.size(), 2);
  EXPECT_EQ(FindParameter(c3d, "SUBJECTS", "USED")->Number(), 2);
  EXPECT_TRUE(RemoveParameter(c3d, "SUBJECTS", "name"));
  EXPECT_FALSE(RemoveParameter(c3d, "SUBJECTS", "name"));
  const C3dRecording again = ParseC3d(FormatC3d(c3d), "again.c3d");
  EXPECT_EQ(again, c3d);
}

TEST(C3dEvents, CountFromFrameOneWhereverTheyStand) {
  RawC3d raw;
  raw.first_frame = 301;
  raw.points.resize(200);
  raw.AddUsualParameters();
  raw.Group(3, "EVENT");
  raw.Integer(3, "USED", 2);
  raw.Reals(3, "TIMES", {2, 2}, {0, 3.5, 1, 2.25});
  raw.Texts(3, "LABELS", 11, {"Foot Strike", "Foot Off"});
  raw.Texts(3, "CONTEXTS", 5, {"Left", "Right"});
  raw.Texts(3, "SUBJECTS", 4, {"Ann"});
  raw.Integers(3, "ICON_IDS", {2}, {1, 2});
  const test::C3dNumbers n = raw.numbers();
  raw.events = n.Word(0) + n.Word(0) + n.Word(12345) + n.Word(1) + n.Word(0) + n.Real(.5);
  raw.events.resize(396 - 294);
  raw.events += "LIC ";
  const std::vector<C3dEvent> expected = {
      {.time_s = 3.5, .label = "Foot Strike", .context = "Left", .subject = "Ann", .icon_id = 1},
      {.time_s = 62.25, .label = "Foot Off", .context = "Right", .icon_id = 2},
      // Half a second behind the first stored frame, which is 3 s behind frame 1.
      {.time_s = 3.5, .label = "LIC", .is_in_header = true, .display_flag = 0}};
  const C3dRecording c3d = Read(raw);
  EXPECT_EQ(Events(c3d), expected);

  C3dRecording changed = c3d;
  SetEvents(changed, expected);
  EXPECT_EQ(Events(ParseC3d(FormatC3d(changed), "again.c3d")), expected);
  SetEvents(changed, {});
  EXPECT_TRUE(Events(ParseC3d(FormatC3d(changed), "again.c3d")).empty());
}

TEST(C3dEvents, CanBeMoreThan255) {
  C3dRecording c3d = Read(OneFrame());
  std::vector<C3dEvent> events;
  for (int i = 0; i < 700; ++i) {
    events.push_back({.time_s = i * .25, .label = "E" + std::to_string(i), .context = "General"});
  }
  SetEvents(c3d, events);
  EXPECT_EQ(Events(ParseC3d(FormatC3d(c3d), "again.c3d")), events);
}

TEST(C3dEvents, DoNotGoBeyondWhatIsThere) {
  RawC3d raw = OneFrame();
  raw.Group(3, "EVENT");
  raw.Integer(3, "USED", 500);
  raw.Reals(3, "TIMES", {2, 1}, {0, 1});
  EXPECT_EQ(Events(Read(raw)).size(), 1);

  C3dRecording c3d = Read(OneFrame());
  const std::vector<C3dEvent> many(19, {.label = "X", .is_in_header = true});
  EXPECT_EQ(ErrorOf([&] { SetEvents(c3d, many); }).code(), ErrorCode::kInvalidArgument);
  const std::vector<C3dEvent> wordy(1, {.label = "TOO LONG", .is_in_header = true});
  EXPECT_EQ(ErrorOf([&] { SetEvents(c3d, wordy); }).code(), ErrorCode::kInvalidArgument);
}

TEST(C3dForcePlates, AreListedByType) {
  RawC3d raw = OneFrame();
  raw.Group(3, "FORCE_PLATFORM");
  raw.Integer(3, "USED", 2);
  raw.Integers(3, "TYPE", {2}, {4, 3});
  std::vector<double> corners(24);
  for (std::size_t i = 0; i < 24; ++i) corners[i] = static_cast<double>(i);
  raw.Reals(3, "CORNERS", {3, 4, 2}, corners);
  raw.Reals(3, "ORIGIN", {3, 2}, {1, 2, 3, 4, 5, 6});
  raw.Integers(3, "CHANNEL", {8, 2}, {1, 2, 3, 4, 5, 6, 0, 0, 7, 8, 9, 10, 11, 12, 13, 14});
  std::vector<double> matrix(36);
  for (std::size_t i = 0; i < 36; ++i) matrix[i] = static_cast<double>(i);
  raw.Reals(3, "CAL_MATRIX", {6, 6, 1}, matrix);
  const std::vector<C3dForcePlate> plates = ForcePlates(Read(raw));
  ASSERT_EQ(plates.size(), 2);
  EXPECT_EQ(plates[0].type, 4);
  EXPECT_EQ(plates[0].corners[1], (std::array<float, 3>{3, 4, 5}));
  EXPECT_EQ(plates[0].channels, (std::vector<int>{1, 2, 3, 4, 5, 6, 0, 0}));
  EXPECT_EQ(plates[0].calibration_columns, 6);
  EXPECT_EQ(plates[0].calibration[1], 6.F) << "row 0, column 1: stored column by column";
  EXPECT_EQ(plates[1].type, 3);
  EXPECT_EQ(plates[1].corners[3], (std::array<float, 3>{21, 22, 23}));
  EXPECT_EQ(plates[1].origin, (std::array<float, 3>{4, 5, 6}));
  EXPECT_EQ(plates[1].channels.back(), 14);
  EXPECT_TRUE(plates[1].calibration.empty());
}

}  // namespace
}  // namespace kinebase
