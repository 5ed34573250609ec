// Features by their words: ids, names, synonyms, opposites and phrases of a feature set.
//
// Read features/feature_set.h first; templates/query.h and templates/editing.h take such words.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/features/feature_set.h"

namespace kinebase {

// A word as it is compared, and where in the text it stands (bytes).
struct PhraseWord {
  std::string text;
  std::size_t first = 0;
  std::size_t count = 0;
};

// The words of a text as they are compared: in lower case, without punctuation, without "the", "a",
// "is" and "are"; "right" and "left" join the word that follows, so that "the right hand is raised"
// and "rhand raised" are the same.
[[nodiscard]] std::vector<PhraseWord> PhraseWords(std::string_view text);
[[nodiscard]] std::string NormalizedPhrase(std::string_view text);  // These, with blanks between.

// All that can be said with a feature set.
class Vocabulary {
 public:
  explicit Vocabulary(const FeatureSet& features);

  // As written, feature by feature: id, name, synonyms, opposites; then the phrases.
  [[nodiscard]] const std::vector<FeaturePhrase>& phrases() const { return phrases_; }

  // Every meaning of a text. None: unknown; several: features that share a name.
  [[nodiscard]] std::vector<std::vector<FeatureState>> Meanings(std::string_view text) const;

  // Whether any phrase has this word, as PhraseWords gives it.
  [[nodiscard]] bool HasWord(std::string_view word) const;

  // Phrases that are spelt nearly as a text, the nearest first; if there are none, phrases that
  // have all its words. Cost  O(phrases · length²).
  [[nodiscard]] std::vector<std::string> Nearest(std::string_view text, std::size_t most = 3) const;

 private:
  std::vector<FeaturePhrase> phrases_;
  std::multimap<std::string, std::size_t, std::less<>> by_words_;  // To the index in phrases_.
  std::set<std::string, std::less<>> words_;
};

// "did you mean 'rhand raised' or 'lhand raised'?", or what else helps where nothing is near.
[[nodiscard]] std::string SuggestPhrases(const Vocabulary& vocabulary, const FeatureSet& features,
                                         std::string_view text);

// Rows of features that a list names, in the order of the set: ids, names, synonyms, phrases of
// features that hold, groups ("upper") or "all", with commas between.
//
// Errors  NotFound, naming what is unknown and what is spelt like it; InvalidArgument for words
// that
//         say that a feature does not hold, or that several features share.
[[nodiscard]] std::vector<int> FindFeatures(const FeatureSet& features, std::string_view list);

}  // namespace kinebase
