// C3D, the common format of optical motion capture, as it stands in the file: a header, groups of
// parameters, and frames of points and analog samples.
//
// motion/c3d_motion.h makes markers of it and a C3D of markers.
// Source: The C3D File Format User Guide (c3d.org); docs/formats/c3d.md.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kinebase/core/diagnostic.h"

namespace kinebase {

// Which machine's numbers the file holds; the value is the file's own code.
enum class C3dProcessor : std::uint8_t { kIntel = 84, kDec = 85, kMips = 86 };

// How points and analog samples are stored: as 32-bit floats or as 16-bit integers.
enum class C3dStorage { kFloat, kInteger };

[[nodiscard]] std::string_view ToString(C3dProcessor processor);  // "Intel", "DEC", "MIPS".
[[nodiscard]] std::string_view ToString(C3dStorage storage);      // "float", "int16".

// One point in one frame. File units, file axes.
struct C3dPoint {
  float x = 0;
  float y = 0;
  float z = 0;

  // The fourth word as stored, a small whole number: negative = not seen, else its low byte is the
  // residual in steps of the recording's scale and its high byte tells which cameras saw it.
  float quality = -1;

  [[nodiscard]] bool is_valid() const { return QualityWord() >= 0; }
  // 0 = filled, filtered or computed from other points. Not for points that are not valid.
  [[nodiscard]] int residual_steps() const { return QualityWord() & 0xff; }
  [[nodiscard]] int camera_mask() const { return QualityWord() >> 8; }  // Bit 0: camera 1.

  // The word as the 16-bit number that it is even in files of floats; -1 for what is none.
  [[nodiscard]] std::int16_t QualityWord() const {
    if (!(std::abs(quality) < 1e6F)) return -1;
    return static_cast<std::int16_t>(static_cast<std::int32_t>(quality));
  }

  // NaN equals NaN here.
  friend bool operator==(const C3dPoint& a, const C3dPoint& b);
};

// Text, 8-bit and 16-bit integers, floats. Integers may stand for unsigned ones.
using C3dValues = std::variant<std::string, std::vector<std::int8_t>, std::vector<std::int16_t>,
                               std::vector<float>>;

struct C3dParameter {
  std::string name;                      // At most 127 bytes; found in any case.
  std::vector<std::uint8_t> dimensions;  // The first runs fastest; empty = one value.
  C3dValues values;                      // As many as the product of the dimensions.
  std::string description;               // At most 255 bytes.
  bool is_locked = false;

  [[nodiscard]] std::size_t size() const;
  // The value at `index` if that is a number and there are so many.
  [[nodiscard]] std::optional<double> Number(std::size_t index = 0) const;
  // The same, an integer below 0 taken for the unsigned one of the same bits.
  [[nodiscard]] std::optional<double> UnsignedNumber(std::size_t index = 0) const;
  // Text as one string for each column, without blanks and zeros at the end; none for numbers.
  [[nodiscard]] std::vector<std::string> Strings() const;

  friend bool operator==(const C3dParameter& a, const C3dParameter& b);  // NaN equals NaN.
};

struct C3dGroup {
  int id = 0;        // 1 to 128, as in the file.
  std::string name;  // Empty: parameters have this number, no group does.
  std::string description;
  bool is_locked = false;
  std::vector<C3dParameter> parameters;

  friend bool operator==(const C3dGroup& a, const C3dGroup& b) = default;
};

// One of the up to 18 events of the header.
struct C3dHeaderEvent {
  std::string label;  // At most 4 bytes.
  float time_s = 0;   // Since the first frame that is stored.
  std::uint8_t display_flag = 1;

  friend bool operator==(const C3dHeaderEvent& a, const C3dHeaderEvent& b);  // NaN equals NaN.
};

// What the fields below hold rules; FormatC3d writes the parameters and header words that say the
// same (POINT:USED, FRAMES, SCALE, RATE, ANALOG:USED, TRIAL:ACTUAL_START_FIELD …) to fit them.
struct C3dRecording {
  C3dProcessor processor = C3dProcessor::kIntel;
  C3dStorage storage = C3dStorage::kFloat;
  float scale = .1F;  // Positive. File units in a step of residuals, and of int16 coordinates.
  float rate_hz = 0;  // Of points.
  std::int64_t first_frame = 1;    // The file's number of the first frame that is stored.
  std::size_t frame_count = 0;     // May exceed 65,535.
  std::size_t point_count = 0;     // At most 65,535.
  std::size_t channel_count = 0;   // Of analog samples; at most 65,535.
  std::size_t subframe_count = 0;  // Analog samples of a channel in a frame of points.
  std::uint16_t max_gap = 0;       // Longest gap that was interpolated, frames; from the header.

