// Values, feature by feature over all samples, then thresholds with hysteresis.

#include "kinebase/features/feature_extraction.h"

#include <algorithm>
#include <cmath>

#include "features/feature_block.h"
#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/motion/motion_editing.h"

namespace kinebase {
namespace {

using internal::BlockValues;
using internal::FeatureBlock;
using internal::kBlockSize;

void CheckStandardJoints(const JointTrajectories& joints) {
  if (joints.joint_count != kStandardJointCount) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("features need the {} standard joints, found {}", kStandardJointCount,
                            joints.joint_count));
  }
  if (joints.frame_count() == 0) {
    throw Error(ErrorCode::kInvalidArgument, "features need at least one frame");
  }
}

// The recording at the rate of the feature set; `storage` holds it if it had to be resampled.
const JointTrajectories& AtRate(const JointTrajectories& joints, double rate_hz,
                                JointTrajectories& storage) {
  if (joints.rate_hz == rate_hz) return joints;
  storage = ResampleTrajectories(joints, rate_hz);
  return storage;
}

double LengthInFirstFrame(const JointTrajectories& joints, const BodyLength& length) {
  double sum = 0;
  for (const auto& [a, b] : length.segments) sum += (joints.at(0, a) - joints.at(0, b)).norm();
  return sum;
}

// Whether a feature holds, from one sample to the next.
class FeatureHysteresis {
 public:
  FeatureHysteresis(const Feature& feature, double unit)
      : test_(feature.test),
        strong_{feature.strong.low * unit, feature.strong.high * unit},
        weak_{feature.weak.low * unit, feature.weak.high * unit} {}

  bool Next(double value) {
    holds_ = Passes(value, holds_ ? weak_ : strong_);
    return holds_;
  }

 private:
  [[nodiscard]] bool Passes(double value, const Threshold& threshold) const {
    switch (test_) {
      case ThresholdTest::kAbove:
        return value > threshold.low;
      case ThresholdTest::kAtLeast:
        return value >= threshold.low;
      case ThresholdTest::kBelow:
        return value < threshold.low;
      case ThresholdTest::kAtMost:
        return value <= threshold.low;
      case ThresholdTest::kInside:
        return value >= threshold.low && value <= threshold.high;
    }
    return false;
  }

  ThresholdTest test_;
  Threshold strong_;
  Threshold weak_;
  bool holds_ = false;
};

std::vector<FeatureHysteresis> BeforeFirstSample(const JointTrajectories& joints,
                                                 const FeatureSet& features) {
  std::vector<FeatureHysteresis> states;
  states.reserve(features.features.size());
  for (const Feature& feature : features.features) {
    const auto length = static_cast<std::size_t>(feature.length);
    states.emplace_back(
        feature, feature.length < 0 ? 1 : LengthInFirstFrame(joints, features.lengths[length]));
  }
  return states;
}

}  // namespace

std::vector<double> FeatureValues(const JointTrajectories& standard_joints,
                                  const FeatureSet& features, int feature) {
  CheckStandardJoints(standard_joints);
  if (feature < 0 || feature >= features.feature_count()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("no feature {}: the set '{}' has 0 to {}", feature, features.name,
                            features.feature_count() - 1));
  }
  JointTrajectories storage;
  const JointTrajectories& joints = AtRate(standard_joints, features.rate_hz, storage);
  const Feature& row = features.features[static_cast<std::size_t>(feature)];
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(joints.frame_count()));
  FeatureBlock block(joints, {&row, 1});
  for (int first = 0; first < joints.frame_count(); first += kBlockSize) {
    block.MoveTo(first);
    const BlockValues some = block.Evaluate(row);
    values.insert(values.end(), some.begin(), some.end());
  }
  return values;
}

void CheckColumnRate(const FeatureSet& features, double rate_hz) {
  constexpr double kLargestStep = 1e9;  // Longer than any recording, and llround can hold it.
  const double ratio = features.rate_hz / rate_hz;
  if (rate_hz > 0 && ratio <= kLargestStep && std::round(ratio) >= 1 &&
      std::abs(ratio - std::round(ratio)) <= 1e-9) {
    return;
  }
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("rate {} Hz must divide the feature set's rate of {} Hz evenly, as "
                          "{} Hz does",
                          rate_hz, features.rate_hz, features.rate_hz / 4));
}

FeatureMatrix ExtractFeatures(const JointTrajectories& standard_joints, const FeatureSet& features,
                              double rate_hz) {
  CheckStandardJoints(standard_joints);
  CheckColumnRate(features, rate_hz);
  const auto step = static_cast<std::size_t>(std::llround(features.rate_hz / rate_hz));
  JointTrajectories storage;
  const JointTrajectories& joints = AtRate(standard_joints, features.rate_hz, storage);
  const auto samples = static_cast<std::size_t>(joints.frame_count());
  FeatureMatrix matrix{.rate_hz = rate_hz, .feature_count = features.feature_count()};
  matrix.columns.assign((samples + step - 1) / step, 0);
  std::vector<FeatureHysteresis> states = BeforeFirstSample(joints, features);
  FeatureBlock block(joints, features.features);
  for (int first = 0; first < joints.frame_count(); first += kBlockSize) {
    block.MoveTo(first);
    for (std::size_t row = 0; row < states.size(); ++row) {
      const BlockValues values = block.Evaluate(features.features[row]);
      // Hysteresis runs over all samples: what happens between two columns counts.
      auto t = static_cast<std::size_t>(first);
      for (const double value : values) {
        const bool holds = states[row].Next(value);
        if (holds && t % step == 0) matrix.columns[t / step] |= std::uint64_t{1} << row;
        ++t;
      }
    }
  }
  return matrix;
}

FrameRange FramesOfColumns(int first_column, int last_column, double column_rate_hz,
                           double recording_rate_hz, std::int64_t frame_count) {
  // Frame i stands for time i / rate; a span of time holds the frames from its start up to its end.
  constexpr double kRounding = 1e-6;
  const double frames_a_column = recording_rate_hz / column_rate_hz;
  const auto to_frame = [&](double frame) {
    return static_cast<std::int64_t>(std::clamp(frame, 0.0, static_cast<double>(frame_count - 1)));
  };
  const auto frame_from = [&](double column) {
    return std::ceil(column * frames_a_column - kRounding);
  };
  FrameRange range{.first = to_frame(frame_from(first_column)),
                   .last = to_frame(frame_from(last_column + 1.0) - 1)};
  if (range.first > range.last) {
    // A column shorter than a frame belongs to the frame that goes on during it.
    range.first = range.last = to_frame(first_column * frames_a_column + kRounding);
  }
  return range;
}

}  // namespace kinebase
