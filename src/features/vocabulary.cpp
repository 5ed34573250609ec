#include "kinebase/features/vocabulary.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr std::array<std::string_view, 4> kFillers = {"the", "a", "is", "are"};

// Letters of other alphabets are bytes from 0x80 on in UTF-8.
bool IsPartOfWord(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         byte >= 0x80U;
}

std::vector<PhraseWord> PlainWords(std::string_view text) {
  std::vector<PhraseWord> words;
  for (std::size_t at = 0; at < text.size();) {
    if (!IsPartOfWord(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && IsPartOfWord(text[end])) ++end;
    words.push_back({ToLower(text.substr(at, end - at)), at, end - at});
    at = end;
  }
  return words;
}

bool HasAllWords(std::string_view text, std::string_view words) {
  const std::vector<PhraseWord> there = PhraseWords(text);
  return std::ranges::all_of(PhraseWords(words), [&](const PhraseWord& word) {
    return std::ranges::find(there, word.text, &PhraseWord::text) != there.end();
  });
}

// Levenshtein's: letters to insert, remove or replace.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row[b.size()];
}

[[noreturn]] void RefuseItem(ErrorCode code, std::string_view item, const std::string& why) {
  throw Error(code, fmt::format("{} {}", Quoted(item), why));
}

// Rows that one item of a list names.
std::vector<int> FeaturesOfItem(const FeatureSet& features, const Vocabulary& vocabulary,
                                std::string_view item) {
  std::vector<int> rows;
  const std::string words = NormalizedPhrase(item);
  for (int i = 0; i < features.feature_count(); ++i) {
    const std::string& group = features.features[static_cast<std::size_t>(i)].group;
    if (words == "all" || (!group.empty() && words == NormalizedPhrase(group))) rows.push_back(i);
  }
  if (!rows.empty()) return rows;
  const auto meanings = vocabulary.Meanings(item);
  if (meanings.empty()) {
    RefuseItem(ErrorCode::kNotFound, item,
               "is no feature: " + SuggestPhrases(vocabulary, features, item));
  }
  if (meanings.size() > 1) {
    RefuseItem(ErrorCode::kInvalidArgument, item, "is the name of several features; use ids");
  }
  for (const FeatureState& state : meanings[0]) {
    if (!state.holds) {
      const std::string& id = features.features[static_cast<std::size_t>(state.feature)].id;
      RefuseItem(ErrorCode::kInvalidArgument, item,
                 fmt::format("says that {} does not hold; name {} itself", id, id));
    }
    rows.push_back(state.feature);
  }
  return rows;
}

}  // namespace

std::vector<PhraseWord> PhraseWords(std::string_view text) {
  std::vector<PhraseWord> words = PlainWords(text);
  std::erase_if(words, [](const PhraseWord& word) {
    return std::ranges::find(kFillers, word.text) != kFillers.end();
  });
  std::vector<PhraseWord> joined;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool is_side = words[i].text == "right" || words[i].text == "left";
    if (is_side && i + 1 < words.size()) {
      const PhraseWord& next = words[i + 1];
      joined.push_back({words[i].text.substr(0, 1) + next.text, words[i].first,
                        next.first + next.count - words[i].first});
      ++i;
    } else {
      joined.push_back(words[i]);
    }
  }
  return joined;
}

std::string NormalizedPhrase(std::string_view text) {
  std::string phrase;
  for (const PhraseWord& word : PhraseWords(text)) {
    phrase.append(phrase.empty() ? "" : " ").append(word.text);
  }
  return phrase;
}

Vocabulary::Vocabulary(const FeatureSet& features) {
  for (int i = 0; i < features.feature_count(); ++i) {
    const Feature& feature = features.features[static_cast<std::size_t>(i)];
    phrases_.push_back({feature.id, {{i, true}}});
    phrases_.push_back({feature.name, {{i, true}}});
    for (const std::string& text : feature.synonyms) phrases_.push_back({text, {{i, true}}});
    for (const std::string& text : feature.opposites) phrases_.push_back({text, {{i, false}}});
  }
  phrases_.insert(phrases_.end(), features.phrases.begin(), features.phrases.end());
  for (std::size_t i = 0; i < phrases_.size(); ++i) {
    by_words_.emplace(NormalizedPhrase(phrases_[i].text), i);
    for (const PhraseWord& word : PhraseWords(phrases_[i].text)) words_.insert(word.text);
  }
}

std::vector<std::vector<FeatureState>> Vocabulary::Meanings(std::string_view text) const {
  std::vector<std::vector<FeatureState>> meanings;
  const auto [first, last] = by_words_.equal_range(NormalizedPhrase(text));
  for (auto entry = first; entry != last; ++entry) {
    const auto& states = phrases_[entry->second].states;
    if (std::ranges::find(meanings, states) == meanings.end()) meanings.push_back(states);
  }
  return meanings;
}

bool Vocabulary::HasWord(std::string_view word) const { return words_.contains(word); }

std::vector<std::string> Vocabulary::Nearest(std::string_view text, std::size_t most) const {
  const std::string wanted = NormalizedPhrase(text);
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const FeaturePhrase& phrase : phrases_) {
    const std::size_t distance = EditDistance(wanted, NormalizedPhrase(phrase.text));
    // From a third of the letters on, likeness is chance.
    if (distance * 3 <= wanted.size()) found.emplace_back(distance, phrase.text);
  }
  std::ranges::stable_sort(found, {}, &std::pair<std::size_t, std::string>::first);
  std::vector<std::string> nearest;
  for (const auto& [distance, phrase] : found) {
    // Behind a near one, one that is much farther is no help.
    if (nearest.size() == most || distance > found.front().first + 1) break;
    nearest.push_back(phrase);
  }
  if (!nearest.empty() || wanted.empty()) return nearest;
  for (const FeaturePhrase& phrase : phrases_) {
    if (nearest.size() < most && HasAllWords(phrase.text, text)) nearest.push_back(phrase.text);
  }
  return nearest;
}

std::string SuggestPhrases(const Vocabulary& vocabulary, const FeatureSet& features,
                           std::string_view text) {
  const std::vector<std::string> nearest = vocabulary.Nearest(text);
  if (nearest.empty()) {
    const Feature& example = features.features.front();
    return fmt::format("feature set '{}' knows, for example, '{}' or '{}'", features.name,
                       example.id, example.name);
  }
  std::string suggestion = "did you mean ";
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const char* before = i == 0 ? "" : i + 1 == nearest.size() ? " or " : ", ";
    suggestion += fmt::format("{}'{}'", before, nearest[i]);
  }
  return suggestion + '?';
}

std::vector<int> FindFeatures(const FeatureSet& features, std::string_view list) {
  const Vocabulary vocabulary(features);
  // Names may have commas in them: "hands far apart, sideways".
  std::vector<int> rows;
  if (!vocabulary.Meanings(list).empty()) {
    rows = FeaturesOfItem(features, vocabulary, list);
  } else {
    for (std::string_view rest = list;;) {
      const std::size_t comma = rest.find(',');
      const auto item = FeaturesOfItem(features, vocabulary, Trim(rest.substr(0, comma)));
      rows.insert(rows.end(), item.begin(), item.end());
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
  }
  std::ranges::sort(rows);
  rows.erase(std::ranges::unique(rows).begin(), rows.end());
  return rows;
}

}  // namespace kinebase
