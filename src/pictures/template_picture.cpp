#include "kinebase/pictures/template_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinebase/core/error.h"
#include "pictures/matrix_picture.h"

namespace kinebase {
namespace {

struct ColorStop {
  double value;
  Color color;
};

constexpr std::array<ColorStop, 4> kStops = {
    {{0, {0, 0, 0}}, {3.0 / 8, {255, 0, 0}}, {3.0 / 4, {255, 255, 0}}, {1, {255, 255, 255}}}};

std::string Counted(std::size_t count, std::string_view singular) {
  return fmt::format("{} {}{}", count, singular, count == 1 ? "" : "s");
}

void CheckDrawable(int columns, double rate_hz, const std::string& what) {
  if (columns == 0) throw Error(ErrorCode::kInvalidArgument, what + " has no columns to draw");
  if (!(rate_hz > 0) || !std::isfinite(rate_hz)) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} has a rate of {} Hz; drawing needs a positive one", what, rate_hz));
  }
}

void CheckValues(const TemplateMatrix& matrix, const FeatureSet& features,
                 const std::string& what) {
  const std::size_t expected = matrix.weights.size() * features.features.size();
  if (matrix.values.size() != expected) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} has {} values; {} columns of {} features need {}", what,
                            matrix.values.size(), matrix.weights.size(), features.feature_count(),
                            expected));
  }
  for (std::size_t i = 0; i < matrix.values.size(); ++i) {
    if (matrix.values[i] >= 0 && matrix.values[i] <= 1) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} has the value {} for {} in column {}; values lie in 0 to 1", what,
                            matrix.values[i], features.features[i % features.features.size()].id,
                            i / features.features.size()));
  }
  for (std::size_t i = 0; i < matrix.weights.size(); ++i) {
    if (matrix.weights[i] > 0 && std::isfinite(matrix.weights[i])) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} has the weight {} in column {}; weights are positive", what,
                            matrix.weights[i], i));
  }
}

double QuantizedValue(double value, double delta) {
  return value <= delta ? 0 : value >= 1 - delta ? 1 : 0.5;
}

std::vector<std::string> MatrixFacts(std::size_t columns, double weight, double rate_hz,
                                     const FeatureSet& features) {
  return {Counted(columns, "column"), fmt::format("{:.2f} s", weight / rate_hz),
          fmt::format("{:g} Hz", rate_hz), "feature set " + features.name};
}

void CheckCosts(const ComparedCosts& costs, std::size_t columns, const FeatureSet& features) {
  bool fits = costs.features.size() == features.features.size();
  for (const ComparedJoint& joint : costs.joints) fits = fits && joint.off.size() == columns;
  if (fits) return;
  throw Error(ErrorCode::kInvalidArgument,
              "the costs of a comparison are of other features or columns than it has");
}

// A cost as it stands beside its row.
std::string CostText(double cost) { return cost > 0 ? fmt::format("{:.4f}", cost) : ""; }

// Rows of joints below those of features, and what every row costs.
void AddCosts(const ComparedCosts& costs, internal::MatrixPicture& picture, FeatureSet& rows) {
  constexpr double kMostSpreads = 2;  // More is not told apart, as it does not cost more.
  const std::size_t features = rows.features.size();
  double of_features = 0;
  double of_poses = 0;
  for (const double cost : costs.features) {
    of_features += cost;
    picture.row_notes.push_back(CostText(cost));
  }
  for (const ComparedJoint& joint : costs.joints) {
    of_poses += joint.cost;
    rows.features.push_back({.name = std::string(ToString(joint.joint)), .group = "poses"});
    picture.row_notes.push_back(CostText(joint.cost));
  }
  std::string fact =
      fmt::format("cost of features {:.4f} and of poses {:.4f}", of_features, of_poses);
  if (costs.lookalikes > 0) fact += fmt::format(", of look-alikes {:.4f}", costs.lookalikes);
  picture.facts.push_back(std::move(fact));
  picture.shaded_rows = static_cast<int>(costs.joints.size());
  std::vector<double> values;
  std::vector<internal::FoundEntry> found;
  for (std::size_t column = 0; column < picture.weights.size(); ++column) {
    for (std::size_t row = 0; row < features; ++row) {
      values.push_back(picture.values[column * features + row]);
      found.push_back(picture.found[column * features + row]);
    }
    for (const ComparedJoint& joint : costs.joints) {
      values.push_back(std::min(joint.off[column] / kMostSpreads, 1.0));
      found.emplace_back();
    }
  }
  picture.values = std::move(values);
  picture.found = std::move(found);
}

}  // namespace

