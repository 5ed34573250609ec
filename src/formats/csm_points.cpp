// Reads the frames of a CSM file.
//
// The format says "a line for every frame" and also "spaces or line feeds are used as separators",
// so frames are found by counting values: what follows a frame must be the number of the next one,
// or nothing. A DROPOUT stands for one marker; some writers leave three. Which of the two a frame
// means is what passes that check.

#include "csm_points.h"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "decimal_number.h"
#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "text_lines.h"

namespace kinebase::internal {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

struct Token {
  std::string_view text;  // Empty: the end of the file.
  std::int64_t line = 0;
  bool is_first_in_line = false;

  [[nodiscard]] bool ends_section() const { return text.empty() || text.front() == '$'; }
};

bool IsSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// Walks over the words of a text. Copies are cheap: a frame may be tried twice.
class TokenCursor {
 public:
  TokenCursor(std::string_view text, std::int64_t line)
      : at_(text.data()), end_(text.data() + text.size()), line_(line) {}

  Token Next() {
    bool is_first_in_line = false;
    for (; at_ != end_ && IsSpace(*at_); ++at_) {
      if (!EndsLine()) continue;
      ++line_;
      is_first_in_line = true;
    }
    const char* const begin = at_;
    while (at_ != end_ && !IsSpace(*at_)) ++at_;
    return {{begin, static_cast<std::size_t>(at_ - begin)}, line_, is_first_in_line};
  }

  // Takes the next word if it is a number in the current line; false, and nothing is taken, if not.
  bool TakeNumber(double& value) {
    const char* at = at_;
    while (at != end_ && (*at == ' ' || *at == '\t')) ++at;
    const auto [next, error] = NumberFromChars(at, end_, end_, value);
    if (error != std::errc() || next == end_ || !IsSpace(*next)) return false;
    at_ = next;
    return true;
  }

  [[nodiscard]] const char* at() const { return at_; }

 private:
  // LF, or a CR that is not part of CRLF.
  [[nodiscard]] bool EndsLine() const {
    return *at_ == '\n' || (*at_ == '\r' && (at_ + 1 == end_ || at_[1] != '\n'));
  }

  const char* at_;
  const char* end_;
  std::int64_t line_;
};

bool IsDropout(std::string_view token) {
  return (token.front() == 'D' || token.front() == 'd') && EqualsIgnoringCase(token, "dropout");
}

std::optional<double> ParseValue(std::string_view token) {
  // What Microsoft's C library prints for NaN and infinity: 1.#QNAN, -1.#IND00.
  if (token.find("1.#") != std::string_view::npos) return kMissing;
  return ParseDouble(token);
}

// What one DROPOUT stands for.
enum Dropout : std::size_t { kMarker, kValue };

enum class Outcome {
  kMisfit,  // Values that are no numbers, too many or too few.
  kEnds,    // The file ends first.
  kLoose,   // What follows has the next frame's number, but does not begin a line.
  kFits,    // A line with a number follows, or the section's end.
};

// One way to read a frame.
struct Attempt {
  Outcome outcome = Outcome::kMisfit;
  TokenCursor after;  // The values.
  Token stop;         // What could not be read, or follows.
  bool has_dropouts = false;
};

class PointsReader {
 public:
  PointsReader(std::string_view text, std::int64_t line, const std::filesystem::path& file,
               const CsmReadOptions& options, CsmRecording& recording)
      : text_(text), cursor_(text, line), file_(file), options_(options), csm_(recording) {
    for (auto& values : values_) values.resize(recording.labels.size() * 3);
  }

  CsmRest Read() {
    Token token = cursor_.Next();
    const std::int64_t first_line = token.line;
    for (; !token.ends_section(); token = cursor_.Next()) {
      if (ReadFrame(token)) continue;
      token = {text_.substr(text_.size()), token.line};
      break;
    }
    if (csm_.frame_numbers.empty()) Fail("'$points' has no frames", first_line);
    ReportJumps();
    return {text_.substr(static_cast<std::size_t>(token.text.data() - text_.data())), token.line};
  }

