// Reads the sections of a CSM file; csm_points.cpp reads the frames.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "csm_points.h"
#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/csm.h"
#include "text_lines.h"

namespace kinebase {
namespace {

enum class Section {
  kNone,
  kFileName,
  kDate,
  kTime,
  kActor,
  kComments,
  kFirstFrame,
  kLastFrame,
  kRate,
  kTalent,
  kSpineLinks,
  kOrder,
  kPoints,
  kUnknown,
};

struct Title {
  std::string_view name;
  Section section;
};

constexpr std::array kTitles = {
    Title{"filename", Section::kFileName},   Title{"capturedate", Section::kDate},
    Title{"date", Section::kDate},           Title{"capturetime", Section::kTime},
    Title{"time", Section::kTime},           Title{"actor", Section::kActor},
    Title{"comments", Section::kComments},   Title{"firstframe", Section::kFirstFrame},
    Title{"lastframe", Section::kLastFrame}, Title{"rate", Section::kRate},
    Title{"talent", Section::kTalent},       Title{"spinelinks", Section::kSpineLinks},
    Title{"order", Section::kOrder},         Title{"points", Section::kPoints},
};

Section FindSection(std::string_view title) {
  const auto found = std::ranges::find_if(
      kTitles, [&](const Title& each) { return EqualsIgnoringCase(each.name, title); });
  return found == kTitles.end() ? Section::kUnknown : found->section;
}

// Sections of text reach to the next line that begins with '$'; others may hold titles anywhere.
bool IsText(Section section) {
  return section == Section::kUnknown || section == Section::kComments ||
         (section >= Section::kFileName && section <= Section::kActor);
}

std::optional<CsmTalent::Unit> ParseTalentUnit(std::string_view word) {
  constexpr std::array<std::string_view, 5> kMillimetres = {"millimeter", "millimeters",
                                                            "millimetre", "millimetres", "mm"};
  constexpr std::array<std::string_view, 3> kInches = {"inches", "inch", "in"};
  const auto is_word = [&](std::string_view each) { return EqualsIgnoringCase(each, word); };
  if (std::ranges::any_of(kMillimetres, is_word)) return CsmTalent::Unit::kMillimetres;
  if (std::ranges::any_of(kInches, is_word)) return CsmTalent::Unit::kInches;
  return std::nullopt;
}

std::string JoinQuoted(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text.append(text.empty() ? "" : ", ").append(Quoted(name));
  return text;
}

class CsmParser {
 public:
  CsmParser(std::string_view text, const std::filesystem::path& file, const CsmReadOptions& options)
      : text_(text), file_(file), options_(options) {}

  CsmRecording Parse() {
    std::string_view rest = text_;
    while (!rest.empty()) rest = ReadUpToPoints(rest);
    EndSection();
    if (!seen_.contains(Section::kOrder)) Fail("has no '$order', the names of the markers", 0);
    if (!seen_.contains(Section::kPoints)) Fail("has no '$points'", 0);
    CheckRange();
    const std::int64_t links = csm_.spine_links.value_or(3);
    if (links != 2 && links != 3) {
      Report(Severity::kWarning, fmt::format("{} spine links; the format knows 2 and 3", links), 0);
    }
    return std::move(csm_);
  }

