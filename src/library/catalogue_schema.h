// The tables of a catalogue, version by version. Internal.
#pragma once

#include <cstdint>

#include "library/sqlite_database.h"

namespace kinebase::internal {

inline constexpr std::int64_t kCatalogueVersion = 2;
inline constexpr std::int64_t kCatalogueApplication = 0x4B494E45;  // "KINE".

// Makes the tables that this version has and the one before had not; version 1 is made from
// nothing. Inside of a transaction that writes. What the new columns say of takes that were there
// is the caller's.
void MakeVersion(const SqliteDatabase& database, std::int64_t version);

// The table that texts are looked up in, in `schema`: "main", or "temp", which is gone with the
// connection and changes no file.
void MakeTextTable(const SqliteDatabase& database, const char* schema);

// Views and triggers, which no version has, may run for ever.
// Errors  MalformedFile if there are any.
void CheckSchema(const SqliteDatabase& database);

}  // namespace kinebase::internal
