// What the parts of the C3D reader and writer share: where things stand in the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/formats/c3d.h"

namespace kinebase::internal {

inline constexpr std::size_t kC3dBlock = 512;  // Bytes; sections begin at multiples of it.
inline constexpr std::size_t kC3dKeyByte = 1;  // Where every C3D file holds kC3dKey.
inline constexpr char kC3dKey = 0x50;
inline constexpr std::uint16_t kC3dFourCharKey = 12345;  // Header events have labels of 4 bytes.
inline constexpr std::uint16_t kC3dRangeKey = 12345;
inline constexpr std::size_t kC3dMaxHeaderEvents = 18;
inline constexpr std::size_t kC3dMaxWord = 65535;

// Byte offsets in the header; the user guide counts words from 1, word w is at 2 · (w - 1).
struct C3dHeaderPlace {
  static constexpr std::size_t kParameterBlock = 0;
  static constexpr std::size_t kPointCount = 2;
  static constexpr std::size_t kAnalogPerFrame = 4;
  static constexpr std::size_t kFirstFrame = 6;
  static constexpr std::size_t kLastFrame = 8;
  static constexpr std::size_t kMaxGap = 10;
  static constexpr std::size_t kScale = 12;
  static constexpr std::size_t kDataBlock = 16;
  static constexpr std::size_t kSubframes = 18;
  static constexpr std::size_t kRate = 20;
  static constexpr std::size_t kFieldsEnd = 24;
  static constexpr std::size_t kRangeKey = 294;
  static constexpr std::size_t kRangeBlock = 296;
  static constexpr std::size_t kEventKey = 298;
  static constexpr std::size_t kEventCount = 300;
  static constexpr std::size_t kEventTimes = 304;
  static constexpr std::size_t kEventFlags = 376;
  static constexpr std::size_t kEventLabels = 396;
};

// Reads the chain of records in [begin, limit) into `recording.groups`; what is odd becomes a
// diagnostic. `begin` is where the section begins, with its own four bytes.
void ReadParameterSection(std::string_view bytes, std::size_t begin, std::size_t limit,
                          C3dRecording& recording);

// The section with its four bytes and at least two zeros at the end, in whole blocks.
// Errors  InvalidArgument, naming the group or parameter that does not fit.
std::string FormatParameterSection(const std::vector<C3dGroup>& groups, C3dProcessor processor);

// Decodes `frame_count` frames from `from` into `points` and `analog`; all else is known by now.
// `release` gets each part of the bytes that is done with.
void ReadFrames(const char* from, C3dRecording& recording,
                const std::function<void(std::string_view)>& release);

// Bytes that all frames take, and these bytes.
std::size_t FrameBytes(const C3dRecording& recording);
void AppendFrames(const C3dRecording& recording, std::string& out);

// Bytes of a group's or parameter's record after its name; the file holds it in 16 bits.
std::size_t RecordLength(const C3dGroup& group);
std::size_t RecordLength(const C3dParameter& parameter);

// Sets one number; a type that cannot hold it gives way to one that can.
void SetNumber(C3dParameter& parameter, std::size_t index, double value);

C3dGroup* FindGroupToEdit(C3dRecording& recording, std::string_view group);
C3dParameter* FindParameterToEdit(C3dRecording& recording, std::string_view group,
                                  std::string_view name);

// A frame number in TRIAL: two unsigned words, the low one first; or one number.
std::optional<std::int64_t> TrialField(const C3dRecording& recording, std::string_view name);

// Makes the parameters that tell counts, rates, scale and frame numbers say what the fields say.
// Those that are missing are added only where nothing else tells.
void AlignParameters(C3dRecording& recording);

// "LABELS", "LABELS2", "LABELS3" …
std::string ListPartName(std::string_view name, int part);

}  // namespace kinebase::internal
