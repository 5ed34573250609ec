// Any C3D recording that a file can hold, for properties.
#pragma once

#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/generators.h"
#include "kinebase/formats/c3d.h"

namespace kinebase::test {

// Bits of every kind that the processor has: DEC knows no infinity, and less far from 1.
inline float AnyFloat(C3dProcessor processor) {
  const auto bits = *rc::gen::arbitrary<std::uint32_t>() * 0x9E3779B9U;
  const auto value = std::bit_cast<float>(bits);
  if (processor != C3dProcessor::kDec || std::isnan(value)) return value;
  const bool fits = std::abs(value) < 1e38F && (value == 0 || std::abs(value) > 1e-37F);
  return fits ? value : .5F;
}

inline std::string AnyText(int longest) {
  const auto size = *rc::gen::inRange<std::size_t>(0, static_cast<std::size_t>(longest));
  return *rc::gen::container<std::string>(size, rc::gen::arbitrary<char>());
}

inline C3dParameter AnyParameter(C3dProcessor processor) {
  C3dParameter parameter{.name = Word(), .description = AnyText(256)};
  parameter.is_locked = *rc::gen::arbitrary<bool>();
  std::size_t count = 1;
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
    parameter.dimensions.push_back(*rc::gen::inRange<std::uint8_t>(0, 6));
    count *= parameter.dimensions.back();
  }
  const int type = *rc::gen::inRange(0, 4);
  std::vector<float> reals(count);
  for (float& real : reals) real = AnyFloat(processor);
  if (type == 0) {
    parameter.values = *rc::gen::container<std::string>(count, rc::gen::arbitrary<char>());
  } else if (type == 1) {
    parameter.values =
        *rc::gen::container<std::vector<std::int8_t>>(count, rc::gen::arbitrary<std::int8_t>());
  } else if (type == 2) {
    parameter.values =
        *rc::gen::container<std::vector<std::int16_t>>(count, rc::gen::arbitrary<std::int16_t>());
  } else {
    parameter.values = std::move(reals);
  }
  return parameter;
}

// None that FormatC3d would set.
inline std::vector<C3dGroup> AnyGroups(C3dProcessor processor) {
  std::vector<C3dGroup> groups;
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
    C3dGroup group{.id = i * 31, .name = Word(), .description = AnyText(256)};
    group.is_locked = *rc::gen::arbitrary<bool>();
    for (int k = *rc::gen::inRange(0, 4); k > 0; --k) {
      group.parameters.push_back(AnyParameter(processor));
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

inline C3dPoint AnyPoint(const C3dRecording& c3d) {
  if (c3d.storage == C3dStorage::kFloat) {
    return {AnyFloat(c3d.processor), AnyFloat(c3d.processor), AnyFloat(c3d.processor),
            AnyFloat(c3d.processor)};
  }
  const auto place = [&] {
    return static_cast<float>(*rc::gen::arbitrary<std::int16_t>()) * c3d.scale;
  };
  return {place(), place(), place(), static_cast<float>(*rc::gen::arbitrary<std::int16_t>())};
}

inline C3dRecording AnyC3d() {
  C3dRecording c3d;
  c3d.processor = *rc::gen::element(C3dProcessor::kIntel, C3dProcessor::kDec, C3dProcessor::kMips);
  c3d.storage = *rc::gen::element(C3dStorage::kFloat, C3dStorage::kInteger);
  c3d.scale = *rc::gen::element(.1F, 1.F, .28118187F, 1e-20F, 1e20F);
  c3d.rate_hz = *rc::gen::element(0.F, 50.F, 120.F, 59.94F);
  c3d.frame_count = *rc::gen::inRange<std::size_t>(0, 6);
  c3d.first_frame = c3d.frame_count == 0 ? 1 : *rc::gen::element(0, 1, 2925, 65000);
  c3d.point_count = *rc::gen::inRange<std::size_t>(0, 4);
  c3d.channel_count = *rc::gen::inRange<std::size_t>(0, 4);
  c3d.subframe_count = *rc::gen::inRange<std::size_t>(1, 4);
  c3d.max_gap = *rc::gen::arbitrary<std::uint16_t>();
  for (std::size_t i = c3d.frame_count * c3d.point_count; i > 0; --i) {
    c3d.points.push_back(AnyPoint(c3d));
  }
  for (std::size_t i = c3d.frame_count * c3d.analog_per_frame(); i > 0; --i) {
    c3d.analog.push_back(c3d.storage == C3dStorage::kFloat
                             ? AnyFloat(c3d.processor)
                             : static_cast<float>(*rc::gen::arbitrary<std::int16_t>()));
  }
  for (int i = *rc::gen::inRange(0, 19); i > 0; --i) {
    c3d.header_events.push_back({.label = *rc::gen::element<std::string>("", "A", "RHS", " LTO"),
                                 .time_s = AnyFloat(c3d.processor),
                                 .display_flag = *rc::gen::arbitrary<std::uint8_t>()});
  }
  for (std::size_t word = 12; word < 146; ++word) {
    c3d.other_header_words[word] = *rc::gen::arbitrary<std::uint16_t>();
  }
  c3d.groups = AnyGroups(c3d.processor);
  if (*rc::gen::inRange(0, 4) == 0) c3d.trailing = AnyText(2000) + "x";
  return c3d;
}

}  // namespace kinebase::test
