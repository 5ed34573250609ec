// Any skeleton and motion that a file can hold, for properties.
#pragma once

#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "kinebase/formats/amc.h"
#include "kinebase/formats/asf.h"

namespace kinebase::test {

// Bits of every kind: zeros, subnormal numbers, infinities, NaN.
inline double AnyDouble() {
  const auto bits = *rc::gen::arbitrary<std::uint64_t>();
  return *rc::gen::element(std::bit_cast<double>(bits * 0x9E3779B97F4A7C15ULL),
                           std::bit_cast<double>(bits), static_cast<double>(bits) / 64, -0.0, 0.1);
}

inline double FiniteDouble() {
  const double value = AnyDouble();
  return std::isfinite(value) ? value : 1.5;
}

inline std::string Word() {
  return "w" + *rc::gen::container<std::string>(rc::gen::elementOf(std::string("abXY01_:.-+()ä")));
}

// Words with single blanks between them.
inline std::string Words() {
  std::string text = Word();
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) text += ' ' + Word();
  return text;
}

// Some of them, in any order.
inline std::vector<AsfDof> Dofs() {
  std::vector<AsfDof> dofs;
  for (int dof = 0; dof < 7; ++dof) {
    if (*rc::gen::arbitrary<bool>()) continue;
    const auto place = *rc::gen::inRange<std::size_t>(0, dofs.size() + 1);
    dofs.insert(dofs.begin() + static_cast<std::ptrdiff_t>(place), static_cast<AsfDof>(dof));
  }
  return dofs;
}

inline std::vector<AsfUnknown> UnknownLines() {
  std::vector<AsfUnknown> lines;
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) lines.push_back({Words()});
  return lines;
}

inline AsfBone AnyBone(int number) {
  AsfBone bone;
  if (*rc::gen::arbitrary<bool>()) bone.id = *rc::gen::arbitrary<std::int64_t>();
  bone.name = Word() + std::to_string(number);
  for (double& value : bone.direction) value = FiniteDouble();
  bone.length = FiniteDouble();
  for (double& value : bone.axis) value = FiniteDouble();
  bone.axis_order = *rc::gen::element<std::string>("XYZ", "zyx", "YXZ", "odd");
  bone.dofs = Dofs();
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
    const double low = AnyDouble();
    const double high = AnyDouble();
    bone.limits.push_back({std::isnan(low) ? -1 : low, std::isnan(high) ? 1 : high});
  }
  bone.unknown = UnknownLines();
  return bone;
}

inline AsfSkeleton AnySkeleton() {
  AsfSkeleton asf;
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) asf.comments.push_back("# " + Words());
  if (*rc::gen::arbitrary<bool>()) asf.version = Words();
  if (*rc::gen::arbitrary<bool>()) asf.name = Words();
  if (*rc::gen::arbitrary<bool>()) asf.mass_unit = FiniteDouble();
  if (*rc::gen::arbitrary<bool>()) asf.length_unit = std::abs(FiniteDouble()) + 1e-300;
  asf.angle_is_degrees = *rc::gen::arbitrary<bool>();
  asf.unknown_units = UnknownLines();
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
    asf.documentation.push_back(*rc::gen::element<std::string>("", "  ", "# text", "begin ", "\t") +
                                *rc::gen::element<std::string>("", Words()));
  }
  asf.root_order = Dofs();
  if (asf.root_order.empty()) asf.root_order = {AsfDof::kRy};
  asf.root_axis = *rc::gen::element<std::string>("XYZ", "zxy");
  for (double& value : asf.root_position) value = FiniteDouble();
  for (double& value : asf.root_orientation) value = FiniteDouble();
  asf.unknown_root = UnknownLines();
  std::vector<std::string> placed = {"root"};
  for (int i = 0; i < *rc::gen::inRange(1, 6); ++i) {
    asf.bones.push_back(AnyBone(i));
    if (i > 0 && *rc::gen::inRange(0, 5) == 0) continue;  // Not in the hierarchy.
    asf.hierarchy.push_back({*rc::gen::elementOf(placed), {asf.bones.back().name}});
    placed.push_back(asf.bones.back().name);
  }
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    asf.unknown_sections.push_back({":x" + Words() + "\n" + Words()});
  }
  return asf;
}

inline AmcMotion AnyMotion() {
  AmcMotion amc;
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    amc.header.push_back(*rc::gen::element<std::string>("# ", "  :", ":x\t") + Words());
  }
  amc.angle_unit =
      *rc::gen::element(AmcAngleUnit::kUnstated, AmcAngleUnit::kDegrees, AmcAngleUnit::kRadians);
  if (amc.angle_unit == AmcAngleUnit::kDegrees) amc.header.emplace_back(" :degrees ");
  if (amc.angle_unit == AmcAngleUnit::kRadians) amc.header.emplace_back(":RADIANS");
  amc.all_bones_have_three_dofs = *rc::gen::arbitrary<bool>();
  if (amc.all_bones_have_three_dofs) amc.header.emplace_back(":FORCE-ALL-JOINTS-BE-3DOF");
  for (int i = *rc::gen::inRange(1, 5); i > 0; --i) {
    const auto count = static_cast<std::size_t>(*rc::gen::inRange(1, 7));
    amc.bones.push_back({Word() + std::to_string(i), amc.column_count, count});
    amc.column_count += count;
  }
  std::int64_t number = *rc::gen::inRange(-5, 1000);
  const std::size_t frames = *rc::gen::inRange<std::size_t>(1, 6);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    amc.frame_numbers.push_back(number);
    number += *rc::gen::inRange(1, 4);
    for (std::size_t i = 0; i < amc.column_count; ++i) amc.values.push_back(AnyDouble());
    if (*rc::gen::inRange(0, 3) == 0) amc.remarks.push_back({frame, "\t# " + Words() + ' '});
  }
  return amc;
}

}  // namespace kinebase::test
