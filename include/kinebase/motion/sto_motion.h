// Motions and analog samples become OpenSim's tables.
//
// Read formats/sto.h first. Source: docs/formats/opensim.md. Ground forces: The C3D File Format
// User Guide, "The FORCE_PLATFORM Group".
#pragma once

#include "kinebase/core/diagnostic.h"
#include "kinebase/formats/c3d.h"
#include "kinebase/formats/sto.h"
#include "kinebase/motion/motion.h"
#include "kinebase/motion/world.h"

namespace kinebase {

// Time is (n - 1) / rate for a file's frame n, in all tables as in TRC.

// Columns `root_tx` … `root_tz` in metres, then `<bone>_rx` … in degrees: the angles of
// EulerAngles for each rotation that the joint's DOFs or the motion have; `<bone>_tx` … in metres
// where a bone moves or stretches.
[[nodiscard]] StoTable ToJointAngles(const Motion& motion);

// Columns `<bone>_imu` of quaternions w, x, y, z, the form of OpenSense's orientation files: what
// turns the bone from the neutral pose to its pose in the world, for the root and each bone that
// turns by itself. They go on without jumps of sign.
[[nodiscard]] StoTable ToOrientations(const Motion& motion);

// All analog channels in real units at their own rate.
//
// diagnostics  Names that changed.
[[nodiscard]] StoTable ToAnalogTable(const C3dRecording& recording, Diagnostics& diagnostics);

struct GroundForceOptions {
  UpAxis up = UpAxis::kZ;   // Of the file.
  double cm_per_unit = .1;  // The same.
};

// What the floor does to the feet on each force plate, at the analog rate: columns
// `ground_force_<n>_vx` … (N), `ground_force_<n>_px` … (the centre of pressure, m) and
// `ground_torque_<n>_x` … (about that point, N·m); world axes, Y up.
//
// The floor only pushes: a plate whose force points down on the whole has its signs turned. Below
// kSmallestPlateForce there is no centre of pressure; the plate's centre and the whole moment stand
// there. Plates of type 1 to 4; others, and plates without place or channels, are left out.
// diagnostics  Plates that are left out, or turned.
[[nodiscard]] StoTable ToGroundForces(const C3dRecording& recording,
                                      const GroundForceOptions& options, Diagnostics& diagnostics);

inline constexpr double kSmallestPlateForce = 10;  // N, across the plate.

}  // namespace kinebase
