#include "kinebase/library/take_source.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "kinebase/features/pose_stream.h"
#include "kinebase/library/take_search.h"

namespace kinebase {
namespace {

using Visitor = std::function<void(const TakesAtHand&)>;
using Chosen = std::span<const StoredTake* const>;

constexpr std::int64_t kShareOfMemory = 4;
// Words and, beside them, what a search keeps of a column at most: candidates and their order.
constexpr std::int64_t kBytesOfAColumn = 64;
// Stored poses, mapped and unpacked, those compared with, and the curves of templates.
constexpr std::int64_t kBytesOfAPose = 1024;
// More at a time gain nothing: a group then takes milliseconds, and its words leave the cache.
constexpr std::int64_t kMostColumns = std::int64_t{1} << 20;
constexpr std::int64_t kMostTakes = std::int64_t{1} << 14;

std::int64_t ColumnsOf(const StoredTake& take, double rate_hz) {
  return std::llround(static_cast<double>(take.frame_count) * rate_hz / take.rate_hz) + 1;
}

// The takes from `begin` on that are at hand together: at least one.
std::size_t EndOfGroup(Chosen takes, std::size_t begin, const TakeRequest& request,
                       std::int64_t memory_bytes) {
  const std::int64_t bytes = kBytesOfAColumn + (request.with_poses ? kBytesOfAPose : 0);
  const std::int64_t most = std::min(memory_bytes / kShareOfMemory / bytes, kMostColumns);
  std::int64_t columns = 0;
  std::size_t end = begin;
  for (; end < takes.size() && static_cast<std::int64_t>(end - begin) < kMostTakes; ++end) {
    columns += ColumnsOf(*takes[end], request.rate_hz);
    if (columns > most && end > begin) break;
  }
  return end;
}

// A stored take on its way to who asked for it.
struct ReadTake {
  std::int64_t columns = 0;
  FeatureView features;
  PoseStream poses;
  std::vector<std::vector<Stretch>> stretches;  // [keyframe query]
  std::optional<Error> error;
};

class StoredReader {
 public:
  StoredReader(const TakeLibrary& library, const TakeRequest& request)
      : library_(library), request_(request), groups_(request.features->Groups()) {}

  [[nodiscard]] ReadTake Read(const StoredTake& take) const {
    ReadTake read;
    try {
      ReadInto(take, read);
    } catch (const Error& error) {
      read.error = error.place().file.empty()
                       ? Error(error.code(), error.message(), {.file = take.path})
                       : error;
    }
    return read;
  }

 private:
  void ReadInto(const StoredTake& take, ReadTake& read) const {
    const std::uint64_t set = request_.features->hash;
    const double rate_hz = request_.rate_hz;
    bool is_wanted = !request_.only_preselected;
    if (!request_.keyframes.empty()) {
      const std::string bytes = library_.RunListsOf(take, set, rate_hz);
      read.columns = library_.ColumnCount(take, set, rate_hz);
      const RunLists lists(bytes, request_.features->feature_count(),
                           static_cast<int>(read.columns));
      read.stretches.reserve(request_.keyframes.size());
      for (const KeyframeQuery& query : request_.keyframes) {
        read.stretches.push_back(
            Preselect(query.keyframes, query.template_columns, groups_, lists, 0));
        is_wanted = is_wanted || !read.stretches.back().empty();
      }
    }
    read.features = {rate_hz, request_.features->feature_count(), {}};
    if (!is_wanted) return;
    read.features.columns = library_.Columns(take, set, rate_hz);
    read.columns = read.features.column_count();
    if (request_.with_poses) {
      read.poses = ExtractPoses(library_.Poses(take, set, rate_hz), rate_hz);
    }
  }

