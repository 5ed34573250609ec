// Replays fuzz/corpus/segment: files named good_… are read, those named bad_… refused with a
// message that names them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "kinebase/core/error.h"
#include "kinebase/library/segment_file.h"
#include "support/files.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

void ReadAll(const fs::path& path) {
  const SegmentFile file(path);
  for (int i = 0; i < file.reader().take_count(); ++i) {
    (void)file.reader().Columns(i);
    (void)file.reader().RunListsOf(i);
    if (file.reader().HasPoses(i)) (void)file.reader().Poses(i);
  }
}

TEST(SegmentCorpus, IsReadOrRefusedAsItsNamesSay) {
  int good = 0;
  int bad = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(KINEBASE_SOURCE_DIR) / "fuzz" / "corpus" / "segment")) {
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    if (name.starts_with("good_")) {
      EXPECT_NO_THROW(ReadAll(entry.path()));
      ++good;
      continue;
    }
    const Error error = test::ErrorOf([&] { ReadAll(entry.path()); });
    EXPECT_EQ(error.code(),
              name == "bad_newer_version" ? ErrorCode::kMismatch : ErrorCode::kMalformedFile);
    EXPECT_THAT(error.what(), testing::HasSubstr(name));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
    ++bad;
  }
  EXPECT_GE(good, 2);
  EXPECT_GE(bad, 8);
}

}  // namespace
}  // namespace kinebase
