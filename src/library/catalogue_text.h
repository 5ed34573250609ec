// The words by which takes are found. Internal.
//
// They stand in an FTS5 table, take_text, a row a take with its id; whoever changes a take changes
// its row in the same transaction.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/library/take_library.h"
#include "library/sqlite_database.h"

namespace kinebase::internal {

// Inside of a transaction that writes. Adds a take's row, or replaces it.
void PutText(const SqliteDatabase& database, const StoredTake& take);
void RemoveText(const SqliteDatabase& database, std::int64_t take);

// Rows that are not there yet. Inside of a transaction that writes, where it is not the temporary
// table.
void FillText(const SqliteDatabase& database, std::span<const StoredTake> takes);

[[nodiscard]] bool HasTextTable(const SqliteDatabase& database);
// Whether there is a row for each take, whatever it says. Cost  O(takes).
[[nodiscard]] bool HasTextOfAll(const SqliteDatabase& database);

// The takes that have all words of the query or words that begin so, ascending. Marks in the query
// only part words.
[[nodiscard]] std::vector<std::int64_t> FindText(const SqliteDatabase& database,
                                                 std::string_view query);

// Whether the rows are those of the takes, as far as these are intact. Inside of one transaction
// with the takes.
[[nodiscard]] bool HasTextOf(const SqliteDatabase& database, const std::vector<StoredTake>& takes);

// Whether the index over the rows is that of the rows. Outside of transactions that read: it takes
// the right to write for a moment, and changes nothing. Not looked at where nobody may write.
[[nodiscard]] bool HasSoundTextIndex(const SqliteDatabase& database);

}  // namespace kinebase::internal
