// Which takes of a library are to be changed or listed.
//
// Read library/take_library.h first.
#pragma once

#include <filesystem>
#include <vector>

#include "kinebase/library/take_library.h"

namespace kinebase {

// Takes by their names and by what they are; each that is given has to hold. Nothing given: all.
struct TakeChoice {
  // Paths of files as the library has them, or folders above them, or the names of files alone.
  std::vector<std::filesystem::path> names;
  TakeFilter filter;
};

// By path; valid as long as the library.
// Errors  NotFound for a name that means no take of the library; those of TakeLibrary::Choose.
[[nodiscard]] std::vector<const StoredTake*> ChooseTakes(const TakeLibrary& library,
                                                         const TakeChoice& choice);

}  // namespace kinebase