 private:
  [[noreturn]] void Fail(const std::string& message, std::int64_t line) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, line});
  }

  void Warn(std::string message, std::int64_t line) {
    csm_.diagnostics.push_back({Severity::kWarning, std::move(message), line});
  }

  // The text ends with this word and without a line end: part of the word may be cut off.
  [[nodiscard]] bool MayBeCut(std::string_view token) const {
    return token.data() + token.size() == text_.data() + text_.size();
  }

  // False if the file ends within the frame, which is then left out.
  bool ReadFrame(const Token& first) {
    const auto number = ParseInteger(first.text);
    if (!number) {
      if (MayBeCut(first.text)) return LeaveOut(first, "the last frame is cut off");
      Fail("expected the number of a frame, found " + Quoted(first.text), first.line);
    }
    CheckNumber(*number, first.line);
    const auto [attempt, dropout] = TryBoth(*number);
    if (attempt.outcome == Outcome::kEnds) {
      return LeaveOut(first, fmt::format("the last frame, {}, is cut off", *number));
    }
    if (attempt.outcome == Outcome::kMisfit) FailMisfit(*number, first, attempt);
    if (csm_.frame_numbers.empty()) Reserve(first.text.data(), attempt.after.at());
    csm_.frame_numbers.push_back(*number);
    csm_.values.insert(csm_.values.end(), values_[dropout].begin(), values_[dropout].end());
    cursor_ = attempt.after;
    if (attempt.stop.text.empty()) CheckEnd(attempt.stop.line);
    return true;
  }

  void Reserve(const char* first_frame, const char* first_frame_end) {
    const std::size_t frames = GuessFrames(first_frame, first_frame_end, text_);
    csm_.frame_numbers.reserve(frames);
    csm_.values.reserve(frames * csm_.labels.size() * 3);
  }

  void CheckNumber(std::int64_t number, std::int64_t line) {
    if (csm_.frame_numbers.empty()) return;
    const std::int64_t before = csm_.frame_numbers.back();
    if (number <= before) {
      Fail(fmt::format("frame {} after frame {}: frame numbers must grow", number, before), line);
    }
    if (number != before + 1 && jumps_++ == 0) first_jump_ = {before, number, line};
  }

  std::pair<Attempt, Dropout> TryBoth(std::int64_t number) {
    Attempt marker = Try(number, kMarker);
    if (!marker.has_dropouts || marker.outcome == Outcome::kFits) return {marker, kMarker};
    Attempt value = Try(number, kValue);
    // A frame that has one value too many for one reading is too short for the other: it is not
    // cut off unless the file is known to be of that kind.
    const bool is_cut = value.outcome == Outcome::kEnds && is_dropout_a_value_;
    if (value.outcome <= marker.outcome || (value.outcome == Outcome::kEnds && !is_cut)) {
      return {marker, kMarker};
    }
    is_dropout_a_value_ = true;
    return {value, kValue};
  }

  Attempt Try(std::int64_t number, Dropout dropout) {
    Attempt attempt{.after = cursor_, .stop = {}};
    std::vector<double>& values = values_[dropout];
    bool swallows_next = false;  // What looks like the next frame's number was taken for a value.
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (attempt.after.TakeNumber(values[i])) continue;
      attempt.stop = attempt.after.Next();
      const std::string_view text = attempt.stop.text;
      if (text.empty()) attempt.outcome = Outcome::kEnds;
      if (attempt.stop.ends_section()) return attempt;
      swallows_next = swallows_next || (attempt.stop.is_first_in_line && IsNext(number, text));
      if (IsDropout(text)) {
        attempt.has_dropouts = true;
        if (dropout == kMarker) {
          if (i % 3 != 0) return attempt;
          values[i] = values[i + 1] = kMissing;
          i += 2;
        }
        values[i] = kMissing;
        continue;
      }
      const auto value = ParseValue(text);
      if (!value) {
        if (MayBeCut(text)) attempt.outcome = Outcome::kEnds;
        return attempt;
      }
      values[i] = *value;
    }
    TokenCursor ahead = attempt.after;
    attempt.stop = ahead.Next();
    attempt.outcome = HowWellFollowed(number, attempt.stop);
    if (attempt.outcome == Outcome::kLoose && swallows_next) attempt.outcome = Outcome::kMisfit;
    return attempt;
  }

  static bool IsNext(std::int64_t number, std::string_view token) {
    const auto next = ParseInteger(token);
    return next && *next > number && *next == number + 1;
  }

  [[nodiscard]] Outcome HowWellFollowed(std::int64_t number, const Token& next) const {
    if (next.ends_section()) return Outcome::kFits;
    const bool may_be_number = ParseInteger(next.text) || MayBeCut(next.text);
    if (next.is_first_in_line && may_be_number) return Outcome::kFits;
    return IsNext(number, next.text) ? Outcome::kLoose : Outcome::kMisfit;
  }

  [[noreturn]] void FailMisfit(std::int64_t number, const Token& first,
                               const Attempt& attempt) const {
    const Token& stop = attempt.stop;
    if (!stop.ends_section() && !IsDropout(stop.text) && !ParseValue(stop.text)) {
      Fail(fmt::format("a value of frame {} is not a number: {}", number, Quoted(stop.text)),
           stop.line);
    }
    std::size_t values = 0;
    std::size_t dropouts = 0;
    TokenCursor cursor = cursor_;
    for (Token token = cursor.Next(); !token.ends_section(); token = cursor.Next()) {
      if (token.is_first_in_line && ParseInteger(token.text)) break;
      ++(IsDropout(token.text) ? dropouts : values);
    }
    Fail(fmt::format("frame {} has {} values and {} drop-outs; '$order' names {} markers of three "
                     "values each",
                     number, values, dropouts, csm_.labels.size()),
         first.line);
  }

  // Returns false.
  bool LeaveOut(const Token& first, const std::string& what) {
    if (csm_.frame_numbers.empty()) Fail(what + ", and there is no other", first.line);
    if (options_.strict) Fail(what + " (without --strict it is left out)", first.line);
    Warn(what + "; it is left out", first.line);
    return false;
  }

  // At the end of the file, after a whole frame.
  void CheckEnd(std::int64_t line) {
    if (IsSpace(text_.back())) return;
    const std::string_view what =
        "the last line has no end: if the file was cut off, its last value ";
    if (options_.strict) {
      Fail(fmt::format("{}may lack digits (without --strict it is read)", what), line);
    }
    Warn(fmt::format("{}may lack digits", what), line);
  }

  // Once, however many there are.
  void ReportJumps() {
    if (jumps_ == 0) return;
    const std::string others = jumps_ == 1 ? "" : fmt::format(", and {} more", jumps_ - 1);
    Warn(fmt::format("frame {} follows frame {}{}: numbers jump, time is taken to go on evenly",
                     first_jump_.to, first_jump_.from, others),
         first_jump_.line);
  }

  std::string_view text_;
  TokenCursor cursor_;
  const std::filesystem::path& file_;
  const CsmReadOptions& options_;
  CsmRecording& csm_;
  std::array<std::vector<double>, 2> values_;  // [Dropout] of the frame that is tried.
  bool is_dropout_a_value_ = false;            // As an earlier frame showed.
  std::int64_t jumps_ = 0;                     // Of frame numbers.
  struct {
    std::int64_t from = 0;
    std::int64_t to = 0;
    std::int64_t line = 0;
  } first_jump_;
};

}  // namespace

CsmRest ReadCsmPoints(std::string_view text, std::int64_t line, const std::filesystem::path& file,
                      const CsmReadOptions& options, CsmRecording& recording) {
  return PointsReader(text, line, file, options, recording).Read();
}

}  // namespace kinebase::internal
