// What is learned from, out of a library on disk: its takes as clips by class, and as a background.
//
// Read library/take_library.h and library/class_learning.h first. Learning needs all of its
// examples at once, so memory is bounded by how many are taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>

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
// path, with the classes and actors that the library knows.
// Errors  As TakeLibrary::TakesWith, and NotFound if none has a class; InvalidArgument if they need
//         more memory, saying how much.
[[nodiscard]] LabelledBatch LoadLabelledTakes(const TakeLibrary& library, const TakeFilter& filter,
                                              const ExampleRequest& request);

// The stretches that have a label, as clips of a class of that name; where takes have it as a
// whole, these. By path and place.
//
// A stretch begins with the first column at or after its first frame, and the features are those
// that the take has there: near its ends they may differ from those of a file cut out of it.
//
// Errors  As LoadLabelledTakes; NotFound also for a label that no take has.
[[nodiscard]] LabelledBatch LoadLabelledStretches(const TakeLibrary& library,
                                                  const std::string& label,
                                                  const TakeFilter& filter,
                                                  const ExampleRequest& request);

// A background, or as much of it as fits.
struct BackgroundTakes {
  TakeBatch batch;
  std::size_t chosen = 0;  // Of so many takes, evenly by path: always the same ones.
  std::size_t available = 0;
};

// All takes but those whose files are given.
// Errors  As TakeLibrary::TakesWith.
[[nodiscard]] BackgroundTakes LoadBackgroundTakes(const TakeLibrary& library,
                                                  const std::set<std::filesystem::path>& without,
                                                  const ExampleRequest& request);

}  // namespace kinebase
