#include "kinebase/core/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Csv, ReadsPlainRowsWithEveryLineEnding) {
  for (const char* text : {"a,b\n1,2\n3,\n", "a,b\r\n1,2\r\n3,\r\n", "a,b\r1,2\r3,",
                           "\xEF\xBB\xBF"
                           "a,b\n1,2\n3,"}) {
    const CsvTable table = ParseCsv(text, "t.csv");
    EXPECT_THAT(table.columns, ElementsAre("a", "b"));
    EXPECT_THAT(table.rows, ElementsAre(ElementsAre("1", "2"), ElementsAre("3", "")));
    EXPECT_THAT(table.lines, ElementsAre(2, 3));
  }
}

TEST(Csv, ReadsQuotedFields) {
  const CsvTable table = ParseCsv("a,b\n\"1,\"\"x\"\"\",\"two\nlines\"\n\"\",4\n", "t.csv");
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("1,\"x\"", "two\nlines"), ElementsAre("", "4")));
  EXPECT_THAT(table.lines, ElementsAre(2, 4));
}

TEST(Csv, PassesOverBlankLines) {
  const CsvTable table = ParseCsv("\n\na\n\n1\n\n\n2", "t.csv");
  EXPECT_THAT(table.columns, ElementsAre("a"));
  EXPECT_THAT(table.lines, ElementsAre(5, 8));
}

TEST(Csv, NamesTheLineOfARowOfAnotherLength) {
  const Error error = test::ErrorOf([] { (void)ParseCsv("a,b\n1,2\n\n1,2,3\n", "t.csv"); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_STREQ(error.what(), "t.csv:4: 3 fields; the header has 2");
}

TEST(Csv, NamesTheLineWhereAnOpenQuoteBegan) {
  const Error error = test::ErrorOf([] { (void)ParseCsv("a,b\n1,\"2\n3,4\n", "t.csv"); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_EQ(error.place().line, 2);
}

TEST(Csv, RefusesTextAfterAClosingQuote) {
  const Error error = test::ErrorOf([] { (void)ParseCsv("a,b\n1,\"2\"3\n", "t.csv"); });
  EXPECT_EQ(error.place().line, 2);
}

TEST(Csv, RefusesATextWithoutHeader) {
  for (const char* text : {"", "\n\r\n", "\xEF\xBB\xBF"}) {
    const Error error = test::ErrorOf([&] { (void)ParseCsv(text, "t.csv"); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  }
}

TEST(Csv, NamesTheColumnsThatThereAreWhenOneIsMissing) {
  const CsvTable table = ParseCsv("file,class\n", "list.csv");
  EXPECT_EQ(table.Column("class"), 1);
  EXPECT_FALSE(table.FindColumn("actor"));
  const Error error = test::ErrorOf([&] { (void)table.Column("actor"); });
  EXPECT_THAT(error.what(), HasSubstr("list.csv:1: no column 'actor'; there are: file, class"));
}

RC_GTEST_PROP(Csv, ReadsBackWhateverCsvFieldWrote, ()) {
  const auto field =
      rc::gen::container<std::string>(rc::gen::elementOf(std::string("ab,\" \n\r\t")));
  const auto rows = *rc::gen::container<std::vector<std::vector<std::string>>>(
      rc::gen::container<std::vector<std::string>>(2, field));
  std::string text = "x,y\n";
  for (const auto& row : rows) text += CsvField(row[0]) + ',' + CsvField(row[1]) + '\n';
  RC_ASSERT(ParseCsv(text, "t.csv").rows == rows);
}

}  // namespace
}  // namespace kinebase
