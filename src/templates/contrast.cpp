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
  // As much as one more, by its own mean and variance.
  void Add(const PoseStatistics& statistics) {
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      const double mean = statistics.mean[i];
      sum_[i] += mean;
      squares_[i] += mean * mean + statistics.variance[i];
    }
    ++count_;
  }
  void Add(std::span<const float> pose) {
    std::array<double, kPoseValues> numbers{};
    std::ranges::copy(pose, numbers.begin());
    Add(numbers);
  }

  [[nodiscard]] bool empty() const { return count_ == 0; }

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

void CheckPoses(const RecordingStreams& recording) {
  const int poses = recording.poses == nullptr ? 0 : recording.poses->column_count();
  if (poses == recording.features.column_count()) return;
  throw Error(
      ErrorCode::kInvalidArgument,
      fmt::format("a recording with {} columns of features and {} poses; a contrast needs a "
                  "pose for each: extract them too",
                  recording.features.column_count(), poses));
}

PoseStatistics MeasurePoses(std::span<const RecordingStreams> labelled,
                            std::span<const RecordingStreams> others) {
  Moments moments;
  for (const auto& recordings : {labelled, others}) {
    for (const RecordingStreams& recording : recordings) {
      CheckPoses(recording);
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

// ones  [column × feature] how often each is one in motion that is not of the class.
std::vector<double> WeighEntries(const TemplateMatrix& matrix, std::size_t performances,
                                 std::span<const double> ones) {
  std::vector<double> weights;
  weights.reserve(matrix.values.size());
  const auto count = static_cast<double>(performances);
  for (std::size_t i = 0; i < matrix.values.size(); ++i) {
    const double value = matrix.values[i];
    const double consistency = std::pow(2 * value - 1, 4);
    const double p = (count * value + 0.5) / (count + 1);
    weights.push_back(consistency * (kUnsurprising + BernoulliDivergence(p, ones[i])));
  }
  const auto features = static_cast<std::size_t>(matrix.feature_count);
  for (std::size_t first = 0; first < weights.size(); first += features) {
    NormalizeSum(std::span(weights).subspan(first, features));
  }
  return weights;
}

std::vector<Alignment> AlignAll(const MotionTemplate& motion_template,
                                std::span<const RecordingStreams> recordings,
                                const Background& background) {
  std::vector<Alignment> alignments;
  for (const RecordingStreams& recording : recordings) {
    if (recording.features.feature_count != motion_template.matrix.feature_count ||
        std::ssize(background.ones) != motion_template.matrix.feature_count) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("template '{}' has {} features, a performance {}, the background {}",
                              motion_template.name, motion_template.matrix.feature_count,
                              recording.features.feature_count, background.ones.size()));
    }
    alignments.push_back(Align(motion_template.matrix, ToTemplateMatrix(recording.features),
                               motion_template.learning));
  }
  return alignments;
}

// The background of each column: the general one, which counts as much as one counterexample, and
// what counterexamples show there.
std::vector<double> OnesOfColumns(const TemplateMatrix& matrix, const Background& background,
                                  std::span<const RecordingStreams> counterexamples,
                                  std::span<const Alignment> alignments) {
  std::vector<double> ones;
  ones.reserve(matrix.values.size());
  for (int column = 0; column < matrix.column_count(); ++column) {
    ones.insert(ones.end(), background.ones.begin(), background.ones.end());
  }
  for (std::size_t i = 0; i < counterexamples.size(); ++i) {
    const TemplateMatrix warped = WarpToReference(ToTemplateMatrix(counterexamples[i].features),
                                                  alignments[i], matrix.column_count());
    for (std::size_t v = 0; v < ones.size(); ++v) ones[v] += warped.values[v];
  }
  for (double& share : ones) share /= static_cast<double>(counterexamples.size() + 1);
  return ones;
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

// The general background, and with it what counterexamples show in this column.
PoseStatistics OthersIn(Moments counterexamples, const PoseStatistics& background) {
  if (counterexamples.empty()) return background;
  counterexamples.Add(background);
  return counterexamples.Statistics();
}

PoseModel ModelOf(std::span<const Moments> columns, std::span<const Moments> counterexamples,
                  const PoseStatistics& background) {
  PoseModel model;
  AppendAsFloats(background.variance, model.spread);
  for (std::size_t column = 0; column < columns.size(); ++column) {
    const PoseStatistics here = columns[column].Statistics();
    const PoseStatistics others = OthersIn(counterexamples[column], background);
    std::vector<double> weights;
    for (std::size_t i = 0; i < here.mean.size(); ++i) {
      const double spread = background.variance[i];
      const double floor = kVarianceFloor * spread;
      // The root, say, is always in its own place.
      weights.push_back(spread > 0 ? GaussianDivergence(here.mean[i], here.variance[i] + floor,
                                                        others.mean[i], others.variance[i])
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
    const FeatureView& matrix = recording.features;
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
                         const Background& background,
                         std::span<const RecordingStreams> counterexamples) {
  if (performances.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "no performances to measure a contrast with");
  }
  for (const RecordingStreams& each : performances) CheckPoses(each);
  for (const RecordingStreams& each : counterexamples) CheckPoses(each);
  const auto alignments = AlignAll(motion_template, performances, background);
  const auto counter_alignments = AlignAll(motion_template, counterexamples, background);
  const auto columns = MomentsOfColumns(motion_template, performances, alignments);
  const auto others = MomentsOfColumns(motion_template, counterexamples, counter_alignments);
  const std::vector<double> ones =
      OnesOfColumns(motion_template.matrix, background, counterexamples, counter_alignments);
  return {.entry_weights = WeighEntries(motion_template.matrix, performances.size(), ones),
          .places = ModelOf(columns, others, background.places),
          .background = background};
}

std::vector<double> MeasureEntryWeights(const MotionTemplate& motion_template,
                                        std::size_t performances, const Background& background,
                                        std::span<const RecordingStreams> counterexamples) {
  const auto alignments = AlignAll(motion_template, counterexamples, background);
  return WeighEntries(
      motion_template.matrix, performances,
      OnesOfColumns(motion_template.matrix, background, counterexamples, alignments));
}

}  // namespace kinebase
