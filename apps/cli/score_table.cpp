#include "cli/score_table.h"

#include "cli/console.h"
#include "fmt/format.h"

namespace kinebase::cli {

std::string AsText(const Rows& rows, std::size_t left) {
  std::vector<std::string> head = rows.front();
  for (std::size_t i = left; i < head.size(); ++i) head[i] = '>' + head[i];
  TextTable table(head);
  for (std::size_t i = 1; i < rows.size(); ++i) table.Add(rows[i]);
  return table.ToString();
}

std::string AsMarkdown(const Rows& rows, std::size_t left) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool is_macro = rows[i].front() == "macro";
    text += '|';
    for (const std::string& cell : rows[i]) {
      text += is_macro ? fmt::format(" **{}** |", cell) : fmt::format(" {} |", cell);
    }
    text += '\n';
    if (i > 0) continue;
    text += '|';
    for (std::size_t c = 0; c < rows[i].size(); ++c) text += c < left ? "---|" : "---:|";
    text += '\n';
  }
  return text;
}

}  // namespace kinebase::cli
