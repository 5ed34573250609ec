// SQLite with errors of ours: a database, its statements, a transaction. Internal.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace kinebase::internal {

// One connection. Not for use from several threads at once.
//
// Errors  Of all members of this file: IoFailure where the system or another program is in the way,
//         MalformedFile where the file is damaged; each names the file.
class SqliteDatabase {
 public:
  enum class Access { kRead, kCreate };

  static constexpr std::chrono::milliseconds kPatience = std::chrono::seconds(20);

  // A reader, too, may write: it takes back what a program that was killed left half done.
  // patience  How long a statement waits for others.
  SqliteDatabase(const std::filesystem::path& file, Access access,
                 std::chrono::milliseconds patience = kPatience);

  void Execute(const char* sql) const;
  [[nodiscard]] std::int64_t Number(const char* sql) const;  // The one number of a query.

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] bool is_read_only() const;  // As the system has it, whatever was asked for.
  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  [[noreturn]] void ThrowError(int result) const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> handle_;
};

class SqliteStatement {
 public:
  SqliteStatement(const SqliteDatabase& database, std::string_view sql);

  // Parameters from the first, "?1", on.
  SqliteStatement& Bind(std::int64_t number);
  SqliteStatement& Bind(double number);
  SqliteStatement& Bind(std::string_view text);
  SqliteStatement& Bind(const std::optional<double>& number);  // Empty: NULL.

  [[nodiscard]] bool Step();  // Whether there is another row.
  void Run();                 // To the end; then it can be bound again.

  [[nodiscard]] std::int64_t Integer(int column) const;
  [[nodiscard]] double Real(int column) const;
  [[nodiscard]] std::string Text(int column) const;
  [[nodiscard]] std::optional<double> RealOrNull(int column) const;

 private:
  void Check(int result) const;

  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  const SqliteDatabase* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int bound_ = 0;
};

// All or nothing. Taken back unless Commit() was reached.
class SqliteTransaction {
 public:
  enum class Kind { kRead, kWrite };

  SqliteTransaction(const SqliteDatabase& database, Kind kind);
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;

  // Waits six times as long as other statements: what leads to here was much work.
  void Commit();

 private:
  const SqliteDatabase& database_;
  bool is_open_ = true;
};

}  // namespace kinebase::internal
