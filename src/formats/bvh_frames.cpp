// The frames of a BVH file: one pass over the mapped text.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "fmt/format.h"
#include "formats/bvh_reader.h"
#include "formats/decimal_number.h"
#include "formats/text_lines.h"

namespace kinebase::internal {
namespace {

bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// Whether a line holds values, not a keyword.
bool IsValueLine(std::string_view line) {
  const std::string_view token = TakeToken(line);
  const char first = token.front();
  return (first >= '0' && first <= '9') || first == '-' || first == '+' || first == '.' ||
         ParseDouble(token).has_value();
}

class FrameReader {
 public:
  explicit FrameReader(BvhContext& context) : context_(context), bvh_(context.bvh) {}

  void Read() {
    while (context_.lines.Next()) {
      const std::string_view line = Trim(context_.lines.line());
      if (line.empty()) continue;
      if (!bvh_.values.empty() || last_line_is_cut_ || IsValueLine(line)) {
        TakeValues(line);
      } else {
        TakeKeyword(line);
      }
    }
    FinishRows();
    CheckHeader();
  }

 private:
  // "Frames: 3", "Frame Time: 0.01", "Frames 3".
  void TakeKeyword(std::string_view line) {
    std::size_t split = line.find(':');
    if (split == std::string_view::npos) split = line.find_last_of(" \t\v\f");
    split = std::min(split, line.size());
    std::string key = ToLower(line.substr(0, split));
    std::erase_if(key, IsBlank);
    const std::string_view value = Trim(line.substr(std::min(split + 1, line.size())));
    if (key == "frames") {
      TakeFrameCount(value);
    } else if (key == "frametime") {
      TakeFrameTime(value);
    } else if (HasBinary(line)) {
      context_.Unexpected("'Frames:', 'Frame Time:' or values", line);
    } else {
      bvh_.unknown.emplace_back(line);
      context_.CountUnknown(line);
    }
  }

  void TakeFrameCount(std::string_view value) {
    if (bvh_.declared_frame_count) context_.Fail("a second 'Frames:'");
    bvh_.declared_frame_count = ParseInteger(value);
    frame_count_line_ = context_.lines.line_number();
    if (bvh_.declared_frame_count.value_or(-1) < 0) {
      context_.Unexpected("a whole number after 'Frames:'", value);
    }
  }

  void TakeFrameTime(std::string_view value) {
    if (!bvh_.frame_time_text.empty()) context_.Fail("a second 'Frame Time:'");
    const auto number = ParseDouble(value);
    if (!number) context_.Unexpected("the seconds of a frame after 'Frame Time:'", value);
    bvh_.frame_time_text = std::string(value);
    if (*number > 0 && std::isfinite(*number)) {
      bvh_.frame_time_s = *number;
    } else {
      context_.Warn("'Frame Time:' says " + Quoted(value) + ", which is no time",
                    context_.lines.line_number());
    }
  }

  // The values of a line.
  void TakeValues(std::string_view line) {
    const bool begins_row = bvh_.values.size() % bvh_.column_count == 0;
    if (begins_row) row_line_ = context_.lines.line_number();
    if (begins_row && TakeWholeRow(line)) return;
    TakePartsOfRows(line);
  }

  // What nearly all lines are: numbers for all columns. False if this one is not, and is still to
  // be read.
  bool TakeWholeRow(std::string_view line) {
    const char* at = line.data();
    const char* const end = at + line.size();
    const char* const text_end = context_.text.data() + context_.text.size();
    row_.resize(bvh_.column_count);
    for (double& value : row_) {
      const auto [next, error] = NumberFromChars(at, end, text_end, value);
      if (error != std::errc() || (next != end && !IsBlank(*next))) return false;
      at = next;
      while (at != end && IsBlank(*at)) ++at;
    }
    if (at != end) return false;
    if (bvh_.values.empty()) {
      bvh_.values.reserve(GuessFrames(line.data(), end, context_.text) * row_.size());
    }
    bvh_.values.insert(bvh_.values.end(), row_.begin(), row_.end());
    return true;
  }

  // A row that its line leaves short goes on in the next.
  void TakePartsOfRows(std::string_view line) {
    const std::size_t before = bvh_.values.size();
    const char* at = line.data();
    const char* const end = at + line.size();
    while (at != end) {
      double value = 0;
      const auto [next, error] = std::from_chars(at, end, value);
      if (error == std::errc() && (next == end || IsBlank(*next))) [[likely]] {
        at = next;
      } else {
        at = TakeRareValue({at, static_cast<std::size_t>(end - at)}, value);
        if (last_line_is_cut_) break;
      }
      bvh_.values.push_back(value);
      while (at != end && IsBlank(*at)) ++at;
    }
    CountRow(before);
  }

