// Which take, clip, skeleton or video of HDM05 a file is by its name.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <unordered_map>

#include "kinebase/library/hdm05.h"

namespace kinebase::internal {

struct Hdm05File {
  enum class Kind { kTake, kClip, kSkeleton, kVideo, kExtra };

  Kind kind = Kind::kExtra;
  std::size_t index = 0;                   // In the catalogue: of the take, class, actor or video.
  std::size_t actor = 0;                   // Of a clip.
  int number = 0;                          // Of a clip.
  Hdm05Format format = Hdm05Format::kAmc;  // Of a take or clip.
  std::string why_extra;
};

// Names of all files that the documentation lists. May be used by several threads at once.
class Hdm05FileNames {
 public:
  Hdm05FileNames();

  // Whether a file is HDM05's by the looks of its name: HDM_….amc, .c3d, .asf, .avi.
  [[nodiscard]] static bool IsCandidate(const std::filesystem::path& file);

  // `file` is a candidate.
  [[nodiscard]] Hdm05File Identify(const std::filesystem::path& file) const;

 private:
  std::unordered_map<std::string, Hdm05File> motions_;  // By name without rate, in lower case.
  std::unordered_map<std::string, Hdm05File> others_;   // By file name in lower case.
};

}  // namespace kinebase::internal
