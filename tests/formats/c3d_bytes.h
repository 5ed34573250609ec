// C3D files put together byte by byte, without the writer under test, so that they can also be
// wrong.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/formats/c3d.h"

namespace kinebase::test {

// Numbers as a processor stores them.
class C3dNumbers {
 public:
  explicit C3dNumbers(C3dProcessor processor) : processor_(processor) {}

  [[nodiscard]] std::string Word(int value) const {
    const auto low = static_cast<char>(value & 0xff);
    const auto high = static_cast<char>((value >> 8) & 0xff);
    return processor_ == C3dProcessor::kMips ? std::string{high, low} : std::string{low, high};
  }

  [[nodiscard]] std::string Real(double value) const {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    std::uint32_t stored = bits;
    // A VAX float of the same bits is a quarter as large: its exponent is two higher.
    if (processor_ == C3dProcessor::kDec && value != 0) stored = bits + 0x01000000;
    const int high = static_cast<int>(stored >> 16);
    const int low = static_cast<int>(stored & 0xffff);
    return processor_ == C3dProcessor::kIntel ? Word(low) + Word(high) : Word(high) + Word(low);
  }

 private:
  C3dProcessor processor_;
};

struct RawPoint {
  double x = 0;
  double y = 0;
  double z = 0;
  int quality = 0;
};

// A small file; every field can be set to something wrong before Bytes() is called.
struct RawC3d {
  C3dProcessor processor = C3dProcessor::kIntel;
  bool is_float = true;
  double scale = .5;  // Positive; its sign in the file tells the storage.
  double rate_hz = 100;
  int first_frame = 1;
  int last_frame = 0;  // 0: as many as there are.
  int point_count = 1;
  int channel_count = 0;
  int subframe_count = 0;
  std::vector<RawPoint> points;  // [frame × point]
  std::vector<double> analog;    // [frame × subframe × channel]
  std::string records;           // Of parameters; made by Group, Integer, …
  int declared_blocks = -1;      // Of the parameter section; -1: the truth.
  int data_block = 0;            // 0: the truth.
  int parameter_block = 2;
  int processor_byte = 0;  // 0: the truth.
  std::string events;      // The header's bytes from word 148 on.
  std::string behind;      // Bytes behind the last frame.

  [[nodiscard]] C3dNumbers numbers() const { return C3dNumbers(processor); }
  [[nodiscard]] int frame_count() const {
    return point_count > 0
               ? static_cast<int>(points.size()) / point_count
               : static_cast<int>(analog.size()) / std::max(1, channel_count * subframe_count);
  }

  static std::string Text8(std::string_view text) {
    return static_cast<char>(text.size()) + std::string(text);
  }

  // `offset` other than -1 lies about where the next record is.
  void Group(int id, std::string_view name, std::string_view description = "", int offset = -1) {
    const std::string rest = Text8(description);
    Record(-id, name, rest, offset);
  }

  void Parameter(int group, std::string_view name, int type, const std::vector<int>& dimensions,
                 const std::string& values, int offset = -1, std::string_view description = "") {
    std::string rest{static_cast<char>(type), static_cast<char>(dimensions.size())};
    for (const int dimension : dimensions) rest += static_cast<char>(dimension);
    Record(group, name, rest + values + Text8(description), offset);
  }
  void Integers(int group, std::string_view name, std::vector<int> dimensions,
                const std::vector<int>& values) {
    std::string stored;
    for (const int value : values) stored += numbers().Word(value);
    Parameter(group, name, 2, std::move(dimensions), stored);
  }
  void Reals(int group, std::string_view name, std::vector<int> dimensions,
             const std::vector<double>& values) {
    std::string stored;
    for (const double value : values) stored += numbers().Real(value);
    Parameter(group, name, 4, std::move(dimensions), stored);
  }
  void Integer(int group, std::string_view name, int value) { Integers(group, name, {}, {value}); }
  void Real(int group, std::string_view name, double value) { Reals(group, name, {}, {value}); }
  void Text(int group, std::string_view name, std::string_view text) {
    Parameter(group, name, -1, {static_cast<int>(text.size())}, std::string(text));
  }
  // Texts of one length, padded with blanks.
  void Texts(int group, std::string_view name, int length, const std::vector<std::string>& texts) {
    std::string stored;
    for (std::string text : texts) {
      text.resize(static_cast<std::size_t>(length), ' ');
      stored += text;
    }
    Parameter(group, name, -1, {length, static_cast<int>(texts.size())}, stored);
  }

