// What lies between a BVH record and a Motion: the bones, and what their numbers mean.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kinebase/motion/bvh_motion.h"
#include "kinebase/motion/rig_mapping.h"

namespace kinebase::internal {

// A bone of the figure: the place of a joint of the file, or a tip.
struct BvhBone {
  int place = -1;     // Joint of the file whose place is this bone's end; -1 for a tip.
  int rotation = -1;  // Joint of the file whose rotation it has; -1 = none: a bone at the root.
};

// The first root of a record in the file's own units and axes: what units and axes are told by.
struct RawFigure {
  std::vector<Joint> joints;
  std::vector<BvhBone> bones;  // [joint]
  Motion motion;               // Its skeleton has the name map.
  RigMapping rig;
};

// The number of joints of the file that belong to its first root; they come first.
[[nodiscard]] int FirstFigureSize(const BvhMotion& bvh);

// Bones without motion.
void BuildBones(const BvhMotion& bvh, RawFigure& figure);

// Rotations, places of the root and changes of bones' offsets.
void BuildFrames(const BvhMotion& bvh, RawFigure& figure, Diagnostics& diagnostics);

// Which axis of the file points up.
[[nodiscard]] UpAxis GuessUpAxis(const RawFigure& figure, Diagnostics& diagnostics);

// Height of the standing figure, file units; 0 if it cannot be told.
[[nodiscard]] double EstimateStature(const RawFigure& figure, UpAxis up);

// Says which standard joints coincide that no body has in one place.
void ReportMissingBones(const RawFigure& figure, Diagnostics& diagnostics);

// The unit of length by the figure's stature.
[[nodiscard]] std::string GuessUnits(const RawFigure& figure, UpAxis up, Diagnostics& diagnostics);

}  // namespace kinebase::internal
