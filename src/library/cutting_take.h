// A take while clips are cut out of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

#include "kinebase/formats/amc.h"
#include "kinebase/formats/c3d.h"
#include "library/cutting_plan.h"

namespace kinebase::internal {

class OpenTake {
 public:
  // Errors  As the readers'.
  OpenTake(const std::filesystem::path& file, ClipType type, bool strict);

  [[nodiscard]] const Diagnostics& diagnostics() const;

  // The bytes of a clip's file.
  // Errors  InvalidArgument with the line of the cut file if the range leaves the take.
  [[nodiscard]] std::string Clip(const ClipPlan& plan) const;

  // What is in a clip's file and was not in the take.
  [[nodiscard]] Diagnostics NotesOn(const ClipPlan& plan) const;

 private:
  [[nodiscard]] std::int64_t frame_count() const;

  std::variant<AmcMotion, C3dRecording> record_;
};

}  // namespace kinebase::internal
