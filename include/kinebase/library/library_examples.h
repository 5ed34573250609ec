// What is learned from, out of a library on disk: its takes as clips by class, and as a background.
//
// Read library/take_library.h and library/class_learning.h first. Learning needs all of its
// examples at once, so memory is bounded by how many are taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>

#include "kinebase/library/class_learning.h"
#include "kinebase/library/take_library.h"

namespace kinebase {

struct ExampleRequest {
  const FeatureSet* features = nullptr;
  double rate_hz = 30;
  bool with_poses = true;
  std::int64_t memory_bytes = 0;  // That examples may use.
  int threads = 0;
};

// Memory that these takes use as examples: features, poses, and what learning keeps of them.
[[nodiscard]] std::int64_t ExampleBytes(std::span<const TakeFeatures> takes);

// The takes that have a class and that the filter leaves, as LoadLabelledClips gives clips: by
// path, with the classes and actors that the library knows. Errors  As TakeLibrary::Load, and
// NotFound if none has a class; InvalidArgument if they need more
//         memory, saying how much.
[[nodiscard]] LabelledBatch LoadLabelledTakes(const TakeLibrary& library, const TakeFilter& filter,
                                              const ExampleRequest& request);

// A background, or as much of it as fits.
struct BackgroundTakes {
  TakeBatch batch;
  std::size_t chosen = 0;  // Of so many takes, evenly by path: always the same ones.
  std::size_t available = 0;
};

// All takes but those whose files are given.
// Errors  As TakeLibrary::Load.
[[nodiscard]] BackgroundTakes LoadBackgroundTakes(const TakeLibrary& library,
                                                  const std::set<std::filesystem::path>& without,
                                                  const ExampleRequest& request);

}  // namespace kinebase
