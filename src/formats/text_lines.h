// What the readers of text formats share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace kinebase::internal {

// Whether a line holds bytes that no text has: a file of another kind under this name.
inline bool HoldsBinaryData(std::string_view line) {
  return std::ranges::any_of(line, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && c != '\t' && c != '\f' && c != '\v';
  });
}

// How many frames a text has if all are as long as its first, and some more, so that their numbers
// need not move to a larger place. What is not needed stays untouched and takes no memory.
inline std::size_t GuessFrames(const char* first_frame, const char* first_frame_end,
                               std::string_view text) {
  const auto left = static_cast<std::size_t>(text.data() + text.size() - first_frame);
  const auto frames = left / static_cast<std::size_t>(first_frame_end - first_frame);
  return frames + frames / 8 + 1;
}

}  // namespace kinebase::internal
