// The query language: docs/query-language.md has its grammar.
#include "kinebase/templates/query.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/features/feature_extraction.h"
#include "kinebase/features/vocabulary.h"

namespace kinebase {
namespace {

// Part of the query: bytes.
struct Span {
  std::size_t first = 0;
  std::size_t count = 0;

  [[nodiscard]] std::size_t end() const { return first + count; }
};

struct Token {
  std::string text;  // In lower case.
  Span span;
};

bool IsSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool IsSign(char c) { return c == '&' || c == ':'; }

// Words between blanks; '&' and ':' stand for themselves.
std::vector<Token> Tokenize(std::string_view text) {
  std::vector<Token> tokens;
  for (std::size_t at = 0; at < text.size();) {
    if (IsSpace(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at + 1;
    if (!IsSign(text[at])) {
      while (end < text.size() && !IsSpace(text[end]) && !IsSign(text[end])) ++end;
    }
    tokens.push_back({ToLower(text.substr(at, end - at)), {at, end - at}});
    at = end;
  }
  return tokens;
}

bool IsContinuationByte(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

std::size_t CharacterCount(std::string_view text) {
  return text.size() - static_cast<std::size_t>(std::ranges::count_if(text, IsContinuationByte));
}

std::string MarkedText(std::string_view query, Span span) {
  std::string line(query);
  std::ranges::replace_if(
      line, [](char c) { return IsSpace(c) || (c >= 0 && c < ' '); }, ' ');
  const std::size_t length = CharacterCount(query.substr(span.first, span.count));
  return line + '\n' + std::string(CharacterCount(query.substr(0, span.first)), ' ') + '^' +
         std::string(std::max<std::size_t>(length, 1) - 1, '~');
}

struct Duration {
  double low_s = 0;
  double high_s = 0;  // As low_s, if it is no range.
  Span span;
};

class QueryParser {
 public:
  QueryParser(std::string_view text, const FeatureSet& features, double rate_hz)
      : text_(text),
        features_(features),
        vocabulary_(features),
        rate_hz_(rate_hz),
        tokens_(Tokenize(text)) {}

  void Parse() {
    if (tokens_.empty()) {
      Fail({0, 0}, fmt::format("the query is empty; say for example '{}'",
                               features_.features.front().name));
    }
    ParsePrefix();
    AddPhase();
    while (Take("then")) {
      ParseGap();
      AddPhase();
    }
    if (at_ < tokens_.size()) {
      Fail(tokens_[at_].span, fmt::format("expected 'then' or the end, found {}; 'for' is the last "
                                          "of a phase, and '&' goes before it",
                                          Quoted(tokens_[at_].text)));
    }
    const auto asks = [](const QueryPhase& phase) { return !phase.states.empty(); };
    if (std::ranges::none_of(phases_, asks)) {
      Fail(Whole(), "the query asks for nothing, so that it would fit everywhere");
    }
  }

  [[nodiscard]] bool is_mirrored() const { return is_mirrored_; }
  [[nodiscard]] bool is_either_side() const { return is_either_side_; }
  [[nodiscard]] const std::vector<QueryPhase>& phases() const { return phases_; }
  [[nodiscard]] int column_count() const { return column_count_; }

 private:
  [[noreturn]] void Fail(Span span, const std::string& message) const {
    throw QueryError(text_, span.first, span.count, message);
  }

  [[nodiscard]] Span Whole() const {
    return {tokens_.front().span.first, tokens_.back().span.end() - tokens_.front().span.first};
  }

  // Where something is missing: the next word, or what follows the last one.
  [[nodiscard]] Span Here() const {
    if (at_ < tokens_.size()) return tokens_[at_].span;
    return {tokens_.empty() ? 0 : tokens_.back().span.end(), 0};
  }

  [[nodiscard]] bool Sees(std::string_view word, std::size_t ahead = 0) const {
    return at_ + ahead < tokens_.size() && tokens_[at_ + ahead].text == word;
  }

  bool Take(std::string_view word) {
    if (!Sees(word)) return false;
    ++at_;
    return true;
  }

  void ParsePrefix() {
    if (Sees("mirrored") && Sees(":", 1)) {
      is_mirrored_ = true;
      at_ += 2;
    } else if (Sees("either") && Sees("side", 1) && Sees(":", 2)) {
      is_either_side_ = true;
      at_ += 3;
    }
  }

  void ParseGap() {
    const Span word = Here();
    if (Take("within")) {
      const Duration duration = ParseDuration(word);
      if (duration.low_s != duration.high_s) {
        Fail(duration.span, "'within' takes one duration; a range goes with 'after'");
      }
      // Columns of "any" that fit up to the whole duration: half of it.
      AddColumns(ColumnsOf({duration.low_s / 2, duration.high_s / 2, duration.span}), {});
    } else if (Take("after")) {
      AddColumns(ColumnsOf(ParseDuration(word)), {});
    }
  }

  void AddPhase() {
    std::map<int, bool> states;
    do {
      ParseTerm(states);
    } while (Take("&") || Take("and"));
    const Span word = Here();
    int columns = ColumnsOfDuration(kPhaseDuration_s, rate_hz_);
    if (Take("for")) columns = ColumnsOf(ParseDuration(word));
    QueryPhase phase;
    for (const auto& [feature, holds] : states) phase.states.push_back({feature, holds});
    AddColumns(columns, std::move(phase.states));
  }

  void AddColumns(int columns, std::vector<FeatureState> states) {
    if (columns > kMostTemplateColumns - column_count_) {
      Fail(Whole(), fmt::format("the query takes more than {} columns; shorten its durations",
                                kMostTemplateColumns));
    }
    phases_.push_back({{column_count_, column_count_ + columns - 1}, std::move(states)});
    column_count_ += columns;
  }

  [[nodiscard]] bool AtEndOfTerm() const {
    constexpr std::array<std::string_view, 5> kEnds = {"then", "for", "&", "and", ":"};
    return at_ >= tokens_.size() || std::ranges::find(kEnds, tokens_[at_].text) != kEnds.end();
  }

  // A phrase, negated where "not" is anywhere among its words.
  void ParseTerm(std::map<int, bool>& states) {
    if (AtEndOfTerm()) {
      Fail(Here(), at_ < tokens_.size()
                       ? fmt::format("expected a phrase before {}", Quoted(tokens_[at_].text))
                       : "expected a phrase at the end");
    }
    const std::size_t first = tokens_[at_].span.first;
    std::optional<Span> negation;
    for (; !AtEndOfTerm(); ++at_) {
      if (tokens_[at_].text != "not") continue;
      if (negation) Fail(tokens_[at_].span, "a second 'not' in one phrase; leave both out");
      negation = tokens_[at_].span;
    }
    const Span span{first, tokens_[at_ - 1].span.end() - first};
    // Blanks in its place keep all other words where they are.
    std::string phrase(text_.substr(span.first, span.count));
    if (negation) phrase.replace(negation->first - first, negation->count, negation->count, ' ');
    if (NormalizedPhrase(phrase) == "any" && !negation) return;
    for (const FeatureState& state : StatesOf(phrase, span, negation.has_value())) {
      const auto [known, is_new] = states.try_emplace(state.feature, state.holds);
      if (!is_new && known->second != state.holds) {
        Fail(span, fmt::format("{} cannot hold and not hold at once; put 'then' between",
                               IdOf(state.feature)));
      }
    }
  }

  [[nodiscard]] const std::string& IdOf(int feature) const {
    return features_.features[static_cast<std::size_t>(feature)].id;
  }

  [[nodiscard]] std::vector<FeatureState> StatesOf(std::string_view phrase, Span span,
                                                   bool negated) const {
    FailAtStrangeSign(phrase, span);
    auto meanings = vocabulary_.Meanings(phrase);
    if (meanings.empty()) FailUnknown(phrase, span);
    if (meanings.size() > 1) {
      std::string ids;
      for (const auto& states : meanings)
        ids += (ids.empty() ? "" : ", ") + IdOf(states[0].feature);
      Fail(span, fmt::format("several features have this name; say which: {}", ids));
    }
    std::vector<FeatureState> states = std::move(meanings[0]);
    if (!negated) return states;
    if (states.size() > 1) {
      Fail(span,
           "'not' goes with one feature, and this phrase asks for several; say for each "
           "whether it holds");
    }
    states[0].holds = !states[0].holds;
    return states;
  }

  [[noreturn]] void FailUnknown(std::string_view phrase, Span span) const {
    const std::vector<PhraseWord> words = PhraseWords(phrase);
    const auto place = [&](const PhraseWord& word) {
      return Span{span.first + word.first, word.count};
    };
    for (const PhraseWord& word : words) {
      if (word.text == "or" || word.text == "either") {
        Fail(place(word),
             "a template cannot choose; compile a query for each, or begin one with "
             "'either side:'");
      }
      if (word.text == "any") Fail(place(word), "'any' stands alone: 'any for 0.5s'");
      if (word.text == "within" || word.text == "after") {
        Fail(place(word), fmt::format("'{}' follows 'then'", word.text));
      }
    }
    FailWhereTwoPhrasesMeet(phrase, span, words);
    const std::string suggestion = SuggestPhrases(vocabulary_, features_, phrase);
    for (const PhraseWord& word : words) {
      if (vocabulary_.HasWord(word.text)) continue;
      Fail(place(word),
           fmt::format("{} is unknown; {}", Quoted(text_.substr(place(word).first, word.count)),
                       suggestion));
    }
    Fail(span, fmt::format("{} is no phrase; {}", Quoted(Trim(phrase)), suggestion));
  }

  // Punctuation does not count in a phrase, but these would seem to.
  void FailAtStrangeSign(std::string_view phrase, Span span) const {
    const std::size_t sign = phrase.find_first_of("()[]{}<>|+*/=;!?\"^~$%");
    if (sign == std::string_view::npos) return;
    Fail({span.first + sign, 1},
         fmt::format("{} means nothing here; a query has phrases, '&', 'not', 'for' and 'then'",
                     Quoted(phrase.substr(sign, 1))));
  }

  void FailWhereTwoPhrasesMeet(std::string_view phrase, Span span,
                               const std::vector<PhraseWord>& words) const {
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::size_t border = words[i].first;
      if (vocabulary_.Meanings(phrase.substr(0, border)).empty() ||
          vocabulary_.Meanings(phrase.substr(border)).empty()) {
        continue;
      }
      Fail({span.first + border, words[i].count},
           "a second phrase begins here; put '&' or 'then' "
           "before it");
    }
  }

  // "0.3s", "200 ms", "0.2-0.5s", "12 columns"; `word` is what it belongs to.
  Duration ParseDuration(Span word) {
    if (at_ >= tokens_.size()) FailDuration(word);
    Duration duration;
    const std::size_t first = tokens_[at_].span.first;
    position_ = first;
    const std::optional<double> low = TakeNumber();
    if (!low) FailDuration(tokens_[at_].span);
    std::optional<double> high = low;
    SkipSpaces();
    if (position_ < text_.size() && text_[position_] == '-') {
      ++position_;
      SkipSpaces();
      high = TakeNumber();
      SkipSpaces();
    }
    const std::size_t unit_at = position_;
    const std::optional<double> unit_s = TakeUnit();
    if (!high || !unit_s) FailDuration({first, std::max(position_, unit_at) - first});
    duration = {*low * *unit_s, *high * *unit_s, {first, position_ - first}};
    while (at_ < tokens_.size() && tokens_[at_].span.first < position_) ++at_;
    return duration;
  }

  [[noreturn]] void FailDuration(Span span) const {
    Fail(span, "expected a duration, as 0.3s, 200ms, 0.2-0.5s or 10 columns");
  }

  void SkipSpaces() {
    while (position_ < text_.size() && IsSpace(text_[position_])) ++position_;
  }

  std::optional<double> TakeNumber() {
    const std::size_t end =
        std::min(text_.find_first_not_of("0123456789.", position_), text_.size());
    const auto number = ParseDouble(text_.substr(position_, end - position_));
    position_ = end;
    return number && std::isfinite(*number) ? number : std::nullopt;
  }

  // Seconds that it stands for.
  std::optional<double> TakeUnit() {
    std::size_t end = position_;
    while (end < text_.size() && !IsSpace(text_[end]) && !IsSign(text_[end])) ++end;
    const std::string unit = ToLower(text_.substr(position_, end - position_));
    position_ = end;
    if (unit == "s") return 1.0;
    if (unit == "ms") return 0.001;
    if (unit == "column" || unit == "columns") return 1 / rate_hz_;
    return std::nullopt;
  }

  // Of a range the geometric mean: as many times longer than the shortest as shorter than the
  // longest, so that the slopes of the matcher reach both.
  [[nodiscard]] int ColumnsOf(const Duration& duration) const {
    const auto& [low_s, high_s, span] = duration;
    if (high_s < low_s) Fail(span, "the range of durations runs backwards; the shorter goes first");
    if (high_s > kWidestDurationRange * low_s) {
      Fail(span, fmt::format("the range is too wide: a template fits from half to twice its "
                             "length, so that the longer may be {:g} times the shorter",
                             kWidestDurationRange));
    }
    try {
      return ColumnsOfDuration(std::sqrt(low_s * high_s), rate_hz_);
    } catch (const Error& error) {
      Fail(span, error.message());
    }
  }

  std::string_view text_;
  const FeatureSet& features_;
  Vocabulary vocabulary_;
  double rate_hz_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;        // In tokens_.
  std::size_t position_ = 0;  // In text_, within a duration.
  bool is_mirrored_ = false;
  bool is_either_side_ = false;
  std::vector<QueryPhase> phases_;
  int column_count_ = 0;
};

// The query without breaks and double blanks: what its template is called.
std::string OnOneLine(std::string_view query) {
  std::string line;
  for (const char c : query) {
    if (!IsSpace(c)) {
      line += c;
    } else if (!line.ends_with(' ')) {
      line += ' ';
    }
  }
  return std::string(Trim(line));
}

MotionTemplate Draw(const std::vector<QueryPhase>& phases, MotionTemplate blank) {
  for (const QueryPhase& phase : phases) {
    for (const FeatureState& state : phase.states) {
      blank = WithEntries(std::move(blank), std::array{state.feature}, phase.columns,
                          state.holds ? 1 : 0);
    }
  }
  return blank;
}

void MirrorPhases(std::vector<QueryPhase>& phases, const FeatureSet& features) {
  const std::vector<int> rows = features.MirrorRows();
  for (QueryPhase& phase : phases) {
    for (FeatureState& state : phase.states) {
      state.feature = rows[static_cast<std::size_t>(state.feature)];
    }
    std::ranges::sort(phase.states, {}, &FeatureState::feature);
  }
}

}  // namespace

QueryError::QueryError(std::string_view query, std::size_t first, std::size_t count,
                       const std::string& message)
    : Error(
          ErrorCode::kInvalidArgument,
          fmt::format("query, column {}: {}", CharacterCount(query.substr(0, first)) + 1, message)),
      column_(static_cast<int>(CharacterCount(query.substr(0, first))) + 1),
      marked_(MarkedText(query, {first, count})) {}

CompiledQuery CompileQuery(std::string_view query, const FeatureSet& features,
                           const QueryOptions& options) {
  CheckColumnRate(features, options.rate_hz);
  QueryParser parser(query, features, options.rate_hz);
  parser.Parse();
  CompiledQuery compiled{.phases = parser.phases()};
  if (parser.is_mirrored()) MirrorPhases(compiled.phases, features);
  const std::string text = OnOneLine(query);
  MotionTemplate result =
      Draw(compiled.phases, BlankTemplate(options.name.empty() ? text : options.name, features,
                                          parser.column_count(), options.rate_hz));
  result.matching = options.matching;
  result.origin = "query: " + text;
  compiled.templates.push_back(std::move(result));
  if (parser.is_either_side()) {
    MotionTemplate other = MirrorTemplate(compiled.templates[0], features);
    if (other.matrix != compiled.templates[0].matrix)
      compiled.templates.push_back(std::move(other));
  }
  return compiled;
}

}  // namespace kinebase