  // Rare forms of numbers: a plus sign, one too small for a double. Returns where it ends. A file
  // that was cut off may end within a number.
  const char* TakeRareValue(std::string_view rest, double& value) {
    const std::string_view token = TakeToken(rest);
    if (const auto parsed = ParseDouble(token)) {
      value = *parsed;
    } else if (rest.empty() && !context_.lines.line_is_terminated() && !HasBinary(token)) {
      last_line_is_cut_ = true;
    } else {
      context_.Unexpected("a number", token);
    }
    return rest.data();
  }

  void CountRow(std::size_t before) {
    const std::size_t columns = bvh_.column_count;
    const std::size_t filled = before % columns;
    const std::size_t count = filled + bvh_.values.size() - before;
    if (count > columns) {
      const std::string found = filled == 0
                                    ? fmt::format("{}", count)
                                    : fmt::format("{} values, {} with those of line {}", filled,
                                                  count, context_.lines.line_number());
      context_.Fail(fmt::format("frame {} has {}{}; the joints have {} channels",
                                before / columns + 1, found, filled == 0 ? " values" : "", columns),
                    row_line_);
    }
    if (filled > 0 && count == columns) ++wrapped_rows_;
  }

  // A file that was cut off ends in the middle of a row, most often of a number.
  void FinishRows() {
    const std::size_t rows = bvh_.frame_count();
    const std::size_t partial = bvh_.values.size() % bvh_.column_count;
    if (rows == 0) {
      context_.Fail(partial == 0 && !last_line_is_cut_
                        ? "has no frames"
                        : fmt::format("has no whole frame: the first has {} values, the joints "
                                      "have {} channels",
                                      partial, bvh_.column_count),
                    row_line_);
    }
    if (partial > 0 || last_line_is_cut_) {
      if (context_.options.strict) {
        context_.Fail(
            fmt::format("frame {} is cut off (without --strict it is left out)", rows + 1),
            row_line_);
      }
      context_.Warn(fmt::format("the last frame, {}, is cut off; it is left out", rows + 1),
                    row_line_);
      bvh_.values.resize(rows * bvh_.column_count);
    } else if (!context_.lines.line_is_terminated()) {
      ReportOpenEnd();
    }
    if (wrapped_rows_ > 0) {
      context_.Warn(fmt::format("{} frames are spread over several lines", wrapped_rows_), 0,
                    Severity::kInfo);
    }
  }

  // Some writers leave the last line without an end, so that alone tells little.
  void ReportOpenEnd() {
    const std::int64_t line = context_.lines.line_number();
    if (context_.options.strict) {
      context_.Fail(
          "the last line has no end, so the file may be cut off (without --strict it is "
          "read)",
          line);
    }
    context_.Warn(
        "the last line has no end: if the file was cut off, its last value may lack digits", line,
        Severity::kInfo);
  }

  void CheckHeader() {
    const auto rows = static_cast<std::int64_t>(bvh_.frame_count());
    if (!bvh_.declared_frame_count) {
      context_.Warn(fmt::format("'Frames:' is missing; there are {} rows", rows), 0);
    } else if (*bvh_.declared_frame_count != rows) {
      const std::string message = fmt::format("'Frames:' says {}, but there are {} rows of values",
                                              *bvh_.declared_frame_count, rows);
      if (context_.options.strict)
        context_.Fail(message + " (without --strict the rows count)", frame_count_line_);
      context_.Warn(message + "; the rows are kept", frame_count_line_);
    }
    if (bvh_.frame_time_text.empty()) context_.Warn("'Frame Time:' is missing", 0);
  }

  BvhContext& context_;
  BvhMotion& bvh_;
  std::vector<double> row_;    // That is read as a whole.
  std::int64_t row_line_ = 0;  // Where the current row begins.
  std::int64_t frame_count_line_ = 0;
  std::int64_t wrapped_rows_ = 0;
  bool last_line_is_cut_ = false;
};

}  // namespace

void ReadBvhFrames(BvhContext& context) { FrameReader(context).Read(); }

}  // namespace kinebase::internal
