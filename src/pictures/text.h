// Text as both kinds of canvas need it. Internal.
#pragma once

#include <cairo.h>

#include <string>
#include <string_view>

#include "kinebase/pictures/canvas.h"

namespace kinebase::internal {

// Valid UTF-8 in one line without anything that XML 1.0 forbids. Spaces are single and inside, as
// SVG viewers show them.
[[nodiscard]] std::string CleanText(std::string_view text);

// Font, size and rendering: metrics are not rounded to dots, so that measuring and drawing agree at
// every scale.
void SelectFont(cairo_t* context, const TextStyle& style);

[[nodiscard]] double CleanTextWidth(const std::string& clean, const TextStyle& style);

}  // namespace kinebase::internal
