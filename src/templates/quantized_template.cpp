#include "kinebase/templates/quantized_template.h"

#include <bit>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "templates/matrix_check.h"

namespace kinebase {

QuantizedTemplate Quantize(const TemplateMatrix& matrix, double delta, Profile matching) {
  if (!internal::IsQuantisation(delta)) {
    throw Error(
        ErrorCode::kInvalidArgument,
        fmt::format("quantisation threshold {}; expected 0 up to, not including, 0.5", delta));
  }
  if (const std::string problem = internal::ProblemOf(matrix); !problem.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "template has " + problem);
  }
  QuantizedTemplate quantized;
  quantized.rate_hz = matrix.rate_hz;
  quantized.feature_count = matrix.feature_count;
  quantized.matching = matching;
  quantized.columns.resize(matrix.weights.size());
  for (int c = 0; c < matrix.column_count(); ++c) {
    QuantizedColumn& column = quantized.columns[c];
    const std::span<const double> values = matrix.Column(c);
    for (std::size_t feature = 0; feature < values.size(); ++feature) {
      const std::uint64_t bit = std::uint64_t{1} << feature;
      const bool is_one = values[feature] >= 1 - delta;
      if (is_one) column.ones |= bit;
      if (is_one || values[feature] <= delta) column.consistent |= bit;
    }
    const int consistent = std::popcount(column.consistent);
    if (consistent == 0) continue;
    column.scale = 1.0 / consistent;
    if (matching == Profile::kBonn) column.scale *= (matrix.weights[c] + 1) / 2;
  }
  return quantized;
}

QuantizedTemplate Quantize(const MotionTemplate& motion_template) {
  const TemplateMatrix& matrix = motion_template.matrix;
  QuantizedTemplate quantized =
      Quantize(matrix, motion_template.quantisation, motion_template.matching);
  if (!motion_template.contrast) return quantized;
  quantized.costs = motion_template.contrast->entry_weights;
  for (int c = 0; c < matrix.column_count(); ++c) {
    QuantizedColumn& column = quantized.columns[c];
    column = {};
    const std::span<const double> values = matrix.Column(c);
    double* costs = quantized.costs.data() + values.size() * static_cast<std::size_t>(c);
    for (std::size_t feature = 0; feature < values.size(); ++feature) {
      const std::uint64_t bit = std::uint64_t{1} << feature;
      if (values[feature] > 0.5) column.ones |= bit;
      if (costs[feature] > 0) column.consistent |= bit;
      if (quantized.matching == Profile::kBonn) costs[feature] *= (matrix.weights[c] + 1) / 2;
    }
  }
  return quantized;
}

}  // namespace kinebase
