// The data section: frame after frame, the points and then the analog samples of each, all floats
// or all 16-bit integers.
//
//   point   x, y, z and the word of quality
//   sample  channel after channel, once for each subframe

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "formats/c3d_layout.h"
#include "formats/c3d_numbers.h"

namespace kinebase::internal {
namespace {

static_assert(sizeof(C3dPoint) == 16 && std::is_trivially_copyable_v<C3dPoint>);

// Whether floats stand in the file as they do in memory.
template <typename Codec>
constexpr bool kIsNative = std::is_same_v<Codec, C3dCodec<C3dProcessor::kIntel>> &&
                           std::endian::native == std::endian::little;

// Room for `count` more values at the end. It is made frame by frame, so that what it is filled
// with stays in the cache until the numbers follow.
template <typename T>
T* Extend(std::vector<T>& values, std::size_t count) {
  values.resize(values.size() + count);
  return values.data() + (values.size() - count);
}

template <typename Codec>
const char* ReadFloatFrames(Codec codec, const char* from, std::size_t count,
                            C3dRecording& recording) {
  const std::size_t points = recording.point_count;
  const std::size_t samples = recording.analog_per_frame();
  for (std::size_t frame = 0; frame < count; ++frame) {
    C3dPoint* point = Extend(recording.points, points);
    float* sample = Extend(recording.analog, samples);
    if constexpr (kIsNative<Codec>) {
      if (points > 0) std::memcpy(point, from, points * sizeof(C3dPoint));
      from += points * sizeof(C3dPoint);
      if (samples > 0) std::memcpy(sample, from, samples * sizeof(float));
      from += samples * sizeof(float);
    } else {
      for (std::size_t i = 0; i < points; ++i, from += sizeof(C3dPoint)) {
        point[i] = {codec.LoadFloat(from), codec.LoadFloat(from + 4), codec.LoadFloat(from + 8),
                    codec.LoadFloat(from + 12)};
      }
      for (std::size_t i = 0; i < samples; ++i, from += 4) sample[i] = codec.LoadFloat(from);
    }
  }
  return from;
}

template <typename Codec>
const char* ReadIntegerFrames(Codec codec, const char* from, std::size_t count,
                              C3dRecording& recording) {
  const auto load = [&](std::size_t place) {
    return static_cast<float>(static_cast<std::int16_t>(codec.LoadWord(from + 2 * place)));
  };
  const bool is_unsigned = HasUnsignedAnalog(recording);
  const float scale = recording.scale;
  const std::size_t points = recording.point_count;
  const std::size_t samples = recording.analog_per_frame();
  for (std::size_t frame = 0; frame < count; ++frame) {
    C3dPoint* point = Extend(recording.points, points);
    for (std::size_t i = 0; i < points; ++i, from += 8) {
      point[i] = {load(0) * scale, load(1) * scale, load(2) * scale, load(3)};
    }
    float* sample = Extend(recording.analog, samples);
    for (std::size_t i = 0; i < samples; ++i, from += 2) {
      sample[i] = is_unsigned ? static_cast<float>(codec.LoadWord(from)) : load(0);
    }
  }
  return from;
}

// The nearest 16-bit number; 0 for what is none.
std::uint16_t ToWord(float value, float low, float high) {
  if (std::isnan(value)) return 0;
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, low, high)));
}

template <typename Codec>
void WriteFloatFrame(Codec codec, const C3dRecording& recording, std::size_t frame, char*& to) {
  const C3dPoint* points = recording.points.data() + frame * recording.point_count;
  const std::size_t samples = recording.analog_per_frame();
  const float* analog = recording.analog.data() + frame * samples;
  for (std::size_t i = 0; i < recording.point_count; ++i) {
    for (const float value : {points[i].x, points[i].y, points[i].z, points[i].quality}) {
      codec.StoreFloat(to, value);
      to += 4;
    }
  }
  for (std::size_t i = 0; i < samples; ++i, to += 4) codec.StoreFloat(to, analog[i]);
}

template <typename Codec>
void WriteIntegerFrame(Codec codec, const C3dRecording& recording, std::size_t frame,
                       bool is_unsigned, char*& to) {
  const C3dPoint* points = recording.points.data() + frame * recording.point_count;
  const std::size_t samples = recording.analog_per_frame();
  const float* analog = recording.analog.data() + frame * samples;
  for (std::size_t i = 0; i < recording.point_count; ++i, to += 8) {
    const C3dPoint& point = points[i];
    codec.StoreWord(to, ToWord(point.x / recording.scale, -32768, 32767));
    codec.StoreWord(to + 2, ToWord(point.y / recording.scale, -32768, 32767));
    codec.StoreWord(to + 4, ToWord(point.z / recording.scale, -32768, 32767));
    codec.StoreWord(to + 6, static_cast<std::uint16_t>(point.QualityWord()));
  }
  const float low = is_unsigned ? 0 : -32768;
  const float high = is_unsigned ? 65535 : 32767;
  for (std::size_t i = 0; i < samples; ++i, to += 2) {
    codec.StoreWord(to, ToWord(analog[i], low, high));
  }
}

}  // namespace

void ReadFrames(const char* from, C3dRecording& recording,
                const std::function<void(std::string_view)>& release) {
  const std::size_t samples = recording.analog_per_frame();
  recording.points.reserve(recording.frame_count * recording.point_count);
  recording.analog.reserve(recording.frame_count * samples);
  // Bytes that are done with take no memory beside the numbers that they became.
  constexpr std::size_t kPart = std::size_t{1} << 18;
  const std::size_t frames_in_part = kPart / (16 * recording.point_count + 4 * samples + 1) + 1;
  WithCodec(recording.processor, [&](auto codec) {
    for (std::size_t done = 0; done < recording.frame_count; done += frames_in_part) {
      const std::size_t count = std::min(frames_in_part, recording.frame_count - done);
      const char* const end = recording.storage == C3dStorage::kFloat
                                  ? ReadFloatFrames(codec, from, count, recording)
                                  : ReadIntegerFrames(codec, from, count, recording);
      release({from, static_cast<std::size_t>(end - from)});
      from = end;
    }
  });
}

std::size_t FrameBytes(const C3dRecording& recording) {
  const std::size_t size = recording.storage == C3dStorage::kFloat ? 4 : 2;
  return (4 * recording.points.size() + recording.analog.size()) * size;
}

void AppendFrames(const C3dRecording& recording, std::string& out) {
  const std::size_t begin = out.size();
  out.resize(begin + FrameBytes(recording));
  if (out.size() == begin) return;
  char* to = out.data() + begin;
  const bool is_unsigned = HasUnsignedAnalog(recording);
  WithCodec(recording.processor, [&](auto codec) {
    for (std::size_t frame = 0; frame < recording.frame_count; ++frame) {
      if (recording.storage == C3dStorage::kFloat) {
        WriteFloatFrame(codec, recording, frame, to);
      } else {
        WriteIntegerFrame(codec, recording, frame, is_unsigned, to);
      }
    }
  });
}

}  // namespace kinebase::internal
