// Writes C3D: the header in block 1, the parameters from block 2, the data behind them.

#include <algorithm>
#include <cmath>
#include <utility>

#include "fmt/format.h"
#include "formats/c3d_layout.h"
#include "formats/c3d_numbers.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

using internal::kC3dBlock;
using internal::kC3dMaxWord;
using Place = internal::C3dHeaderPlace;

constexpr std::int64_t kMaxFrameNumber = 4294967295;  // Two words of TRIAL.
constexpr std::uint8_t kParameterBlock = 2;

[[noreturn]] void Refuse(const std::string& message) {
  throw Error(ErrorCode::kInvalidArgument, message);
}

void Check(const C3dRecording& recording) {
  if (recording.points.size() != recording.frame_count * recording.point_count ||
      recording.analog.size() != recording.frame_count * recording.analog_per_frame()) {
    Refuse(
        fmt::format("a C3D recording of {} frames, {} points and {} × {} samples holds {} points "
                    "and {} samples",
                    recording.frame_count, recording.point_count, recording.subframe_count,
                    recording.channel_count, recording.points.size(), recording.analog.size()));
  }
  for (const auto& [count, what] : {std::pair(recording.point_count, "points"),
                                    std::pair(recording.channel_count, "analog channels"),
                                    std::pair(recording.subframe_count, "samples in a frame")}) {
    if (count > kC3dMaxWord) {
      Refuse(fmt::format("a C3D file holds up to {} {}, not {}", kC3dMaxWord, what, count));
    }
  }
  const std::int64_t last = std::max(recording.first_frame, recording.last_frame());
  if (recording.first_frame < 0 || last > kMaxFrameNumber) {
    Refuse(fmt::format("a C3D file numbers frames from 0 to {}, not from {} to {}", kMaxFrameNumber,
                       recording.first_frame, last));
  }
  if (!(recording.scale > 0) || !std::isfinite(recording.scale)) {
    Refuse(
        fmt::format("the scale of a C3D recording is {:g}; it must be positive", recording.scale));
  }
}

// Everything but the data.
C3dRecording WithoutData(const C3dRecording& recording) {
  C3dRecording bare;
  bare.processor = recording.processor;
  bare.storage = recording.storage;
  bare.scale = recording.scale;
  bare.rate_hz = recording.rate_hz;
  bare.first_frame = recording.first_frame;
  bare.frame_count = recording.frame_count;
  bare.point_count = recording.point_count;
  bare.channel_count = recording.channel_count;
  bare.subframe_count = recording.subframe_count;
  bare.groups = recording.groups;
  return bare;
}

// The parameter section, and the block where the data begin behind it.
std::pair<std::string, std::uint16_t> FormatParameters(const C3dRecording& recording) {
  C3dRecording bare = WithoutData(recording);
  internal::AlignParameters(bare);
  std::string section = internal::FormatParameterSection(bare.groups, bare.processor);
  // A place that a byte cannot hold takes a wider type, and that may take another block.
  for (;;) {
    const std::size_t block = kParameterBlock + section.size() / kC3dBlock;
    if (block > kC3dMaxWord) {
      Refuse(fmt::format("the parameters take {} bytes, more than a C3D file can hold",
                         section.size()));
    }
    C3dParameter* place = internal::FindParameterToEdit(bare, "POINT", "DATA_START");
    if (place != nullptr && place->Number()) {
      internal::SetNumber(*place, 0, static_cast<double>(block));
    }
    std::string placed = internal::FormatParameterSection(bare.groups, bare.processor);
    const bool fits = placed.size() == section.size();
    section = std::move(placed);
    if (fits) return {std::move(section), static_cast<std::uint16_t>(block)};
  }
}

class HeaderWriter {
 public:
  explicit HeaderWriter(const C3dRecording& recording)
      : recording_(recording), bytes_(kC3dBlock, '\0') {}

  std::string Write(std::uint16_t data_block) {
    for (std::size_t i = 0; i < recording_.other_header_words.size(); ++i) {
      PutWord(2 * i, recording_.other_header_words[i]);
    }
    bytes_[Place::kParameterBlock] = static_cast<char>(kParameterBlock);
    bytes_[internal::kC3dKeyByte] = internal::kC3dKey;
    PutCount(Place::kPointCount, recording_.point_count);
    PutCount(Place::kAnalogPerFrame, recording_.analog_per_frame());
    const bool is_empty = recording_.frame_count == 0;
    PutCount(Place::kFirstFrame, is_empty ? 1 : static_cast<std::size_t>(recording_.first_frame));
    PutCount(Place::kLastFrame, is_empty ? 0 : static_cast<std::size_t>(recording_.last_frame()));
    PutWord(Place::kMaxGap, recording_.max_gap);
    const bool is_float = recording_.storage == C3dStorage::kFloat;
    PutFloat(Place::kScale, is_float ? -recording_.scale : recording_.scale);
    PutWord(Place::kDataBlock, data_block);
    PutCount(Place::kSubframes, recording_.subframe_count);
    PutFloat(Place::kRate, recording_.rate_hz);
    PutEvents();
    return std::move(bytes_);
  }

 private:
  void PutWord(std::size_t at, std::uint16_t word) {
    internal::StoreWord(recording_.processor, bytes_.data() + at, word);
  }
  // The header has 16 bits for what the parameters tell in full.
  void PutCount(std::size_t at, std::size_t count) {
    PutWord(at, static_cast<std::uint16_t>(std::min(count, kC3dMaxWord)));
  }
  void PutFloat(std::size_t at, float value) {
    internal::StoreFloat(recording_.processor, bytes_.data() + at, value);
  }

  void PutEvents() {
    const auto& events = recording_.header_events;
    if (events.size() > internal::kC3dMaxHeaderEvents) {
      Refuse(fmt::format("the header of a C3D file has room for {} events, not {}",
                         internal::kC3dMaxHeaderEvents, events.size()));
    }
    // Any words there belong to an older kind of events, which are written back as they were.
    const auto& words = recording_.other_header_words;
    const bool has_others = words[Place::kEventKey / 2] != 0 || words[Place::kEventCount / 2] != 0;
    if (events.empty() && has_others) return;
    PutWord(Place::kEventKey, internal::kC3dFourCharKey);
    PutWord(Place::kEventCount, static_cast<std::uint16_t>(events.size()));
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (events[i].label.size() > 4) {
        Refuse(fmt::format("the header's events have labels of 4 bytes; {} is longer",
                           Quoted(events[i].label)));
      }
      PutFloat(Place::kEventTimes + 4 * i, events[i].time_s);
      bytes_[Place::kEventFlags + i] = static_cast<char>(events[i].display_flag);
      std::string label = events[i].label;
      label.resize(4, ' ');
      std::ranges::copy(label,
                        bytes_.begin() + static_cast<std::ptrdiff_t>(Place::kEventLabels + 4 * i));
    }
  }

  const C3dRecording& recording_;
  std::string bytes_;
};

}  // namespace

std::string FormatC3d(const C3dRecording& recording) {
  Check(recording);
  const auto [parameters, data_block] = FormatParameters(recording);
  const std::size_t size =
      kC3dBlock + parameters.size() + internal::FrameBytes(recording) + recording.trailing.size();
  const std::size_t padded = (size + kC3dBlock - 1) / kC3dBlock * kC3dBlock;
  std::string out;
  out.reserve(padded);
  out += HeaderWriter(recording).Write(data_block);
  out += parameters;
  internal::AppendFrames(recording, out);
  out += recording.trailing;
  out.resize(padded);
  return out;
}

}  // namespace kinebase
