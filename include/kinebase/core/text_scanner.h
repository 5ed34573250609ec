// Reading text formats: lines of any ending, tokens, numbers. No copies, no locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinebase {

// UTF-8's, which some programs write first. A reader takes the first one for it, also where a name
// begins with one.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// Walks over the lines of a text: LF, CRLF or CR; a UTF-8 byte order mark is skipped.
class LineScanner {
 public:
  explicit LineScanner(std::string_view text);

  // Moves to the next line. False at the end of the text.
  bool Next();

  [[nodiscard]] std::string_view line() const { return line_; }            // Without its ending.
  [[nodiscard]] std::int64_t line_number() const { return line_number_; }  // 1-based.
  // Whether the line ended with LF or CR (false only for a last line cut off at the text's end).
  [[nodiscard]] bool line_is_terminated() const { return terminated_; }

  // What follows the current line, and a way past its first `bytes`, which hold `lines` whole
  // lines: for readers that have a faster way for the usual form.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  void Skip(std::size_t bytes, std::int64_t lines);

 private:
  std::string_view rest_;
  const char* next_feed_ = nullptr;  // First LF in `rest_`, or its end; null: not yet looked for.
  std::string_view line_;
  std::int64_t line_number_ = 0;
  bool terminated_ = true;
};

// Takes the next token, delimited by blanks and tabs, off the front of `text`; empty at the end.
[[nodiscard]] std::string_view TakeToken(std::string_view& text);
[[nodiscard]] std::vector<std::string_view> SplitTokens(std::string_view text);
[[nodiscard]] std::string_view Trim(std::string_view text);

// A whole token as a number: "1", "+1.5", "-0", "1e-3", "nan", "inf". Empty if it is none.
[[nodiscard]] std::optional<double> ParseDouble(std::string_view token);
[[nodiscard]] std::optional<std::int64_t> ParseInteger(std::string_view token);

// The shortest text that reads back as the same double.
[[nodiscard]] std::string ToShortestText(double value);
void AppendShortestText(std::string& out, double value);

[[nodiscard]] bool EqualsIgnoringCase(std::string_view a, std::string_view b);
// The text with & < > and " as XML's references.
[[nodiscard]] std::string EscapeXml(std::string_view text);

[[nodiscard]] std::string ToLower(std::string_view text);

// `text` for an error message: shortened, valid UTF-8, unprintable bytes as \xNN.
[[nodiscard]] std::string Quoted(std::string_view text);

}  // namespace kinebase
