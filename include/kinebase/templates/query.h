// Templates from words: "rhand raised & lknee bent for 0.3s then both feet apart".
//
// Read features/vocabulary.h and templates/editing.h first. docs/query-language.md has the grammar,
// what durations and gaps come to, and examples.
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.4, draws such templates by
// hand; the language is ours.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/features/feature_set.h"
#include "kinebase/templates/editing.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

// How long a phase lasts that does not say it.
inline constexpr double kPhaseDuration_s = 0.3;

// The slopes of the matcher let n columns fit from n/2 to 2n columns of a recording: a range of
// durations can be this many times as long as short.
inline constexpr double kWidestDurationRange = 4;

struct QueryOptions {
  std::string name;  // Of the template; empty: the query itself.
  double rate_hz = 30;
  Profile matching = Profile::kBonn;
};

// One moment of a query, or a gap between two.
struct QueryPhase {
  ColumnRange columns;
  std::vector<FeatureState> states;  // By feature; empty: nothing is asked.
};

struct CompiledQuery {
  // One; with "either side:" a second one for the other side, unless both are the same.
  std::vector<MotionTemplate> templates;
  std::vector<QueryPhase> phases;  // Of the first template.
};

// InvalidArgument: a query that cannot be understood, with the word that is to blame.
class QueryError : public Error {
 public:
  // first, count  Bytes of the query.
  QueryError(std::string_view query, std::size_t first, std::size_t count,
             const std::string& message);

  [[nodiscard]] int column() const { return column_; }  // Of the word; characters, 1-based.

  // The query on one line, and below it a line with '^' and '~' under the word.
  [[nodiscard]] const std::string& marked() const { return marked_; }

 private:
  int column_ = 0;
  std::string marked_;
};

// Entries that the query names become 0 or 1, all others "any"; weights are 1.
//
// Errors  QueryError; InvalidArgument if the set has no such rate.
// Cost    O(words · phrases of the set) and the size of the template.
[[nodiscard]] CompiledQuery CompileQuery(std::string_view query, const FeatureSet& features,
                                         const QueryOptions& options = {});

}  // namespace kinebase
