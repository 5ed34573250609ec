// A take and a template of one feature, whose matches can be counted on the fingers.
#pragma once

#include <initializer_list>
#include <utility>

#include "kinebase/library/takes.h"
#include "kinebase/templates/quantized_template.h"

namespace kinebase::test {

// A take at 120 Hz, four frames a column of which the last lacks one, whose feature holds in the
// stretches of columns first … last.
inline TakeFeatures OneFeatureTake(int columns,
                                   std::initializer_list<std::pair<int, int>> stretches) {
  TakeFeatures take{.path = "take.amc", .rate_hz = 120, .frame_count = 4 * columns - 1};
  take.features = {.rate_hz = 30, .feature_count = 1};
  take.features.columns.resize(static_cast<std::size_t>(columns));
  for (const auto& [first, last] : stretches) {
    for (int c = first; c <= last && c < columns; ++c) {
      take.features.columns[static_cast<std::size_t>(c)] = 1;
    }
  }
  return take;
}

// "0, then five times 1, then 0".
inline TemplateMatrix OneFeatureMatrix() {
  TemplateMatrix matrix{.rate_hz = 30, .feature_count = 1};
  matrix.values = {0, 1, 1, 1, 1, 1, 0};
  matrix.weights.assign(7, 1);
  return matrix;
}

inline QuantizedTemplate OneFeatureTemplate() {
  return Quantize(OneFeatureMatrix(), 0.1, Profile::kBonn);
}

}  // namespace kinebase::test
