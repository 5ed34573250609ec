// A TRC record becomes markers, and back.
//
// Read formats/trc.h and motion/marker_cloud.h first. Units and axes are decided here.
// Source: docs/formats/opensim.md.
#pragma once

#include <string>

#include "kinebase/core/diagnostic.h"
#include "kinebase/formats/trc.h"
#include "kinebase/motion/marker_cloud.h"
#include "kinebase/motion/world.h"

namespace kinebase {

struct TrcBuildOptions {
  double rate_hz = 0;
  double cm_per_unit = .1;
  UpAxis up = UpAxis::kY;
};

// Errors       Mismatch for more frames than an int counts.
// diagnostics  How many values are no places.
[[nodiscard]] MarkerCloud BuildMarkers(const TrcRecording& recording,
                                       const TrcBuildOptions& options, Diagnostics& diagnostics);

// The rate that the header tells, else the one of the time column; 0 if neither is a rate.
//
// diagnostics  If the header does not tell it.
[[nodiscard]] double FindRate(const TrcRecording& recording, Diagnostics& diagnostics);

struct TrcWriteOptions {
  std::string units = "mm";  // A unit of motion/world.h.
  UpAxis up = UpAxis::kY;
  std::string file_name;  // For the header.
};

// Places to six digits behind the point in millimetres, as many as that makes in other units.
// Frame n has time (n - 1) / rate. Tabs in names become blanks; empty and repeated names change.
//
// Errors       InvalidArgument for an unknown unit.
// diagnostics  Names that changed.
[[nodiscard]] TrcRecording ToTrc(const MarkerCloud& markers, const TrcWriteOptions& options,
                                 Diagnostics& diagnostics);

}  // namespace kinebase
