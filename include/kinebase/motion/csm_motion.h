// A CSM record becomes markers, and back; its names become those of the preset, and back.
//
// Read formats/csm.h, formats/mnm.h and motion/marker_cloud.h first. Units and axes are decided
// here. Source: "Character Studio CSM Motion Capture File format"; docs/formats/csm.md.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinebase/core/diagnostic.h"
#include "kinebase/formats/csm.h"
#include "kinebase/formats/mnm.h"
#include "kinebase/motion/marker_cloud.h"
#include "kinebase/motion/world.h"

namespace kinebase {

// The format says millimetres and Z up; others are for files that do not keep to it.
struct CsmBuildOptions {
  double rate_hz = 0;
  double cm_per_unit = .1;
  UpAxis up = UpAxis::kZ;
};

// A marker with DROPOUT, NaN or at (0, 0, 0) is missing.
//
// Errors       Mismatch for more frames than an int counts.
// diagnostics  How many are missing by the latter two.
[[nodiscard]] MarkerCloud BuildMarkers(const CsmRecording& recording,
                                       const CsmBuildOptions& options, Diagnostics& diagnostics);

// Frames, names and rate as a CSM in millimetres, Z up, to 1e-6 mm. Names lose a subject's prefix
// where they are unique without; blanks and commas become '_'; empty and repeated names change.
//
// diagnostics  Names that changed.
[[nodiscard]] CsmRecording ToCsm(const MarkerCloud& markers, Diagnostics& diagnostics);

// A file's labels under the preset's names, as an MNM file tells; others as they are.
//
// A row that gives the wrist band's name to the stick, as the format's own sample does, counts for
// nothing: the two stand in different places, and the band's name says which it is.
// diagnostics  Such rows; labels that another one has already.
[[nodiscard]] std::vector<std::string> PresetLabels(std::span<const std::string> labels,
                                                    const MarkerNames& names,
                                                    Diagnostics& diagnostics);

// The way back: the preset's names as the file calls them. A subject's prefix goes.
// diagnostics  Names that fit none of the labels; labels that another one has already.
[[nodiscard]] std::vector<std::string> CustomLabels(std::span<const std::string> labels,
                                                    const MarkerNames& names,
                                                    Diagnostics& diagnostics);

// What Character Studio would miss: required markers that are not there, and what is then known
// less well (a warning); optional ones, names that the preset lacks (infos).
[[nodiscard]] Diagnostics CheckPreset(std::span<const std::string> labels);

// Whether a wrist has markers both of a band and of a stick, which the format forbids.
[[nodiscard]] bool HasBandAndStick(std::span<const std::string> labels);

}  // namespace kinebase
