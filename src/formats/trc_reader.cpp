// Reads TRC.
//
//   PathFileType  4  (X/Y/Z)  name.trc
//   DataRate  CameraRate  NumFrames  NumMarkers  Units  OrigDataRate  ...
//   60        60          2          2           mm     60            ...
//   Frame#  Time  R.ASIS          L.ASIS
//                 X1  Y1  Z1      X2  Y2  Z2
//
//   1       0     1   2   3       4   5   6
//
// with a tab for every gap, two more behind each name, and nothing between the tabs where a value
// is missing.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/trc.h"
#include "text_lines.h"

namespace kinebase {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Walks over the fields of a line: between tabs, or words where there is no tab.
class FieldScanner {
 public:
  explicit FieldScanner(std::string_view line)
      : rest_(line), has_tabs_(line.find('\t') != std::string_view::npos) {
    is_at_end_ = !has_tabs_ && Trim(rest_).empty();
  }

  // Nothing at the end of the line.
  std::optional<std::string_view> Next() {
    if (is_at_end_) return std::nullopt;
    if (!has_tabs_) {
      const std::string_view word = TakeToken(rest_);
      is_at_end_ = Trim(rest_).empty();
      return word;
    }
    const std::size_t tab = rest_.find('\t');
    const std::string_view field = Trim(rest_.substr(0, tab));
    is_at_end_ = tab == std::string_view::npos;
    rest_.remove_prefix(is_at_end_ ? rest_.size() : tab + 1);
    return field;
  }

  [[nodiscard]] bool has_tabs() const { return has_tabs_; }

 private:
  std::string_view rest_;
  bool has_tabs_;
  bool is_at_end_ = false;
};

// Without the empty ones at the end.
std::vector<std::string_view> SplitFields(std::string_view line) {
  std::vector<std::string_view> fields;
  FieldScanner scanner(line);
  while (const auto field = scanner.Next()) fields.push_back(*field);
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  return fields;
}

bool StartsWithIgnoringCase(std::string_view text, std::string_view start) {
  return EqualsIgnoringCase(text.substr(0, start.size()), start);
}

// A whole number, also as "1.0".
std::optional<std::int64_t> ParseWholeNumber(std::string_view field) {
  if (const auto number = ParseInteger(field)) return number;
  constexpr double kExactIntegers = 9007199254740992;  // 2^53
  const auto value = ParseDouble(field);
  if (!value || !(std::abs(*value) < kExactIntegers) || *value != std::floor(*value)) {
    return std::nullopt;
  }
  return static_cast<std::int64_t>(*value);
}

std::optional<double> ParseCoordinate(std::string_view field) {
  // What Microsoft's C library prints for NaN and infinity: 1.#QNAN, -1.#IND00.
  if (field.empty() || field.find("1.#") != std::string_view::npos) return kMissing;
  return ParseDouble(field);
}

class TrcParser {
 public:
  TrcParser(std::string_view text, const std::filesystem::path& file, const TrcReadOptions& options)
      : lines_(text), file_(file), options_(options) {}

  TrcRecording Parse() {
    ReadFileType();
    ReadHeader();
    ReadLabels();
    while (std::exchange(is_at_row_, false) || NextLine()) {
      if (!ReadRow()) break;
    }
    if (trc_.frame_numbers.empty()) Fail("has no frames", 0);
    CheckCounts();
    CheckTimes();
    return std::move(trc_);
  }

