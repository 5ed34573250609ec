// The words by which takes are found. Internal.
//
// They stand in an FTS5 table, take_text, a row a take with its id; whoever changes a take changes
// its row in the same transaction.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/library/take_library.h"
#include "library/sqlite_database.h"

namespace kinebase::internal {

// Inside of a transaction that writes. Adds a take's row, or replaces it.
void PutText(const SqliteDatabase& database, const StoredTake& take);
void RemoveText(const SqliteDatabase& database, std::int64_t take);

// All rows of a table that is empty. Inside of a transaction that writes, where it is not the
// temporary table.
void FillText(const SqliteDatabase& database, const std::vector<StoredTake>& takes);

// The takes that have all words of the query or words that begin so, ascending. Marks in the query
// only part words.
[[nodiscard]] std::vector<std::int64_t> FindText(const SqliteDatabase& database,
                                                 std::string_view query);

// Whether the rows are those of the takes. Inside of one transaction with the takes.
[[nodiscard]] bool HasTextOf(const SqliteDatabase& database, const std::vector<StoredTake>& takes);

// Whether the index over the rows is that of the rows. Outside of transactions that read: it takes
// the right to write for a moment, and changes nothing. Not looked at where nobody may write.
[[nodiscard]] bool HasSoundTextIndex(const SqliteDatabase& database);

}  // namespace kinebase::internal
