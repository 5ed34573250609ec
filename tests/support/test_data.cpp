#include "support/test_data.h"

#include <cstdlib>

namespace kinebase::test {
namespace {

std::filesystem::path TestDataRoot() {
  if (const char* named = std::getenv("KINEBASE_TEST_DATA")) return named;
  return std::filesystem::path(KINEBASE_SOURCE_DIR).parent_path() / "shared";
}

}  // namespace

bool HasTestData() {
  return std::filesystem::is_directory(TestDataRoot() / "data") &&
         std::filesystem::is_directory(TestDataRoot() / "golden");
}

std::filesystem::path TestData(const std::filesystem::path& relative) {
  return TestDataRoot() / relative;
}

}  // namespace kinebase::test
