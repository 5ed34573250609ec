// Compares a copy of HDM05, or a part of one, with what the documentation says it holds.
//
// Read library/hdm05.h first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinebase/core/progress.h"
#include "kinebase/library/hdm05.h"

namespace kinebase {

enum class Hdm05Presence { kMissing, kUnreadable, kFound };

struct Hdm05TakeStatus {
  const Hdm05Take* take = nullptr;
  std::array<Hdm05Presence, 2> files{};  // [Hdm05Format]
};

struct Hdm05ClassStatus {
  const Hdm05Class* motion_class = nullptr;
  std::array<std::vector<Hdm05Presence>, 2> clips;  // [Hdm05Format][number − 1]

  [[nodiscard]] int found(Hdm05Format format) const;
  [[nodiscard]] int found(Hdm05Format format, std::size_t actor) const;
  [[nodiscard]] bool complete(Hdm05Format format) const;
};

enum class Hdm05FindingKind {
  kUnreadable,       // The file is broken; `message` is the reader's.
  kWrongFrameCount,  // Another number of frames than documented.
  kDamaged,          // Readable, but something at its end is cut off.
  kExtra,            // Named like HDM05's files, but the documentation knows no such file.
  kDuplicate,        // The same name and format as an earlier file.
  kKnownDefect,      // The documentation says what is wrong with it.
};
[[nodiscard]] std::string_view ToString(Hdm05FindingKind kind);  // "wrong frame count".

struct Hdm05Finding {
  Hdm05FindingKind kind = Hdm05FindingKind::kExtra;
  std::filesystem::path file;
  std::string message;
  std::optional<std::int64_t> expected_frames;  // With kWrongFrameCount.
  std::optional<std::int64_t> found_frames;
};

struct Hdm05Report {
  std::filesystem::path folder;
  int readable_count = 0;                 // Takes, clips and skeletons.
  std::vector<Hdm05TakeStatus> takes;     // As in the catalogue.
  std::vector<Hdm05ClassStatus> classes;  // As in the catalogue.
  std::vector<Hdm05Presence> skeletons;   // [actor]
  std::vector<Hdm05Presence> videos;      // As in the catalogue; never opened.
  std::vector<Hdm05Finding> findings;     // By kind, then by file.

  // Takes that are there and can be read. actor "" and part 0: all.
  [[nodiscard]] int TakesFound(Hdm05Format format, std::string_view actor = {}, int part = 0) const;
  [[nodiscard]] int ClipsFound(Hdm05Format format) const;
  [[nodiscard]] int ClipsFound(Hdm05Format format, std::size_t actor) const;
  // Names without rate and extension, in the catalogue's order.
  [[nodiscard]] std::vector<std::string> MissingTakes(Hdm05Format format) const;
  [[nodiscard]] std::vector<std::string> MissingClips(Hdm05Format format) const;
  // Actors of whom there are AMC files and no skeleton.
  [[nodiscard]] std::vector<std::string> MissingSkeletons() const;
  [[nodiscard]] std::vector<const Hdm05Finding*> FindingsOf(Hdm05FindingKind kind) const;
  // Whether files differ from the documentation or cannot be read. Missing and extra files and
  // known defects are no difference.
  [[nodiscard]] bool HasFaults() const;
};

// Looks at all files below `folder` that are named as those of HDM05, in any case and wherever they
// lie; takes and clips as AMC and C3D, skeletons, videos. A file that cannot be read is a finding.
//
// Errors   NotFound if there is no such folder or no file of HDM05 in it; InvalidArgument for a
//          file; Cancelled.
// Cost     Reads every take and clip once.
// Threads  The report does not depend on their number.
[[nodiscard]] Hdm05Report CheckHdm05(const std::filesystem::path& folder, int threads = 0,
                                     const ProgressCallback& progress = {});

}  // namespace kinebase
