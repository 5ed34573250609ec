// Takes and motion classes by words.

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

#include "kinebase/core/text_scanner.h"
#include "kinebase/library/hdm05.h"
#include "library/name_words.h"

namespace kinebase {
namespace {

using Words = std::vector<std::string>;

bool IsLetterOrDigit(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

// Runs of letters and digits, in lower case: "Sit-ups, 5 times" → sit, ups, 5, times.
Words SplitWords(std::string_view text) {
  Words words;
  bool in_word = false;
  for (const char c : text) {
    const bool belongs = IsLetterOrDigit(c);
    if (belongs && !in_word) words.emplace_back();
    if (belongs) words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    in_word = belongs;
  }
  return words;
}

// What a class is called, and the words in it: "kickRFront1Reps" → kickrfront1reps, kick, r,
// front, 1, reps.
void AddClassName(std::string_view name, Words& words) {
  words.push_back(ToLower(name));
  std::ranges::move(SplitWords(internal::SpacedName(name)), std::back_inserter(words));
}

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

bool HasWord(const Words& words, std::string_view beginning) {
  return std::ranges::any_of(words,
                             [=](const std::string& word) { return word.starts_with(beginning); });
}

bool HasAll(const Words& words, const Words& asked) {
  return std::ranges::all_of(asked, [&](const std::string& word) { return HasWord(words, word); });
}

bool HasAny(const Words& words, const Words& asked) {
  return std::ranges::any_of(asked, [&](const std::string& word) { return HasWord(words, word); });
}

Words WordsOf(const Hdm05Step& step) {
  Words words = SplitWords(step.text);
  for (const std::string& name : step.classes) AddClassName(name, words);
  return words;
}

Words TitleWords(const Hdm05Scene& scene) {
  Words words = SplitWords(scene.title);
  for (const Hdm05Part& part : Hdm05().parts) {
    if (part.part == scene.part) words = std::move(words) + SplitWords(part.title);
  }
  return words;
}

enum Rank { kInOnePlace, kWithTitles, kAnywhere, kNowhere };

// Where a scene's script has all words.
struct ScriptMatch {
  Rank rank = kNowhere;
  std::vector<const Hdm05Step*> steps;
};

ScriptMatch MatchScript(const Hdm05Scene& scene, const Words& asked) {
  const Words titles = TitleWords(scene);
  std::vector<const Hdm05Step*> whole;
  std::vector<const Hdm05Step*> with_titles;
  std::vector<const Hdm05Step*> some;
  Words all = titles;
  for (const Hdm05Step& step : scene.steps) {
    const Words words = WordsOf(step);
    if (HasAll(words, asked)) whole.push_back(&step);
    if (HasAny(words, asked)) some.push_back(&step);
    if (HasAny(words, asked) && HasAll(words + titles, asked)) with_titles.push_back(&step);
    all = std::move(all) + words;
  }
  if (asked.empty()) return {.rank = kInOnePlace};
  if (!whole.empty()) return {kInOnePlace, std::move(whole)};
  if (HasAll(titles, asked)) return {.rank = kWithTitles};
  if (!with_titles.empty()) return {kWithTitles, std::move(with_titles)};
  if (HasAll(all, asked)) return {kAnywhere, std::move(some)};
  return {};
}

// A scene of the script or of freestyle, with all takes that the query lets in.
struct Candidate {
  int part = 0;
  int scene = 0;
  const Hdm05Scene* script = nullptr;
  std::vector<const Hdm05Take*> takes;
};

std::vector<Candidate> Candidates(const Hdm05Query& query) {
  std::vector<Candidate> candidates;
  const auto is_asked_for = [&](int part) { return !query.part || *query.part == part; };
  for (const Hdm05Scene& scene : Hdm05().scenes) {
    if (is_asked_for(scene.part)) {
      candidates.push_back({.part = scene.part, .scene = scene.scene, .script = &scene});
    }
  }
  for (const Hdm05Take& take : Hdm05().takes) {
    if (!is_asked_for(take.part) || (!query.actor.empty() && take.actor != query.actor)) continue;
    auto place = std::ranges::find_if(candidates, [&](const Candidate& candidate) {
      return candidate.part == take.part && candidate.scene == take.scene;
    });
    if (place == candidates.end()) {
      candidates.push_back({.part = take.part, .scene = take.scene});
      place = candidates.end() - 1;
    }
    place->takes.push_back(&take);
  }
  std::ranges::stable_sort(candidates, [](const Candidate& a, const Candidate& b) {
    return std::pair(a.part, a.scene) < std::pair(b.part, b.scene);
  });
  return candidates;
}

}  // namespace

std::vector<Hdm05Match> FindHdm05Takes(const Hdm05Query& query) {
  const Words asked = SplitWords(query.words);
  std::array<std::vector<Hdm05Match>, kNowhere> by_rank;
  for (Candidate& candidate : Candidates(query)) {
    ScriptMatch script;
    if (candidate.script != nullptr) script = MatchScript(*candidate.script, asked);
    if (script.rank == kNowhere) {
      const Words titles = candidate.script == nullptr ? Words() : TitleWords(*candidate.script);
      std::erase_if(candidate.takes, [&](const Hdm05Take* take) {
        const Words words = SplitWords(take->description);
        return (words.empty() && !asked.empty()) || !HasAll(words + titles, asked);
      });
      if (candidate.takes.empty()) continue;
      script.rank = kInOnePlace;
    }
    by_rank[script.rank].push_back({.part = candidate.part,
                                    .scene = candidate.scene,
                                    .script = candidate.script,
                                    .steps = std::move(script.steps),
                                    .takes = std::move(candidate.takes)});
  }
  std::vector<Hdm05Match> matches;
  for (auto& rank : by_rank) std::ranges::move(rank, std::back_inserter(matches));
  return matches;
}

std::vector<const Hdm05Class*> FindHdm05Classes(std::string_view words) {
  const Words asked = SplitWords(words);
  std::vector<const Hdm05Class*> classes;
  for (const Hdm05Class& motion_class : Hdm05().classes) {
    Words own = SplitWords(motion_class.description);
    AddClassName(motion_class.name, own);
    if (HasAll(own, asked)) classes.push_back(&motion_class);
  }
  return classes;
}

}  // namespace kinebase
