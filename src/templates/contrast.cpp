#include "kinebase/templates/contrast.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/templates/learning.h"

namespace kinebase {
namespace {

// Few clips give few values to tell a variance from: this share of the background's is added, so
// that no joint is taken for nailed down.
constexpr double kVarianceFloor = 0.05;
// What consistent entries weigh that are no surprise at all.
constexpr double kUnsurprising = 0.3;

// Sums, for means and variances.
class Moments {
 public:
  void Add(std::span<const double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      sum_[i] += values[i];
      squares_[i] += values[i] * values[i];
    }
    ++count_;
  }
  void Add(std::span<const float> pose) {
    std::array<double, kPoseValues> numbers{};
    std::ranges::copy(pose, numbers.begin());
    Add(numbers);
  }

  [[nodiscard]] PoseStatistics Statistics() const {
    PoseStatistics statistics;
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      const double mean = sum_[i] / count_;
      statistics.mean.push_back(mean);
      statistics.variance.push_back(std::max(squares_[i] / count_ - mean * mean, 0.0));
    }
    return statistics;
  }

 private:
  std::array<double, kPoseValues> sum_{};
  std::array<double, kPoseValues> squares_{};
  double count_ = 0;
};

PoseStatistics MeasurePoses(std::span<const RecordingStreams> labelled,
                            std::span<const RecordingStreams> others) {
  Moments moments;
  for (const auto& recordings : {labelled, others}) {
    for (const RecordingStreams& recording : recordings) {
      for (int column = 0; column < recording.poses->column_count(); ++column) {
        moments.Add(recording.poses->Column(column));
      }
    }
  }
  return moments.Statistics();
}

double BernoulliDivergence(double p, double b) {
  return p * std::log(p / b) + (1 - p) * std::log((1 - p) / (1 - b));
}

double GaussianDivergence(double mean, double variance, double other_mean, double other_variance) {
  const double ratio = variance / other_variance;
  const double shift = mean - other_mean;
  return (ratio + shift * shift / other_variance - 1 - std::log(ratio)) / 2;
}

void NormalizeSum(std::span<double> weights) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  if (!(sum > 0)) return;
  for (double& weight : weights) weight /= sum;
}

std::vector<double> WeighEntries(const TemplateMatrix& matrix, std::size_t performances,
                                 std::span<const double> background) {
  std::vector<double> weights;
  weights.reserve(matrix.values.size());
  const auto count = static_cast<double>(performances);
  for (int column = 0; column < matrix.column_count(); ++column) {
    const std::span<const double> values = matrix.Column(column);
    for (std::size_t feature = 0; feature < values.size(); ++feature) {
      const double consistency = std::pow(2 * values[feature] - 1, 4);
      const double p = (count * values[feature] + 0.5) / (count + 1);
      weights.push_back(consistency *
                        (kUnsurprising + BernoulliDivergence(p, background[feature])));
    }
    NormalizeSum(std::span(weights).last(values.size()));
  }
  return weights;
}

// The mean pose of each performance in each column of the template, by the alignment of features.
std::vector<Moments> MomentsOfColumns(const MotionTemplate& motion_template,
                                      std::span<const RecordingStreams> performances,
                                      std::span<const Alignment> alignments) {
  const auto columns = static_cast<std::size_t>(motion_template.matrix.column_count());
  std::vector<Moments> moments(columns);
  for (std::size_t i = 0; i < performances.size(); ++i) {
    std::vector<std::array<double, kPoseValues>> sums(columns);
    std::vector<int> counts(columns);
    for (const AlignedColumns& cell : alignments[i].path) {
      const std::span<const float> values = performances[i].poses->Column(cell.other);
      const auto column = static_cast<std::size_t>(cell.reference);
      for (std::size_t v = 0; v < values.size(); ++v) sums[column][v] += values[v];
      ++counts[column];
    }
    for (std::size_t column = 0; column < columns; ++column) {
      for (double& sum : sums[column]) sum /= counts[column];
      moments[column].Add(sums[column]);
    }
  }
  return moments;
}

void AppendAsFloats(std::span<const double> numbers, std::vector<float>& to) {
  for (const double number : numbers) to.push_back(static_cast<float>(number));
}

PoseModel ModelOf(std::span<const Moments> columns, const PoseStatistics& background) {
  PoseModel model;
  AppendAsFloats(background.variance, model.spread);
  for (const Moments& column : columns) {
    const PoseStatistics here = column.Statistics();
    std::vector<double> weights;
    for (std::size_t i = 0; i < here.mean.size(); ++i) {
      const double spread = background.variance[i];
      const double floor = kVarianceFloor * spread;
      // The root, say, is always in its own place.
      weights.push_back(spread > 0 ? GaussianDivergence(here.mean[i], here.variance[i] + floor,
                                                        background.mean[i], spread)
                                   : 0);
    }
    NormalizeSum(weights);
    AppendAsFloats(here.mean, model.mean);
    AppendAsFloats(weights, model.weight);
  }
  return model;
}

}  // namespace

Background MeasureBackground(std::span<const RecordingStreams> labelled,
                             std::span<const RecordingStreams> others) {
  Background background;
  double columns = 0;
  for (const RecordingStreams& recording : labelled) {
    const FeatureMatrix& matrix = *recording.features;
    if (background.ones.empty()) {
      background.ones.resize(static_cast<std::size_t>(matrix.feature_count));
    }
    if (std::ssize(background.ones) != matrix.feature_count) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("recordings with {} and with {} features; extract all with one set",
                              background.ones.size(), matrix.feature_count));
    }
    for (int column = 0; column < matrix.column_count(); ++column) {
      for (int i = 0; i < matrix.feature_count; ++i) {
        if (matrix.at(column, i)) background.ones[static_cast<std::size_t>(i)] += 1;
      }
    }
    columns += matrix.column_count();
  }
  if (columns == 0) {
    throw Error(ErrorCode::kInvalidArgument, "no columns to measure a background on");
  }
  // Never 0 or 1: what has not been seen yet may still come.
  for (double& share : background.ones) share = (share + 0.5) / (columns + 1);
  background.places = MeasurePoses(labelled, others);
  return background;
}

Contrast MeasureContrast(const MotionTemplate& motion_template,
                         std::span<const RecordingStreams> performances,
                         const Background& background) {
  if (performances.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "no performances to measure a contrast with");
  }
  std::vector<Alignment> alignments;
  for (const RecordingStreams& performance : performances) {
    if (performance.features->feature_count != motion_template.matrix.feature_count ||
        std::ssize(background.ones) != motion_template.matrix.feature_count) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("template '{}' has {} features, a performance {}, the background {}",
                              motion_template.name, motion_template.matrix.feature_count,
                              performance.features->feature_count, background.ones.size()));
    }
    alignments.push_back(Align(motion_template.matrix, ToTemplateMatrix(*performance.features),
                               motion_template.learning));
  }
  const std::vector<Moments> columns = MomentsOfColumns(motion_template, performances, alignments);
  return {
      .entry_weights = WeighEntries(motion_template.matrix, performances.size(), background.ones),
      .places = ModelOf(columns, background.places)};
}

}  // namespace kinebase
