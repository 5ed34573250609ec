// Searching all takes of a source for many templates, some takes at a time: files, or a library of
// any size.
//
// Read library/take_search.h and library/take_source.h first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kinebase/library/take_search.h"
#include "kinebase/library/take_source.h"

namespace kinebase {

// A template that is ready to be searched for. Those that agree in the hash of their feature set
// and in the rate share the takes' features; those of them with a contrast are each other's rivals.
struct SearchQuery {
  // Where it has keyframes, and no contrast, only stretches that show these are searched.
  MotionTemplate motion_template;
  FeatureSet features;
  std::optional<FuzzyQuery> fuzzy;  // Searched for instead, everywhere.
};

struct SourceSearchOptions {
  std::optional<double> tau;  // Of all templates; else each one's own, else kDefaultTau.
  std::size_t most_hits = 500;
  int faults = 0;  // Of fuzzy queries.
  int threads = 0;
  ProgressCallback progress;
  // Hears of all takes, some at a time, for each query before it is searched for there.
  std::function<void(std::size_t query, std::span<const TakeView> takes)> on_takes;
};

struct SourceHit {
  std::size_t query = 0;
  std::filesystem::path file;
  TakeHit hit;  // Its `take` means nothing any more.
};

struct SourceHits {
  std::vector<SourceHit> hits;  // The best of all; of equals plain templates' before rivals'.
  std::size_t takes = 0;        // That could be read for some query,
  std::int64_t frames = 0;      // and theirs.
  std::vector<std::pair<std::filesystem::path, Diagnostics>> diagnostics;  // Where there are any.
  std::vector<TakeFailure> failures;  // Of all queries: a take may have hits and be here, too.
  // Of all templates but those with a contrast; less than all where keyframes left something out.
  std::int64_t searched_columns = 0;
  std::int64_t all_columns = 0;
};

// What SearchTakes and RankTakes find in all takes, whatever group of takes they come in.
//
// Errors   Those of TakeSource::Visit, SearchTakes and RankTakes.
// Cost     Of these. Memory: the takes at hand and the best hits of each query.
// Threads  The result does not depend on the thread count.
[[nodiscard]] SourceHits SearchSource(const TakeSource& source,
                                      std::span<const SearchQuery> queries,
                                      const SourceSearchOptions& options = {});

}  // namespace kinebase
