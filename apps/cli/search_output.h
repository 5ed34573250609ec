// Hits as `kinebase search` shows them: JSON, a table for people, CSV.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/console.h"
#include "kinebase/library/take_search.h"

namespace kinebase::cli {

// A hit with the names that people know it by.
struct NamedHit {
  std::size_t query = 0;  // Index of the template among those asked for.
  std::string template_name;
  std::filesystem::path file;
  TakeHit hit;
};

[[nodiscard]] Json HitsToJson(const std::vector<NamedHit>& hits,
                              const std::vector<TakeFailure>& failures, std::int64_t frames,
                              double elapsed_s);
[[nodiscard]] std::string HitsToText(const std::vector<NamedHit>& hits, bool many_templates);

// With an empty column "verdict", for people to fill; library/feedback.h reads it.
[[nodiscard]] std::string HitsToCsv(const std::vector<NamedHit>& hits);

}  // namespace kinebase::cli
