#include "kinebase/core/folder_flush.h"

#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

TEST(FlushFolder, TakesFoldersAndNothingElse) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "file", "x");
  EXPECT_NO_THROW(FlushFolder(folder.path()));
  EXPECT_EQ(test::ErrorOf([&] { FlushFolder(folder.path() / "none"); }).code(),
            ErrorCode::kNotFound);
  EXPECT_EQ(test::ErrorOf([&] { FlushFolder(folder.path() / "file"); }).code(),
            ErrorCode::kNotFound);
}

}  // namespace
}  // namespace kinebase
