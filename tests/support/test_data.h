// Real recordings and golden results that tests read in place.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace kinebase::test {

// Whether there is a folder with `data` and `golden` in it: $KINEBASE_TEST_DATA, or ../shared from
// the project's root.
bool HasTestData();

// A path below that folder.
std::filesystem::path TestData(const std::filesystem::path& relative);

}  // namespace kinebase::test

// For the first line of a test: on a machine without the recordings the test says so.
#define KINEBASE_NEEDS_TEST_DATA()                                                   \
  if (!kinebase::test::HasTestData()) {                                              \
    GTEST_SKIP() << "no test recordings: set KINEBASE_TEST_DATA to the folder with " \
                    "'data' and 'golden'";                                           \
  }                                                                                  \
  static_assert(true)