 private:
  [[noreturn]] void Fail(const std::string& message, std::int64_t line) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, line});
  }
  [[noreturn]] void Fail(const std::string& message) const { Fail(message, line_); }

  void Report(Severity severity, std::string message, std::int64_t line) {
    csm_.diagnostics.push_back({severity, std::move(message), line});
  }

  // What strict reading refuses. `remedy` says what is done about it otherwise.
  void Repair(const std::string& message, const std::string& remedy, std::int64_t line) {
    if (options_.strict) {
      Fail(fmt::format("{} (without --strict {})", message, remedy), line);
    }
    Report(Severity::kWarning, fmt::format("{}; {}", message, remedy), line);
  }

  // Reads to the end of the text, or over one `$points`. Returns what is left.
  std::string_view ReadUpToPoints(std::string_view text) {
    LineScanner lines(text);
    const std::int64_t lines_before = line_ == 0 ? 0 : line_ - 1;
    while (lines.Next()) {
      line_ = lines_before + lines.line_number();
      CheckText(lines.line());
      std::string_view rest = Trim(lines.line());
      if (!TakeLine(rest)) continue;
      const char* const end = text_.data() + text_.size();
      const auto after = ReadPoints({rest.data(), static_cast<std::size_t>(end - rest.data())});
      line_ = after.line;
      return after.text;
    }
    return {};
  }

  void CheckText(std::string_view line) const {
    if (!internal::HoldsBinaryData(line)) return;
    Fail("holds binary data; expected the text of a CSM file");
  }

  internal::CsmRest ReadPoints(std::string_view text) {
    if (csm_.labels.empty()) Fail("'$points' before any marker of '$order'");
    return internal::ReadCsmPoints(text, line_, file_, options_, csm_);
  }

  // True if `$points` begins here; `line` is then what follows on its line.
  bool TakeLine(std::string_view& line) {
    bool is_title = line.starts_with('$');
    bool follows_title = false;
    while (true) {
      if (is_title) {
        BeginSection(TakeToken(line).substr(1));
        follows_title = true;
        if (section_ == Section::kPoints) return true;
      }
      if (IsText(section_)) {
        TakeText(Trim(line), follows_title);
        return false;
      }
      is_title = TakeWords(line);
      if (!is_title) return false;
    }
  }

  void BeginSection(std::string_view title) {
    EndSection();
    section_ = FindSection(title);
    section_line_ = line_;
    words_ = 0;
    is_repeated_ = false;
    if (section_ == Section::kUnknown) {
      csm_.unknown_sections.push_back({std::string(title), {}});
      return;
    }
    if (section_ == Section::kComments || seen_.insert(section_).second) return;
    if (section_ == Section::kOrder || section_ == Section::kPoints) {
      Fail(fmt::format("'${}' stands twice", title));
    }
    is_repeated_ = true;
    if (reported_twice_.insert(section_).second) {
      Repair(fmt::format("'${}' stands twice", ToLower(title)), "the first counts", line_);
    }
  }

  void EndSection() {
    switch (section_) {
      case Section::kFirstFrame:
      case Section::kLastFrame:
      case Section::kRate:
      case Section::kSpineLinks:
        if (words_ == 0 && !is_repeated_) {
          Repair("a section without its number", "it is left out", section_line_);
        }
        break;
      case Section::kTalent:
        if (!is_repeated_) FinishTalent();
        break;
      case Section::kOrder:
        FinishOrder();
        break;
      case Section::kComments:
        DropEmptyEnd(csm_.comments);
        break;
      case Section::kUnknown:
        DropEmptyEnd(csm_.unknown_sections.back().lines);
        break;
      default:
        break;
    }
    section_ = Section::kNone;
  }

  static void DropEmptyEnd(std::vector<std::string>& lines) {
    while (!lines.empty() && lines.back().empty()) lines.pop_back();
  }

  // A line of a section of text, trimmed.
  void TakeText(std::string_view line, bool follows_title) {
    switch (section_) {
      case Section::kFileName:
        return AddText(csm_.file_name, line);
      case Section::kDate:
        return AddText(csm_.capture_date, line);
      case Section::kTime:
        return AddText(csm_.capture_time, line);
      case Section::kActor:
        return AddText(csm_.actor, line);
      case Section::kComments:
        // Empty lines count within a comment only.
        if (follows_title) comment_begins_ = true;
        if (comment_begins_ && line.empty()) return;
        comment_begins_ = false;
        csm_.comments.emplace_back(line);
        return;
      default:
        csm_.unknown_sections.back().lines.emplace_back(line);
    }
  }

  void AddText(std::string& field, std::string_view line) {
    if (is_repeated_ || line.empty()) return;
    if (!field.empty()) field += ' ';
    field += line;
  }

  // Takes words up to a title, which is then the front of `line`, or the line's end.
  bool TakeWords(std::string_view& line) {
    while (true) {
      line = Trim(line);
      if (line.starts_with('$')) return true;
      const std::string_view word = TakeToken(line);
      if (word.empty()) return false;
      TakeWord(word);
      ++words_;
    }
  }

  void TakeWord(std::string_view word) {
    if (is_repeated_) return;
    switch (section_) {
      case Section::kFirstFrame:
        return TakeInteger(word, csm_.declared_first_frame);
      case Section::kLastFrame:
        return TakeInteger(word, csm_.declared_last_frame);
      case Section::kSpineLinks:
        return TakeInteger(word, csm_.spine_links);
      case Section::kRate:
        return TakeRate(word);
      case Section::kTalent:
        return TakeTalentWord(word);
      case Section::kOrder:
        return TakeLabels(word);
      default:
        Fail("expected a section such as '$order', found " + Quoted(word));
    }
  }

  // Whether `word` is the number of its section. One more is reported.
  bool IsFirstWord(std::string_view word) {
    if (words_ == 1) {
      Repair("more than a number: " + Quoted(word), "it is left out", line_);
    }
    return words_ == 0;
  }

  void TakeInteger(std::string_view word, std::optional<std::int64_t>& field) {
    if (!IsFirstWord(word)) return;
    field = ParseInteger(word);
    if (!field) Repair("not a whole number: " + Quoted(word), "it is left out", line_);
  }

  void TakeRate(std::string_view word) {
    if (!IsFirstWord(word)) return;
    const auto rate = ParseDouble(word);
    if (rate && std::isfinite(*rate)) {
      csm_.rate_hz = rate;
    } else {
      Repair("not a rate: " + Quoted(word), "it is left out", line_);
    }
  }

  // Names are separated by blanks. They must not hold commas, so a comma is meant as a separator.
  void TakeLabels(std::string_view word) {
    while (!word.empty()) {
      const std::size_t comma = std::min(word.find(','), word.size());
      if (comma < word.size() && !has_comma_) {
        has_comma_ = true;
        Repair("a comma among the names of the markers", "it is taken as a blank", line_);
      }
      if (comma > 0) csm_.labels.emplace_back(word.substr(0, comma));
      word.remove_prefix(std::min(comma + 1, word.size()));
      // What stood behind a comma would otherwise be written as a title.
      if (word.starts_with('$')) Fail("a marker's name begins with '$': " + Quoted(word));
    }
  }

  void FinishOrder() {
    if (csm_.labels.empty()) Fail("'$order' names no marker", section_line_);
    std::set<std::string_view> names;
    std::vector<std::string> repeated;
    for (const auto& label : csm_.labels) {
      if (!names.insert(label).second) repeated.push_back(label);
    }
    if (repeated.empty()) return;
    if (repeated.size() > kMostNamed) repeated.resize(kMostNamed);
    Report(Severity::kWarning, "markers of the same name: " + JoinQuoted(repeated), section_line_);
  }

  void TakeTalentWord(std::string_view word) {
    const auto value = ParseDouble(word);
    if (value && pending_name_.empty()) {
      RepairTalent("a number without a name before it: ", word);
    } else if (value && !std::isfinite(*value)) {
      RepairTalent("not a length: ", word);
      pending_name_.clear();
    } else if (value) {
      AddMeasure(*value);
    } else {
      const auto unit = ParseTalentUnit(word);
      if (unit && talent_.unit == CsmTalent::Unit::kUnstated) {
        talent_.unit = *unit;
        return;
      }
      if (!pending_name_.empty()) RepairTalent("a name without a number: ", pending_name_);
      pending_name_ = word;
    }
  }

  // Once, however often: the rest of a section that is something else altogether adds nothing.
  void RepairTalent(const std::string& message, std::string_view word) {
    if (std::exchange(is_talent_repaired_, true)) return;
    Repair("'$talent': " + message + Quoted(word), "it is left out", line_);
  }

  [[nodiscard]] bool HasMeasure(std::string_view name) const {
    return measure_names_.contains(ToLower(name));
  }

  void AddMeasure(double value) {
    std::string name = std::exchange(pending_name_, {});
    if (HasMeasure(name)) {
      if (EqualsIgnoringCase(name, "pelvheight") && second_pelvis_height_ == 0) {
        // The format's description has it twice and means the pelvis' length, as its sample shows.
        second_pelvis_height_ = line_;
        name = kSecondPelvisHeight;
      } else {
        return RepairTalent("a name that stands twice: ", name);
      }
    }
    measure_names_.insert(ToLower(name));
    talent_.measures.push_back({std::move(name), value});
  }

  void FinishTalent() {
    if (!pending_name_.empty()) RepairTalent("a name without a number: ", pending_name_);
    if (second_pelvis_height_ > 0) ReadSecondPelvisHeight();
    const auto known = CsmTalentNames();
    std::vector<std::string> unknown;
    for (const auto& measure : talent_.measures) {
      const auto is_it = [&](std::string_view each) {
        return EqualsIgnoringCase(each, measure.name);
      };
      if (std::ranges::none_of(known, is_it)) unknown.push_back(measure.name);
    }
    std::vector<std::string> missing;
    for (const auto name : known) {
      if (!HasMeasure(name)) missing.emplace_back(name);
    }
    if (talent_.unit == CsmTalent::Unit::kUnstated) {
      Report(Severity::kWarning,
             "'$talent' says neither 'millimeters' nor 'inches': its sizes cannot be used",
             section_line_);
    }
    if (unknown.size() > kMostNamed) unknown.resize(kMostNamed);
    if (!unknown.empty()) {
      Report(Severity::kWarning, "'$talent' has unknown names: " + JoinQuoted(unknown),
             section_line_);
    }
    if (!missing.empty()) {
      Report(Severity::kWarning, "'$talent' lacks " + JoinQuoted(missing), section_line_);
    }
    csm_.talent = std::move(talent_);
  }

  void ReadSecondPelvisHeight() {
    const auto second =
        std::ranges::find(talent_.measures, kSecondPelvisHeight, &CsmTalent::Measure::name);
    if (HasMeasure("pelvlength")) {
      talent_.measures.erase(second);
      return RepairTalent("a name that stands twice: ", "pelvheight");
    }
    second->name = "pelvlength";
    measure_names_.insert(second->name);
    Report(Severity::kInfo, "'$talent': the second 'pelvheight' is read as 'pelvlength'",
           second_pelvis_height_);
  }

  void CheckRange() {
    const std::int64_t first = csm_.frame_numbers.front();
    const std::int64_t last = csm_.frame_numbers.back();
    const auto wrong_first = csm_.declared_first_frame.value_or(first) != first;
    const auto wrong_last = csm_.declared_last_frame.value_or(last) != last;
    if (!wrong_first && !wrong_last) return;
    Report(Severity::kWarning,
           fmt::format("frames {} to {} are declared, {} to {} are there: {} frames",
                       csm_.declared_first_frame.value_or(first),
                       csm_.declared_last_frame.value_or(last), first, last, csm_.frame_count()),
           0);
  }

  static constexpr std::size_t kMostNamed = 10;  // Names in one diagnostic.
  // No word of a file: it holds a blank.
  static constexpr std::string_view kSecondPelvisHeight = "second pelvheight";

  std::string_view text_;
  const std::filesystem::path& file_;
  const CsmReadOptions& options_;
  CsmRecording csm_;
  std::int64_t line_ = 0;
  Section section_ = Section::kNone;
  std::int64_t section_line_ = 0;
  std::size_t words_ = 0;     // Of the section so far.
  bool is_repeated_ = false;  // The section is read over.
  bool comment_begins_ = false;
  bool has_comma_ = false;
  std::set<Section> seen_;
  std::set<Section> reported_twice_;

  CsmTalent talent_;
  std::set<std::string> measure_names_;    // Lower case.
  std::string pending_name_;               // Whose number is still to come.
  std::int64_t second_pelvis_height_ = 0;  // Its line.
  bool is_talent_repaired_ = false;
};

}  // namespace

CsmRecording ParseCsm(std::string_view text, const std::filesystem::path& file,
                      const CsmReadOptions& options) {
  if (text.empty()) {
    throw Error(ErrorCode::kMalformedFile, "is empty; expected a CSM recording", {file});
  }
  return CsmParser(text, file, options).Parse();
}

CsmRecording ReadCsm(const std::filesystem::path& path, const CsmReadOptions& options) {
  const MappedFile file(path);
  return ParseCsm(file.text(), path, options);
}

}  // namespace kinebase
