#include "library/hdm05_file_names.h"

#include <algorithm>
#include <array>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase::internal {
namespace {

namespace fs = std::filesystem;

constexpr double kHdm05RateHz = 120;

std::string LowerExtension(const fs::path& file) { return ToLower(file.extension().string()); }

// Why a motion's name is none of the documentation's.
std::string WhyExtra(const TakeName& name) {
  const Hdm05Catalogue& catalogue = Hdm05();
  if (name.actor.empty()) {
    return "is not named HDM_{actor}_{part}-{scene}_{take}_120 or HDM_{actor}_{class}_{nnn}_120";
  }
  const auto actor = catalogue.FindActor(ToLower(name.actor));
  if (!actor) return fmt::format("HDM05 has no actor {}", Quoted(name.actor));
  if (name.class_name.empty()) {
    return fmt::format("HDM05 has no take {} of actor {}", Quoted(name.take), name.actor);
  }
  const Hdm05Class* motion_class = catalogue.FindClass(name.class_name);
  if (motion_class == nullptr) {
    return fmt::format("HDM05 has no motion class {}", Quoted(name.class_name));
  }
  const Hdm05ClipNumbers numbers = ClipNumbers(*motion_class, *actor);
  if (numbers.count() == 0) {
    return fmt::format("HDM05 has no clip of {} by actor {}", motion_class->name, name.actor);
  }
  return fmt::format("HDM05 has clips {:03} to {:03} of {} by actor {}", numbers.first,
                     numbers.last, motion_class->name, name.actor);
}

}  // namespace

Hdm05FileNames::Hdm05FileNames() {
  using Kind = Hdm05File::Kind;
  const Hdm05Catalogue& catalogue = Hdm05();
  for (std::size_t i = 0; i < catalogue.takes.size(); ++i) {
    motions_.emplace(ToLower(catalogue.takes[i].name()),
                     Hdm05File{.kind = Kind::kTake, .index = i});
  }
  for (std::size_t i = 0; i < catalogue.classes.size(); ++i) {
    for (std::size_t actor = 0; actor < catalogue.actors.size(); ++actor) {
      const Hdm05ClipNumbers numbers = ClipNumbers(catalogue.classes[i], actor);
      for (int number = numbers.first; number <= numbers.last; ++number) {
        motions_.emplace(
            ToLower(Hdm05ClipName(catalogue.classes[i], actor, number)),
            Hdm05File{.kind = Kind::kClip, .index = i, .actor = actor, .number = number});
      }
    }
  }
  for (std::size_t i = 0; i < catalogue.actors.size(); ++i) {
    others_.emplace(fmt::format("hdm_{}.asf", catalogue.actors[i].id),
                    Hdm05File{.kind = Kind::kSkeleton, .index = i});
  }
  for (std::size_t i = 0; i < catalogue.videos.size(); ++i) {
    others_.emplace(ToLower(catalogue.videos[i].file), Hdm05File{.kind = Kind::kVideo, .index = i});
  }
}

bool Hdm05FileNames::IsCandidate(const fs::path& file) {
  static constexpr std::array kExtensions = {".amc", ".c3d", ".asf", ".avi"};
  return ToLower(file.filename().string()).starts_with("hdm_") &&
         std::ranges::find(kExtensions, LowerExtension(file)) != kExtensions.end();
}

Hdm05File Hdm05FileNames::Identify(const fs::path& file) const {
  const std::string extension = LowerExtension(file);
  if (extension == ".asf" || extension == ".avi") {
    const auto known = others_.find(ToLower(file.filename().string()));
    if (known != others_.end()) return known->second;
    return {.why_extra =
                extension == ".asf" ? "HDM05 has no such skeleton" : "HDM05 has no such video"};
  }
  const std::string stem = ToLower(file.stem().string());
  const TakeName name = ParseTakeName(file);
  Hdm05File found;
  if (const auto bare = motions_.find(stem); bare != motions_.end()) {
    found = bare->second;
  } else {
    const auto rated = motions_.find(stem.substr(0, stem.rfind('_')));
    if (rated == motions_.end()) {
      found.why_extra = WhyExtra(name);
    } else if (name.rate_hz != kHdm05RateHz) {
      found.why_extra = "is not at 120 Hz by its name, as HDM05 is";
    } else {
      found = rated->second;
    }
  }
  found.format = extension == ".c3d" ? Hdm05Format::kC3d : Hdm05Format::kAmc;
  return found;
}

}  // namespace kinebase::internal
