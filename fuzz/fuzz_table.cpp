// Any bytes as a table: of labels, of clips, of what distractors may show. Each reader gives what
// is safe to use or one kinebase::Error; a table is the same after writing and reading it, and
// labels become an ELAN document without characters that XML has no place for.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/library/annotation_file.h"
#include "kinebase/library/evaluation.h"
#include "kinebase/library/takes.h"

namespace {

void Check(bool holds) {
  if (!holds) std::abort();
}

// Another exception than kinebase::Error leaves through here and is a finding.
template <typename Read>
void Try(const Read& read) {
  try {
    read();
  } catch (const kinebase::Error& error) {
    Check(error.code() == kinebase::ErrorCode::kMalformedFile);
    Check(std::string_view(error.what()).starts_with("fuzz.csv"));
  }
}

std::string Row(const std::vector<std::string>& fields) {
  // An empty line is no row.
  if (fields.size() == 1 && fields.front().empty()) return "\"\"\n";
  std::string row = kinebase::CsvField(fields.front());
  for (std::size_t i = 1; i < fields.size(); ++i) row += ',' + kinebase::CsvField(fields[i]);
  return row + '\n';
}

void TryCsv(std::string_view text) {
  const kinebase::CsvTable table = kinebase::ParseCsv(text, "fuzz.csv");
  std::string written = "\xEF\xBB\xBF" + Row(table.columns);
  for (const auto& row : table.rows) {
    Check(row.size() == table.columns.size());
    written += Row(row);
  }
  const kinebase::CsvTable again = kinebase::ParseCsv(written, "fuzz.csv");
  Check(again.columns == table.columns && again.rows == table.rows);
  Check(std::ranges::is_sorted(table.lines) && table.lines.size() == table.rows.size());
}

void TryLabels(std::string_view text) {
  std::vector<kinebase::AnnotationTier> tiers;
  for (const auto& label : kinebase::ParseSegmentLabels(text, "fuzz.csv")) {
    Check(label.first_frame >= 1 && label.first_frame <= label.last_frame && label.line >= 2);
    tiers.push_back({.name = std::to_string(tiers.size()) + label.recording,
                     .segments = {{.end_s = 1, .text = label.label}}});
  }
  const std::string document = kinebase::FormatElan(tiers, {});
  Check(std::ranges::none_of(
      document, [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\n'; }));
}

void TryClips(std::string_view text) {
  for (const kinebase::ListedClip& clip : kinebase::ParseClipList(text, "fuzz.csv")) {
    Check(!clip.name.empty() && !clip.class_name.empty() && clip.file.empty() && clip.line >= 2);
  }
}

void TryRelevant(std::string_view text) {
  const auto relevant = kinebase::PossiblyRelevant::Parse(text, "fuzz.csv", text, "fuzz.csv");
  (void)relevant.MayShow("squat", "13_29", 100);
  Check(!kinebase::PossiblyRelevant().MayShow("squat", "13_29", 100));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Try([&] { TryCsv(text); });
  Try([&] { TryLabels(text); });
  Try([&] { TryClips(text); });
  Try([&] { TryRelevant(text); });
  return 0;
}
