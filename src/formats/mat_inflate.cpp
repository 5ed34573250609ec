#include "formats/mat_inflate.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>

#include "kinebase/core/error.h"

namespace kinebase::internal {
namespace {

// zlib counts in 32 bits; more is handed over bit by bit.
uInt Share(std::size_t size) {
  return static_cast<uInt>(std::min<std::size_t>(size, std::numeric_limits<uInt>::max()));
}

class Inflater {
 public:
  Inflater() {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  z_stream& stream() { return stream_; }

 private:
  z_stream stream_{};
};

}  // namespace

InflateStatus Inflate(std::string_view packed, std::size_t limit, std::string& out) {
  Inflater inflater;
  z_stream& stream = inflater.stream();
  std::array<char, 1 << 16> buffer;
  while (true) {
    if (stream.avail_in == 0) {
      // zlib only reads from there.
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
      stream.avail_in = Share(packed.size());
      packed.remove_prefix(stream.avail_in);
    }
    stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
    stream.avail_out = buffer.size();
    const int status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t got = buffer.size() - stream.avail_out;
    if (got > limit - out.size()) return InflateStatus::kTooLarge;
    out.append(buffer.data(), got);
    if (status == Z_STREAM_END) return InflateStatus::kGood;
    const bool starved = got == 0 && stream.avail_in == 0 && packed.empty();
    if (status != Z_OK || starved) return InflateStatus::kDamaged;
  }
}

std::string Deflate(std::string_view bytes) {
  // Higher levels take several times as long for a few percent of recordings' numbers.
  constexpr int kLevel = Z_BEST_SPEED;
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), kLevel) != Z_OK) {
    throw std::bad_alloc();  // The only way to fail here.
  }
  out.resize(size);
  return out;
}

}  // namespace kinebase::internal
