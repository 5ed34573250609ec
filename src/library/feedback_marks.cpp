// Reading tables of hits that somebody marked.
#include <optional>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/feedback.h"
#include "nlohmann/json.hpp"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Nothing where there is no verdict.
std::optional<Verdict> VerdictOf(std::string_view text, std::string_view what, const Place& place) {
  const std::string word = ToLower(Trim(text));
  if (word.empty()) return std::nullopt;
  const std::optional<Verdict> verdict = ParseVerdict(word);
  if (verdict) return verdict;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("{}verdict {}; expected right or wrong, or nothing for a hit that is not "
                          "judged",
                          what, Quoted(text)),
              place);
}

void CheckFrames(const TemplateMark& mark, std::string_view what, const Place& place) {
  if (mark.first_frame >= 1 && mark.last_frame >= mark.first_frame) return;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("{}frames {} to {}; expected first_frame and last_frame from 1, the last "
                          "not before the first",
                          what, mark.first_frame, mark.last_frame),
              place);
}

std::int64_t FrameOf(const std::string& text, const Place& place) {
  const auto frame = ParseInteger(Trim(text));
  if (frame) return *frame;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("frame {}; expected a whole number from 1", Quoted(text)), place);
}

std::vector<ListedMark> ReadCsvMarks(std::string_view text, const fs::path& file) {
  const CsvTable table = ParseCsv(text, file);
  const std::size_t file_column = table.Column("file");
  const std::size_t first_column = table.Column("first_frame");
  const std::size_t last_column = table.Column("last_frame");
  const std::size_t verdict_column = table.Column("verdict");
  const auto template_column = table.FindColumn("template");
  std::vector<ListedMark> marks;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<std::string>& row = table.rows[i];
    const Place place{file, table.lines[i]};
    const std::optional<Verdict> verdict = VerdictOf(row[verdict_column], "", place);
    if (!verdict) continue;
    ListedMark& listed = marks.emplace_back();
    listed.mark = {.file = row[file_column],
                   .first_frame = FrameOf(row[first_column], place),
                   .last_frame = FrameOf(row[last_column], place),
                   .verdict = *verdict};
    if (template_column) listed.template_name = row[*template_column];
    listed.place = place;
    CheckFrames(listed.mark, "", place);
  }
  return marks;
}

json ParseHits(std::string_view text, const fs::path& file) {
  json document = json::parse(text, nullptr, false);
  if (document.is_discarded()) {
    throw Error(ErrorCode::kMalformedFile,
                "not JSON, though it begins with '{': an edit may have left a comma too many or "
                "too few",
                {file});
  }
  if (!document.contains("hits") || !document["hits"].is_array()) {
    throw Error(ErrorCode::kMalformedFile,
                "has no list of hits; expected what kinebase search --json gives, with verdicts",
                {file});
  }
  return std::move(document["hits"]);
}

// One field of a hit.
template <typename T>
T FieldOf(const json& hit, const char* key, std::string_view what, const fs::path& file) {
  try {
    return hit.at(key).get<T>();
  } catch (const json::exception&) {
    throw Error(ErrorCode::kMalformedFile,
                fmt::format("{}no usable \"{}\"; expected hits as kinebase search --json gives "
                            "them, with a \"verdict\" of \"right\" or \"wrong\" in some",
                            what, key),
                {file});
  }
}

std::vector<ListedMark> ReadJsonMarks(std::string_view text, const fs::path& file) {
  std::vector<ListedMark> marks;
  std::size_t number = 0;
  for (const json& hit : ParseHits(text, file)) {
    const std::string what = fmt::format("hit {}: ", ++number);
    if (!hit.is_object() || !hit.contains("verdict") || hit["verdict"].is_null()) continue;
    const Place place{file};
    const auto verdict = VerdictOf(FieldOf<std::string>(hit, "verdict", what, file), what, place);
    if (!verdict) continue;
    ListedMark& listed = marks.emplace_back();
    listed.mark = {.file = FieldOf<std::string>(hit, "file", what, file),
                   .first_frame = FieldOf<std::int64_t>(hit, "first_frame", what, file),
                   .last_frame = FieldOf<std::int64_t>(hit, "last_frame", what, file),
                   .verdict = *verdict};
    if (hit.contains("template")) {
      listed.template_name = FieldOf<std::string>(hit, "template", what, file);
    }
    listed.place = place;
    CheckFrames(listed.mark, what, place);
  }
  return marks;
}

}  // namespace

std::vector<ListedMark> ReadMarks(const fs::path& table) {
  const MappedFile file(table);
  std::string_view text = file.text();
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  const bool is_json = begin != std::string_view::npos && text[begin] == '{';
  return is_json ? ReadJsonMarks(text, table) : ReadCsvMarks(text, table);
}

}  // namespace kinebase
