// The Δ curve: for every column of a recording, how well the template fits a stretch ending there.
//
// Read templates/quantized_template.h first; search/hits.h turns the curve into hits.
// Method: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.2.
// Departures: docs/design/search.md.
//
// Steps (template, recording) are (1,1), (1,2), (2,1), in this order where costs tie. Profile
// paper: the path of least cost. Profile bonn: the predecessor of least accumulated cost is picked
// first, then the cell's cost is added, doubled after a step (2,1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinebase/templates/quantized_template.h"

namespace kinebase {

// [column of the recording]
struct DeltaCurve {
  std::vector<double> delta;        // Accumulated cost / template columns; +inf where no path ends.
  std::vector<std::int32_t> start;  // Column where that path starts; -1 where there is none.
};

// Straightforward and slow: the reference that every kernel must equal bit for bit.
[[nodiscard]] DeltaCurve ComputeDeltaReference(const QuantizedTemplate& motion_template,
                                               std::span<const std::uint64_t> columns);

// The same by the widest vector instructions that the machine has.
//
// columns  Feature words of one recording; fewer than half the template gives only +inf.
// Cost     O(template columns · columns) time, O(columns) memory.
// Threads  May be called concurrently.
[[nodiscard]] DeltaCurve ComputeDelta(const QuantizedTemplate& motion_template,
                                      std::span<const std::uint64_t> columns);

// Instruction sets that ComputeDelta can use on this machine, best first; for tests and benchmarks.
[[nodiscard]] std::vector<std::int64_t> SupportedDeltaTargets();
[[nodiscard]] const char* DeltaTargetName(std::int64_t target);
// Restricts ComputeDelta to one of them, process-wide; 0 lifts the restriction.
void UseDeltaTarget(std::int64_t target);

// One cell of a warping path, 0-based.
struct PathCell {
  int template_column = 0;
  int recording_column = 0;

  friend bool operator==(const PathCell&, const PathCell&) = default;
};

// The path behind delta[last]: from (0, start) to (template columns − 1, last). Empty if none.
// Cost  O(template columns²): at most twice as many recording columns are looked at.
[[nodiscard]] std::vector<PathCell> TracePath(const QuantizedTemplate& motion_template,
                                              std::span<const std::uint64_t> columns, int last);

}  // namespace kinebase