 private:
  [[noreturn]] void Fail(const std::string& message, std::int64_t line) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, line});
  }
  [[noreturn]] void Fail(const std::string& message) const { Fail(message, lines_.line_number()); }

  void Warn(std::string message, std::int64_t line) {
    trc_.diagnostics.push_back({Severity::kWarning, std::move(message), line});
  }

  // What strict reading refuses. `remedy` says what is done about it otherwise.
  void Repair(const std::string& message, const std::string& remedy) {
    if (options_.strict) Fail(fmt::format("{} (without --strict {})", message, remedy));
    Warn(fmt::format("{}; {}", message, remedy), lines_.line_number());
  }

  // The next line that is not blank; false at the end.
  bool NextLine() {
    while (lines_.Next()) {
      if (!Trim(lines_.line()).empty()) return true;
    }
    return false;
  }

  std::string_view HeaderLine(std::string_view what) {
    if (!NextLine()) Fail(fmt::format("ends before {}", what), 0);
    if (internal::HoldsBinaryData(lines_.line())) {
      Fail("holds binary data; expected the text of a TRC file");
    }
    return lines_.line();
  }

  void ReadFileType() {
    FieldScanner fields(HeaderLine("its first line"));
    const std::string_view title = fields.Next().value_or("");
    if (!EqualsIgnoringCase(title, "PathFileType")) {
      Fail("expected 'PathFileType', found " + Quoted(title));
    }
    trc_.path_file_type = fields.Next().value_or("");
    trc_.axes = fields.Next().value_or("");
    while (const auto part = fields.Next()) {
      if (part->empty()) continue;
      if (!trc_.file_name.empty()) trc_.file_name += ' ';
      trc_.file_name += *part;
    }
  }

  void ReadHeader() {
    const std::vector<std::string_view> names = SplitFields(HeaderLine("the names of its header"));
    const std::vector<std::string_view> values =
        SplitFields(HeaderLine("the values of its header"));
    for (std::size_t i = 0; i < std::max(names.size(), values.size()); ++i) {
      TakeField(i < names.size() ? names[i] : "", i < values.size() ? values[i] : "");
    }
  }

  void TakeField(std::string_view name, std::string_view value) {
    const auto is = [&](std::string_view each) { return EqualsIgnoringCase(name, each); };
    if (name.empty()) {
      if (!value.empty() && !has_nameless_value_) {
        has_nameless_value_ = true;
        Repair("a value of the header without a name: " + Quoted(value), "it is left out");
      }
    } else if (is("DataRate")) {
      TakeRate(value, trc_.data_rate_hz);
    } else if (is("CameraRate")) {
      TakeRate(value, trc_.camera_rate_hz);
    } else if (is("NumFrames")) {
      TakeCount(value, trc_.declared_frame_count);
    } else if (is("NumMarkers")) {
      TakeCount(value, trc_.declared_marker_count);
    } else if (is("Units")) {
      trc_.units = value;
    } else if (is("OrigDataRate")) {
      TakeRate(value, trc_.original_rate_hz);
    } else if (is("OrigDataStartFrame")) {
      TakeCount(value, trc_.original_first_frame);
    } else if (is("OrigNumFrames")) {
      TakeCount(value, trc_.original_frame_count);
    } else {
      trc_.other_fields.push_back({std::string(name), std::string(value)});
    }
  }

  void TakeRate(std::string_view value, std::optional<double>& field) {
    if (value.empty()) return;
    const auto rate = ParseDouble(value);
    if (rate && std::isfinite(*rate)) {
      field = rate;
    } else {
      Repair("not a rate: " + Quoted(value), "it is left out");
    }
  }

  void TakeCount(std::string_view value, std::optional<std::int64_t>& field) {
    if (value.empty()) return;
    if (const auto count = ParseWholeNumber(value)) {
      field = count;
    } else {
      Repair("not a whole number: " + Quoted(value), "it is left out");
    }
  }

  void ReadLabels() {
    const std::vector<std::string_view> fields = SplitFields(HeaderLine("the markers' names"));
    if (fields.size() < 2 || !StartsWithIgnoringCase(fields[0], "frame") ||
        !StartsWithIgnoringCase(fields[1], "time")) {
      Fail("expected 'Frame#', 'Time' and the markers' names, found " +
           Quoted(Trim(lines_.line())));
    }
    labels_line_ = lines_.line_number();
    TakeLabels(std::span(fields).subspan(2));
    const std::size_t axes = CountAxes();
    if (axes % 3 != 0) {
      Fail(fmt::format("{} columns of coordinates; expected three for each marker", axes));
    }
    if (axes > trc_.labels.size() * 3) trc_.labels.resize(axes / 3);
    if (trc_.labels.empty()) Fail("names no markers", labels_line_);
    row_.resize(trc_.labels.size() * 3);
  }

  // A name stands above the first of its three columns; some writers leave no columns between.
  void TakeLabels(std::span<const std::string_view> fields) {
    bool is_compact = false;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      is_compact = is_compact || (i % 3 != 0 && !fields[i].empty());
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (is_compact ? !fields[i].empty() : i % 3 == 0) trc_.labels.emplace_back(fields[i]);
    }
    if (is_compact) {
      Repair("the markers' names do not stand above their columns", "they are taken in order");
    }
  }

  // Reads the line `X1 Y1 Z1 X2 …` if there is one. Returns how many columns it names.
  std::size_t CountAxes() {
    if (!NextLine()) Fail("has no frames", 0);
    const std::vector<std::string_view> fields = SplitFields(lines_.line());
    const auto first = std::ranges::find_if(fields, [](auto field) { return !field.empty(); });
    if (first == fields.end() || ParseDouble(*first)) {
      Repair("no line 'X1 Y1 Z1 …' below the names", "three columns a marker are taken");
      is_at_row_ = true;
      return 0;
    }
    if (!StartsWithIgnoringCase(*first, "x")) {
      Fail("expected 'X1', 'Y1', 'Z1' …, found " + Quoted(*first));
    }
    return static_cast<std::size_t>(
        std::ranges::count_if(fields, [](auto field) { return !field.empty(); }));
  }

  // False if the file ends within the row, which is then left out.
  bool ReadRow() {
    const std::string_view line = lines_.line();
    FieldScanner fields(line);
    const bool may_be_cut = !lines_.line_is_terminated();
    const auto number = ParseWholeNumber(fields.Next().value_or(""));
    if (!number) {
      if (may_be_cut) return LeaveOut("the last row");
      Fail("expected the number of a frame, found " + Quoted(Trim(line)));
    }
    CheckNumber(*number);
    const std::string_view time_field = fields.Next().value_or("");
    const auto time = ParseDouble(time_field);
    const std::string frame = fmt::format("frame {}", *number);
    if (!time || !std::isfinite(*time)) {
      if (may_be_cut) return LeaveOut(frame);
      Fail(fmt::format("the time of {} is not a number: {}", frame, Quoted(time_field)));
    }
    if (!ReadCoordinates(fields, frame)) return LeaveOut(frame);
    trc_.frame_numbers.push_back(*number);
    trc_.times_s.push_back(*time);
    trc_.values.insert(trc_.values.end(), row_.begin(), row_.end());
    if (may_be_cut) CheckEnd(line.back());
    return true;
  }

  // False if the line is cut off.
  bool ReadCoordinates(FieldScanner& fields, const std::string& frame) {
    std::size_t count = 0;
    std::size_t there = 0;  // Up to the last that is not empty.
    while (const auto field = fields.Next()) {
      ++count;
      if (!field->empty()) there = count;
      const auto value = ParseCoordinate(*field);
      const bool is_last =
          field->data() + field->size() == lines_.line().data() + lines_.line().size();
      if (!value && is_last && !lines_.line_is_terminated()) return false;
      if (!value) Fail(fmt::format("a value of {} is not a number: {}", frame, Quoted(*field)));
      if (count <= row_.size()) row_[count - 1] = *value;
    }
    if (there <= row_.size() && count >= row_.size()) return true;
    if (count < row_.size() && !lines_.line_is_terminated()) return false;
    if (there > row_.size() || there % 3 != 0 || !fields.has_tabs()) {
      Fail(fmt::format("{} has {} coordinates; expected {}, three for each of {} markers", frame,
                       there, row_.size(), trc_.labels.size()));
    }
    std::fill(row_.begin() + static_cast<std::ptrdiff_t>(there), row_.end(), kMissing);
    if (!std::exchange(has_short_row_, true)) {
      Repair(
          fmt::format("{} has {} columns of coordinates instead of {}", frame, count, row_.size()),
          "the markers at its end are taken as missing");
    }
    return true;
  }

  void CheckNumber(std::int64_t number) {
    if (trc_.frame_numbers.empty()) return;
    const std::int64_t before = trc_.frame_numbers.back();
    if (number <= before) {
      Fail(fmt::format("frame {} after frame {}: frame numbers must grow", number, before));
    }
    if (number == before + 1 || std::exchange(has_jump_, true)) return;
    Warn(fmt::format("frame {} follows frame {}: numbers jump, time is taken to go on evenly",
                     number, before),
         lines_.line_number());
  }

  // Returns false.
  bool LeaveOut(const std::string& what) {
    if (trc_.frame_numbers.empty()) Fail(what + " is cut off, and there is no other");
    Repair(what + " is cut off", "it is left out");
    return false;
  }

  // After a whole row without a line end. `last` is its last byte.
  void CheckEnd(char last) {
    if (last == ' ' || last == '\t') return;
    Repair("the last line has no end", "if the file was cut off, its last value may lack digits");
  }

  void CheckCounts() {
    const auto check = [&](std::optional<std::int64_t> declared, std::size_t there,
                           std::string_view what) {
      if (!declared || *declared == static_cast<std::int64_t>(there)) return;
      Warn(fmt::format("{} {} are declared, {} are there", *declared, what, there), 0);
    };
    check(trc_.declared_frame_count, trc_.frame_count(), "frames");
    check(trc_.declared_marker_count, trc_.marker_count(), "markers");
  }

  // The time of each frame must be what its number and the rate say, within half a frame.
  void CheckTimes() {
    const double rate_hz = trc_.data_rate_hz.value_or(0);
    if (!(rate_hz > 0)) return;
    const auto first = static_cast<double>(trc_.frame_numbers.front());
    for (std::size_t i = 1; i < trc_.frame_count(); ++i) {
      const auto number = static_cast<double>(trc_.frame_numbers[i]);
      const double expected_s = trc_.times_s.front() + (number - first) / rate_hz;
      if (std::abs(trc_.times_s[i] - expected_s) * rate_hz <= .5) continue;
      Warn(fmt::format("frame {} has time {:g} s, at {:g} Hz it is {:g} s", trc_.frame_numbers[i],
                       trc_.times_s[i], rate_hz, expected_s),
           0);
      return;
    }
  }

  LineScanner lines_;
  const std::filesystem::path& file_;
  const TrcReadOptions& options_;
  TrcRecording trc_;
  std::vector<double> row_;
  std::int64_t labels_line_ = 0;
  bool has_nameless_value_ = false;
  bool is_at_row_ = false;  // The scanner stands at the first row already.
  bool has_short_row_ = false;
  bool has_jump_ = false;
};

}  // namespace

TrcRecording ParseTrc(std::string_view text, const std::filesystem::path& file,
                      const TrcReadOptions& options) {
  if (text.empty()) {
    throw Error(ErrorCode::kMalformedFile, "is empty; expected a TRC recording", {file});
  }
  return TrcParser(text, file, options).Parse();
}

TrcRecording ReadTrc(const std::filesystem::path& path, const TrcReadOptions& options) {
  const MappedFile file(path);
  return ParseTrc(file.text(), path, options);
}

}  // namespace kinebase
