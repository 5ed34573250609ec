#include "library/sqlite_database.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <thread>

#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase::internal {
namespace {

using std::chrono::milliseconds;
using Kind = SqliteTransaction::Kind;

constexpr milliseconds kPatience(100);

class BusyDatabase : public testing::Test {
 protected:
  BusyDatabase() { writer_.Execute("CREATE TABLE numbers(number)"); }

  // A transaction that has read, so that no other can end.
  void BeginReading(std::optional<SqliteTransaction>& transaction) const {
    transaction.emplace(reader_, Kind::kRead);
    EXPECT_EQ(reader_.Number("SELECT count(*) FROM numbers"), 0);
  }

  test::TemporaryFolder folder_;
  SqliteDatabase writer_{folder_.path() / "db", SqliteDatabase::Access::kCreate, kPatience};
  SqliteDatabase reader_{folder_.path() / "db", SqliteDatabase::Access::kRead, kPatience};
};

TEST_F(BusyDatabase, IsWrittenWhenAReaderEndsThatTookLongerThanAStatementWaits) {
  std::optional<SqliteTransaction> reading;
  BeginReading(reading);
  std::thread end([&] {
    std::this_thread::sleep_for(2 * kPatience);
    reading.reset();
  });
  {
    SqliteTransaction writing(writer_, Kind::kWrite);
    writer_.Execute("INSERT INTO numbers VALUES(1)");
    writing.Commit();
  }
  end.join();
  EXPECT_EQ(reader_.Number("SELECT count(*) FROM numbers"), 1);
}

TEST_F(BusyDatabase, IsGivenUpOnInTheEnd) {
  std::optional<SqliteTransaction> reading;
  BeginReading(reading);
  {
    SqliteTransaction writing(writer_, Kind::kWrite);
    writer_.Execute("INSERT INTO numbers VALUES(1)");
    const Error error = test::ErrorOf([&] { writing.Commit(); });
    EXPECT_EQ(error.code(), ErrorCode::kIoFailure);
    EXPECT_THAT(error.what(), testing::HasSubstr("in use by another program; try again"));
  }
  reading.reset();
  EXPECT_EQ(reader_.Number("SELECT count(*) FROM numbers"), 0);
}

}  // namespace
}  // namespace kinebase::internal
