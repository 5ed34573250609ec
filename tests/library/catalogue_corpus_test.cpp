// Replays fuzz/corpus/catalogue: files named good_… are read and sound, those named bad_… are
// refused with a message that names the catalogue, or found to be damaged.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "kinebase/core/error.h"
#include "kinebase/library/library_upkeep.h"
#include "kinebase/library/take_library.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

bool IsRowDamaged(const StoredTake& take) { return !take.is_intact; }

// Segments are not there, so only what the catalogue itself says is looked at.
bool IsSound(const fs::path& library) {
  const TakeLibrary opened(library);
  const VerifyReport report = VerifyLibrary(library, 1);
  return std::ranges::none_of(opened.takes(), IsRowDamaged) && report.damaged_records.empty() &&
         !report.words_are_damaged;
}

TEST(CatalogueCorpus, IsReadOrRefusedAsItsNamesSay) {
  int good = 0;
  int bad = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(KINEBASE_SOURCE_DIR) / "fuzz" / "corpus" / "catalogue")) {
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    const test::TemporaryFolder library;
    fs::copy_file(entry.path(), library.path() / "catalogue.sqlite");
    std::optional<bool> is_sound;
    std::string message;
    try {
      is_sound = IsSound(library.path());
    } catch (const Error& error) {
      message = error.what();
    }
    if (name.starts_with("good_")) {
      EXPECT_EQ(is_sound, true) << message;
      ++good;
      continue;
    }
    EXPECT_NE(is_sound, true);
    if (!is_sound) {
      EXPECT_THAT(message, testing::HasSubstr("catalogue.sqlite"));
      EXPECT_THAT(message, testing::Not(testing::HasSubstr("\n")));
    }
    ++bad;
  }
  EXPECT_GE(good, 3);
  EXPECT_GE(bad, 8);
}

}  // namespace
}  // namespace kinebase
