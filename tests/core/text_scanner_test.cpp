#include "kinebase/core/text_scanner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> Lines(std::string_view text) {
  std::vector<std::string> lines;
  for (LineScanner scanner(text); scanner.Next();) {
    lines.emplace_back(scanner.line());
    EXPECT_EQ(scanner.line_number(), static_cast<std::int64_t>(lines.size()));
  }
  return lines;
}

TEST(LineScanner, TakesEveryLineEnding) {
  for (const char* text : {"a\nb\n\nc\n", "a\r\nb\r\n\r\nc\r\n", "a\rb\r\rc\r"}) {
    EXPECT_THAT(Lines(text), ElementsAre("a", "b", "", "c"));
  }
}

TEST(LineScanner, TakesMixedLineEndings) {
  EXPECT_THAT(Lines("a\r\nb\rc\nd\r\r\n\n\re"), ElementsAre("a", "b", "c", "d", "", "", "", "e"));
}

TEST(LineScanner, SkipsOneByteOrderMarkAtTheStartOnly) {
  EXPECT_THAT(Lines("\xEF\xBB\xBF"), IsEmpty());
  EXPECT_THAT(Lines("\xEF\xBB\xBF"
                    "a\n\xEF\xBB\xBF"
                    "b"),
              ElementsAre("a",
                          "\xEF\xBB\xBF"
                          "b"));
}

TEST(LineScanner, HasNoLineInAnEmptyText) { EXPECT_THAT(Lines(""), IsEmpty()); }

TEST(LineScanner, SaysWhetherTheLastLineIsTerminated) {
  for (const auto& [text, terminated] : std::vector<std::pair<std::string_view, bool>>{
           {"a", false}, {"a\n", true}, {"a\r", true}, {"a\r\n", true}, {"a\nb", false}}) {
    LineScanner scanner(text);
    while (scanner.Next()) {
    }
    EXPECT_EQ(scanner.line_is_terminated(), terminated) << text;
  }
}

TEST(LineScanner, GoesOnBehindLinesThatWereReadInAnotherWay) {
  LineScanner scanner("a\nbb\ncc\nd");
  ASSERT_TRUE(scanner.Next());
  EXPECT_EQ(scanner.rest(), "bb\ncc\nd");
  scanner.Skip(6, 2);
  EXPECT_EQ(scanner.line_number(), 3);
  EXPECT_TRUE(scanner.line_is_terminated());
  ASSERT_TRUE(scanner.Next());
  EXPECT_EQ(scanner.line(), "d");
  EXPECT_EQ(scanner.line_number(), 4);
  EXPECT_FALSE(scanner.line_is_terminated());
  EXPECT_EQ(scanner.rest(), "");
}

RC_GTEST_PROP(LineScanner, GivesBackTheLinesOfAnyTextWhateverEndsThem, ()) {
  const auto line = rc::gen::container<std::string>(rc::gen::elementOf(std::string("ab \t#1.")));
  const auto lines = *rc::gen::container<std::vector<std::string>>(line);
  const auto ending = *rc::gen::elementOf(std::vector<std::string>{"\n", "\r\n", "\r"});
  std::string text;
  for (const auto& each : lines) text += each + ending;
  RC_ASSERT(Lines(text) == lines);
}

// A search for LF from every CR would read the rest of the file again for each line.
TEST(LineScanner, NeedsLinearTimeWhateverEndsTheLines) {
  std::string text(8'000'000, '\r');
  text += '\n';
  const auto begin = std::chrono::steady_clock::now();
  std::int64_t lines = 0;
  for (LineScanner scanner(text); scanner.Next();) ++lines;
  EXPECT_EQ(lines, 8'000'000);
  // Milliseconds when linear, an hour when not.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(TakeToken, SplitsAtBlanksOfAllKinds) {
  EXPECT_THAT(SplitTokens(" a\tbc  \v d\f\r"), ElementsAre("a", "bc", "d"));
  EXPECT_THAT(SplitTokens(" \t "), IsEmpty());
  std::string_view text = " one two";
  EXPECT_EQ(TakeToken(text), "one");
  EXPECT_EQ(text, " two");
}

TEST(Trim, TakesBlanksOffBothEnds) {
  EXPECT_EQ(Trim(" \ta b\v\f\r "), "a b");
  EXPECT_EQ(Trim(" \t"), "");
  EXPECT_EQ(Trim(""), "");
}

TEST(ParseDouble, ReadsTheUsualForms) {
  EXPECT_EQ(ParseDouble("1"), 1);
  EXPECT_EQ(ParseDouble("+1.5"), 1.5);
  EXPECT_EQ(ParseDouble("-.5"), -0.5);
  EXPECT_EQ(ParseDouble("5."), 5);
  EXPECT_EQ(ParseDouble("1e3"), 1000);
  EXPECT_EQ(ParseDouble("7.62852e-016"), 7.62852e-16);
  EXPECT_EQ(ParseDouble("1E+2"), 100);
  EXPECT_EQ(ParseDouble("4.9e-324"), std::numeric_limits<double>::denorm_min());
}

TEST(ParseDouble, KeepsTheSignOfZero) {
  EXPECT_EQ(ParseDouble("-0"), 0);
  EXPECT_TRUE(std::signbit(ParseDouble("-0").value()));
  EXPECT_FALSE(std::signbit(ParseDouble("+0").value()));
}

