#include "kinebase/library/take_source.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "kinebase/features/pose_stream.h"
#include "kinebase/library/take_search.h"

namespace kinebase {
namespace {

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
std::size_t EndOfGroup(Chosen takes, std::size_t begin, std::span<const TakeRequest> requests,
                       std::int64_t memory_bytes) {
  std::int64_t bytes = 0;
  std::int64_t columns = 0;  // Of the request that has most.
  std::size_t end = begin;
  for (; end < takes.size() && static_cast<std::int64_t>(end - begin) < kMostTakes; ++end) {
    std::int64_t most = 0;
    for (const TakeRequest& request : requests) {
      const std::int64_t of_take = ColumnsOf(*takes[end], request.rate_hz);
      bytes += of_take * (kBytesOfAColumn + (request.with_poses ? kBytesOfAPose : 0));
      most = std::max(most, of_take);
    }
    columns += most;
    const bool fits = bytes <= memory_bytes / kShareOfMemory && columns <= kMostColumns;
    if (!fits && end > begin) break;
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

// Those that could not be read, each once for each thing that is wrong with it.
class Failures {
 public:
  void Add(const std::filesystem::path& path, const Error& error) {
    if (known_.emplace(path, error.what()).second) all_.push_back({path, error});
  }
  std::vector<TakeFailure> Take() { return std::move(all_); }

 private:
  std::set<std::pair<std::filesystem::path, std::string>> known_;
  std::vector<TakeFailure> all_;
};

using Read = std::vector<ReadTake>;

// What could be read of a group, as it is visited.
TakesAtHand Gather(Chosen takes, std::size_t first, const Read& read, std::size_t queries) {
  TakesAtHand at_hand;
  at_hand.takes.reserve(takes.size());
  at_hand.places.reserve(takes.size());
  at_hand.stretches.resize(queries);
  for (std::size_t i = 0; i < takes.size(); ++i) {
    if (read[i].error) continue;
    const StoredTake& take = *takes[i];
    const int index = static_cast<int>(at_hand.takes.size());
    TakeView& view = at_hand.takes.emplace_back();
    view.path = &take.path;
    view.name = &take.name;
    view.rate_hz = take.rate_hz;
    view.frame_count = take.frame_count;
    view.features = read[i].features;
    view.poses = &read[i].poses;
    at_hand.places.push_back(first + i);
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

// Where the takes of a batch are among the stretches that were asked for, in the same order.
std::vector<std::size_t> PlacesOf(const TakeBatch& batch, std::span<const TakeStretch> stretches) {
  std::vector<std::size_t> places;
  places.reserve(batch.takes.size());
  for (std::size_t i = 0; i < stretches.size() && places.size() < batch.takes.size(); ++i) {
    const TakeStretch& read = batch.takes[places.size()].stretch;
    if (read.file == stretches[i].file && read.first_frame == stretches[i].first_frame &&
        read.last_frame == stretches[i].last_frame) {
      places.push_back(i);
    }
  }
  return places;
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

std::vector<TakeFailure> TakeSource::Visit(
    const TakeRequest& request, const std::function<void(const TakesAtHand&)>& visit) const {
  return VisitTogether({&request, 1},
                       [&](std::size_t, const TakesAtHand& at_hand) { visit(at_hand); });
}

std::vector<TakeFailure> TakeSource::VisitTogether(std::span<const TakeRequest> requests,
                                                   const Visitor& visit) const {
  if (requests.empty()) return {};
  if (const auto* files = std::get_if<Files>(&from_)) return VisitFiles(*files, requests, visit);
  return VisitStored(std::get<Stored>(from_), requests, visit);
}

std::vector<TakeFailure> TakeSource::VisitFiles(const Files& files,
                                                std::span<const TakeRequest> requests,
                                                const Visitor& visit) {
  Failures failures;
  for (std::size_t r = 0; r < requests.size(); ++r) {
    const TakeRequest& request = requests[r];
    const TakeBatch batch = LoadManyTakeFeatures(
        files.stretches, *request.features, request.rate_hz, files.load, requests.front().threads,
        requests.front().progress, {.poses = request.with_poses});
    TakesAtHand at_hand{.places = PlacesOf(batch, files.stretches), .takes = ViewsOf(batch.takes)};
    for (const TakeView& take : at_hand.takes) at_hand.columns += take.features.column_count();
    if (!request.keyframes.empty()) {
      const KeyframeIndex index = IndexTakes(at_hand.takes, *request.features);
      at_hand.stretches.reserve(request.keyframes.size());
      for (const KeyframeQuery& query : request.keyframes) {
        at_hand.stretches.push_back(index.Preselect(query.keyframes, query.template_columns));
      }
    }
    visit(r, at_hand);
    for (const TakeFailure& failure : batch.failures) failures.Add(failure.path, failure.error);
  }
  return failures.Take();
}

std::vector<TakeFailure> TakeSource::VisitStored(const Stored& stored,
                                                 std::span<const TakeRequest> requests,
                                                 const Visitor& visit) {
  std::vector<const StoredTake*> chosen;
  std::vector<StoredReader> readers;
  readers.reserve(requests.size());
  for (const TakeRequest& request : requests) {
    chosen = stored.library.TakesWith(*request.features, request.rate_hz, stored.filter,
                                      request.with_poses);
    readers.emplace_back(stored.library, request);
  }
  const Chosen takes = chosen;
  Failures failures;
  for (std::size_t begin = 0; begin < takes.size();) {
    const std::size_t end = EndOfGroup(takes, begin, requests, stored.memory_bytes);
    const Chosen group = takes.subspan(begin, end - begin);
    for (std::size_t r = 0; r < requests.size(); ++r) {
      Read read(group.size());
      ParallelFor(group.size(), requests.front().threads,
                  [&](std::size_t i) { read[i] = readers[r].Read(*group[i]); });
      visit(r, Gather(group, begin, read, requests[r].keyframes.size()));
      for (std::size_t i = 0; i < group.size(); ++i) {
        if (read[i].error) failures.Add(group[i]->path, *read[i].error);
      }
    }
    stored.library.ReleaseMemory(group);
    begin = end;
    Report(requests.front().progress, begin, takes.size());
  }
  return failures.Take();
}

}  // namespace kinebase
