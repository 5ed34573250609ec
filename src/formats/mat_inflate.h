// Compressed variables of MAT-files, with zlib.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinebase::internal {

enum class InflateStatus { kGood, kDamaged, kTooLarge };

// Unpacks `packed` to `out`, at most `limit` bytes.
[[nodiscard]] InflateStatus Inflate(std::string_view packed, std::size_t limit, std::string& out);

[[nodiscard]] std::string Deflate(std::string_view bytes);

}  // namespace kinebase::internal
