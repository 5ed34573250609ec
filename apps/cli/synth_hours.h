// kinebase synth --hours: a library on disk of made-up motion, without files in between.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "kinebase/library/take_import.h"

namespace kinebase::cli {

// Takes of five minutes, the last of what remains; twelve by one actor. They are made when the
// import asks for them, and named after the folder, the seed, the actor and a number.
[[nodiscard]] std::vector<ImportSource> SyntheticSources(const std::filesystem::path& library,
                                                         double hours, std::uint64_t seed);

}  // namespace kinebase::cli