  std::vector<C3dPoint> points;  // [frame × point]
  std::vector<float> analog;     // [frame × subframe × channel] as stored; see AnalogScaling.

  std::vector<C3dHeaderEvent> header_events;
  // The header's 256 words; 0 where a field above has it.
  std::array<std::uint16_t, 256> other_header_words{};
  std::vector<C3dGroup> groups;  // In the order of the file.
  std::string trailing;          // Bytes after the last frame, without zeros at the end.

  Diagnostics diagnostics;  // What was odd; not part of equality.

  [[nodiscard]] std::size_t analog_per_frame() const { return subframe_count * channel_count; }
  [[nodiscard]] const C3dPoint& point(std::size_t frame, std::size_t point) const {
    return points[frame * point_count + point];
  }
  [[nodiscard]] std::int64_t last_frame() const {
    return first_frame + static_cast<std::int64_t>(frame_count) - 1;
  }

  // NaN equals NaN; POINT:DATA_START, which tells a place in the file, does not count.
  friend bool operator==(const C3dRecording& a, const C3dRecording& b);
};

struct C3dReadOptions {
  bool strict = false;  // Refuse a file that ends before its last frame.
};

// Reads the bytes of a C3D file. `file` is for messages only.
//
// Reads Intel, DEC and MIPS files of floats and of int16. The parameters rule over the header (but
// for the scale), the size of the file over both; each disagreement is a diagnostic, and the
// record's parameters then say what is so. Damaged parameters are left out with a diagnostic.
// Errors  MalformedFile with the byte: empty, no C3D, cut off before its data, an unknown
//         processor, a scale of 0 or beyond reason.
// Cost    Linear in the file; memory 16 bytes a point, 4 bytes a sample. No allocation exceeds
//         what the file's size allows.
[[nodiscard]] C3dRecording ParseC3d(std::string_view bytes, const std::filesystem::path& file,
                                    const C3dReadOptions& options = {});
[[nodiscard]] C3dRecording ReadC3d(const std::filesystem::path& path,
                                   const C3dReadOptions& options = {});

// The bytes of a C3D file. ParseC3d(FormatC3d(r)) == r for every r that was read.
//
// Frames beyond 65,535 are told by POINT:LONG_FRAMES and TRIAL:ACTUAL_START_FIELD and
// ACTUAL_END_FIELD, which are added where they are missing. Numbers that DEC's floats or int16
// cannot hold become the nearest that they can.
// Errors  InvalidArgument, naming what does not fit: counts that do not match the data, more points
//         than 65,535, a text that is too long, more parameters than a file can have.
[[nodiscard]] std::string FormatC3d(const C3dRecording& recording);

// --- Parameters. Group and parameter names are found in any case; of two of a name, the first.

[[nodiscard]] const C3dGroup* FindGroup(const C3dRecording& recording, std::string_view group);
[[nodiscard]] const C3dParameter* FindParameter(const C3dRecording& recording,
                                                std::string_view group, std::string_view name);

// Replaces the parameter of that name or adds it, and its group if need be.
// Errors  InvalidArgument: no room for another group (127).
void SetParameter(C3dRecording& recording, std::string_view group, C3dParameter parameter);

// True if there was one.
bool RemoveParameter(C3dRecording& recording, std::string_view group, std::string_view name);

[[nodiscard]] C3dParameter RealParameter(std::string_view name, float value);
[[nodiscard]] C3dParameter IntegerParameter(std::string_view name, int value);  // As 16 bits.
[[nodiscard]] C3dParameter TextParameter(std::string_view name, std::string_view text);

// Lists that go on in NAME2, NAME3 … where there are more than 255 values: LABELS, DESCRIPTIONS,
// SCALE, OFFSET, UNITS.
[[nodiscard]] std::vector<std::string> TextList(const C3dRecording& recording,
                                                std::string_view group, std::string_view name);
[[nodiscard]] std::vector<double> NumberList(const C3dRecording& recording, std::string_view group,
                                             std::string_view name, bool is_unsigned = false);
// Continuations that are no longer needed go. Texts longer than 255 bytes are cut.
void SetTextList(C3dRecording& recording, std::string_view group, std::string_view name,
                 std::span<const std::string> texts);
void SetRealList(C3dRecording& recording, std::string_view group, std::string_view name,
                 std::span<const float> values);

// One for each point or channel: empty where the file has fewer.
[[nodiscard]] std::vector<std::string> PointLabels(const C3dRecording& recording);
[[nodiscard]] std::vector<std::string> ChannelLabels(const C3dRecording& recording);

// --- Analog samples.

// A value in real units is (stored - offset) · scale · general_scale.
struct C3dAnalogScaling {
  double general_scale = 1;
  std::vector<double> scale;       // [channel]
  std::vector<double> offset;      // [channel]
  std::vector<std::string> units;  // [channel] "V", "N"; may be empty.
};
[[nodiscard]] C3dAnalogScaling AnalogScaling(const C3dRecording& recording);

// Whether ANALOG:FORMAT says that int16 samples and offsets are unsigned.
[[nodiscard]] bool HasUnsignedAnalog(const C3dRecording& recording);

// All samples in real units, [frame × subframe × channel].
[[nodiscard]] std::vector<double> ScaledAnalog(const C3dRecording& recording);

// --- Events.

struct C3dEvent {
  double time_s = 0;    // Frame 1 is at 0, whichever frame is the first that is stored.
  std::string label;    // "Foot Strike", "RHS".
  std::string context;  // "Left", "Right", "General".
  std::string subject;
  std::string description;
  int icon_id = 0;
  int generic_flag = 0;
  bool is_in_header = false;  // Has a time, a label and the next only.
  std::uint8_t display_flag = 1;

