// Which takes there are below some paths, and their features.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/core/progress.h"
#include "kinebase/features/feature_extraction.h"
#include "kinebase/features/joint_stream.h"
#include "kinebase/features/pose_stream.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase {

// All motion files that `paths` name: files as they are, folders searched below, sorted by name.
// A file named twice comes once. Links to folders are followed once each.
// Errors  NotFound for a path that does not exist or a folder with no motion file in it;
//         InvalidArgument for a file of an unknown format, naming the known ones.
[[nodiscard]] std::vector<std::filesystem::path> FindMotionFiles(
    std::span<const std::filesystem::path> paths);

// Where files are that a list or a template names: as they stand, else by their name in the first
// of `places`, files and folders, that has it. Empty for those that are nowhere.
// Errors  NotFound for a place that does not exist.
[[nodiscard]] std::vector<std::filesystem::path> FindNamedFiles(
    std::span<const std::filesystem::path> names, std::span<const std::filesystem::path> places);

// A stretch of a take: "take.amc" or "take.amc:120-480" (1-based, inclusive, as people count: the
// first stored frame is 1).
struct TakeStretch {
  std::filesystem::path file;
  std::int64_t first_frame = 0;  // 0 = whole take.
  std::int64_t last_frame = 0;
};
// A name that exists as a file is taken whole, even if it ends like a stretch.
// Errors  InvalidArgument: last before first, or 0.
[[nodiscard]] TakeStretch ParseTakeStretch(const std::string& text);

// The frames of a recording that a stretch names; the recording itself if it names none.
// Errors  InvalidArgument for a stretch that leaves the take, naming its frames.
[[nodiscard]] Recording CutToStretch(const Recording& recording, const TakeStretch& stretch);

// LoadRecording and CutToStretch.
[[nodiscard]] Recording LoadStretch(const TakeStretch& stretch, const LoadOptions& options);

// A take that was read, with its features.
struct TakeFeatures {
  std::filesystem::path path;
  TakeStretch stretch;  // As it was asked for.
  TakeName name;
  double rate_hz = 0;  // Of the file.
  std::int64_t frame_count = 0;
  FeatureMatrix features;
  // At the rate of the features; empty unless asked for.
  PoseStream poses;
  JointStream rotations;
  JointStream positions;
  Diagnostics diagnostics;
};

// A take as it is searched: what it names lies elsewhere, in a TakeFeatures or in a library on
// disk, and is valid as long as that.
struct TakeView {
  const std::filesystem::path* path = nullptr;
  const TakeName* name = nullptr;
  double rate_hz = 0;  // Of the file.
  std::int64_t frame_count = 0;
  FeatureView features;
  const PoseStream* poses = nullptr;         // Null or empty where there are none.
  const Diagnostics* diagnostics = nullptr;  // Null where none are known.

  TakeView() = default;
  TakeView(const TakeFeatures& take)  // NOLINT(google-explicit-constructor)
      : path(&take.path),
        name(&take.name),
        rate_hz(take.rate_hz),
        frame_count(take.frame_count),
        features(take.features),
        poses(&take.poses),
        diagnostics(&take.diagnostics) {}
};

// [take]
[[nodiscard]] inline std::vector<TakeView> ViewsOf(std::span<const TakeFeatures> takes) {
  return {takes.begin(), takes.end()};
}

// What to extract of a take beside its features.
struct TakeParts {
  bool poses = false;
  bool rotations = false;
  bool positions = false;
};

// Reads one take, or a stretch of it, and extracts its features, and other parts if asked to.
// Errors  Those of LoadRecording and StandardJoints; InvalidArgument for a stretch that leaves the
//         take; Mismatch for rotations and positions of a skeleton that ExtractJointStream refuses,
//         or of markers.
[[nodiscard]] TakeFeatures LoadTakeFeatures(const TakeStretch& stretch, const FeatureSet& features,
                                            double rate_hz, const LoadOptions& options,
                                            const TakeParts& parts = {});

struct TakeFailure {
  std::filesystem::path path;
  Error error;
};

struct TakeBatch {
  std::vector<TakeFeatures> takes;    // Those that could be read, in the order asked for.
  std::vector<TakeFailure> failures;  // The others.
};

// The same for many, in parallel. One bad file never stops the batch.
// Errors  Cancelled.
[[nodiscard]] TakeBatch LoadManyTakeFeatures(std::span<const TakeStretch> stretches,
                                             const FeatureSet& features, double rate_hz,
                                             const LoadOptions& options, int threads,
                                             const ProgressCallback& progress,
                                             const TakeParts& parts = {});

// A row of a list of clips (columns file, class, actor, …).
struct ListedClip {
  std::filesystem::path name;  // As the list has it.
  std::filesystem::path file;  // Where it is; empty if it is nowhere.
  std::string class_name;
  std::string actor;      // Empty where the list does not tell.
  std::int64_t line = 0;  // Of the list.
};

// Whether each clip of a list needs a class.
enum class ListedClass { kRequired, kOptional };

// A list as it stands, `file` still empty.
// list    For messages.
// Errors  MalformedFile: no such table, a clip without a file or a class that it needs, with its
//         line.
[[nodiscard]] std::vector<ListedClip> ParseClipList(std::string_view text,
                                                    const std::filesystem::path& list,
                                                    ListedClass needs = ListedClass::kRequired);

// All of them. A file that is named in full and exists is that one; others are looked up by name
// below the list's folder, then below `folders`.
// Errors  MalformedFile.
[[nodiscard]] std::vector<ListedClip> ReadClipList(const std::filesystem::path& list,
                                                   std::span<const std::filesystem::path> folders,
                                                   ListedClass needs = ListedClass::kRequired);

// Clips of a list (columns file, class, actor, …) that belong to a class and to one of `actors`
// (empty: all). Files are looked up as ReadClipList does.
// Errors  NotFound: a file of the list that is nowhere; a class that the list lacks, naming those
//         that there are; MalformedFile.
[[nodiscard]] std::vector<TakeStretch> ClipsOfClass(const std::filesystem::path& list,
                                                    const std::string& class_name,
                                                    std::span<const std::string> actors,
                                                    std::span<const std::filesystem::path> folders);

}  // namespace kinebase
