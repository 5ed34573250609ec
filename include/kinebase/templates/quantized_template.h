// A template as the matcher sees it: per column which features must be 1, which 0, which are free.
//
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.2.
#pragma once

#include <cstdint>
#include <vector>

#include "kinebase/templates/motion_template.h"

namespace kinebase {

struct QuantizedColumn {
  std::uint64_t consistent = 0;  // Bit i: feature i must agree.
  std::uint64_t ones = 0;        // Which of those must be 1.
  double scale = 0;              // Cost of one mismatch: 1 / |consistent|, by the column's weight
                                 // (weight + 1) / 2 in profile bonn; 0 where nothing is consistent.
};

struct QuantizedTemplate {
  double rate_hz = 0;
  int feature_count = 0;
  Profile matching = Profile::kBonn;
  std::vector<QuantizedColumn> columns;
  // [column × feature] what a mismatch costs, instead of the columns' scales; empty: those.
  std::vector<double> costs;

  [[nodiscard]] int column_count() const { return static_cast<int>(columns.size()); }
};

// δ in [0, 0.5): values ≤ δ become 0, values ≥ 1 − δ become 1, the rest "any".
// Errors  InvalidArgument.
[[nodiscard]] QuantizedTemplate Quantize(const TemplateMatrix& matrix, double delta,
                                         Profile matching);

// As the template is matched. With a contrast every entry asks for what it mostly was, and a
// mismatch costs its weight, by the column's as above; nothing is left free for being undecided.
[[nodiscard]] QuantizedTemplate Quantize(const MotionTemplate& motion_template);

}  // namespace kinebase
