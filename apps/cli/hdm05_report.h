// What `kinebase hdm05 check` found, for people and for scripts.
#pragma once

#include <string>

#include "cli/console.h"
#include "kinebase/library/hdm05_check.h"

namespace kinebase::cli {

[[nodiscard]] Json Hdm05ReportJson(const Hdm05Report& report, double elapsed_s);

// list_all_missing  Every name that is missing, not just how many and the first.
[[nodiscard]] std::string Hdm05ReportText(const Hdm05Report& report, bool list_all_missing);

}  // namespace kinebase::cli