TEST(ParseDouble, ReadsWhatIsNotFinite) {
  EXPECT_TRUE(std::isnan(ParseDouble("nan").value()));
  EXPECT_TRUE(std::isnan(ParseDouble("NaN").value()));
  EXPECT_EQ(ParseDouble("inf"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(ParseDouble("-Infinity"), -std::numeric_limits<double>::infinity());
}

TEST(ParseDouble, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "+", "-", ".", "e5", "1.5x", "+-1", "-+1", "++1", "--1", "1 ", " 1",
                           "1,5", "0x10", "1e", "1e+", "1.2.3", "1d3"}) {
    EXPECT_FALSE(ParseDouble(text)) << "'" << text << "'";
  }
}

TEST(ParseDouble, RoundsWhatIsTooSmallToZero) {
  EXPECT_EQ(ParseDouble("1e-400"), 0);
  EXPECT_EQ(ParseDouble("+1e-400"), 0);
  EXPECT_TRUE(std::signbit(ParseDouble("-1e-400").value()));
  const std::string zeros(400, '0');
  EXPECT_EQ(ParseDouble("0." + zeros + "1"), 0);
  EXPECT_EQ(ParseDouble("0." + zeros + "1e+10"), 0);
  EXPECT_EQ(ParseDouble("1e-99999999999999999999"), 0);
}

TEST(ParseDouble, RefusesWhatIsTooLarge) {
  EXPECT_FALSE(ParseDouble("1e400"));
  EXPECT_FALSE(ParseDouble("-1e400"));
  const std::string zeros(400, '0');
  EXPECT_FALSE(ParseDouble("1" + zeros));
  EXPECT_FALSE(ParseDouble("1" + zeros + "e-10"));
  EXPECT_FALSE(ParseDouble("1e99999999999999999999"));
}

RC_GTEST_PROP(ParseDouble, AgreesWithTheStandardLibraryOnAnyDecimal, ()) {
  const auto digits =
      rc::gen::container<std::string>(rc::gen::inRange('0', static_cast<char>('9' + 1)));
  const std::string text = *rc::gen::elementOf(std::vector<std::string>{"", "-"}) + "1" + *digits +
                           "." + *digits + "e" + std::to_string(*rc::gen::inRange(-340, 341));
  const double expected = std::strtod(text.c_str(), nullptr);
  const auto value = ParseDouble(text);
  if (std::isinf(expected)) {
    RC_ASSERT(!value);
  } else {
    RC_ASSERT(value.value() == expected);
  }
}

RC_GTEST_PROP(ToShortestText, ReadsBackAsTheSameDouble, ()) {
  const auto bits = *rc::gen::arbitrary<std::uint64_t>();
  const auto value = std::bit_cast<double>(bits * 0x9E3779B97F4A7C15ULL);
  const auto again = ParseDouble(ToShortestText(value));
  RC_ASSERT(again.has_value());
  if (std::isnan(value)) {
    RC_ASSERT(std::isnan(*again));
  } else {
    RC_ASSERT(std::bit_cast<std::uint64_t>(*again) == std::bit_cast<std::uint64_t>(value));
  }
}

TEST(ToShortestText, IsShort) {
  EXPECT_EQ(ToShortestText(0.1), "0.1");
  EXPECT_EQ(ToShortestText(-0.0), "-0");
  EXPECT_EQ(ToShortestText(120), "120");
  EXPECT_EQ(ToShortestText(1e300), "1e+300");
}

TEST(ParseInteger, TakesWholeNumbersOnly) {
  EXPECT_EQ(ParseInteger("12"), 12);
  EXPECT_EQ(ParseInteger("+12"), 12);
  EXPECT_EQ(ParseInteger("-3"), -3);
  EXPECT_EQ(ParseInteger("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  for (const char* text : {"", "+", "1.0", "1e3", "12x", "+-1", "9223372036854775808", " 1"}) {
    EXPECT_FALSE(ParseInteger(text)) << text;
  }
}

TEST(EqualsIgnoringCase, ComparesLettersOnly) {
  EXPECT_TRUE(EqualsIgnoringCase(":Degrees", ":DEGREES"));
  EXPECT_FALSE(EqualsIgnoringCase("deg", "degrees"));
  EXPECT_FALSE(EqualsIgnoringCase("[", "{"));
  EXPECT_EQ(ToLower("ÄbC"), "Äbc");
}

TEST(Quoted, ShowsWhatCannotBePrinted) {
  EXPECT_EQ(Quoted("lfoot"), "'lfoot'");
  EXPECT_EQ(Quoted(std::string("a\0\n\x7F", 4)), "'a\\x00\\x0A\\x7F'");
}

TEST(Quoted, ShortensLongText) {
  EXPECT_EQ(Quoted(std::string(41, 'a')), "'" + std::string(40, 'a') + "…'");
  EXPECT_LT(Quoted(std::string(1'000'000, 'a')).size(), 50);
}

// Messages go to terminals and into JSON, which both want UTF-8.
TEST(Quoted, IsValidUtf8WhateverTheBytes) {
  EXPECT_EQ(Quoted("größe €"), "'größe €'");
  EXPECT_EQ(Quoted("gr\xF6\xDF"), "'gr\\xF6\\xDF'");
  EXPECT_EQ(Quoted("\xE2\x82"), "'\\xE2\\x82'");
  EXPECT_EQ(Quoted("\xC0\xAF\xED\xA0\x80"), "'\\xC0\\xAF\\xED\\xA0\\x80'");
  // A character of two bytes across the place where it is cut.
  EXPECT_EQ(Quoted(std::string(39, 'a') + "ö" + "b"), "'" + std::string(39, 'a') + "…'");
}

}  // namespace
}  // namespace kinebase
