// A small made-up BVH file, and any record that a file can hold.
#pragma once

#include <rapidcheck.h>

#include <string>
#include <string_view>
#include <utility>

#include "formats/generators.h"
#include "kinebase/formats/bvh.h"

namespace kinebase::test {

inline constexpr std::string_view kArmBvh =
    "HIERARCHY\n"
    "ROOT Base Plate\n"
    "{\n"
    "\tOFFSET 0 0 0\n"
    "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "\tJOINT rig:Upper\n"
    "\t{\n"
    "\t\tOFFSET 0 10 0\n"
    "\t\tCHANNELS 3 Yrotation Xrotation Zrotation\n"
    "\t\tEnd Site\n"
    "\t\t{\n"
    "\t\t\tOFFSET 0 5.5 0\n"
    "\t\t}\n"
    "\t}\n"
    "\tJOINT Slide\n"
    "\t{\n"
    "\t\tOFFSET 3 0 -1\n"
    "\t\tCHANNELS 1 Xposition\n"
    "\t}\n"
    "}\n"
    "MOTION\n"
    "Frames: 3\n"
    "Frame Time: 0.0083333\n"
    "1 2 3 10 20 30 40 50 60 7\n"
    "1.5 2.5 3.5 11 21 31 41 51 61 7.5\n"
    "-2 3 4 12 22 32 42 52 62 8\n";

inline std::vector<std::string> AnyUnknownLines() {
  std::vector<std::string> lines;
  for (int i = *rc::gen::inRange(0, 2); i > 0; --i) lines.push_back(Words());
  return lines;
}

inline BvhJoint AnyBvhJoint(int parent) {
  BvhJoint joint{.name = *rc::gen::arbitrary<bool>() ? Words() : std::string(), .parent = parent};
  for (double& value : joint.offset) value = FiniteDouble();
  for (int i = *rc::gen::inRange(0, 8); i > 0; --i) {
    joint.channels.push_back(static_cast<BvhChannel>(*rc::gen::inRange(0, 6)));
  }
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    BvhJoint::EndSite end_site{.name = *rc::gen::element<std::string>("Site", "", "of it all")};
    for (double& value : end_site.offset) value = FiniteDouble();
    end_site.unknown = AnyUnknownLines();
    joint.end_sites.push_back(std::move(end_site));
  }
  joint.unknown = AnyUnknownLines();
  return joint;
}

// Several trees, depth first.
inline BvhMotion AnyBvh() {
  BvhMotion bvh;
  const int joints = *rc::gen::inRange(1, 9);
  for (int i = 0; i < joints; ++i) {
    // Any joint from which the last one hangs, or none.
    int parent = i - 1;
    while (parent >= 0 && *rc::gen::arbitrary<bool>()) {
      parent = bvh.joints[static_cast<std::size_t>(parent)].parent;
    }
    bvh.joints.push_back(AnyBvhJoint(parent));
  }
  if (bvh.joints[0].channels.empty()) bvh.joints[0].channels = {BvhChannel::kZRotation};
  for (BvhJoint& joint : bvh.joints) {
    joint.first_column = bvh.column_count;
    bvh.column_count += joint.channels.size();
  }
  const int frames = *rc::gen::inRange(1, 5);
  for (std::size_t i = 0; i < bvh.column_count * static_cast<std::size_t>(frames); ++i) {
    bvh.values.push_back(AnyDouble());
  }
  if (*rc::gen::arbitrary<bool>()) {
    bvh.declared_frame_count =
        *rc::gen::element<std::int64_t>(frames, 0, 9'000'000'000'000'000'000);
  }
  bvh.frame_time_text = *rc::gen::element<std::string>("", "0.0083333", ".04", "1e-2", "0", "-1");
  bvh.unknown = AnyUnknownLines();
  return bvh;
}

}  // namespace kinebase::test
