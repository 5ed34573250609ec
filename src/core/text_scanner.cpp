#include "kinebase/core/text_scanner.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>

#include "fmt/format.h"

namespace kinebase {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kBlanks = " \t\v\f\r";
constexpr std::size_t kMaxQuotedLength = 40;

bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r' && c != '\n'); }

char LowerChar(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

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
  const void* feed = std::memchr(begin, '\n', rest_.size());
  std::size_t length = feed == nullptr
                           ? rest_.size()
                           : static_cast<std::size_t>(static_cast<const char*>(feed) - begin);
  std::size_t ending = feed == nullptr ? 0 : 1;
  // A CR inside is a line end of its own unless it belongs to CRLF.
  const void* carriage_return = std::memchr(begin, '\r', length);
  if (carriage_return != nullptr) {
    const auto at = static_cast<std::size_t>(static_cast<const char*>(carriage_return) - begin);
    ending = at + 1 == length && feed != nullptr ? 2 : 1;
    length = at;
  }
  line_ = rest_.substr(0, length);
  terminated_ = ending > 0;
  rest_.remove_prefix(length + ending);
  return true;
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
    const std::size_t exponent = token.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos && exponent + 1 < token.size() &&
                      token[exponent + 1] == '-';
    return tiny ? std::optional(token.front() == '-' ? -0.0 : 0.0) : std::nullopt;
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

std::string ToLower(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), LowerChar);
  return lower;
}

std::string Quoted(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text.substr(0, kMaxQuotedLength)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      quoted += fmt::format("\\x{:02X}", byte);
    } else {
      quoted += c;
    }
  }
  quoted += text.size() > kMaxQuotedLength ? "…'" : "'";
  return quoted;
}

}  // namespace kinebase
