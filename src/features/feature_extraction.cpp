// Values, feature by feature over all samples, then thresholds with hysteresis.

#include "kinebase/features/feature_extraction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/features/smoothing.h"
#include "kinebase/motion/motion_editing.h"

namespace kinebase {
namespace {

using Eigen::Vector3d;

// Not Eigen's normalized(): that leaves a zero vector zero, and a direction that does not exist
// must give NaN, which passes no test.
Vector3d Unit(const Vector3d& v) { return v / v.norm(); }

// Unlike std::min and std::max these never lose a NaN: where a joint is missing, so is what is
// measured by it.
double Smaller(double a, double b) { return a < b || std::isnan(a) ? a : b; }
double Larger(double a, double b) { return a > b || std::isnan(a) ? a : b; }

double AngleDegrees(const Vector3d& a, const Vector3d& b) {
  const double cosine = a.dot(b) / (a.norm() * b.norm());
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

// One term of a feature over a whole recording.
class TermEvaluator {
 public:
  TermEvaluator(const JointTrajectories& joints, const FeatureTerm& term)
      : joints_(joints), term_(term), frames_(joints.frame_count()) {}

  std::vector<double> Evaluate() const {
    std::vector<double> values = Raw();
    for (double& value : values) {
      value = (term_.absolute ? std::abs(value) : value) * term_.factor;
    }
    return values;
  }

 private:
  const Vector3d& At(int frame, std::size_t joint) const {
    return joints_.at(frame, term_.joints[joint]);
  }

  template <typename Function>
  std::vector<double> ForEachFrame(Function function) const {
    std::vector<double> values(static_cast<std::size_t>(frames_));
    for (int frame = 0; frame < frames_; ++frame) {
      values[static_cast<std::size_t>(frame)] = function(frame);
    }
    return values;
  }

  std::vector<double> Raw() const {
    switch (term_.type) {
      case TermType::kPlane:
        return ForEachFrame([&](int t) { return PlaneNormal(t).dot(At(t, 3) - At(t, 2)); });
      case TermType::kNormalPlane:
        return ForEachFrame([&](int t) { return Direction(t).dot(At(t, 3) - At(t, 2)); });
      case TermType::kAngle:
        return ForEachFrame(
            [&](int t) { return AngleDegrees(At(t, 0) - At(t, 1), At(t, 2) - At(t, 3)); });
      case TermType::kAngleWithUp:
        return ForEachFrame(
            [&](int t) { return AngleDegrees(At(t, 1) - At(t, 0), Vector3d::UnitY()); });
      case TermType::kNormalMove:
        return Move([&](int t) { return Direction(t); });
      case TermType::kPlaneMove:
        return Move([&](int t) { return PlaneNormal(t); });
      case TermType::kFast:
        return Fast();
      case TermType::kApproach:
        return Approach();
      case TermType::kHeight:
        return ForEachFrame([&](int t) { return At(t, 0).y() - LowestY(t); });
      case TermType::kHeightExtent:
        return ForEachFrame([&](int t) { return HighestY(t) - LowestY(t); });
      case TermType::kGroundExtent:
        return ForEachFrame([&](int t) { return GroundExtent(t); });
    }
    return {};
  }

  Vector3d Direction(int t) const { return Unit(At(t, 1) - At(t, 0)); }
  Vector3d PlaneNormal(int t) const {
    return Unit((At(t, 0) - At(t, 2)).cross(At(t, 1) - At(t, 2)));
  }

  // Smoothed velocity of a moving point, cm/s, one array an axis.
  template <typename Function>
  std::array<std::vector<double>, 3> SmoothedVelocity(Function position) const {
    std::array<std::vector<double>, 3> velocity;
    for (auto& axis : velocity) axis.resize(static_cast<std::size_t>(frames_));
    for (int t = 0; t < frames_; ++t) {
      // The last difference is repeated: there is no sample after the last.
      const int from = std::max(0, std::min(t, frames_ - 2));
      const Vector3d step = position(std::min(from + 1, frames_ - 1)) - position(from);
      for (int axis = 0; axis < 3; ++axis) velocity[axis][static_cast<std::size_t>(t)] = step[axis];
    }
    const int width = BoxWidth(term_.window_ms, joints_.rate_hz);
    for (auto& axis : velocity) {
      axis = BoxFilter(axis, width);
      for (double& value : axis) value *= joints_.rate_hz;
    }
    return velocity;
  }

  template <typename Normal>
  std::vector<double> Move(Normal normal) const {
    const auto v = SmoothedVelocity([&](int t) { return Vector3d(At(t, 3) - At(t, 2)); });
    return ForEachFrame([&](int t) {
      const auto i = static_cast<std::size_t>(t);
      return normal(t).dot(Vector3d(v[0][i], v[1][i], v[2][i]));
    });
  }

  std::vector<double> Fast() const {
    const auto v = SmoothedVelocity([&](int t) { return At(t, 0); });
    return ForEachFrame([&](int t) {
      const auto i = static_cast<std::size_t>(t);
      return Vector3d(v[0][i], v[1][i], v[2][i]).norm();
    });
  }

  std::vector<double> Approach() const {
    const auto v = SmoothedVelocity([&](int t) { return Vector3d(At(t, 3) - At(t, 2)); });
    return ForEachFrame([&](int t) {
      const auto i = static_cast<std::size_t>(t);
      const Vector3d towards = Unit(At(t, 2) - At(t, 3));
      const Vector3d sideways = Unit(At(t, 0) - At(t, 1));
      return Vector3d(v[0][i], v[1][i], v[2][i]).dot(towards) * std::abs(towards.dot(sideways));
    });
  }

  double LowestY(int t) const {
    double low = std::numeric_limits<double>::infinity();
    for (int j = 0; j < kStandardJointCount; ++j) {
      const auto joint = static_cast<StandardJoint>(j);
      if (std::ranges::find(term_.ignored_joints, joint) != term_.ignored_joints.end()) continue;
      low = Smaller(low, joints_.at(t, joint).y());
    }
    return low;
  }

  double HighestY(int t) const {
    double high = -std::numeric_limits<double>::infinity();
    for (int j = 0; j < kStandardJointCount; ++j) high = Larger(high, joints_.at(t, j).y());
    return high;
  }

  double GroundExtent(int t) const {
    std::array<Vector3d, kStandardJointCount> points;
    std::size_t count = 0;
    if (term_.joints.empty()) {
      for (int j = 0; j < kStandardJointCount; ++j) points[count++] = joints_.at(t, j);
    } else {
      for (const StandardJoint joint : term_.joints) {
        if (count < points.size()) points[count++] = joints_.at(t, joint);
      }
    }
    double largest = 0;
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double dx = points[a].x() - points[b].x();
        const double dz = points[a].z() - points[b].z();
        largest = Larger(largest, dx * dx + dz * dz);
      }
    }
    return std::sqrt(largest);
  }

