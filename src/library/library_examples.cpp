#include "kinebase/library/library_examples.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"

namespace kinebase {
namespace {

using Chosen = std::vector<const StoredTake*>;

// A word, and a pose with what is computed of it on the way.
constexpr std::int64_t kBytesOfAColumn = 16;
constexpr std::int64_t kBytesOfAPose = std::int64_t{2} * kPoseValues * sizeof(float);

std::int64_t BytesOf(std::int64_t columns, bool with_poses) {
  return columns * (kBytesOfAColumn + (with_poses ? kBytesOfAPose : 0));
}

std::int64_t BytesOf(const StoredTake& take, const ExampleRequest& request) {
  const double seconds = static_cast<double>(take.frame_count) / take.rate_hz;
  return BytesOf(std::llround(seconds * request.rate_hz) + 1, request.with_poses);
}

TakeBatch Load(const TakeLibrary& library, const Chosen& takes, const ExampleRequest& request) {
  std::vector<std::optional<TakeFeatures>> loaded(takes.size());
  std::vector<std::optional<Error>> errors(takes.size());
  ParallelFor(takes.size(), request.threads, [&](std::size_t i) {
    try {
      loaded[i] =
          library.LoadTake(*takes[i], *request.features, request.rate_hz, request.with_poses);
    } catch (const Error& error) {
      errors[i] = error;
    }
  });
  library.ReleaseMemory(takes);
  TakeBatch batch;
  batch.takes.reserve(takes.size());
  for (std::size_t i = 0; i < takes.size(); ++i) {
    if (loaded[i]) {
      batch.takes.push_back(std::move(*loaded[i]));
    } else {
      batch.failures.push_back({takes[i]->path, *errors[i]});
    }
  }
  return batch;
}

// As many as fit, one from each of as many equal parts. Those that fit are fewer than their mean
// size says, where they happen to be long.
Chosen EvenlyChosen(const Chosen& takes, const ExampleRequest& request) {
  std::int64_t bytes = 0;
  for (const StoredTake* take : takes) bytes += BytesOf(*take, request);
  if (bytes <= request.memory_bytes) return takes;
  const double share = static_cast<double>(request.memory_bytes) / static_cast<double>(bytes);
  const auto count = static_cast<std::size_t>(share * static_cast<double>(takes.size()));
  Chosen chosen;
  bytes = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const StoredTake* take = takes[i * takes.size() / count];
    bytes += BytesOf(*take, request);
    if (bytes <= request.memory_bytes) chosen.push_back(take);
  }
  return chosen;
}

}  // namespace

std::int64_t ExampleBytes(std::span<const TakeFeatures> takes) {
  std::int64_t bytes = 0;
  for (const TakeFeatures& take : takes) {
    bytes += BytesOf(take.features.column_count(), !take.poses.values.empty());
  }
  return bytes;
}

LabelledBatch LoadLabelledTakes(const TakeLibrary& library, const TakeFilter& filter,
                                const ExampleRequest& request) {
  Chosen takes = library.TakesWith(*request.features, request.rate_hz, filter, request.with_poses);
  std::erase_if(takes, [](const StoredTake* take) {
    return take->is_intact && take->name.class_name.empty();
  });
  if (takes.empty()) {
    throw Error(ErrorCode::kNotFound,
                "the library knows no class of these takes; import a table of clips with --list");
  }
  std::int64_t bytes = 0;
  for (const StoredTake* take : takes) bytes += BytesOf(*take, request);
  if (bytes > request.memory_bytes) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} takes to learn from need some {} MB of memory, and {} may be used; "
                            "raise --memory, or choose fewer with --actors",
                            takes.size(), (bytes >> 20) + 1, request.memory_bytes >> 20));
  }
  TakeBatch batch = Load(library, takes, request);
  LabelledBatch labelled{.clips = {}, .failures = std::move(batch.failures)};
  labelled.clips.reserve(batch.takes.size());
  for (TakeFeatures& take : batch.takes) {
    std::string class_name = take.name.class_name;
    std::string actor = take.name.actor;
    labelled.clips.push_back({std::move(take), std::move(class_name), std::move(actor)});
  }
  return labelled;
}

BackgroundTakes LoadBackgroundTakes(const TakeLibrary& library,
                                    const std::set<std::filesystem::path>& without,
                                    const ExampleRequest& request) {
  Chosen takes = library.TakesWith(*request.features, request.rate_hz, {}, request.with_poses);
  std::erase_if(takes, [&](const StoredTake* take) { return without.contains(take->path); });
  const Chosen chosen = EvenlyChosen(takes, request);
  return {
      .batch = Load(library, chosen, request), .chosen = chosen.size(), .available = takes.size()};
}

}  // namespace kinebase
