// Each point of docs/formats/opensim.md about MOT and STO files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "formats/texts.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/sto.h"
#include "support/files.h"

namespace kinebase {
namespace {

using test::LineOf;
using test::With;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view kAngles =
    "walk\nversion=1\nnRows=2\nnColumns=3\ninDegrees=yes\n\nUnits are S.I. units\nendheader\n"
    "time\tknee\thip\n0\t1.5\t-2\n0.01\t1.75\tnan\n";

constexpr std::string_view kTurns =
    "DataRate=100\nDataType=Quaternion\nversion=3\nendheader\n"
    "time\tpelvis_imu\ttorso_imu\n0\t1,0,0,0\t.5,.5,-.5,-.5\n";

StoTable Parse(std::string_view text) { return ParseSto(text, "walk.mot"); }

TEST(StoReader, ReadsATableOfAngles) {
  const StoTable table = Parse(kAngles);
  EXPECT_EQ(table.name, "walk");
  EXPECT_THAT(table.header, ElementsAre(StoHeaderLine{"version", "1"},
                                        StoHeaderLine{"", "Units are S.I. units"}));
  EXPECT_EQ(table.in_degrees, true);
  EXPECT_EQ(table.component_count, 1);
  EXPECT_THAT(table.labels, ElementsAre("knee", "hip"));
  EXPECT_THAT(table.times_s, ElementsAre(0, .01));
  EXPECT_THAT(table.Cell(0, 1), ElementsAre(-2));
  EXPECT_THAT(table.Cell(1, 1), ElementsAre(testing::IsNan()));
  EXPECT_THAT(table.diagnostics, IsEmpty());
}

TEST(StoReader, ReadsATableOfQuaternions) {
  const StoTable table = Parse(kTurns);
  EXPECT_EQ(table.name, "");
  EXPECT_EQ(table.data_type, "Quaternion");
  EXPECT_EQ(table.in_degrees, std::nullopt);
  EXPECT_THAT(table.Cell(0, 1), ElementsAre(.5, .5, -.5, -.5));
}

TEST(StoReader, TakesAnyLineEndAndBlanks) {
  for (const char* ending : {"\r\n", "\r", " \n\t\n"}) {
    EXPECT_EQ(Parse("\xEF\xBB\xBF" + test::WithLineEnds(kAngles, ending)), Parse(kAngles));
  }
  EXPECT_EQ(Parse(With(With(kAngles, "knee\t", "knee  "), "1.5\t", " 1.5 ")), Parse(kAngles));
}

TEST(StoReader, ReportsCountsThatAreNotThere) {
  const StoTable table =
      Parse(With(With(kAngles, "nRows=2", "nRows=9"), "nColumns=3", "datacolumns=5"));
  ASSERT_EQ(table.diagnostics.size(), 2);
  EXPECT_EQ(table.diagnostics[0].message, "9 rows are declared, 2 are there");
  EXPECT_EQ(table.diagnostics[1].message, "5 columns are declared, 3 are there");
}

TEST(StoReader, RefusesWhatIsNoTable) {
  struct Case {
    std::string text;
    std::string_view at;  // On the line that the error names.
    const char* message;
  };
  const Case cases[] = {
      {With(kAngles, "endheader\n", ""), "0.01", "no line 'endheader'"},
      {With(kAngles, "time\tknee", "t\tknee"), "t\tknee", "'time' first, found 't'"},
      {With(kAngles, "0.01\t", "soon\t"), "soon", "expected a time"},
      {With(kAngles, "\t1.75", ""), "0.01", "1 cells after the time; expected 2"},
      {With(kAngles, "\t1.75", "\t1\t1"), "0.01", "3 cells"},
      {With(kAngles, "1.75", "1,75"), "0.01", "a cell is not a number: '1,75'"},
      {With(kTurns, "1,0,0,0", "1,0,0"), "1,0,0", "not 4 numbers with commas between"},
      {With(kTurns, "1,0,0,0", "1,0,0,0,0"), "1,0,0", "not 4 numbers"},
      {With(kTurns, "1,0,0,0", "1"), "torso_imu\n0", "not 4 numbers"},
      {With(kTurns, "Quaternion", "Matrix"), "Matrix", "unknown DataType 'Matrix'"},
      {With(kAngles, "=yes", "=maybe"), "maybe", "inDegrees=yes or inDegrees=no"},
  };
  for (const Case& each : cases) {
    const Error error = test::ErrorOf([&] { (void)Parse(each.text); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    EXPECT_THAT(error.message(), HasSubstr(each.message));
    EXPECT_EQ(error.place().file, "walk.mot");
    EXPECT_GE(error.place().line, LineOf(each.text, each.at)) << error.what();
  }
  for (const std::string_view text :
       {std::string_view(""), std::string_view("endheader"), std::string_view("\0endheader", 10)}) {
    (void)test::ErrorOf([&] { (void)Parse(text); });
  }
}

TEST(StoWriter, GivesBackWhatWasRead) {
  for (const std::string_view text :
       {kAngles, kTurns, std::string_view("\v\xEF\xBB\xBFwalk\nendheader\ntime\n"),
        std::string_view("a=b\nfree\n=c\nendheader\ntime\n"),
        std::string_view("free\n=c=d\nendheader\ntime a\n1 2\n"),
        std::string_view("DataType=vec3\nx\nendheader\ntime\ta\n-0\tinf,nan,1e-300\n")}) {
    const StoTable table = Parse(text);
    EXPECT_EQ(Parse(FormatSto(table)), table) << text;
    EXPECT_THAT(Parse(FormatSto(table)).diagnostics, IsEmpty());
  }
}

}  // namespace
}  // namespace kinebase