  const TakeLibrary& library_;
  const TakeRequest& request_;
  std::vector<FeatureGroup> groups_;
};

// What could be read of a group, as it is visited; the rest goes to the failures.
TakesAtHand Gather(Chosen takes, const std::vector<ReadTake>& read, std::size_t queries,
                   std::vector<TakeFailure>& failures) {
  TakesAtHand at_hand;
  at_hand.takes.reserve(takes.size());
  at_hand.stretches.resize(queries);
  for (std::size_t i = 0; i < takes.size(); ++i) {
    const StoredTake& take = *takes[i];
    if (read[i].error) {
      failures.push_back({take.path, *read[i].error});
      continue;
    }
    const int index = static_cast<int>(at_hand.takes.size());
    TakeView& view = at_hand.takes.emplace_back();
    view.path = &take.path;
    view.name = &take.name;
    view.rate_hz = take.rate_hz;
    view.frame_count = take.frame_count;
    view.features = read[i].features;
    view.poses = &read[i].poses;
    at_hand.columns += read[i].columns;
    for (std::size_t query = 0; query < queries; ++query) {
      for (Stretch stretch : read[i].stretches[query]) {
        stretch.recording = index;
        at_hand.stretches[query].push_back(stretch);
      }
    }
  }
  return at_hand;
}

void Report(const ProgressCallback& progress, std::size_t done, std::size_t total) {
  if (progress && !progress("searching", done, total)) {
    throw Error(ErrorCode::kCancelled, "cancelled");
  }
}

}  // namespace

TakeSource::TakeSource(std::vector<TakeStretch> stretches, LoadOptions load)
    : from_(Files{std::move(stretches), std::move(load)}) {}

TakeSource::TakeSource(const std::filesystem::path& library, TakeFilter filter,
                       std::int64_t memory_bytes)
    : from_(std::in_place_type<Stored>, TakeLibrary(library), std::move(filter), memory_bytes) {}

std::vector<TakeSource> SourcesIn(std::span<const std::filesystem::path> paths,
                                  const LoadOptions& load, std::int64_t memory_bytes) {
  std::vector<TakeSource> sources;
  std::vector<std::filesystem::path> others;
  for (const std::filesystem::path& path : paths) {
    if (IsLibrary(path)) {
      sources.emplace_back(path, TakeFilter(), memory_bytes);
    } else {
      others.push_back(path);
    }
  }
  if (others.empty()) return sources;
  std::vector<TakeStretch> stretches;
  for (auto& file : FindMotionFiles(others)) stretches.push_back({.file = std::move(file)});
  sources.emplace(sources.begin(), std::move(stretches), load);
  return sources;
}

std::vector<TakeFailure> TakeSource::Visit(const TakeRequest& request, const Visitor& visit) const {
  if (const auto* files = std::get_if<Files>(&from_)) return VisitFiles(*files, request, visit);
  return VisitStored(std::get<Stored>(from_), request, visit);
}

std::vector<TakeFailure> TakeSource::VisitFiles(const Files& files, const TakeRequest& request,
                                                const Visitor& visit) {
  const TakeBatch batch =
      LoadManyTakeFeatures(files.stretches, *request.features, request.rate_hz, files.load,
                           request.threads, request.progress, {.poses = request.with_poses});
  TakesAtHand at_hand{.takes = ViewsOf(batch.takes)};
  for (const TakeView& take : at_hand.takes) at_hand.columns += take.features.column_count();
  if (!request.keyframes.empty()) {
    const KeyframeIndex index = IndexTakes(at_hand.takes, *request.features);
    for (const KeyframeQuery& query : request.keyframes) {
      at_hand.stretches.push_back(index.Preselect(query.keyframes, query.template_columns));
    }
  }
  visit(at_hand);
  return batch.failures;
}

std::vector<TakeFailure> TakeSource::VisitStored(const Stored& stored, const TakeRequest& request,
                                                 const Visitor& visit) {
  const std::vector<const StoredTake*> chosen = stored.library.TakesWith(
      *request.features, request.rate_hz, stored.filter, request.with_poses);
  const Chosen takes = chosen;
  const StoredReader reader(stored.library, request);
  std::vector<TakeFailure> failures;
  std::size_t first = 0;
  for (std::size_t begin = 0; begin < takes.size();) {
    const std::size_t end = EndOfGroup(takes, begin, request, stored.memory_bytes);
    const Chosen group = takes.subspan(begin, end - begin);
    std::vector<ReadTake> read(group.size());
    ParallelFor(group.size(), request.threads,
                [&](std::size_t i) { read[i] = reader.Read(*group[i]); });
    TakesAtHand at_hand = Gather(group, read, request.keyframes.size(), failures);
    at_hand.first = first;
    first += at_hand.takes.size();
    visit(at_hand);
    stored.library.ReleaseMemory(group);
    begin = end;
    Report(request.progress, begin, takes.size());
  }
  return failures;
}

}  // namespace kinebase
