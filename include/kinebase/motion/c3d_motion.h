// A C3D record becomes markers, and back.
//
// Read formats/c3d.h and motion/marker_cloud.h first. Units and axes are decided here.
// Source: The C3D File Format User Guide (c3d.org); docs/formats/c3d.md.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kinebase/core/diagnostic.h"
#include "kinebase/formats/c3d.h"
#include "kinebase/motion/marker_cloud.h"
#include "kinebase/motion/world.h"

namespace kinebase {

// The unit of length, as motion/world.h knows it: what POINT:UNITS says, else by the size of what
// is there in a frame: below 10 it is metres, below 300 centimetres, else millimetres.
//
// diagnostics  If it is guessed.
[[nodiscard]] std::string FindUnits(const C3dRecording& recording, Diagnostics& diagnostics);

// The axis that points up: what POINT:Y_SCREEN says, else the one along which heads and shoulders
// are away from feet, else the one along which the markers of a frame spread most.
//
// diagnostics  If it is guessed.
[[nodiscard]] UpAxis FindUpAxis(const C3dRecording& recording, Diagnostics& diagnostics);

// Indices of the points that are places. Others are angles, forces, moments, powers and scalars
// that a body model left behind, as POINT:ANGLES, FORCES … tell by their labels.
[[nodiscard]] std::vector<std::size_t> PlacesAmongPoints(const C3dRecording& recording);

struct C3dBuildOptions {
  double rate_hz = 0;
  double cm_per_unit = .1;
  UpAxis up = UpAxis::kZ;
};

// The points that are places. One that is not valid, at (0, 0, 0) or not a number is missing; one
// with residual 0 was filled.
//
// Errors       Mismatch for more frames than an int counts.
// diagnostics  Points that are no places; how many are missing although they are valid.
[[nodiscard]] MarkerCloud BuildMarkers(const C3dRecording& recording,
                                       const C3dBuildOptions& options, Diagnostics& diagnostics);

// What a record that is written anew was read from.
struct C3dBase {
  const C3dRecording* recording = nullptr;  // Null: there is none.
  double cm_per_unit = .1;
  UpAxis up = UpAxis::kZ;
};

struct C3dWriteOptions {
  std::string units = "mm";  // A unit of motion/world.h.
  UpAxis up = UpAxis::kZ;
  C3dBase base;
};

// The markers as an Intel record of floats.
//
// The base's parameters are kept, and its analog samples, events and force plates if it has the
// same frames and rate; corners of plates turn with the axes. Where markers are its places one by
// one, other points and the residuals and cameras of measured ones are kept too. A measured marker
// of unknown residual gets that of one step.
//
// Errors       InvalidArgument for an unknown unit.
// diagnostics  What of the base is left out; numbers of frames that C3D cannot hold.
[[nodiscard]] C3dRecording ToC3d(const MarkerCloud& markers, const C3dWriteOptions& options,
                                 Diagnostics& diagnostics);

// Sets POINT:UNITS, or X_SCREEN and Y_SCREEN.
void SetUnits(C3dRecording& recording, const std::string& units);
void SetUpAxis(C3dRecording& recording, UpAxis up);

}  // namespace kinebase
