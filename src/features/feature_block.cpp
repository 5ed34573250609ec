#include "features/feature_block.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "kinebase/features/smoothing.h"

namespace kinebase::internal {
namespace {

constexpr int kAxes = 3;

// Unlike std::min and std::max these never lose a NaN: where a joint is missing, so is what is
// measured by it. Without branches, so that they are applied to several samples at once.
double Smaller(double a, double b) {
  const bool is_a = static_cast<int>(a < b) | static_cast<int>(std::isnan(a));
  return is_a ? a : b;
}
double Larger(double a, double b) {
  const bool is_a = static_cast<int>(a > b) | static_cast<int>(std::isnan(a));
  return is_a ? a : b;
}

}  // namespace

FeatureBlock::FeatureBlock(const JointTrajectories& joints, std::span<const Feature> features)
    : joints_(joints) {
  for (const Feature& feature : features) {
    for (const FeatureTerm& term : feature.terms) {
      margin_ = std::max(margin_, BoxWidth(term.window_ms, joints.rate_hz));
    }
  }
}

void FeatureBlock::MoveTo(int first) {
  const int frames = joints_.frame_count();
  first_ = first;
  size_ = std::min(kBlockSize, frames - first);
  held_first_ = std::max(0, first - margin_);
  // One more after the margin: a step needs the sample after its own.
  const std::int64_t end = std::int64_t{first} + size_ + margin_ + 1;
  held_size_ = static_cast<int>(std::min<std::int64_t>(frames, end)) - held_first_;
  places_.resize(static_cast<std::size_t>(held_size_) * kStandardJointCount * kAxes);
  const auto stride = static_cast<std::size_t>(held_size_);
  for (int joint = 0; joint < kStandardJointCount; ++joint) {
    double* x = places_.data() + static_cast<std::size_t>(joint) * kAxes * stride;
    for (int i = 0; i < held_size_; ++i, ++x) {
      const Eigen::Vector3d& place = joints_.at(held_first_ + i, joint);
      x[0] = place.x();
      x[stride] = place.y();
      x[2 * stride] = place.z();
    }
  }
}

const double* FeatureBlock::Axis(int joint, int axis, int sample) const {
  const int row = joint * kAxes + axis;
  return places_.data() + static_cast<std::ptrdiff_t>(row) * held_size_ + (sample - held_first_);
}

FeatureBlock::Vectors FeatureBlock::Between(StandardJoint from, StandardJoint to) const {
  const auto a = static_cast<int>(from);
  const auto b = static_cast<int>(to);
  return {At(b, 0) - At(a, 0), At(b, 1) - At(a, 1), At(b, 2) - At(a, 2)};
}

BlockValues FeatureBlock::Dot(const Vectors& a, const Vectors& b) {
  // In the order in which Eigen adds: sums in another one have other last bits.
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

// A direction that does not exist gives NaN, which passes no test.
FeatureBlock::Vectors FeatureBlock::Unit(const Vectors& v) {
  const BlockValues length = Dot(v, v).sqrt();
  return {v.x / length, v.y / length, v.z / length};
}

BlockValues FeatureBlock::AngleDegrees(const Vectors& a, const Vectors& b) {
  BlockValues angle = Dot(a, b) / (Dot(a, a).sqrt() * Dot(b, b).sqrt());
  for (double& value : angle) {
    value = std::acos(std::clamp(value, -1.0, 1.0)) * 180 / std::numbers::pi;
  }
  return angle;
}

BlockValues FeatureBlock::Evaluate(const Feature& feature) {
  BlockValues values = Evaluate(feature.terms.front());
  for (std::size_t i = 1; i < feature.terms.size(); ++i) {
    const BlockValues term = Evaluate(feature.terms[i]);
    if (feature.combination == TermCombination::kSum) {
      values += term;
    } else {
      for (int t = 0; t < size_; ++t) values[t] = Smaller(values[t], term[t]);
    }
  }
  return values;
}

BlockValues FeatureBlock::Evaluate(const FeatureTerm& term) {
  const BlockValues values = Raw(term);
  if (term.absolute) return values.abs() * term.factor;
  return values * term.factor;
}

BlockValues FeatureBlock::Raw(const FeatureTerm& term) {
  const auto& joints = term.joints;
  switch (term.type) {
    case TermType::kPlane:
      return Dot(PlaneNormal(term), Between(joints[2], joints[3]));
    case TermType::kNormalPlane:
      return Dot(Direction(term), Between(joints[2], joints[3]));
    case TermType::kAngle:
      return AngleDegrees(Between(joints[1], joints[0]), Between(joints[3], joints[2]));
    case TermType::kAngleWithUp: {
      const BlockValues zero = BlockValues::Zero(size_);
      return AngleDegrees(Between(joints[0], joints[1]), {zero, BlockValues::Ones(size_), zero});
    }
    case TermType::kNormalMove:
      return Dot(Direction(term), Velocity(joints[2], joints[3], term.window_ms));
    case TermType::kPlaneMove:
      return Dot(PlaneNormal(term), Velocity(joints[2], joints[3], term.window_ms));
    case TermType::kFast: {
      const Vectors velocity = Velocity(std::nullopt, joints[0], term.window_ms);
      return Dot(velocity, velocity).sqrt();
    }
    case TermType::kApproach:
      return Approach(term);
    case TermType::kHeight:
      return At(static_cast<int>(joints[0]), 1) - LowestY(term.ignored_joints);
    case TermType::kHeightExtent:
      return HighestY() - LowestY({});
    case TermType::kGroundExtent:
      return GroundExtent(joints);
  }
  return BlockValues::Zero(size_);
}

FeatureBlock::Vectors FeatureBlock::Direction(const FeatureTerm& term) const {
  return Unit(Between(term.joints[0], term.joints[1]));
}

FeatureBlock::Vectors FeatureBlock::PlaneNormal(const FeatureTerm& term) const {
  const Vectors a = Between(term.joints[2], term.joints[0]);
  const Vectors b = Between(term.joints[2], term.joints[1]);
  return Unit({a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x});
}

BlockValues FeatureBlock::Approach(const FeatureTerm& term) {
  const auto& joints = term.joints;
  const Vectors towards = Unit(Between(joints[3], joints[2]));
  const Vectors sideways = Unit(Between(joints[1], joints[0]));
  return Dot(Velocity(joints[2], joints[3], term.window_ms), towards) *
         Dot(towards, sideways).abs();
}

BlockValues FeatureBlock::LowestY(std::span<const StandardJoint> ignored) const {
  BlockValues low = BlockValues::Constant(size_, std::numeric_limits<double>::infinity());
  for (int joint = 0; joint < kStandardJointCount; ++joint) {
    if (std::ranges::find(ignored, static_cast<StandardJoint>(joint)) != ignored.end()) continue;
    const double* y = Axis(joint, 1, first_);
    for (int t = 0; t < size_; ++t) low[t] = Smaller(low[t], y[t]);
  }
  return low;
}

BlockValues FeatureBlock::HighestY() const {
  BlockValues high = BlockValues::Constant(size_, -std::numeric_limits<double>::infinity());
  for (int joint = 0; joint < kStandardJointCount; ++joint) {
    const double* y = Axis(joint, 1, first_);
    for (int t = 0; t < size_; ++t) high[t] = Larger(high[t], y[t]);
  }
  return high;
}

BlockValues FeatureBlock::GroundExtent(std::span<const StandardJoint> joints) const {
  std::vector<int> chosen;
  chosen.reserve(std::max<std::size_t>(joints.size(), kStandardJointCount));
  for (const StandardJoint joint : joints) chosen.push_back(static_cast<int>(joint));
  for (int joint = 0; joints.empty() && joint < kStandardJointCount; ++joint) {
    chosen.push_back(joint);
  }
  BlockValues largest = BlockValues::Zero(size_);
  for (std::size_t a = 0; a < chosen.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const BlockValues dx = At(chosen[a], 0) - At(chosen[b], 0);
      const BlockValues dz = At(chosen[a], 2) - At(chosen[b], 2);
      const BlockValues distance = dx * dx + dz * dz;
      for (int t = 0; t < size_; ++t) largest[t] = Larger(largest[t], distance[t]);
    }
  }
  return largest.sqrt();
}

FeatureBlock::Vectors FeatureBlock::Velocity(std::optional<StandardJoint> from, StandardJoint to,
                                             double window_ms) {
  const int width = BoxWidth(window_ms, joints_.rate_hz);
  const auto axis = [&](int i) -> BlockValues {
    const double* start = from ? Axis(static_cast<int>(*from), i, held_first_) : nullptr;
    const double* end = Axis(static_cast<int>(to), i, held_first_);
    return SmoothedSteps(start, end, width) * joints_.rate_hz;
  };
  return {axis(0), axis(1), axis(2)};
}

// From one sample to the next, of `to`, or of `to` seen from `from` if that is not null.
BlockValues FeatureBlock::SmoothedSteps(const double* from, const double* to, int width) {
  const int frames = joints_.frame_count();
  const auto step = [&](int a, int b) {  // Held samples.
    return from == nullptr ? to[b] - to[a] : (to[b] - from[b]) - (to[a] - from[a]);
  };
  steps_.resize(static_cast<std::size_t>(size_) + static_cast<std::size_t>(width) - 1);
  const int first = first_ - ((width + 1) / 2 - 1);
  if (first >= 0 && first + std::ssize(steps_) < frames) {
    const int held = first - held_first_;
    for (int i = 0; i < std::ssize(steps_); ++i) {
      steps_[static_cast<std::size_t>(i)] = step(held + i, held + i + 1);
    }
  } else {
    for (int i = 0; i < std::ssize(steps_); ++i) {
      // The last step is repeated: there is no sample after the last.
      const auto sample = static_cast<int>(ReflectedSample(first + i, frames));
      const int start = std::max(0, std::min(sample, frames - 2));
      steps_[static_cast<std::size_t>(i)] =
          step(start - held_first_, std::min(start + 1, frames - 1) - held_first_);
    }
  }
  BlockValues smooth(size_);
  if (width <= 1) {
    std::ranges::copy(steps_, smooth.data());
  } else {
    BoxFilterPadded(steps_, width, {smooth.data(), static_cast<std::size_t>(size_)});
  }
  return smooth;
}

}  // namespace kinebase::internal