  const JointTrajectories& joints_;
  const FeatureTerm& term_;
  int frames_;
};

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

std::vector<double> Evaluate(const JointTrajectories& joints, const Feature& feature) {
  std::vector<double> values = TermEvaluator(joints, feature.terms.front()).Evaluate();
  for (std::size_t i = 1; i < feature.terms.size(); ++i) {
    const std::vector<double> term = TermEvaluator(joints, feature.terms[i]).Evaluate();
    for (std::size_t t = 0; t < values.size(); ++t) {
      values[t] = feature.combination == TermCombination::kSum ? values[t] + term[t]
                                                               : Smaller(values[t], term[t]);
    }
  }
  return values;
}

double LengthInFirstFrame(const JointTrajectories& joints, const BodyLength& length) {
  double sum = 0;
  for (const auto& [a, b] : length.segments) sum += (joints.at(0, a) - joints.at(0, b)).norm();
  return sum;
}

bool Passes(double value, ThresholdTest test, const Threshold& threshold, double unit) {
  switch (test) {
    case ThresholdTest::kAbove:
      return value > threshold.low * unit;
    case ThresholdTest::kAtLeast:
      return value >= threshold.low * unit;
    case ThresholdTest::kBelow:
      return value < threshold.low * unit;
    case ThresholdTest::kAtMost:
      return value <= threshold.low * unit;
    case ThresholdTest::kInside:
      return value >= threshold.low * unit && value <= threshold.high * unit;
  }
  return false;
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
  return Evaluate(AtRate(standard_joints, features.rate_hz, storage),
                  features.features[static_cast<std::size_t>(feature)]);
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
  for (int row = 0; row < features.feature_count(); ++row) {
    const Feature& feature = features.features[static_cast<std::size_t>(row)];
    const double unit =
        feature.length < 0
            ? 1
            : LengthInFirstFrame(joints,
                                 features.lengths[static_cast<std::size_t>(feature.length)]);
    const std::vector<double> values = Evaluate(joints, feature);
    // Hysteresis runs over all samples: what happens between two columns counts.
    bool state = false;
    for (std::size_t t = 0; t < samples; ++t) {
      state = state ? Passes(values[t], feature.test, feature.weak, unit)
                    : Passes(values[t], feature.test, feature.strong, unit);
      if (state && t % step == 0) matrix.columns[t / step] |= std::uint64_t{1} << row;
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
