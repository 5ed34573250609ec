#include "library/catalogue_text.h"

#include <array>
#include <functional>
#include <unordered_map>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/motion_file.h"
#include "library/name_words.h"

namespace kinebase::internal {
namespace {

constexpr std::size_t kColumns = 6;
using Texts = std::array<std::string, kColumns>;  // In the order of the table's columns.

// As it stands, and its words: "squat1Reps" is found by "squat" and by "reps".
std::string WithWords(const std::string& name) {
  const std::string spaced = SpacedName(name);
  return spaced == name ? name : name + ' ' + spaced;
}

Texts TextsOf(const StoredTake& take) {
  std::string labels;
  for (const StoredLabel& label : take.labels) labels += WithWords(label.text) + '\n';
  return {WithWords(take.path.stem().string()),
          WithWords(take.name.class_name),
          take.name.actor,
          WithWords(take.skeleton.path.stem().string()),
          labels,
          take.description};
}

// Names of files stand there without their ending: "86_01.amc" is found as 86_01.
std::string_view WithoutEnding(std::string_view word) {
  const std::size_t dot = word.rfind('.');
  const bool is_file = dot != std::string_view::npos && FindMotionFormat(word) != nullptr;
  return is_file ? word.substr(0, dot) : word;
}

// Each word in quotes, where nothing in it is an operator; '*' for what begins so.
std::string MatchOf(std::string_view query) {
  std::string match;
  for (const std::string_view token : SplitTokens(query)) {
    const std::string_view word = WithoutEnding(token);
    match += match.empty() ? "\"" : " \"";
    for (const char c : word) match += c == '"' ? std::string("\"\"") : std::string(1, c);
    match += "\"*";
  }
  return match;
}

bool HasRowsOf(const SqliteDatabase& database, const std::vector<StoredTake>& takes) {
  std::unordered_map<std::int64_t, const StoredTake*> by_id;
  by_id.reserve(takes.size());
  for (const StoredTake& take : takes) by_id.emplace(take.id, &take);
  SqliteStatement rows(database, "SELECT rowid, * FROM main.take_text");
  std::size_t count = 0;
  for (; rows.Step(); ++count) {
    const auto take = by_id.find(rows.Integer(0));
    if (take == by_id.end()) return false;
    if (!take->second->is_intact) continue;  // Its words may be those that it had.
    const Texts expected = TextsOf(*take->second);
    for (std::size_t i = 0; i < kColumns; ++i) {
      if (rows.Text(static_cast<int>(i) + 1) != expected[i]) return false;
    }
  }
  return count == takes.size();
}

// What the check says, or false where SQLite finds damage on its way.
bool IsSound(const std::function<bool()>& check) {
  try {
    return check();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kMalformedFile) throw;
    return false;
  }
}

}  // namespace

void RemoveText(const SqliteDatabase& database, std::int64_t take) {
  SqliteStatement(database, "DELETE FROM take_text WHERE rowid = ?1").Bind(take).Run();
}

void PutText(const SqliteDatabase& database, const StoredTake& take) {
  RemoveText(database, take.id);
  FillText(database, std::span(&take, 1));
}

void FillText(const SqliteDatabase& database, std::span<const StoredTake> takes) {
  SqliteStatement row(database,
                      "INSERT INTO take_text(rowid, name, class, actor, skeleton, labels, "
                      "description) VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7)");
  for (const StoredTake& take : takes) {
    row.Bind(take.id);
    for (const std::string& text : TextsOf(take)) row.Bind(text);
    row.Run();
  }
}

std::vector<std::int64_t> FindText(const SqliteDatabase& database, std::string_view query) {
  std::vector<std::int64_t> ids;
  const std::string match = MatchOf(query);
  if (match.empty()) return ids;
  SqliteStatement rows(database, "SELECT rowid FROM take_text WHERE take_text MATCH ?1 ORDER BY 1");
  rows.Bind(match);
  while (rows.Step()) ids.push_back(rows.Integer(0));
  return ids;
}

bool HasTextTable(const SqliteDatabase& database) {
  return database.Number("SELECT count(*) FROM main.sqlite_master WHERE name = 'take_text'") > 0;
}

bool HasTextOfAll(const SqliteDatabase& database) {
  return IsSound([&] {
    return database.Number(
               "SELECT EXISTS(SELECT 1 FROM takes WHERE id NOT IN "
               "(SELECT rowid FROM main.take_text))") == 0;
  });
}

bool HasTextOf(const SqliteDatabase& database, const std::vector<StoredTake>& takes) {
  return IsSound([&] { return HasRowsOf(database, takes); });
}

bool HasSoundTextIndex(const SqliteDatabase& database) {
  if (database.is_read_only()) return true;
  return IsSound([&] {
    // A command in the form of a row.
    database.Execute("INSERT INTO take_text(take_text) VALUES('integrity-check')");
    return true;
  });
}

}  // namespace kinebase::internal
