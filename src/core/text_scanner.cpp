#include "kinebase/core/text_scanner.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "fmt/format.h"

namespace kinebase {
namespace {

constexpr std::string_view kBlanks = " \t\v\f\r";
constexpr std::size_t kMaxQuotedLength = 40;

bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r' && c != '\n'); }

char LowerChar(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Whether a decimal number that no double can hold is too small, not too large: whether its first
// digit that counts stands, after the exponent has moved the point, to the right of it.
bool IsTiny(std::string_view number) {
  const std::size_t mark = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, mark);
  const auto point = static_cast<std::int64_t>(std::min(digits.find('.'), digits.size()));
  const auto first = static_cast<std::int64_t>(digits.find_first_of("123456789"));
  const std::string_view exponent = number.substr(std::min(mark + 1, number.size()));
  constexpr std::int64_t kOutweighsAllDigits = std::int64_t{1} << 60;
  const auto power = exponent.empty() ? std::optional<std::int64_t>(0) : ParseInteger(exponent);
  if (!power || std::abs(*power / 2) > kOutweighsAllDigits) return exponent.front() == '-';
  return point - first + *power <= 0;
}

// Bytes of the UTF-8 character that `text` starts with; 0 if it starts with none that is printable.
std::size_t PrintableLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7F ? 1 : 0;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, surrogates, beyond U+10FFFF, control characters of Latin-1 (RFC 3629).
  const unsigned char next = byte(1);
  const bool wrong = (lead == 0xE0 && next < 0xA0) || (lead == 0xED && next >= 0xA0) ||
                     (lead == 0xF0 && next < 0x90) || (lead == 0xF4 && next >= 0x90) ||
                     (lead == 0xC2 && next < 0xA0);
  return wrong ? 0 : length;
}

// from_chars knows no leading plus; "+-1" must stay wrong.
std::string_view WithoutPlus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') {
    token.remove_prefix(1);
  }
  return token;
}

}  // namespace

LineScanner::LineScanner(std::string_view text) : rest_(text) {
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool LineScanner::Next() {
  if (rest_.empty()) return false;
  ++line_number_;
  const char* begin = rest_.data();
  const char* const end = begin + rest_.size();
  // Lines that end with CR alone must not search for the same LF again and again.
  if (next_feed_ == nullptr || next_feed_ < begin) {
    const void* found = std::memchr(begin, '\n', rest_.size());
    next_feed_ = found == nullptr ? end : static_cast<const char*>(found);
  }
  const bool has_feed = next_feed_ != end;
  auto length = static_cast<std::size_t>(next_feed_ - begin);
  std::size_t ending = has_feed ? 1 : 0;
  // A CR inside is a line end of its own unless it belongs to CRLF.
  const void* carriage_return = std::memchr(begin, '\r', length);
  if (carriage_return != nullptr) {
    const auto at = static_cast<std::size_t>(static_cast<const char*>(carriage_return) - begin);
    ending = at + 1 == length && has_feed ? 2 : 1;
    length = at;
  }
  line_ = rest_.substr(0, length);
  terminated_ = ending > 0;
  rest_.remove_prefix(length + ending);
  return true;
}

void LineScanner::Skip(std::size_t bytes, std::int64_t lines) {
  rest_.remove_prefix(bytes);
  line_number_ += lines;
  line_ = {};
  terminated_ = true;
}

std::string_view TakeToken(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && IsBlank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !IsBlank(text[end])) ++end;
  const std::string_view token = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return token;
}

std::vector<std::string_view> SplitTokens(std::string_view text) {
  std::vector<std::string_view> tokens;
  for (auto token = TakeToken(text); !token.empty(); token = TakeToken(text)) {
    tokens.push_back(token);
  }
  return tokens;
}

std::string_view Trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::optional<double> ParseDouble(std::string_view token) {
  token = WithoutPlus(token);
  double value = 0;
  const char* end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (result.ptr != end || result.ec == std::errc::invalid_argument) return std::nullopt;
  if (result.ec == std::errc::result_out_of_range) {
    // Too small rounds to zero as in every other reader; too large is not a number to go on with.
    const bool negative = token.front() == '-';
    if (!IsTiny(token.substr(negative ? 1 : 0))) return std::nullopt;
    return negative ? -0.0 : 0.0;
  }
  return value;
}

std::optional<std::int64_t> ParseInteger(std::string_view token) {
  token = WithoutPlus(token);
  std::int64_t value = 0;
  const char* end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

void AppendShortestText(std::string& out, double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  out.append(buffer.data(), result.ptr);
}

std::string ToShortestText(double value) {
  std::string text;
  AppendShortestText(text, value);
  return text;
}

bool EqualsIgnoringCase(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, LowerChar, LowerChar);
}

std::string EscapeXml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string ToLower(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), LowerChar);
  return lower;
}

std::string Quoted(std::string_view text) {
  std::string quoted = "'";
  std::string_view rest = text;
  for (std::size_t taken = 0; !rest.empty();) {
    const std::size_t printable = PrintableLength(rest);
    const std::size_t step = std::max<std::size_t>(printable, 1);
    taken += step;
    if (taken > kMaxQuotedLength) return quoted + "…'";
    if (printable > 0) {
      quoted += rest.substr(0, printable);
    } else {
      quoted += fmt::format("\\x{:02X}", static_cast<unsigned char>(rest.front()));
    }
    rest.remove_prefix(step);
  }
  return quoted + "'";
}

}  // namespace kinebase