Color TemplateColor(double value) {
  for (std::size_t i = 1; i < kStops.size(); ++i) {
    const auto& [low, low_color] = kStops[i - 1];
    const auto& [high, high_color] = kStops[i];
    if (value <= high)
      return Mix(low_color, high_color, std::max(0.0, (value - low) / (high - low)));
  }
  return kStops.back().color;
}

void DrawTemplate(const MotionTemplate& motion_template, const FeatureSet& features,
                  const std::filesystem::path& path, Overwrite overwrite,
                  const TemplatePictureOptions& options) {
  CheckFeatureSet(motion_template, features);
  const TemplateMatrix& matrix = motion_template.matrix;
  const std::string what = fmt::format("template \"{}\"", motion_template.name);
  CheckDrawable(matrix.column_count(), matrix.rate_hz, what);
  CheckValues(matrix, features, what);

  internal::MatrixPicture picture;
  picture.title = motion_template.name.empty() ? "Motion template" : motion_template.name;
  picture.facts =
      MatrixFacts(matrix.weights.size(), matrix.total_weight(), matrix.rate_hz, features);
  if (!motion_template.clips.empty()) {
    picture.facts.insert(picture.facts.begin(), Counted(motion_template.clips.size(), "clip"));
  }
  picture.rate_hz = matrix.rate_hz;
  picture.values = matrix.values;
  picture.weights = matrix.weights;
  picture.show_weights = options.weights;
  if (options.quantized) {
    picture.coding = internal::CellCoding::kQuantized;
    picture.facts.push_back(fmt::format("quantised with δ = {:g}", motion_template.quantisation));
    for (double& value : picture.values) {
      value = QuantizedValue(value, motion_template.quantisation);
    }
  }
  internal::DrawMatrixPicture(picture, features, path, overwrite);
}

void DrawFeatureMatrix(const FeatureMatrix& matrix, const FeatureSet& features,
                       const std::string& title, const std::filesystem::path& path,
                       Overwrite overwrite) {
  if (matrix.feature_count != features.feature_count()) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("the feature matrix has {} rows and feature set \"{}\" has {}; use the "
                            "set that it was computed with",
                            matrix.feature_count, features.name, features.feature_count()));
  }
  CheckDrawable(matrix.column_count(), matrix.rate_hz, "the feature matrix");

  internal::MatrixPicture picture;
  picture.title = title.empty() ? "Feature matrix" : title;
  picture.facts = MatrixFacts(matrix.columns.size(), static_cast<double>(matrix.columns.size()),
                              matrix.rate_hz, features);
  picture.coding = internal::CellCoding::kBits;
  picture.rate_hz = matrix.rate_hz;
  picture.weights.assign(matrix.columns.size(), 1);
  picture.show_weights = false;
  for (int column = 0; column < matrix.column_count(); ++column) {
    for (int feature = 0; feature < matrix.feature_count; ++feature) {
      picture.values.push_back(matrix.at(column, feature) ? 1 : 0);
    }
  }
  internal::DrawMatrixPicture(picture, features, path, overwrite);
}

void DrawComparison(std::span<const ComparedColumn> columns, double rate_hz,
                    const FeatureSet& features, const std::string& title,
                    const std::filesystem::path& path, Overwrite overwrite,
                    const std::optional<ComparedCosts>& costs) {
  CheckDrawable(static_cast<int>(columns.size()), rate_hz, "the comparison");
  if (costs) CheckCosts(*costs, columns.size(), features);
  internal::MatrixPicture picture;
  picture.title = title.empty() ? "Comparison" : title;
  picture.facts =
      MatrixFacts(columns.size(), static_cast<double>(columns.size()), rate_hz, features);
  picture.coding = internal::CellCoding::kQuantized;
  picture.rate_hz = rate_hz;
  picture.weights.assign(columns.size(), 1);
  picture.show_weights = false;
  for (const ComparedColumn& column : columns) {
    for (int feature = 0; feature < features.feature_count(); ++feature) {
      const auto has = [feature](std::uint64_t word) { return ((word >> feature) & 1U) != 0; };
      const bool is_asked = has(column.consistent);
      picture.values.push_back(!is_asked ? 0.5 : has(column.ones) ? 1 : 0);
      picture.found.push_back({.holds = has(column.recording),
                               .is_wrong = is_asked && has(column.recording) != has(column.ones)});
    }
  }
  FeatureSet rows = features;
  if (costs) AddCosts(*costs, picture, rows);
  internal::DrawMatrixPicture(picture, rows, path, overwrite);
}

}  // namespace kinebase
