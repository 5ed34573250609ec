// Replays fuzz/corpus/table: the second word of a file's name is the reader, which reads files
// named good_… and refuses those named bad_… with a message that names them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/library/annotation_file.h"
#include "kinebase/library/evaluation.h"
#include "kinebase/library/takes.h"
#include "support/files.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

using Read = std::function<void(std::string_view text, const fs::path& file)>;

const std::map<std::string, Read>& Readers() {
  static const std::map<std::string, Read> readers = {
      {"csv", [](auto text, const auto& file) { (void)ParseCsv(text, file); }},
      {"labels", [](auto text, const auto& file) { (void)ParseSegmentLabels(text, file); }},
      {"clips", [](auto text, const auto& file) { (void)ParseClipList(text, file); }},
      {"relevant",
       [](auto text, const auto& file) { (void)PossiblyRelevant::Parse(text, file, text, file); }}};
  return readers;
}

TEST(TableCorpus, IsReadOrRefusedAsItsNamesSay) {
  int good = 0;
  int bad = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(KINEBASE_SOURCE_DIR) / "fuzz" / "corpus" / "table")) {
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    const std::size_t begin = name.find('_') + 1;
    const Read& read = Readers().at(name.substr(begin, name.find('_', begin) - begin));
    const std::string text = test::ReadText(entry.path());
    if (name.starts_with("good_")) {
      EXPECT_NO_THROW(read(text, entry.path()));
      ++good;
      continue;
    }
    const Error error = test::ErrorOf([&] { read(text, entry.path()); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    EXPECT_THAT(error.what(), testing::HasSubstr(name));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
    ++bad;
  }
  EXPECT_GE(good, 5);
  EXPECT_GE(bad, 10);
}

}  // namespace
}  // namespace kinebase