  // POINT (group 1) and ANALOG (2) as they should be.
  void AddUsualParameters() {
    Group(1, "POINT");
    Integer(1, "USED", point_count);
    Integer(1, "FRAMES", frame_count());
    Real(1, "SCALE", is_float ? -scale : scale);
    Real(1, "RATE", rate_hz);
    Group(2, "ANALOG");
    Integer(2, "USED", channel_count);
    if (channel_count > 0) Real(2, "RATE", rate_hz * subframe_count);
  }

  [[nodiscard]] std::string Header(int data_start_block) const {
    const C3dNumbers n = numbers();
    const int last = last_frame != 0 ? last_frame : first_frame + frame_count() - 1;
    std::string header{static_cast<char>(parameter_block), 0x50};
    header += n.Word(point_count) + n.Word(channel_count * subframe_count) + n.Word(first_frame) +
              n.Word(last) + n.Word(7) + n.Real(is_float ? -scale : scale) +
              n.Word(data_start_block) + n.Word(subframe_count) + n.Real(rate_hz);
    header.resize(294);
    header += events;
    header.resize(512);
    return header;
  }

  [[nodiscard]] std::string Bytes() const {
    std::string section = std::string{1, 0x50, 0, 0} + records + std::string(2, '\0');
    section.resize((section.size() + 511) / 512 * 512);
    const int blocks = static_cast<int>(section.size() / 512);
    section[2] = static_cast<char>(declared_blocks >= 0 ? declared_blocks : blocks);
    section[3] =
        static_cast<char>(processor_byte != 0 ? processor_byte : static_cast<int>(processor));
    const int data = data_block != 0 ? data_block : 2 + blocks;
    return Header(data) + section + Data() + behind;
  }

  [[nodiscard]] std::string Data() const {
    const C3dNumbers n = numbers();
    std::string data;
    const auto put = [&](double value, double step) {
      data += is_float ? n.Real(value) : n.Word(static_cast<int>(std::lround(value / step)));
    };
    const auto samples =
        static_cast<std::size_t>(channel_count) * static_cast<std::size_t>(subframe_count);
    for (int frame = 0; frame < frame_count(); ++frame) {
      for (int i = 0; i < point_count; ++i) {
        const RawPoint& point =
            points[static_cast<std::size_t>(frame) * static_cast<std::size_t>(point_count) +
                   static_cast<std::size_t>(i)];
        put(point.x, scale);
        put(point.y, scale);
        put(point.z, scale);
        put(point.quality, 1);
      }
      for (std::size_t i = 0; i < samples; ++i) {
        put(analog[static_cast<std::size_t>(frame) * samples + i], 1);
      }
    }
    return data;
  }

 private:
  void Record(int id, std::string_view name, const std::string& rest, int offset) {
    const int length = static_cast<int>(rest.size()) + 2;
    records += static_cast<char>(name.size());
    records += static_cast<char>(id);
    records += name;
    records += numbers().Word(offset >= 0 ? offset : length) + rest;
  }
};

// Two frames of two points and two channels of two subframes, all of which int16 can hold.
inline RawC3d TwoFrames(C3dProcessor processor = C3dProcessor::kIntel, bool is_float = true) {
  RawC3d raw;
  raw.processor = processor;
  raw.is_float = is_float;
  raw.first_frame = 11;
  raw.point_count = 2;
  raw.channel_count = 2;
  raw.subframe_count = 2;
  raw.points = {{1, -2.5, 1000, 0x0503}, {0, 0, 0, -1}, {1.5, -3, 1001, 0}, {-.5, 7, 8, 0x0001}};
  raw.analog = {1, -2, 3, -4, 5, -6, 7, -8};
  return raw;
}

}  // namespace kinebase::test