  friend bool operator==(const C3dEvent&, const C3dEvent&) = default;
};

// Those of the EVENT group in their order, then those of the header.
[[nodiscard]] std::vector<C3dEvent> Events(const C3dRecording& recording);

// Replaces the events. Other parameters of the EVENT group that hold a value an event go.
// Errors  InvalidArgument: more than 18 in the header, or a label there of more than 4 bytes.
void SetEvents(C3dRecording& recording, std::span<const C3dEvent> events);

// --- Force plates.

struct C3dForcePlate {
  int type = 0;                                   // 1 to 4, as the user guide defines them.
  std::array<std::array<float, 3>, 4> corners{};  // File units and axes.
  std::array<float, 3> origin{};                  // Of the sensor, in the plate's own axes.
  std::vector<int> channels;                      // 1-based analog channels; 0 = none.
  std::vector<float> calibration;                 // [row × column], row by row; may be empty.
  std::size_t calibration_columns = 0;

  friend bool operator==(const C3dForcePlate&, const C3dForcePlate&) = default;
};
// What the group FORCE_PLATFORM tells; values that are missing stay 0 or empty.
[[nodiscard]] std::vector<C3dForcePlate> ForcePlates(const C3dRecording& recording);

// --- Editing.

// Frames first … last (0-based among those stored, inclusive) with their analog samples.
//
// Frame numbers go on counting as in the take, so the times in the EVENT group, which count from
// frame 1, stay as they are; those in the header count from the first stored frame and are moved.
// An event stays if the frame nearest to it does. Everything else is kept.
// Errors  InvalidArgument if the range is empty or leaves the recording.
[[nodiscard]] C3dRecording CutC3d(const C3dRecording& recording, std::int64_t first,
                                  std::int64_t last);

// Converts points and analog samples to the other storage. To int16 the scale becomes the
// smallest that holds all points, and ANALOG:SCALE and OFFSET change where samples are no whole
// numbers; values then differ by up to half a step.
void ChangeStorage(C3dRecording& recording, C3dStorage storage);

}  // namespace kinebase
