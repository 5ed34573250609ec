#include "library/sqlite_database.h"

#include <sqlite3.h>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase::internal {
namespace {

// What reading and making takes visible lasts is milliseconds, but nothing holds a reader to that:
// a program may be stopped in the middle, other programs take their time.
constexpr int kCommitAttempts = 6;

constexpr int kKindOfResult = 0xFF;  // Of an extended result code.

Error ToError(int result, const char* message, const std::filesystem::path& file) {
  switch (result & kKindOfResult) {
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
    case SQLITE_ERROR:  // Of statements that are ours: a table or a column of theirs is missing.
      return {
          ErrorCode::kMalformedFile,
          fmt::format("is no catalogue that can be read ({}); restore it from a copy, or import "
                      "the files into a new library",
                      message),
          {.file = file}};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {ErrorCode::kIoFailure, "is in use by another program; try again", {.file = file}};
    default:
      return {ErrorCode::kIoFailure,
              fmt::format("cannot read or write the catalogue: {}", message),
              {.file = file}};
  }
}

}  // namespace

void SqliteDatabase::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

SqliteDatabase::SqliteDatabase(const std::filesystem::path& file, Access access,
                               std::chrono::milliseconds patience)
    : file_(file) {
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE |
                    (access == Access::kCreate ? SQLITE_OPEN_CREATE : 0);
  sqlite3* handle = nullptr;
  const int result = sqlite3_open_v2(file.c_str(), &handle, flags, nullptr);
  handle_.reset(handle);  // There is one even where opening failed.
  if (result != SQLITE_OK) ThrowError(result);
  sqlite3_busy_timeout(handle, static_cast<int>(patience.count()));
}

void SqliteDatabase::ThrowError(int result) const {
  const char* message = handle_ ? sqlite3_errmsg(handle_.get()) : sqlite3_errstr(result);
  throw ToError(result, message, file_);
}

void SqliteDatabase::Execute(const char* sql) const {
  const int result = sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr);
  if (result != SQLITE_OK) ThrowError(result);
}

std::int64_t SqliteDatabase::Number(const char* sql) const {
  SqliteStatement statement(*this, sql);
  return statement.Step() ? statement.Integer(0) : 0;
}

bool SqliteDatabase::is_read_only() const {
  return sqlite3_db_readonly(handle_.get(), "main") == 1;
}

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SqliteStatement::SqliteStatement(const SqliteDatabase& database, std::string_view sql)
    : database_(&database) {
  sqlite3_stmt* statement = nullptr;
  Check(sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()), &statement,
                           nullptr));
  statement_.reset(statement);
}

void SqliteStatement::Check(int result) const {
  if (result != SQLITE_OK) database_->ThrowError(result);
}

SqliteStatement& SqliteStatement::Bind(std::int64_t number) {
  Check(sqlite3_bind_int64(statement_.get(), ++bound_, number));
  return *this;
}

SqliteStatement& SqliteStatement::Bind(double number) {
  Check(sqlite3_bind_double(statement_.get(), ++bound_, number));
  return *this;
}

SqliteStatement& SqliteStatement::Bind(std::string_view text) {
  // Text without an address would be NULL and not empty.
  Check(sqlite3_bind_text(statement_.get(), ++bound_, text.empty() ? "" : text.data(),
                          static_cast<int>(text.size()), SQLITE_TRANSIENT));
  return *this;
}

SqliteStatement& SqliteStatement::Bind(const std::optional<double>& number) {
  if (number) return Bind(*number);
  Check(sqlite3_bind_null(statement_.get(), ++bound_));
  return *this;
}

bool SqliteStatement::Step() {
  const int result = sqlite3_step(statement_.get());
  if (result == SQLITE_ROW) return true;
  if (result != SQLITE_DONE) database_->ThrowError(result);
  return false;
}

void SqliteStatement::Run() {
  while (Step()) {
  }
  Check(sqlite3_reset(statement_.get()));
  bound_ = 0;
}

std::int64_t SqliteStatement::Integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double SqliteStatement::Real(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

std::string SqliteStatement::Text(int column) const {
  const auto* text = sqlite3_column_text(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text), static_cast<std::size_t>(size)};
}

std::optional<double> SqliteStatement::RealOrNull(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return {};
  return Real(column);
}

SqliteTransaction::SqliteTransaction(const SqliteDatabase& database, Kind kind)
    : database_(database) {
  database.Execute(kind == Kind::kWrite ? "BEGIN IMMEDIATE" : "BEGIN");
}

SqliteTransaction::~SqliteTransaction() {
  // What fails here was taken back already, or will be by whoever opens the catalogue next.
  if (is_open_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void SqliteTransaction::Commit() {
  int result = SQLITE_BUSY;
  // A transaction that readers keep from its end is still open, and can be ended later.
  for (int i = 0; i < kCommitAttempts && (result & kKindOfResult) == SQLITE_BUSY; ++i) {
    result = sqlite3_exec(database_.handle(), "COMMIT", nullptr, nullptr, nullptr);
  }
  if (result != SQLITE_OK) database_.ThrowError(result);
  is_open_ = false;
}

}  // namespace kinebase::internal
