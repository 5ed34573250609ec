// Each point of docs/formats/asf-amc.md about skeleton files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "formats/texts.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/asf.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

using test::kArmAsf;
using test::LineOf;
using test::With;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

AsfSkeleton Parse(std::string_view text) { return ParseAsf(text, "arm.asf"); }

// The error of a text, which must name the line that holds `part`.
std::string ErrorAt(std::string_view text, std::string_view part) {
  const Error error = test::ErrorOf([&] { (void)Parse(text); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.place().file, "arm.asf");
  EXPECT_EQ(error.place().line, LineOf(text, part)) << error.what();
  return error.message();
}

TEST(AsfReader, ReadsEveryField) {
  const AsfSkeleton asf = Parse(kArmAsf);
  EXPECT_EQ(asf.file_name, "arm.asf");
  EXPECT_THAT(asf.comments, ElementsAre("# made up"));
  EXPECT_EQ(asf.version, "1.10");
  EXPECT_EQ(asf.name, "arm");
  EXPECT_EQ(asf.mass_unit, 1);
  EXPECT_EQ(asf.length_unit, 0.45);
  EXPECT_TRUE(asf.angle_is_degrees);
  EXPECT_THAT(asf.documentation, ElementsAre("  two bones"));
  EXPECT_THAT(asf.root_order, ElementsAre(AsfDof::kTx, AsfDof::kTy, AsfDof::kTz, AsfDof::kRx,
                                          AsfDof::kRy, AsfDof::kRz));
  EXPECT_EQ(asf.root_axis, "XYZ");
  EXPECT_THAT(asf.root_position, ElementsAre(1, 2, 3));
  EXPECT_THAT(asf.root_orientation, ElementsAre(0, 0, 0));
  ASSERT_EQ(asf.bones.size(), 2);
  const AsfBone& upper = asf.bones[0];
  EXPECT_EQ(upper.id, 1);
  EXPECT_EQ(upper.name, "upper");
  EXPECT_THAT(upper.direction, ElementsAre(0, 1, 0));
  EXPECT_EQ(upper.length, 2);
  EXPECT_THAT(upper.axis, ElementsAre(0, 0, 20));
  EXPECT_EQ(upper.axis_order, "XYZ");
  EXPECT_THAT(upper.dofs, ElementsAre(AsfDof::kRx, AsfDof::kRy, AsfDof::kRz));
  EXPECT_THAT(upper.limits,
              ElementsAre(AsfLimits{-160, 20}, AsfLimits{-70, 70}, AsfLimits{-60, 70}));
  EXPECT_EQ(upper.line, LineOf(kArmAsf, "id 1") - 1);
  ASSERT_EQ(asf.hierarchy.size(), 2);
  EXPECT_EQ(asf.hierarchy[1].parent, "upper");
  EXPECT_THAT(asf.hierarchy[1].children, ElementsAre("lower"));
  EXPECT_THAT(asf.diagnostics, IsEmpty());
}

TEST(AsfReader, TakesAnyLineEndAndAByteOrderMark) {
  const AsfSkeleton expected = Parse(kArmAsf);
  for (const char* ending : {"\n", "\r\n", "\r", " \t\r\n"}) {
    EXPECT_EQ(Parse("\xEF\xBB\xBF" + test::WithLineEnds(kArmAsf, ending)).bones, expected.bones);
  }
  EXPECT_EQ(Parse(test::WithLineEnds(kArmAsf, "\r\n")), expected);
  EXPECT_EQ(Parse(test::WithLineEnds(kArmAsf, "\r")), expected);
  std::string unterminated(kArmAsf);
  unterminated.pop_back();
  EXPECT_EQ(Parse(unterminated), expected);
  std::string tabs(kArmAsf);
  std::ranges::replace(tabs, ' ', '\t');
  EXPECT_EQ(Parse(tabs).bones, expected.bones);
}

TEST(AsfReader, TakesUpperCase) {
  std::string text(kArmAsf);
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  const AsfSkeleton asf = Parse(text);
  EXPECT_EQ(asf.hierarchy[0].parent, "root");
  EXPECT_EQ(asf.bones[1].name, "LOWER");
  EXPECT_EQ(asf.bones[0].dofs, Parse(kArmAsf).bones[0].dofs);
}

TEST(AsfReader, FindsBonesThatTheHierarchySpellsInAnotherCase) {
  const AsfSkeleton asf = Parse(With(kArmAsf, "    upper lower", "    Upper LOWER"));
  EXPECT_EQ(asf.hierarchy[1].parent, "upper");
  EXPECT_THAT(asf.hierarchy[1].children, ElementsAre("lower"));
}

TEST(AsfReader, TakesUnitsInAnyCombination) {
  EXPECT_FALSE(Parse(With(kArmAsf, "  mass 1.0\n", "")).mass_unit);
  EXPECT_FALSE(Parse(With(kArmAsf, "angle deg", "angle rad")).angle_is_degrees);
  EXPECT_FALSE(Parse(With(kArmAsf, "angle deg", "ANGLE Radians")).angle_is_degrees);
  EXPECT_TRUE(Parse(With(kArmAsf, "  angle deg\n", "")).angle_is_degrees);
  EXPECT_THAT(Parse(With(kArmAsf, "angle deg", "time s")).unknown_units,
              ElementsAre(AsfUnknown{"time s"}));
  const AsfSkeleton silent = Parse(With(kArmAsf, "  length 0.45\n", ""));
  EXPECT_FALSE(silent.length_unit);
  ASSERT_EQ(silent.diagnostics.size(), 1);
  EXPECT_THAT(silent.diagnostics[0].message, HasSubstr("length"));
}

TEST(AsfReader, RefusesUnitsThatMakeNoSense) {
  EXPECT_THAT(ErrorAt(With(kArmAsf, "angle deg", "angle grad"), "grad"), HasSubstr("'grad'"));
  for (const char* length :
       {"length 0", "length -1", "length inf", "length nan", "length 0.45 in"}) {
    (void)ErrorAt(With(kArmAsf, "length 0.45", length), length);
  }
  (void)ErrorAt(With(kArmAsf, "mass 1.0", "mass heavy"), "heavy");
}

TEST(AsfReader, KeepsTheOrderOfDofsOfEveryKind) {
  EXPECT_THAT(Parse(With(kArmAsf, "dof rz", "dof L rz TX Rx")).bones[1].dofs,
              ElementsAre(AsfDof::kLength, AsfDof::kRz, AsfDof::kTx, AsfDof::kRx));
  EXPECT_THAT(Parse(With(kArmAsf, "    dof rz\n", "")).bones[1].dofs, IsEmpty());
  EXPECT_THAT(Parse(With(kArmAsf, "order TX TY TZ RX RY RZ", "order RZ TX")).root_order,
              ElementsAre(AsfDof::kRz, AsfDof::kTx));
}

TEST(AsfReader, RefusesDofsThatMakeNoSense) {
  EXPECT_THAT(ErrorAt(With(kArmAsf, "dof rz", "dof rw"), "rw"), HasSubstr("'rw'"));
  EXPECT_THAT(ErrorAt(With(kArmAsf, "dof rz", "dof rz ry rz"), "rz ry"), HasSubstr("twice"));
}

TEST(AsfReader, NeverInfersDofsFromLimits) {
  const AsfSkeleton more =
      Parse(With(kArmAsf, "dof rz", "dof rz\nlimits (-1 1)\n(-inf inf)\n(2 3)"));
  EXPECT_THAT(more.bones[1].dofs, ElementsAre(AsfDof::kRz));
  EXPECT_THAT(more.bones[1].limits,
              ElementsAre(AsfLimits{-1, 1}, AsfLimits{-kInfinity, kInfinity}, AsfLimits{2, 3}));
  const AsfSkeleton none = Parse(With(kArmAsf, "dof rz", "limits (-1 1)"));
  EXPECT_THAT(none.bones[1].dofs, IsEmpty());
  EXPECT_THAT(none.bones[1].limits, ElementsAre(AsfLimits{-1, 1}));
}

TEST(AsfReader, TakesLimitsInAnyLayout) {
  for (const char* limits :
       {"limits (-1 1) (-2 2)", "limits\n(-1 1)\n(-2 2)", "limits ( -1, 1 )(-2 2)",
        "limits (-1 1) # first\n # second\n  (-2.0 +2)"}) {
    EXPECT_THAT(Parse(With(kArmAsf, "dof rz", limits)).bones[1].limits,
                ElementsAre(AsfLimits{-1, 1}, AsfLimits{-2, 2}))
        << limits;
  }
}

TEST(AsfReader, RefusesLimitsThatMakeNoSense) {
  for (const char* limits : {"limits (-5", "limits -1 1", "limits (1)", "limits (1 2 3)",
                             "limits (a b)", "limits (nan 1)", "limits (1 2) x"}) {
    (void)ErrorAt(With(kArmAsf, "dof rz", limits), limits);
  }
}

TEST(AsfReader, NeedsNoIdsAndNoAxisOrder) {
  const AsfSkeleton asf =
      Parse(With(With(kArmAsf, "    id 2\n", ""), "axis 0 0 0 XYZ", "axis 1e1 -2 +3"));
  EXPECT_FALSE(asf.bones[1].id);
  EXPECT_THAT(asf.bones[1].axis, ElementsAre(10, -2, 3));
  EXPECT_EQ(asf.bones[1].axis_order, "XYZ");
  EXPECT_EQ(Parse(With(kArmAsf, "axis 0 0 20 XYZ", "axis 0 0 20 ZYX")).bones[0].axis_order, "ZYX");
}

TEST(AsfReader, TakesSectionsInAnyOrder) {
  const std::string_view text = kArmAsf;
  const std::size_t bones = text.find(":bonedata");
  const std::size_t hierarchy = text.find(":hierarchy");
  const std::size_t root = text.find(":root");
  std::string shuffled(text.substr(hierarchy));
  shuffled += text.substr(bones, hierarchy - bones);
  shuffled += text.substr(root, bones - root);
  shuffled += text.substr(0, root);
  EXPECT_EQ(Parse(shuffled), Parse(kArmAsf));
}

TEST(AsfReader, TakesAValueBehindItsSectionOrBelowIt) {
  EXPECT_EQ(Parse(With(kArmAsf, ":name arm", ":name\n  arm")), Parse(kArmAsf));
  EXPECT_EQ(Parse(With(kArmAsf, ":units\n  mass 1.0", ":units mass 1.0")), Parse(kArmAsf));
  EXPECT_EQ(
      Parse(With(kArmAsf, ":documentation\n  two bones", ":documentation two bones")).documentation,
      std::vector<std::string>{"two bones"});
  (void)ErrorAt(With(kArmAsf, ":name arm", ":name :version"), ":name :version");
}

TEST(AsfReader, TakesCommentsAnywhere) {
  std::string text(kArmAsf);
  for (const char* at : {"mass 1.0", "order TX TY TZ RX RY RZ", "direction 0 1 0", "dof rz",
                         "(-70 70)", "root upper"}) {
    text = With(text, at, std::string(at) + " # about " + at + "\n# a line of its own");
  }
  const AsfSkeleton asf = Parse(text);
  EXPECT_EQ(asf.comments.size(), 13);
  EXPECT_EQ(asf.comments[1], "# about mass 1.0");
  EXPECT_EQ(asf.bones, Parse(kArmAsf).bones);
  EXPECT_EQ(asf.hierarchy, Parse(kArmAsf).hierarchy);
}

TEST(AsfReader, KeepsDocumentationToTheByte) {
  const AsfSkeleton asf =
      Parse(With(kArmAsf, "  two bones\n", "  two bones \n\n# not a comment\n\tbegin\n caf\xE9\n"));
  EXPECT_THAT(asf.documentation,
              ElementsAre("  two bones ", "", "# not a comment", "\tbegin", " caf\xE9"));
}

TEST(AsfReader, KeepsWhatItDoesNotKnow) {
  std::string text = With(kArmAsf, "    id 2\n", "    bodymass 3 4\n    id 2\n");
  text = With(text, "  axis XYZ\n  position", "  colour red\n  axis XYZ\n  position");
  text += ":Skin body.SKIN\n  vertex 1 2\n";
  const AsfSkeleton asf = Parse(text);
  EXPECT_THAT(asf.bones[1].unknown, ElementsAre(AsfUnknown{"bodymass 3 4"}));
  EXPECT_THAT(asf.unknown_root, ElementsAre(AsfUnknown{"colour red"}));
  EXPECT_THAT(asf.unknown_sections, ElementsAre(AsfUnknown{":Skin body.SKIN\nvertex 1 2"}));
  EXPECT_EQ(Parse(FormatAsf(asf)), asf);
}

TEST(AsfReader, TellsAnUnknownLineInParenthesesFromLimits) {
  const AsfSkeleton asf = Parse(With(kArmAsf, "    dof rz\n", "    (3 4)\n    limits (1 2)\n"));
  EXPECT_THAT(asf.bones[1].unknown, ElementsAre(AsfUnknown{"(3 4)"}));
  EXPECT_EQ(Parse(FormatAsf(asf)), asf);
}

TEST(AsfReader, NamesABoneOfTheHierarchyThatBonedataLacks) {
  EXPECT_THAT(ErrorAt(With(kArmAsf, "    upper lower", "    upper lower hand"), "lower hand"),
              HasSubstr("'hand'"));
}

TEST(AsfReader, ReportsABoneThatTheHierarchyLacks) {
  const AsfSkeleton asf = Parse(With(kArmAsf, "    upper lower\n", ""));
  EXPECT_EQ(asf.bones.size(), 2);
  ASSERT_EQ(asf.diagnostics.size(), 1);
  EXPECT_EQ(asf.diagnostics[0].severity, Severity::kWarning);
  EXPECT_THAT(asf.diagnostics[0].message, HasSubstr("'lower'"));
  EXPECT_EQ(asf.diagnostics[0].line, asf.bones[1].line);
}

TEST(AsfReader, RefusesCyclesAndSecondParents) {
  (void)ErrorAt(With(kArmAsf, "    upper lower", "    upper lower\n    lower upper"),
                "lower upper");
  (void)ErrorAt(With(kArmAsf, "    upper lower", "    upper lower upper"), "lower upper");
  (void)ErrorAt(With(kArmAsf, "root upper", "root upper lower"), "    upper lower");
  (void)ErrorAt(With(kArmAsf, "root upper", "upper upper"), "upper upper");
  (void)ErrorAt(With(kArmAsf, "    upper lower", "    upper lower\n    lower root"), "lower root");
}

TEST(AsfReader, RefusesABoneThatLacksSomething) {
  EXPECT_THAT(ErrorAt(With(kArmAsf, "    name lower\n", ""), "  end\n:hierarchy"),
              HasSubstr("'name'"));
  EXPECT_THAT(ErrorAt(With(kArmAsf, "    direction 1 0 0\n", ""), "  end\n:hierarchy"),
              HasSubstr("'direction'"));
  EXPECT_THAT(ErrorAt(With(kArmAsf, "    length 3\n", ""), "  end\n:hierarchy"),
              HasSubstr("'length'"));
  EXPECT_THAT(ErrorAt(With(kArmAsf, "  end\n:hierarchy", ":hierarchy"), ":hierarchy"),
              HasSubstr("no 'end'"));
  EXPECT_THAT(ErrorAt(With(kArmAsf, "  end\n  begin", "  begin"), "  begin\n    id 2"),
              HasSubstr("no 'end'"));
}

TEST(AsfReader, RefusesNamesThatMakeNoSense) {
  EXPECT_THAT(ErrorAt(With(kArmAsf, "name lower", "name upper"), "  end\n:hierarchy"),
              HasSubstr("second bone named 'upper'"));
  (void)ErrorAt(With(kArmAsf, "name lower", "name Root"), "  end\n:hierarchy");
  (void)ErrorAt(With(kArmAsf, "name lower", "name lower arm"), "lower arm");
}

TEST(AsfReader, RefusesNumbersThatAreNone) {
  (void)ErrorAt(With(kArmAsf, "direction 1 0 0", "direction 1 0"), "direction 1 0");
  (void)ErrorAt(With(kArmAsf, "direction 1 0 0", "direction 1 0 0 0"), "direction 1 0 0 0");
  (void)ErrorAt(With(kArmAsf, "direction 1 0 0", "direction 1 nan 0"), "nan");
  (void)ErrorAt(With(kArmAsf, "length 3", "length 3,5"), "3,5");
  (void)ErrorAt(With(kArmAsf, "length 3", "length 1e999"), "1e999");
  (void)ErrorAt(With(kArmAsf, "axis 0 0 0 XYZ", "axis 0 XYZ"), "axis 0 XYZ");
  (void)ErrorAt(With(kArmAsf, "id 2", "id two"), "id two");
  (void)ErrorAt(With(kArmAsf, "position 1 2 3", "position 1 2"), "position 1 2");
}

TEST(AsfReader, ReadsAMissingRootOrderAsTheUsualOne) {
  const AsfSkeleton asf = Parse(With(kArmAsf, "  order TX TY TZ RX RY RZ\n", ""));
  EXPECT_EQ(asf.root_order, Parse(kArmAsf).root_order);
  EXPECT_EQ(asf.diagnostics.size(), 1);
}

TEST(AsfReader, RefusesWhatIsNoSkeleton) {
  for (const std::string_view text :
       {std::string_view(""), std::string_view("\n\n"), std::string_view(":version 1.10\n"),
        std::string_view(":bonedata\n:hierarchy\n"), std::string_view("\xEF\xBB\xBF")}) {
    EXPECT_EQ(test::ErrorOf([&] { (void)Parse(text); }).code(), ErrorCode::kMalformedFile);
  }
  (void)ErrorAt("hello\n", "hello");
  (void)ErrorAt(With(kArmAsf, "two bones", std::string_view("two\0bones", 9)), "two");
  EXPECT_THAT(
      test::ErrorOf([] { (void)Parse(kArmAsf.substr(0, kArmAsf.find(":hierarchy"))); }).message(),
      HasSubstr(":hierarchy"));
}

TEST(AsfReader, EndsWithASkeletonOrAnErrorWhereverTheFileIsCut) {
  for (std::size_t length = 0; length < kArmAsf.size(); ++length) {
    try {
      EXPECT_GE(Parse(kArmAsf.substr(0, length)).bones.size(), 2);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    }
  }
}

TEST(AsfReader, ReadsFilesByName) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "größe 1.asf", kArmAsf);
  EXPECT_EQ(ReadAsf(folder.path() / "größe 1.asf"), Parse(kArmAsf));
  EXPECT_EQ(test::ErrorOf([&] { (void)ReadAsf(folder.path() / "none.asf"); }).code(),
            ErrorCode::kNotFound);
}

}  // namespace
}  // namespace kinebase
