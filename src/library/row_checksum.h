// Checksums of what stands in rows of a catalogue. Internal.
//
// SQLite keeps none of what is stored: a bit that flips on the disk in a number or a name is read
// as another number or name. A take has one checksum over all its rows, so that one that is gone is
// missed too.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "library/checksum.h"

namespace kinebase {
struct StoredTake;
}

namespace kinebase::internal {

class RowChecksum {
 public:
  RowChecksum& Add(std::int64_t number) {
    constexpr int kBits = 8;
    for (std::size_t i = 0; i < sizeof(number); ++i) {
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(number) >> (kBits * i));
    }
    return *this;
  }
  RowChecksum& Add(double number) { return Add(std::bit_cast<std::int64_t>(number)); }
  RowChecksum& Add(std::string_view text) {
    Add(static_cast<std::int64_t>(text.size()));
    bytes_ += text;
    return *this;
  }

  [[nodiscard]] std::int64_t value() const { return static_cast<std::int64_t>(Checksum(bytes_)); }

 private:
  std::string bytes_;
};

// Of everything that the catalogue says of a take; labels and features in the catalogue's order.
[[nodiscard]] std::int64_t ChecksumOf(const StoredTake& take);

}  // namespace kinebase::internal
