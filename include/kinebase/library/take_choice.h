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

// By path; valid as long as the library. As TakeLibrary::Choose also all that are not intact.
// Errors  NotFound for a name that means no take of a library that is all intact; those of
//         TakeLibrary::Choose.
[[nodiscard]] std::vector<const StoredTake*> ChooseTakes(const TakeLibrary& library,
                                                         const TakeChoice& choice);

// The same, where something is to be said of takes.
struct ChosenTakes {
  std::vector<const StoredTake*> takes;  // Intact.
  std::vector<TakeFailure> failures;     // The others.
};
[[nodiscard]] ChosenTakes ChooseIntactTakes(const TakeLibrary& library, const TakeChoice& choice);

// The same, where something is to be changed, which is done whole or not at all.
// Errors  Also MalformedFile if any is not intact, with the remedy.
[[nodiscard]] std::vector<const StoredTake*> ChooseTakesToChange(const TakeLibrary& library,
                                                                 const TakeChoice& choice);

}  // namespace kinebase
