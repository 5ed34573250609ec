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

void CheckFits(const Chosen& takes, const ExampleRequest& request) {
  std::int64_t bytes = 0;
  for (const StoredTake* take : takes) bytes += BytesOf(*take, request);
  if (bytes > request.memory_bytes) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} takes to learn from need some {} MB of memory, and {} may be used; "
                            "raise --memory, or choose fewer with --actors",
                            takes.size(), (bytes >> 20) + 1, request.memory_bytes >> 20));
  }
}

// The columns that begin within a stretch's frames; a take's poses may be missing.
TakeFeatures CutToLabel(const TakeFeatures& take, const StoredLabel& label) {
  TakeFeatures cut = take;
  if (label.first_frame == 0) return cut;
  cut.stretch.first_frame = label.first_frame;
  cut.stretch.last_frame = label.last_frame;
  const double columns_a_frame = take.features.rate_hz / take.rate_hz;
  const auto column_at = [&](std::int64_t frames) {
    const auto column = std::llround(std::ceil(static_cast<double>(frames) * columns_a_frame));
    return std::clamp<std::ptrdiff_t>(column, 0, std::ssize(take.features.columns));
  };
  const auto first = column_at(label.first_frame - 1);
  const auto end = column_at(label.last_frame);
  const auto& columns = take.features.columns;
  cut.features.columns.assign(columns.begin() + first, columns.begin() + end);
  const auto& poses = take.poses.values;
  if (poses.empty()) return cut;
  cut.poses.values.assign(poses.begin() + first * kPoseValues, poses.begin() + end * kPoseValues);
  return cut;
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
  CheckFits(takes, request);
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

LabelledBatch LoadLabelledStretches(const TakeLibrary& library, const std::string& label,
                                    const TakeFilter& filter, const ExampleRequest& request) {
  const auto has_label = [&](const StoredLabel& each) { return each.text == label; };
  TakeFilter with_label = filter;
  if (with_label.labels.empty()) with_label.labels = {label};
  Chosen takes =
      library.TakesWith(*request.features, request.rate_hz, with_label, request.with_poses);
  std::erase_if(takes, [&](const StoredTake* take) {  // Damaged ones are to be named.
    return take->is_intact && std::ranges::none_of(take->labels, has_label);
  });
  if (takes.empty()) {
    throw Error(ErrorCode::kNotFound, fmt::format("has no label '{}' in these takes", label),
                {.file = library.folder()});
  }
  CheckFits(takes, request);
  TakeBatch batch = Load(library, takes, request);
  LabelledBatch labelled{.clips = {}, .failures = std::move(batch.failures)};
  auto stored = takes.begin();
  for (const TakeFeatures& take : batch.takes) {  // In the order of the stored ones.
    stored = std::find_if(stored, takes.end(), [&](auto* each) { return each->path == take.path; });
    for (const StoredLabel& each : (*stored)->labels) {
      if (!has_label(each)) continue;
      TakeFeatures cut = CutToLabel(take, each);
      if (cut.features.columns.empty()) {
        labelled.failures.push_back(
            {take.path, Error(ErrorCode::kInvalidArgument,
                              fmt::format("its stretch {}-{} is too short to learn from",
                                          each.first_frame, each.last_frame),
                              {.file = take.path})});
        continue;
      }
      labelled.clips.push_back({std::move(cut), label, take.name.actor});
    }
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
