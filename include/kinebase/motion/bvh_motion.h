// The BVH record becomes a Skeleton and a Motion, and back.
//
// Read formats/bvh.h first. All interpretation is here: units, axes, which joint is which.
// A rotation of BVH turns what hangs below its joint, one of Motion the bone that ends in its joint
// and all below. So the rotation of BVH joint J goes to every bone that begins at J, which is
// named after the joint where it ends; an `End Site` becomes a bone named "J_tip", and so does the
// missing one of a leaf, with length 0, as it carries the leaf's rotation.
// Source: docs/formats/bvh.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinebase/core/diagnostic.h"
#include "kinebase/formats/bvh.h"
#include "kinebase/motion/joint_source.h"
#include "kinebase/motion/motion.h"
#include "kinebase/motion/world.h"

namespace kinebase {

struct BvhBuildOptions {
  std::string units;              // As CentimetresIn; empty: by stature.
  std::optional<UpAxis> up_axis;  // Empty: by how the figure stands.
  double rate_hz = 0;             // 0: the frame time's.
};

struct BvhFigure {
  Motion motion;                           // Of the first root; Y up.
  std::string units;                       // Of the file's lengths: "cm", "inch / 0.45".
  UpAxis up_axis = UpAxis::kY;             // Of the file.
  std::string rig;                         // As RigMapping::rig.
  std::vector<JointSource> joint_sources;  // How the standard joints were found.
};

// Errors       InvalidArgument: unknown unit; no rate, as the frame time is none.
// diagnostics  What was chosen for the user: units, axis, what position channels mean; roots that
//              are left out; missing values (replaced by those of the frame before).
[[nodiscard]] BvhFigure BuildFigure(const BvhMotion& bvh, const BvhBuildOptions& options,
                                    Diagnostics& diagnostics);

// What readers take a file's lengths and axis for, which it does not tell.
struct BvhWorld {
  std::string units;
  UpAxis up_axis = UpAxis::kY;
};

// up_axis  The axis if it is known; units are guessed along it.
// Errors   As BuildFigure.
[[nodiscard]] BvhWorld GuessWorld(const BvhMotion& bvh, std::optional<UpAxis> up_axis = {});

struct BvhWriteOptions {
  std::string units = "cm";
  UpAxis up_axis = UpAxis::kY;
};

// A motion as BVH. Of a skeleton that came from BVH the joints are what they were; of others each
// bone becomes a joint where it begins, with the bone's name, and tips become `End Site`. Angles
// come in the bone's Euler order, unwound from frame to frame; stretched bones as position
// channels, which hold the whole place. Joints come back within 1e-6 cm.
//
// diagnostics  What a BVH cannot say: limits, a rate that readers round.
[[nodiscard]] BvhMotion ToBvh(const Motion& motion, const BvhWriteOptions& options,
                              Diagnostics& diagnostics);

}  // namespace kinebase
