// GLB, a glTF 2.0 scene in one binary file: a tree of nodes that moves, with bones to look at.
//
// Written only. motion/glb_file.cpp makes one of a recording.
// Source: Khronos Group, "glTF 2.0 Specification"; docs/formats/glb.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace kinebase {

using GlbVector = std::array<float, 3>;      // Metres, Y up.
using GlbQuaternion = std::array<float, 4>;  // (x, y, z, w), unit length.

// A place that turns and moves, and all below with it.
struct GlbNode {
  std::string name;
  int parent = -1;          // Index; smaller than the node's own. -1 for the root.
  GlbVector translation{};  // From the parent, in its space.
  GlbQuaternion rotation = {0, 0, 0, 1};
  GlbVector bone{};  // Drawn from the node to there, in its own space; zero: nothing is drawn.

  // One for each time of the scene, or none: the node keeps what is said above.
  std::vector<GlbVector> translations;
  std::vector<GlbQuaternion> rotations;
};

struct GlbScene {
  std::string name;              // Of the scene and its animation.
  std::vector<GlbNode> nodes;    // Parents first; the first is the root, and the only one.
  std::vector<float> times_s;    // Strictly increasing; empty: nothing moves.
  double rate_hz = 0;            // In the animation's extras, for programs that ask.
  std::int64_t first_frame = 1;  // The same.
};

// The bytes of a GLB file: a node for each of the scene's, an octahedron for every bone, one
// animation if there are times.
//
// Errors  InvalidArgument: no node, a node before its parent, times that do not grow, another
//         number of values than of times; Mismatch: more than the 4 GiB that a GLB file can hold.
[[nodiscard]] std::string FormatGlb(const GlbScene& scene);

}  // namespace kinebase
