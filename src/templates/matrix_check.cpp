#include "templates/matrix_check.h"

#include <cmath>

#include "fmt/format.h"

namespace kinebase::internal {

std::string ProblemOf(const TemplateMatrix& matrix) {
  if (!std::isfinite(matrix.rate_hz) || matrix.rate_hz <= 0) {
    return fmt::format("rate {} Hz; expected a number above 0", matrix.rate_hz);
  }
  if (matrix.feature_count < 1 || matrix.feature_count > kMaxFeatures) {
    return fmt::format("{} features; expected 1 to {}", matrix.feature_count, kMaxFeatures);
  }
  if (matrix.weights.empty()) return "no columns; expected at least one";
  const std::size_t features = static_cast<std::size_t>(matrix.feature_count);
  if (matrix.values.size() != matrix.weights.size() * features) {
    return fmt::format("{} values; expected {} columns of {} features", matrix.values.size(),
                       matrix.weights.size(), features);
  }
  for (std::size_t c = 0; c < matrix.weights.size(); ++c) {
    const double weight = matrix.weights[c];
    if (!std::isfinite(weight) || weight <= 0) {
      return fmt::format("weight {} of column {}; expected a number above 0", weight, c + 1);
    }
  }
  for (std::size_t i = 0; i < matrix.values.size(); ++i) {
    const double value = matrix.values[i];
    if (!(value >= 0 && value <= 1)) {
      return fmt::format("value {} of feature {} in column {}; expected 0 to 1", value,
                         i % features + 1, i / features + 1);
    }
  }
  return {};
}

bool IsQuantisation(double delta) { return delta >= 0 && delta < 0.5; }

}  // namespace kinebase::internal
