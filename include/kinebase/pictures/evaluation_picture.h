// How well methods find motion classes, as pictures: precision over recall, which class is taken
// for which, and whether confidences keep what they promise.
//
// Read pictures/canvas.h first: EncodePicture and WritePicture draw what these functions describe.
// docs/pictures.md shows how to read the pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kinebase/pictures/canvas.h"

namespace kinebase {

struct PrecisionCurve {
  std::string name;               // Of the method.
  std::vector<double> precision;  // In [0, 1], at recalls evenly spaced from 0 to 1; two or more.
};

// The curves of all methods over one thing, such as a class.
struct PrecisionPanel {
  std::string title;
  std::vector<PrecisionCurve> curves;
};

// A large panel with the legend, and below it small ones with the same axes. The curves of all
// panels are those of the same methods in the same order; only the large panel's names are shown.
//
// Errors  InvalidArgument: no curves, panels with different numbers of them, values that no
//         precision can have.
[[nodiscard]] Picture PrecisionPicture(PrecisionPanel whole, std::vector<PrecisionPanel> parts);

// What things of each class were taken for.
struct ConfusionCounts {
  std::string title;
  std::string counted;                            // What is counted: "clips".
  std::vector<std::string> classes;               // Of the rows, and of the columns in this order.
  std::vector<std::vector<std::int64_t>> counts;  // [class][taken for]; a column more than classes
                                                  // is for those taken for nothing.
};

// Rows are what is true and shaded by their shares: blue where it was recognised, orange where not.
// Columns have the numbers of the rows, as names are long.
//
// Errors  InvalidArgument: no classes, rows of other lengths than said above, negative counts.
[[nodiscard]] Picture ConfusionPicture(ConfusionCounts confusion);

// Hits of about the same confidence.
struct ReliabilityGroup {
  std::size_t hits = 0;
  double confidence = 0;  // Mean, in [0, 1]; of no meaning without hits.
  double right = 0;       // Share.
};

struct ReliabilityPanel {
  std::string title;
  std::vector<ReliabilityGroup> groups;  // Of evenly spaced confidences from 0 to 1.
};

// Fewer hits say little: groups of less are drawn faint.
inline constexpr std::size_t kFewHits = 30;

// For each panel confidence against share right, with the distance to the diagonal as a stem, and
// below it the numbers of hits as bars of logarithmic height.
//
// Errors  InvalidArgument: no panels, a panel without groups, values outside [0, 1].
[[nodiscard]] Picture ReliabilityPicture(std::vector<ReliabilityPanel> panels);

}  // namespace kinebase
