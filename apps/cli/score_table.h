// Tables of scores, for people or for a document.
#pragma once

#include <string>
#include <vector>

namespace kinebase::cli {

// Rows of cells; the first row is the head.
using Rows = std::vector<std::vector<std::string>>;

// Cells but the first `left` of each row are aligned to the right.
[[nodiscard]] std::string AsText(const Rows& rows, std::size_t left = 1);
// The same; a row that begins with "macro" is bold.
[[nodiscard]] std::string AsMarkdown(const Rows& rows, std::size_t left = 1);

}  // namespace kinebase::cli
