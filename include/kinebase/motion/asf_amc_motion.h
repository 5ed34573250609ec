// The ASF and AMC records become a Skeleton and a Motion, and back.
//
// Read formats/asf.h and formats/amc.h first. All interpretation is here: units, axes, orders.
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 4.1; docs/formats/asf-amc.md.
#pragma once

#include <memory>

#include "kinebase/core/diagnostic.h"
#include "kinebase/formats/amc.h"
#include "kinebase/formats/asf.h"
#include "kinebase/motion/motion.h"
#include "kinebase/motion/skeleton.h"

namespace kinebase {

// What `:units length u` means for a value v.
enum class LengthReading {
  kAuto,                  // Inches if that gives a human stature, else centimetres, else inches.
  kDivideToInches,        // v / u inches, as HDM05 and CMU.
  kMultiplyToCentimetres  // v · u cm.
};

struct AsfBuildOptions {
  LengthReading length_reading = LengthReading::kAuto;
};

// Centimetres in one unit of the file's lengths under a reading (never kAuto).
[[nodiscard]] double CentimetresPerUnit(const AsfSkeleton& asf, LengthReading reading);

// The reading that kAuto stands for, with a diagnostic where the file leaves it open; others as
// they are.
[[nodiscard]] LengthReading ChooseLengthReading(const AsfSkeleton& asf, LengthReading wanted,
                                                Diagnostics& diagnostics);

// Errors       MalformedFile: unknown Euler order.
// diagnostics  Which reading of the lengths was taken where the file leaves it open; limits that do
//              not fit the DOFs (they are left out); standard joints that are told by the shape of
//              the skeleton, as fewer than half of its bones have the names of HDM05 and CMU.
[[nodiscard]] std::shared_ptr<const Skeleton> BuildSkeleton(const AsfSkeleton& asf,
                                                            const AsfBuildOptions& options,
                                                            Diagnostics& diagnostics);

// asf, skeleton  A record and what BuildSkeleton made of it.
// Errors         Mismatch, with the AMC's line: a bone that the skeleton lacks, another number of
//                values than DOFs there.
// diagnostics    Bones with DOFs that the motion lacks (they stay neutral); missing values
//                (replaced by those of the frame before).
[[nodiscard]] Motion BuildMotion(const AmcMotion& amc, const AsfSkeleton& asf,
                                 std::shared_ptr<const Skeleton> skeleton, double rate_hz,
                                 const AsfBuildOptions& options, Diagnostics& diagnostics);

// A skeleton as an ASF in degrees with `:units length 0.45`, as HDM05 has it.
[[nodiscard]] AsfSkeleton ToAsf(const Skeleton& skeleton);

// A motion as an AMC in degrees for ToAsf's skeleton. Rotations that a joint's DOFs cannot express
// are lost; `diagnostics` names those joints, and bones whose names are no single words.
[[nodiscard]] AmcMotion ToAmc(const Motion& motion, Diagnostics& diagnostics);

}  // namespace kinebase
