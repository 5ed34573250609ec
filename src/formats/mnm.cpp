#include "kinebase/formats/mnm.h"

#include <algorithm>
#include <set>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "text_lines.h"

namespace kinebase {
namespace {

constexpr std::string_view kBlanksAndComma = " \t\v\f\r,";

// Takes the next name off the front of `text`; empty at the end.
std::string_view TakeName(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanksAndComma), text.size()));
  const std::size_t end = std::min(text.find_first_of(kBlanksAndComma), text.size());
  const std::string_view name = text.substr(0, end);
  text.remove_prefix(end);
  return name;
}

class MnmParser {
 public:
  MnmParser(std::string_view text, const std::filesystem::path& file, const MnmReadOptions& options)
      : lines_(text), file_(file), options_(options) {}

  MarkerNames Parse() {
    while (lines_.Next()) TakeLine(Trim(lines_.line()));
    if (names_.rows.empty()) {
      throw Error(ErrorCode::kMalformedFile,
                  "has no rows; expected two names a line, the preset's and the file's", {file_});
    }
    return std::move(names_);
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, lines_.line_number()});
  }

  void Repair(const std::string& message, const std::string& remedy) {
    if (options_.strict) Fail(fmt::format("{} (without --strict {})", message, remedy));
    names_.diagnostics.push_back(
        {Severity::kWarning, fmt::format("{}; {}", message, remedy), lines_.line_number()});
  }

  void TakeLine(std::string_view line) {
    CheckText(line);
    if (line.empty()) return;
    if (line.front() == '#' || line.front() == ';') {
      names_.comments.emplace_back(line);
      return;
    }
    if (line.find(',') != std::string_view::npos && !has_comma_) {
      has_comma_ = true;
      Repair("a comma, which names must not hold", "it is taken as a blank");
    }
    MarkerNames::Row row{.line = lines_.line_number()};
    row.preset = TakeName(line);
    row.custom = TakeName(line);
    if (row.custom.empty()) {
      if (!row.preset.empty()) Repair("only one name: " + Quoted(row.preset), "it is left out");
      return;
    }
    if (const auto more = TakeName(line); !more.empty()) {
      Repair("more than two names: " + Quoted(more), "the first two count");
    }
    if (row.preset.front() == '#' || row.preset.front() == ';') {
      // After a comma at the line's beginning. Written back, it would be a comment.
      Fail("a name begins with a comment's sign: " + Quoted(row.preset));
    }
    if (!presets_.insert(ToLower(row.preset)).second) {
      return Repair(fmt::format("{} stands twice on the left", Quoted(row.preset)),
                    "the first row counts");
    }
    if (!customs_.insert(ToLower(row.custom)).second) {
      return Repair(fmt::format("{} stands twice on the right", Quoted(row.custom)),
                    "the first row counts");
    }
    names_.rows.push_back(std::move(row));
  }

  void CheckText(std::string_view line) const {
    if (!internal::HoldsBinaryData(line)) return;
    Fail("holds binary data; expected the text of an MNM file");
  }

  LineScanner lines_;
  const std::filesystem::path& file_;
  const MnmReadOptions& options_;
  MarkerNames names_;
  std::set<std::string> presets_;  // Lower case.
  std::set<std::string> customs_;
  bool has_comma_ = false;
};

}  // namespace

std::optional<std::string_view> MarkerNames::PresetName(std::string_view custom) const {
  const auto found = std::ranges::find_if(
      rows, [&](const Row& row) { return EqualsIgnoringCase(row.custom, custom); });
  if (found == rows.end()) return std::nullopt;
  return found->preset;
}

std::optional<std::string_view> MarkerNames::CustomName(std::string_view preset) const {
  const auto found = std::ranges::find_if(
      rows, [&](const Row& row) { return EqualsIgnoringCase(row.preset, preset); });
  if (found == rows.end()) return std::nullopt;
  return found->custom;
}

MarkerNames ParseMnm(std::string_view text, const std::filesystem::path& file,
                     const MnmReadOptions& options) {
  return MnmParser(text, file, options).Parse();
}

MarkerNames ReadMnm(const std::filesystem::path& path, const MnmReadOptions& options) {
  const MappedFile file(path);
  return ParseMnm(file.text(), path, options);
}

std::string FormatMnm(const MarkerNames& names) {
  std::string out;
  const bool begins_with_a_name = names.comments.empty() && !names.rows.empty();
  if (begins_with_a_name && names.rows.front().preset.starts_with(kByteOrderMark)) {
    out += kByteOrderMark;
  }
  for (const auto& comment : names.comments) out += comment + '\n';
  for (const auto& row : names.rows) out += row.preset + ' ' + row.custom + '\n';
  return out;
}

}  // namespace kinebase
