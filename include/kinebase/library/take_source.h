// Where takes come from that are searched: files, which are read anew, or a library on disk, which
// has their features. What searches asks for takes and gets them some at a time.
//
// A library's features are searched where they are in its mapped files. No more takes are at hand
// than fit into the memory that may be used, and that of a segment is given back once its takes
// have been visited: so an archive may be of any size.
// Read library/take_library.h and library/take_search.h first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "kinebase/library/memory_limits.h"
#include "kinebase/library/take_library.h"
#include "kinebase/library/takes.h"
#include "kinebase/search/keyframe_index.h"

namespace kinebase {

// Keyframes of a template, to preselect by.
struct KeyframeQuery {
  std::span<const Keyframe> keyframes;
  int template_columns = 0;
};

struct TakeRequest {
  const FeatureSet* features = nullptr;
  double rate_hz = 30;
  bool with_poses = false;
  std::vector<KeyframeQuery> keyframes;
  // Whether takes that show no keyframes are wanted too; their words are not even read otherwise.
  bool only_preselected = false;
  int threads = 0;
  // Hears of takes read from files, or visited of a library.
  ProgressCallback progress;
};

// Some takes of all, in their order.
struct TakesAtHand {
  std::vector<std::size_t> places;  // [take] its index among all of the source, for any request.
  std::int64_t columns = 0;         // Of all of them, whether read or not.
  std::vector<TakeView> takes;      // Features are empty where only preselected ones are wanted.
  std::vector<std::vector<Stretch>> stretches;  // [keyframe query]; recordings index `takes`.
};

class TakeSource {
 public:
  TakeSource(std::vector<TakeStretch> stretches, LoadOptions load);

  // memory_bytes  Roughly what takes at hand may use, with what searching them needs: a quarter of
  //               it is for their data. A take that is larger is at hand alone. Beside it there is
  //               the library's catalogue, some 500 bytes a take.
  // Errors        As TakeLibrary.
  TakeSource(const std::filesystem::path& library, TakeFilter filter,
             std::int64_t memory_bytes = kDefaultMemoryBytes);

  // Whether all takes are one group, as those of files are.
  [[nodiscard]] bool comes_at_once() const { return std::holds_alternative<Files>(from_); }

  // Calls `visit` with all takes, one group after another; what it is given is valid until it
  // returns. Files are read at once, and are one group.
  //
  // Returns  The takes that could not be read, in their order.
  // Errors   NotFound as TakeLibrary::TakesWith, before anything is visited; Preselect's;
  //          Cancelled.
  // Cost     Of reading; for a library that of comparing checksums, at the speed of memory.
  std::vector<TakeFailure> Visit(const TakeRequest& request,
                                 const std::function<void(const TakesAtHand&)>& visit) const;

  // The same for several requests: each group of takes is visited once for each of them, in their
  // order, before the next group. So all that is asked of a take comes together, and a take that
  // cannot be read for one request is still visited for the others.
  //
  // requests  Threads and progress are those of the first.
  // visit     Hears which request it is.
  // Returns   Of all requests; a take that fails several in the same words comes once.
  std::vector<TakeFailure> VisitTogether(
      std::span<const TakeRequest> requests,
      const std::function<void(std::size_t, const TakesAtHand&)>& visit) const;

 private:
  struct Files {
    std::vector<TakeStretch> stretches;
    LoadOptions load;
  };
  struct Stored {
    TakeLibrary library;
    TakeFilter filter;
    std::int64_t memory_bytes;
  };
  using Visitor = std::function<void(std::size_t, const TakesAtHand&)>;
  static std::vector<TakeFailure> VisitFiles(const Files& files,
                                             std::span<const TakeRequest> requests,
                                             const Visitor& visit);
  static std::vector<TakeFailure> VisitStored(const Stored& stored,
                                              std::span<const TakeRequest> requests,
                                              const Visitor& visit);

  std::variant<Files, Stored> from_;
};

// The libraries among `paths`, each by itself, and all the files that the others name.
// Errors  As FindMotionFiles and TakeLibrary.
[[nodiscard]] std::vector<TakeSource> SourcesIn(std::span<const std::filesystem::path> paths,
                                                const LoadOptions& load,
                                                std::int64_t memory_bytes = kDefaultMemoryBytes);

}  // namespace kinebase
