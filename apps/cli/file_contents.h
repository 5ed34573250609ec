// What formats hold besides poses and markers, for `kinebase info`.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/console.h"

namespace kinebase::cli {

// "41 (3 without a name), 2.1 % of the samples missing".
[[nodiscard]] std::string DescribeMarkers(const MarkerCloud& markers);

// Lines for people: a title and what follows it. None for formats that hold nothing else.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> DescribeContents(
    const Recording& recording);

[[nodiscard]] Json ContentsAsJson(const Recording& recording);  // An object; may be empty.

}  // namespace kinebase::cli
