// Numbers of text formats against the C library: every value comes out to the last bit.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "fmt/format.h"
#include "kinebase/formats/amc.h"
#include "kinebase/formats/bvh.h"
#include "kinebase/formats/csm.h"

namespace kinebase {
namespace {

constexpr std::size_t kColumns = 3;

std::string Digits(std::mt19937& random, std::size_t count) {
  std::string digits;
  while (digits.size() < count) digits += static_cast<char>('0' + random() % 10);
  return digits;
}

// A number of any form that these formats have: "7", "-0.5", ".25", "3.", "-2.07272e-014".
std::string NumberText(std::mt19937& random) {
  const std::size_t whole = random() % 4 == 0 ? random() % 20 : 1 + random() % 4;
  const std::size_t fraction = random() % 4 == 0 ? random() % 20 : random() % 8;
  std::string text = random() % 2 == 0 ? "-" : "";
  text += Digits(random, whole == 0 && fraction == 0 ? 1 : whole);
  if (fraction > 0 || random() % 8 == 0) text += "." + Digits(random, fraction);
  if (random() % 4 == 0) {
    constexpr std::string_view kMarks[] = {"e", "E", "e-", "e+", "e-0"};
    text += fmt::format("{}{}", kMarks[random() % 5], random() % 26);
  }
  return text;
}

std::vector<std::string> NumberTexts() {
  std::mt19937 random(11);
  // Halfway between two doubles, at the largest whole number, small and large powers.
  std::vector<std::string> texts = {"9007199254740993",
                                    "9007199254740992",
                                    "0.9007199254740993",
                                    "1e22",
                                    "1e23",
                                    "-1e-22",
                                    "1e-23",
                                    "12345678.12345678",
                                    "90071992.54740993",
                                    "0",
                                    "-0",
                                    "-0.0"};
  while (texts.size() < 30'000) texts.push_back(NumberText(random));
  return texts;
}

void ExpectTheSame(const std::vector<std::string>& texts, const std::vector<double>& values) {
  ASSERT_EQ(values.size(), texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const double expected = std::strtod(texts[i].c_str(), nullptr);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(values[i]), std::bit_cast<std::uint64_t>(expected))
        << texts[i] << " is read as " << values[i];
  }
}

// The texts in rows: `row` writes what comes before a row, given its number.
template <typename Row>
std::string Table(std::string head, const std::vector<std::string>& texts, Row row) {
  for (std::size_t i = 0; i < texts.size(); i += kColumns) {
    head += row(i / kColumns + 1);
    head += fmt::format("{} {} {}\n", texts[i], texts[i + 1], texts[i + 2]);
  }
  return head;
}

constexpr std::string_view kBvhHead =
    "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n}\nMOTION\n";

TEST(NumberText, OfAnAmcFileIsReadToTheLastBit) {
  const auto texts = NumberTexts();
  const auto row = [](std::size_t number) { return fmt::format("{}\na ", number); };
  ExpectTheSame(texts, ParseAmc(Table("", texts, row), "a.amc").values);
}

TEST(NumberText, OfABvhFileIsReadToTheLastBit) {
  const auto texts = NumberTexts();
  const auto row = [](std::size_t) { return std::string(); };
  ExpectTheSame(texts, ParseBvh(Table(std::string(kBvhHead), texts, row), "a.bvh").values);
}

TEST(NumberText, OfACsmFileIsReadToTheLastBit) {
  const auto texts = NumberTexts();
  const auto row = [](std::size_t number) { return fmt::format("{} ", number); };
  ExpectTheSame(texts, ParseCsm(Table("$order a\n$points\n", texts, row), "a.csm").values);
}

// Numbers are read several bytes at a time; here nothing stands behind them.
TEST(NumberText, MayEndWithTheFile) {
  for (std::size_t length = 1; length <= 40; ++length) {
    std::string text = std::string(kBvhHead) + "-0.5 12 " + std::string(length, '1');
    const std::vector<char> bytes(text.begin(), text.end());
    const BvhMotion bvh = ParseBvh({bytes.data(), bytes.size()}, "a.bvh");
    ExpectTheSame({"-0.5", "12", std::string(length, '1')}, bvh.values);
  }
}

}  // namespace
}  // namespace kinebase
